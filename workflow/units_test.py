#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of the parts of a batch, without Snakemake and the program."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
import costs  # noqa: E402
import gather  # noqa: E402
import recordings  # noqa: E402
import step  # noqa: E402
import tree  # noqa: E402


class InFolder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name).resolve()

    def write(self, name, text):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / name).write_text(text)
        return self.folder / name


class Table(InFolder):
    def refused(self, text, part, name="t.csv"):
        with self.assertRaises(recordings.Failure) as failure:
            recordings.read(self.write(name, text))
        self.assertIn(part, str(failure.exception))
        self.assertNotIn("\n", str(failure.exception))

    def test_all_columns(self):
        table = self.write("t.tsv", "name\tsequence\tmodes\tsegmenter\tcamera\tframes\tsettings\troom\n"
                                    "a\trecordings/a\toff full off\tonnx:net.onnx\ttum_fr1\t5:20\tseed=1 loop.enabled=false\tlab\n")
        recording, = recordings.read(table)
        self.assertEqual(recording.modes, ("off", "full"))
        self.assertEqual(recording.segmenter_with_path(), f"onnx:{self.folder}/net.onnx")
        self.assertEqual(recording.camera_with_path(), "tum_fr1")
        self.assertEqual(recording.settings, ("seed=1", "loop.enabled=false"))
        self.assertEqual(recordings.frame_count(recording), 15)
        self.assertEqual([run.name for run in recordings.runs([recording])], ["a/off", "a/full"])
        self.assertEqual(recordings.rooms([recording]), {"lab/full": ["a/full"], "lab/off": ["a/off"]})

    def test_rooms_do_not_depend_on_the_order(self):
        rows = ["c,c,lab", "a,a,lab", "b,b,"]
        found = [recordings.rooms(recordings.read(self.write("t.csv", "\n".join(["name,sequence,room", *order]) + "\n")))
                 for order in (rows, rows[::-1])]
        self.assertEqual(found, [{"lab/full": ["a/full", "c/full"]}] * 2)

    def test_ground_truth(self):
        self.write("a/groundtruth.txt", "")
        table = self.write("t.csv", "name,sequence,groundtruth\na,a,\nb,b,\nc,a,none\nd,a,other.txt\n")
        own, absent, none, other = [recording.truth() for recording in recordings.read(table)]
        self.assertEqual((own, absent, none, other), (self.folder / "a/groundtruth.txt", None, None, self.folder / "other.txt"))

    def test_frames_are_never_too_few(self):
        for i in range(30):
            self.write(f"a/rgb/{i}.png", "")
            self.write(f"a/depth/{i}.png", "")
        self.write("b.bag", "x" * 1_000_000)
        table = self.write("t.csv", "name,sequence\na,a\nb,b.bag\nc,c\n")
        folder, bag, absent = [recordings.frame_count(recording) for recording in recordings.read(table)]
        self.assertGreaterEqual(folder, 30)
        self.assertGreater(bag, 1)
        self.assertEqual(absent, 0)

    def test_refuses(self):
        self.refused("", "no column name")
        self.refused("name,sequence\n", "no recording")
        self.refused("name,sequence,mode\na,a,off\n", "unknown columns mode")
        self.refused("name,sequence\na\n", "t.csv:2: expected as many values")
        self.refused("name,sequence\na,b,c\n", "t.csv:2: expected as many values")
        self.refused("name,sequence\na,\n", "a has no sequence")
        self.refused("name,sequence\n../a,b\n", "'../a' cannot be a name")
        self.refused("name,sequence,modes\na,b,../x\n", "'../x' cannot be a name")
        self.refused("name,sequence,room\na,b,/\n", "'/' cannot be a name")
        self.refused("name,sequence,frames\na,b,ten\n", "expected A:B")
        self.refused("name,sequence,settings\na,b,seed\n", "expected key=value")
        with self.assertRaises(recordings.Failure):
            recordings.read(self.folder / "absent.csv")


class Tree(unittest.TestCase):
    def test_every_leaf_is_below_the_root_once(self):
        for count in range(1, 40):
            leaves = list(range(count))

            def below(level, index):
                if level == 0:
                    return tree.leaves_below(leaves, 0, index)
                return [leaf for child in tree.children(count, level, index) for leaf in below(*tree.level_and_index(child))]

            level, index = tree.level_and_index(tree.root(count))
            self.assertEqual(below(level, index), leaves)
            self.assertEqual(tree.leaves_below(leaves, level, index), leaves)
            self.assertLess(2 ** level, max(2, count))


class Limits(unittest.TestCase):
    def test_are_above_the_measured_cost_and_grow(self):
        for name, cost in costs.MEASURED.items():
            for frames in (0, 100, 10_000):
                self.assertGreater(60 * costs.minutes(name, frames, 1), 2 * (cost.seconds + cost.seconds_a_frame * frames))
                self.assertGreater(costs.megabytes(name, frames, 1), cost.mb + cost.mb_a_frame * frames)
                self.assertEqual(costs.minutes(name, frames, 3), 3 * costs.minutes(name, frames, 1))


class Step(InFolder):
    def run_step(self, script, *options):
        command = [sys.executable, step.__file__, "outcome.json", *options, "--", "sh", "-c", script]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        outcome = self.folder / "outcome.json"
        return done.returncode, json.loads(outcome.read_text()) if outcome.is_file() else None

    def test_success(self):
        code, outcome = self.run_step("echo figures", "--stdout", "figures.txt")
        self.assertEqual((code, outcome["state"], outcome["message"]), (0, "done", ""))
        self.assertEqual((self.folder / "figures.txt").read_text(), "figures\n")

    def test_a_reason_is_an_outcome(self):
        code, outcome = self.run_step("echo 'stillmap: warning: old' >&2; echo 'stillmap: a.txt: bad' >&2; exit 2")
        self.assertEqual((code, outcome["state"], outcome["message"]), (0, "failed", "a.txt: bad"))
        code, outcome = self.run_step("exit 3")
        self.assertEqual((code, outcome["state"]), (0, "lost"))

    def test_what_may_end_otherwise_has_no_outcome(self):
        for script in ("kill -9 $$", "exit 1", "exit 4", "echo 'stillmap: out of memory: close' >&2; exit 2"):
            self.assertEqual(self.run_step(script), (1, None), script)

    def test_what_comes_after_a_failure_does_not_run(self):
        self.write("before.json", '{"state": "failed", "message": "a.txt: bad"}')
        code, outcome = self.run_step("touch ran", "--after", "before.json")
        self.assertEqual((code, outcome), (0, {"state": "failed", "message": "a.txt: bad"}))
        self.assertFalse((self.folder / "ran").exists())


class Gathered(InFolder):
    def test_names_what_has_no_outcome_and_writes_text_as_text(self):
        table = self.write("t.csv", "name,sequence,room\na,<b>|x,lab\n")
        gather.write(table, self.folder)
        result = json.loads((self.folder / "table.json").read_text())
        self.assertEqual((result["failed"], result["rows"][0]["state"]), (2, "failed"))
        self.assertIn("logs/run/a/full.log", result["rows"][0]["message"])
        self.write("outcomes/run/a/full.json", '{"state": "failed", "message": "<b>|x"}')
        gather.write(table, self.folder)
        self.assertIn("&lt;b&gt;|x", (self.folder / "index.html").read_text())
        self.assertNotIn("<b>", (self.folder / "index.html").read_text())
        self.assertIn("<b>\\|x", (self.folder / "table.md").read_text())


if __name__ == "__main__":
    unittest.main()
