#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of fetch_models, with a stand-in for npm: nothing is fetched."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parent / "fetch_models"


class FetchModels(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.models = self.folder / "data" / "models"
        self.calls = self.folder / "calls"
        (self.folder / "bin").mkdir()
        # Python with the packages for ONNX is not what is tested here.
        self.script = self.folder / "tools" / "fetch_models"
        self.script.parent.mkdir()
        text = TOOL.read_text().replace("python=/usr/bin/python3", "python=true")
        self.script.write_text(text)
        self.script.chmod(0o755)
        (self.folder / "tools" / "tfjs_to_onnx.py").write_text("")

    def run_with_npm(self, npm):
        program = self.folder / "bin" / "npm"
        program.write_text(f"#!/bin/sh\necho \"$@\" >>'{self.calls}'\n{npm}\n")
        program.chmod(0o755)
        environment = {**os.environ, "STILLMAP_MODELS": str(self.models),
                       "PATH": f"{self.folder}/bin:{os.environ['PATH']}"}
        return subprocess.run([self.script], env=environment, capture_output=True, text=True)

    def left_behind(self):
        """All files but the lock."""
        return sorted(str(path.relative_to(self.models)) for path in self.models.rglob("*")
                      if path.is_file() and path.name != ".lock")

    def test_another_content_is_not_used(self):
        result = self.run_with_npm("echo not it >package.tgz")
        self.assertEqual(result.returncode, 1)
        self.assertIn("SHA-256", result.stderr)
        self.assertIn("not used", result.stderr)
        self.assertEqual(self.left_behind(), [])

    def test_no_network(self):
        result = self.run_with_npm("echo ENOTFOUND >&2; exit 1")
        self.assertEqual(result.returncode, 1)
        self.assertIn("ENOTFOUND", result.stderr)
        self.assertIn("is the network there?", result.stderr)
        self.assertEqual(self.left_behind(), [])

    def test_packs_and_never_installs(self):
        self.run_with_npm("exit 1")
        self.assertRegex(self.calls.read_text(), r"^pack \S+@\d+\.\d+\.\d+ --ignore-scripts")

    def test_rest_of_an_interrupted_call_goes(self):
        (self.models / ".partial.abc").mkdir(parents=True)
        (self.models / ".partial.abc" / "part.tgz").write_text("x")
        self.run_with_npm("exit 1")
        self.assertEqual(self.left_behind(), [])

    def test_complete_needs_no_network(self):
        self.run_with_npm("exit 1")
        self.calls.unlink()
        text = TOOL.read_text()
        pins = [" ".join(re.search(rf"^{part}_{what}=(.*)$", text, re.MULTILINE).group(1)
                         for what in ("package", "sha256")) for part in ("runtime", "network")]
        (self.models / "include").mkdir()
        for name in ("libonnxruntime.so.1", "include/onnxruntime_cxx_api.h", "nanodet.onnx",
                     "selfie.onnx"):
            (self.models / name).write_text("x")
        checksum = subprocess.run(["cksum"], input="", capture_output=True, text=True,
                                  check=True).stdout.strip()
        (self.models / "libonnxruntime.so.1.from").write_text(pins[0] + "\n")
        (self.models / "nanodet.onnx.from").write_text(f"{pins[1]} {checksum}\n")
        result = self.run_with_npm("exit 1")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("complete", result.stdout)
        self.assertFalse(self.calls.exists())
        (self.models / "selfie.onnx").unlink()
        self.assertEqual(self.run_with_npm("exit 1").returncode, 1)


if __name__ == "__main__":
    unittest.main()
