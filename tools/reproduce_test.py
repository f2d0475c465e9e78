#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of ablation, reproduce and what they use; a script stands in for the program."""
import contextlib
import importlib.machinery
import importlib.util
import io
import json
import math
import os
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TOOLS = pathlib.Path(__file__).resolve().parent
import article_tables  # noqa: E402
import sequence_runs  # noqa: E402
import trajectory_plot  # noqa: E402


def tool(name):
    loader = importlib.machinery.SourceFileLoader(name, str(TOOLS / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


ablation, reproduce = tool("ablation"), tool("reproduce")

# Writes a report whose ATE tells the mode and the start; `view` writes its picture.
STAND_IN = """#!/usr/bin/env python3
import json, pathlib, sys
args = sys.argv[1:]
if args[0] == "view":
    pathlib.Path(args[args.index("--out") + 1]).write_text("picture")
    sys.exit()
out = pathlib.Path(args[args.index("--out") + 1])
mode = args[args.index("--dynamics") + 1]
start = int(args[args.index("--frames") + 1].rstrip(":"))
ate = {"off": 0.5, "paper": 0.004}.get(mode, 0.002) + 0.001 * start + (0.01 if "dynamics.jump.enabled=false" in args else 0)
error = {"rmse": ate, "std": ate / 2}
(out / "trajectory.txt").write_text("".join(f"{i} {i} 0 0 0 0 0 1\\n" for i in range(5)))
(out / "report.json").write_text(json.dumps({"ate": error, "rpe": {"trans": error, "rot_deg": error},
    "frames": {"tracked": 90 - start, "total": 90, "ratio": (90 - start) / 90}}))
"""


class Tools(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        program = self.folder / "stillmap"
        program.write_text(STAND_IN)
        program.chmod(0o755)
        own = sequence_runs.PROGRAM
        sequence_runs.PROGRAM = program
        self.addCleanup(setattr, sequence_runs, "PROGRAM", own)
        for name in ("rgbd_dataset_freiburg3_walking_xyz", "sitting_static", "desk"):
            (self.folder / "data" / name).mkdir(parents=True)
            (self.folder / "data" / name / "rgb.txt").write_text("")
            (self.folder / "data" / name / "groundtruth.txt").write_text(
                "".join(f"{i} 0 {i} 0 0 0 0 1\n" for i in range(5)))

    def run_tool(self, module, *arguments):
        sys.argv = ["tool", *map(str, arguments)]
        text = io.StringIO()
        with contextlib.redirect_stdout(text):
            module.main()
        return text.getvalue()


class Sums(unittest.TestCase):
    def test_sign_test_by_hand(self):
        self.assertEqual(sequence_runs.sign_test(7, 0), 2 / 128)
        self.assertEqual(sequence_runs.sign_test(1, 6), 2 * 8 / 128)
        self.assertEqual(sequence_runs.sign_test(3, 3), 1.0)
        self.assertEqual(sequence_runs.sign_test(0, 0), 1.0)

    def test_the_tables_are_those_of_the_article(self):
        self.assertEqual(article_tables.TABLES["ate"]["walking_xyz"]["Ours"], (0.0157, 0.0083))
        self.assertEqual(article_tables.TABLES["ate"]["walking_rpy"]["DS-SLAM"], (0.4442, 0.2350))
        self.assertEqual(article_tables.TABLES["rpe_rot"]["sitting_static"]["ORB-SLAM2"], (0.2881, 0.1244))
        self.assertEqual(article_tables.TABLES["tracked"]["walking_halfsphere"]["Dyna-SLAM"], (525, 1021))

    def test_a_turned_and_moved_trajectory_lies_on_the_truth(self):
        truth = [(float(i), (math.cos(i), math.sin(2 * i), 0.1 * i)) for i in range(20)]
        c, s = math.cos(0.7), math.sin(0.7)
        estimate = [(t, (c * x - s * y + 3, z - 1, s * x + c * y)) for t, (x, y, z) in truth]
        for (_, true), own in zip(truth, trajectory_plot.aligned(truth, [(t, (x, -z, y)) for t, (x, z, y) in estimate])):
            self.assertLess(math.dist(true, own), 1e-6)


class Ablation(Tools):
    def test_pairs_are_counted_and_marked_when_sure(self):
        text = self.run_tool(ablation, f"desk={self.folder / 'data/desk'}", "--modes", "full", "--jobs", 1)
        rows = {line.split("|")[1].strip(): line for line in text.splitlines()}
        self.assertIn("| 0.0050* |", rows["full"])
        self.assertIn("0.0150* **+7 -0**", rows["full, without jump"])
        self.assertIn("+7 -0, p = 0.016", rows["full, without jump"])
        self.assertIn("0.0050* +0 -0", rows["full, without extension"])

    def test_an_argument_that_is_no_folder_is_refused(self):
        with self.assertRaisesRegex(sequence_runs.Failure, "nowhere: expected NAME=FOLDER"):
            self.run_tool(ablation, "desk=nowhere")


class Reproduction(Tools):
    def test_published_and_own_figures_stand_in_one_column(self):
        out = self.folder / "out"
        self.run_tool(reproduce, self.folder / "data", "--out", out, "--modes", "off,paper", "--starts", 3)
        page = (out / "reproduction.md").read_text()
        self.assertIn("| **fr3 walking_xyz, published** | 0.7521 | 0.4712 | 0.0157 | 0.0083 |", page)
        self.assertIn("| rgbd_dataset_freiburg3_walking_xyz | 0.5010 | 0.2505 | 0.0050 | 0.0025 |", page)
        self.assertIn("| sitting_static | 88 / 90 | 97.8 % | 88 / 90 | 97.8 % |", page)
        self.assertNotIn("desk", page)
        results = json.loads((out / "reproduction.json").read_text())
        self.assertEqual(results["sitting_static"]["paper"]["tracked"], [88, 90])
        for picture in ("reproduction-map-sitting_static.jpg", "reproduction-trajectory-sitting_static.svg"):
            self.assertIn(picture, page)
            self.assertTrue((out / picture).is_file())
        self.assertIn("<td>0.0157</td>", (out / "reproduction.html").read_text())

    def test_a_folder_without_sequences_is_refused(self):
        with self.assertRaisesRegex(sequence_runs.Failure, "no folder in it ends with walking_halfsphere"):
            self.run_tool(reproduce, self.folder / "data/desk")


if __name__ == "__main__":
    os.environ.pop("STILLMAP", None)
    unittest.main()
