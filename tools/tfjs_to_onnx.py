#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Converts a TensorFlow.js graph model to ONNX.

tfjs_to_onnx.py MODEL.json OUT.onnx NAME=NODE...

MODEL.json stands beside its weight files. Only what the outputs NODE need is converted; in the ONNX
file they have the names NAME. Knows the operations of convolutional networks; an unknown one is an
error that names it. Needs Debian's python3-onnx and python3-numpy.

TensorFlow keeps channels last, ONNX convolves channels first: every convolution, pooling and
resizing gets a transposition before and after it, of which ONNX Runtime removes nearly all.
"""
import base64
import json
import os
import pathlib
import sys

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

OPSET = 13
CHANNELS_FIRST = [0, 3, 1, 2]
CHANNELS_LAST = [0, 2, 3, 1]
SAME_OP = {"Add": "Add", "AddV2": "Add", "BiasAdd": "Add", "Sub": "Sub", "Mul": "Mul",
           "RealDiv": "Div", "Maximum": "Max", "Minimum": "Min", "AddN": "Sum",
           "Relu": "Relu", "Sigmoid": "Sigmoid", "Tanh": "Tanh", "Exp": "Exp", "MatMul": "MatMul"}
POOLING = {"MaxPool": "MaxPool", "AvgPool": "AveragePool"}


class ConversionError(Exception):
    """What is wrong with the model, in one line."""


def read_weights(model, folder):
    """The constants of the model by name, as the node's own type (quantized ones restored)."""
    weights = {}
    for group in model["weightsManifest"]:
        data = b"".join((folder / name).read_bytes() for name in group["paths"])
        start = 0
        for entry in group["weights"]:
            stored = np.dtype(entry.get("quantization", entry)["dtype"])
            count = int(np.prod(entry["shape"], dtype=np.int64))
            if start + count * stored.itemsize > len(data):
                raise ConversionError(f"{group['paths'][0]} ends within {entry['name']}")
            values = np.frombuffer(data, stored, count, start).reshape(entry["shape"])
            start += count * stored.itemsize
            if "scale" in entry.get("quantization", {}):
                steps = entry["quantization"]
                values = values.astype(np.float32) * steps["scale"] + steps["min"]
            weights[entry["name"]] = values.astype(entry["dtype"])
    return weights


def dense(index, shape, values, default):
    """TensorFlow's SparseToDense."""
    array = np.full(tuple(int(n) for n in shape), default, dtype=values.dtype)
    rows = np.atleast_1d(index)
    rows = rows.reshape(-1, 1) if rows.ndim == 1 else rows
    array[tuple(rows.T)] = values
    return array


class Node:
    """A node of the TensorFlow graph."""

    def __init__(self, node):
        self.name = node["name"]
        self.op = node["op"]
        self.inputs = [name for name in node.get("input", []) if not name.startswith("^")]
        self.attributes = node.get("attr", {})

    def numbers(self, key):
        listed = self.attributes.get(key, {}).get("list", {})
        return [int(n) for n in listed.get("i", [])]

    def words(self, key):
        listed = self.attributes.get(key, {}).get("list", {})
        return [base64.b64decode(word).decode() for word in listed.get("s", [])]

    def word(self, key, default=""):
        value = self.attributes.get(key, {}).get("s")
        return default if value is None else base64.b64decode(value).decode()

    def value(self, key, kind, default):
        return self.attributes.get(key, {}).get(kind, default)


class Converter:
    def __init__(self, model, weights):
        self.nodes = {node["name"]: Node(node) for node in model["modelTopology"]["node"]}
        self.weights = weights
        self.made = {}  # (TensorFlow's node, its output) -> ONNX's name
        self.onnx_nodes = []
        self.initializers = []
        self.inputs = []

    # -- what is known while converting

    def node(self, reference):
        name = reference.split(":")[0]
        if name not in self.nodes:
            raise ConversionError(f"the model has no node '{name}'")
        return self.nodes[name]

    def constant(self, reference):
        """The value of a node that does not depend on the input, else None."""
        node = self.node(reference)
        if node.op == "Const":
            return self.weights[node.name]
        if node.op not in ("Identity", "Add", "AddV2", "SparseToDense"):
            return None
        values = [self.constant(name) for name in node.inputs]
        if any(value is None for value in values):
            return None
        if node.op == "SparseToDense":
            return dense(*values)
        return values[0] if node.op == "Identity" else values[0] + values[1]

    def known(self, node, index):
        value = self.constant(node.inputs[index])
        if value is None:
            raise ConversionError(f"{node.op} '{node.name}': input {index} is not constant")
        return value

    # -- making ONNX nodes

    def emit(self, op, inputs, outputs=1, **attributes):
        names = [f"t{len(self.onnx_nodes)}_{i}" for i in range(outputs)]
        self.onnx_nodes.append(helper.make_node(op, inputs, names, **attributes))
        return names[0] if outputs == 1 else names

    def store(self, array):
        name = f"c{len(self.initializers)}"
        if array.dtype == np.int32:
            array = array.astype(np.int64)
        self.initializers.append(numpy_helper.from_array(np.ascontiguousarray(array), name))
        return name

    def first(self, name):
        return self.emit("Transpose", [name], perm=CHANNELS_FIRST)

    def last(self, name):
        return self.emit("Transpose", [name], perm=CHANNELS_LAST)

    def get(self, reference):
        """ONNX's name of a TensorFlow output, converting what it needs."""
        node = self.node(reference)
        index = int(reference.partition(":")[2] or 0)
        if (node.name, index) not in self.made:
            made = self.convert(node)
            names = made if isinstance(made, list) else [made]
            self.made.update({(node.name, i): name for i, name in enumerate(names)})
        return self.made[node.name, index]

    def convert(self, node):
        value = self.constant(node.name)
        if value is not None:
            return self.store(value)
        if node.op in SAME_OP:
            return self.emit(SAME_OP[node.op], [self.get(name) for name in node.inputs])
        if node.op in POOLING:
            return self.pooling(node)
        method = getattr(self, "op_" + node.op.lstrip("_"), None)
        if method is None:
            raise ConversionError(f"operation {node.op} ('{node.name}') is not known")
        return method(node)

    def activation(self, name, op, node):
        if op == "Relu6":
            bounds = [self.store(np.float32(bound)) for bound in (0, 6)]
            return self.emit("Clip", [name, *bounds])
        if op == "LeakyRelu":
            key = "alpha" if node.op == "LeakyRelu" else "leakyrelu_alpha"
            return self.emit(op, [name], alpha=float(node.value(key, "f", 0.2)))
        if op == "Prelu":
            slope = self.known(node, 3).reshape(-1, 1, 1)
            return self.emit("PRelu", [name, self.store(slope)])
        if op in ("Relu", "Sigmoid"):
            return self.emit(op, [name])
        raise ConversionError(f"activation {op} ('{node.name}') is not known")

    # -- convolutions and pooling

    def padding(self, node):
        how = node.word("padding")
        if how == "EXPLICIT":
            pads = node.numbers("explicit_paddings")
            return {"pads": [pads[2], pads[4], pads[3], pads[5]]}
        return {"auto_pad": "SAME_UPPER" if how == "SAME" else "VALID"}

    def convolution(self, node, weights, groups):
        if node.word("data_format", "NHWC") != "NHWC":
            raise ConversionError(f"{node.op} '{node.name}': expected channels last")
        inputs = [self.first(self.get(node.inputs[0])), self.store(weights)]
        fused = node.words("fused_ops")
        if "BiasAdd" in fused:
            inputs.append(self.store(self.known(node, 2)))
        dilations = node.numbers("dilations") or [1, 1, 1, 1]
        name = self.emit("Conv", inputs, kernel_shape=weights.shape[2:], group=groups,
                         strides=node.numbers("strides")[1:3], dilations=dilations[1:3],
                         **self.padding(node))
        for op in fused:
            name = name if op == "BiasAdd" else self.activation(name, op, node)
        return self.last(name)

    def op_Conv2D(self, node):
        return self.convolution(node, self.known(node, 1).transpose(3, 2, 0, 1), 1)

    def op_DepthwiseConv2dNative(self, node):
        weights = self.known(node, 1)
        height, width, channels, multiplier = weights.shape
        shape = (channels * multiplier, 1, height, width)
        return self.convolution(node, weights.transpose(2, 3, 0, 1).reshape(shape), channels)

    op_FusedConv2D = op_Conv2D
    op_FusedDepthwiseConv2dNative = op_DepthwiseConv2dNative

    def op_Conv2DBackpropInput(self, node):
        weights = self.known(node, 1).transpose(3, 2, 0, 1)
        inputs = [self.first(self.get(node.inputs[2])), self.store(weights)]
        size = [int(n) for n in self.known(node, 0)[1:3]]
        return self.last(self.emit("ConvTranspose", inputs, kernel_shape=weights.shape[2:],
                                   strides=node.numbers("strides")[1:3], output_shape=size,
                                   **self.padding(node)))

    def pooling(self, node):
        name = self.first(self.get(node.inputs[0]))
        return self.last(self.emit(POOLING[node.op], [name], kernel_shape=node.numbers("ksize")[1:3],
                                   strides=node.numbers("strides")[1:3], **self.padding(node)))

    def op_ResizeBilinear(self, node):
        name = self.first(self.get(node.inputs[0]))
        shape = self.emit("Shape", [name])
        ends = [self.store(np.array([n])) for n in (0, 2)]
        kept = self.emit("Slice", [shape, *ends])
        size = self.emit("Concat", [kept, self.store(self.known(node, 1).astype(np.int64))], axis=0)
        grid = ("align_corners" if node.value("align_corners", "b", False) else
                "half_pixel" if node.value("half_pixel_centers", "b", False) else "asymmetric")
        return self.last(self.emit("Resize", [name, "", "", size], mode="linear",
                                   coordinate_transformation_mode=grid))

    # -- everything else

    def op_Placeholder(self, node):
        sizes = [max(1, int(dim["size"])) for dim in node.value("shape", "shape", {})["dim"]]
        self.inputs.append(helper.make_tensor_value_info(node.name, TensorProto.FLOAT, sizes))
        return node.name

    def op_Identity(self, node):
        return self.get(node.inputs[0])

    def op_Relu6(self, node):
        return self.activation(self.get(node.inputs[0]), node.op, node)

    op_LeakyRelu = op_Relu6

    def op_Transpose(self, node):
        return self.emit("Transpose", [self.get(node.inputs[0])], perm=self.known(node, 1).tolist())

    def op_Pad(self, node):
        inputs = [self.get(node.inputs[0]), self.store(self.known(node, 1).T.reshape(-1))]
        if node.op == "PadV2":
            inputs.append(self.store(self.known(node, 2)))
        return self.emit("Pad", inputs)

    op_PadV2 = op_Pad

    def op_ConcatV2(self, node):
        names = [self.get(name) for name in node.inputs[:-1]]
        return self.emit("Concat", names, axis=int(self.known(node, -1)))

    def op_Mean(self, node):
        axes = [int(axis) for axis in np.atleast_1d(self.known(node, 1))]
        return self.emit("ReduceMean", [self.get(node.inputs[0])], axes=axes,
                         keepdims=int(node.value("keep_dims", "b", False)))

    def op_Reshape(self, node):
        return self.emit("Reshape", [self.get(node.inputs[0]), self.store(self.known(node, 1))])

    def op_SplitV(self, node):
        sizes = self.known(node, 1)
        names = self.emit("Split", [self.get(node.inputs[0]), self.store(sizes)], len(sizes),
                          axis=int(self.known(node, 2)))
        return names if len(sizes) > 1 else [names]

    # -- the whole

    def model(self, outputs):
        """The ONNX model; `outputs` maps its output names to TensorFlow nodes."""
        for name, reference in outputs.items():
            self.onnx_nodes.append(helper.make_node("Identity", [self.get(reference)], [name]))
        results = [helper.make_tensor_value_info(name, TensorProto.FLOAT, None) for name in outputs]
        graph = helper.make_graph(self.onnx_nodes, "graph", self.inputs, results, self.initializers)
        made = helper.make_model(graph, opset_imports=[helper.make_opsetid("", OPSET)],
                                 producer_name="stillmap")
        made.ir_version = 8
        made = onnx.shape_inference.infer_shapes(made)
        onnx.checker.check_model(made)
        return made


def convert_file(source, target, outputs):
    try:
        model = json.loads(source.read_text())
        weights = read_weights(model, source.parent)
    except (ValueError, KeyError, TypeError) as error:
        raise ConversionError(f"no TensorFlow.js graph model: {error!r}") from error
    converted = Converter(model, weights).model(outputs)
    partial = target.with_name(target.name + ".partial")
    partial.write_bytes(converted.SerializeToString())
    os.replace(partial, target)


def main(arguments):
    if len(arguments) < 3 or not all("=" in output for output in arguments[2:]):
        print("usage: tfjs_to_onnx.py MODEL.json OUT.onnx NAME=NODE...", file=sys.stderr)
        return 2
    sys.setrecursionlimit(100000)  # a deep network is a deep recursion
    source, target = (pathlib.Path(name) for name in arguments[:2])
    try:
        convert_file(source, target, dict(output.split("=", 1) for output in arguments[2:]))
    except (ConversionError, OSError) as error:
        print(f"tfjs_to_onnx: {source}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
