#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of tfjs_to_onnx.py; skipped where python3-onnx is not there."""
import base64
import json
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
try:
    import numpy as np
    import onnx
    import tfjs_to_onnx
except ImportError as error:
    print(f"tfjs_to_onnx_test: skipped: {error}")
    sys.exit(0)


def node(name, op, inputs=(), **attributes):
    return {"name": name, "op": op, "input": list(inputs), "attr": attributes}


def numbers(*values):
    return {"list": {"i": [str(value) for value in values]}}


def word(text):
    return {"s": base64.b64encode(text.encode()).decode()}


def entry(name, shape, kind, **quantization):
    made = {"name": name, "shape": shape, "dtype": kind}
    return {**made, "quantization": quantization} if quantization else made


class Weights(unittest.TestCase):
    def read(self, data, *entries):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "a.bin").write_bytes(data[:5])
            (pathlib.Path(folder) / "b.bin").write_bytes(data[5:])
            model = {"weightsManifest": [{"paths": ["a.bin", "b.bin"], "weights": list(entries)}]}
            return tfjs_to_onnx.read_weights(model, pathlib.Path(folder))

    def test_kinds_one_after_another(self):
        data = (np.array([1.5, -2], "<f4").tobytes() + np.array([[7], [-8]], "<i4").tobytes()
                + np.array([0.5], "<f2").tobytes() + bytes([0, 10, 255]))
        weights = self.read(
            data, entry("f", [2], "float32"), entry("i", [2, 1], "int32"),
            entry("h", [], "float32", dtype="float16"),
            entry("q", [3], "float32", dtype="uint8", scale=0.5, min=-1))
        self.assertEqual(weights["f"].tolist(), [1.5, -2])
        self.assertEqual(weights["i"].tolist(), [[7], [-8]])
        self.assertEqual(weights["h"].tolist(), 0.5)
        self.assertEqual(weights["h"].dtype, np.float32)
        self.assertEqual(weights["q"].tolist(), [-1, 4, 126.5])

    def test_too_short(self):
        with self.assertRaisesRegex(tfjs_to_onnx.ConversionError, "ends within f"):
            self.read(bytes(7), entry("f", [2], "float32"))

    def test_dense(self):
        index, values = np.array([[0, 1], [1, 0]]), np.array([5, 6])
        self.assertEqual(tfjs_to_onnx.dense(index, np.array([2, 2]), values, 9).tolist(),
                         [[9, 5], [6, 9]])
        self.assertEqual(tfjs_to_onnx.dense(np.array(2), np.array([3]), np.array(4), 0).tolist(),
                         [0, 0, 4])


class Graph(unittest.TestCase):
    def convert(self, nodes, weights, **outputs):
        placeholder = node("in", "Placeholder", shape={"shape": {"dim": [
            {"size": size} for size in ("-1", "4", "4", "3")]}})
        model = {"modelTopology": {"node": [placeholder, *nodes]}}
        return tfjs_to_onnx.Converter(model, weights).model(outputs)

    def test_a_convolution_with_all_that_is_fused(self):
        weights = {"w": np.arange(54, dtype=np.float32).reshape(3, 3, 3, 2),
                   "b": np.array([1, 2], np.float32)}
        fused = {"list": {"s": [base64.b64encode(op).decode() for op in (b"BiasAdd", b"Relu6")]}}
        model = self.convert(
            [node("w", "Const"), node("b", "Const"),
             node("c", "_FusedConv2D", ("in", "w", "b"), strides=numbers(1, 2, 2, 1),
                  padding=word("SAME"), fused_ops=fused)],
            weights, result="c")
        ops = [made.op_type for made in model.graph.node]
        self.assertEqual(ops, ["Transpose", "Conv", "Clip", "Transpose", "Identity"])
        shape = [dim.dim_value for dim in model.graph.output[0].type.tensor_type.shape.dim]
        self.assertEqual((model.graph.output[0].name, shape), ("result", [1, 2, 2, 2]))
        kernel = onnx.numpy_helper.to_array(model.graph.initializer[0])
        # Output 1, input 2, row 0, column 1 of the kernel.
        self.assertEqual(kernel[1, 2, 0, 1], weights["w"][0, 1, 2, 1])

    def test_what_no_output_needs_is_left_out(self):
        model = self.convert([node("r", "Relu", ("in",)), node("x", "Unheard", ("r",))], {}, y="r")
        self.assertEqual([made.op_type for made in model.graph.node], ["Relu", "Identity"])

    def test_unknown_operation(self):
        with self.assertRaisesRegex(tfjs_to_onnx.ConversionError, "Unheard"):
            self.convert([node("x", "Unheard", ("in",))], {}, y="x")
        with self.assertRaisesRegex(tfjs_to_onnx.ConversionError, "no node 'z'"):
            self.convert([], {}, y="z")


class Program(unittest.TestCase):
    def test_bad_files(self):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder) / "m.json"
            target = pathlib.Path(folder) / "m.onnx"
            for text in ("", "[1]", json.dumps({"weightsManifest": 3})):
                source.write_text(text)
                self.assertEqual(tfjs_to_onnx.main([str(source), str(target), "y=x"]), 1)
            self.assertEqual(tfjs_to_onnx.main([str(target), str(target), "y=x"]), 1)
            self.assertEqual(tfjs_to_onnx.main([str(source)]), 2)
            self.assertFalse(target.exists())


if __name__ == "__main__":
    unittest.main()
