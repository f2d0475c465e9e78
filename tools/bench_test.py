#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of bench_runs and bench_compare and what they use; a script stands in for the program."""
import importlib.machinery
import importlib.util
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

sys.dont_write_bytecode = True
TOOLS = pathlib.Path(__file__).resolve().parent
import there_and_back  # noqa: E402
import watched_run  # noqa: E402


def tool(name):
    loader = importlib.machinery.SourceFileLoader(name, str(TOOLS / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


bench_runs, bench_compare, benchmark_page = tool("bench_runs"), tool("bench_compare"), tool("benchmark_page")
soak = tool("soak")


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def sequence(self, name="office"):
        """Three pairs, 0.1 s and then 0.3 s apart; depth comes 5 ms later; a colour image is without depth."""
        folder = self.folder / name
        (folder / "rgb").mkdir(parents=True)
        (folder / "depth").mkdir()
        for k in range(3):
            (folder / f"rgb/{k}.png").write_text(f"colour {k}")
            (folder / f"depth/{k}.png").write_text(f"depth {k}")
        (folder / "rgb.txt").write_text("# colour\n10.000000 rgb/0.png\n10.05 rgb/none.png\n10.1 rgb/1.png\n10.4 rgb/2.png\n")
        (folder / "depth.txt").write_text("10.005000 depth/0.png\n10.105000 depth/1.png\n10.405000 depth/2.png\n")
        (folder / "groundtruth.txt").write_text(
            "".join(f"{10 + 0.1 * i + 0.002:.3f} {i} 0 0 0 0 0 1\n" for i in range(5)))
        (folder / "detections/masks").mkdir(parents=True)
        (folder / "detections/masks/10.1.png").write_text("mask 1")
        (folder / "detections/detections.jsonl").write_text(
            '{"stamp":"10.000000","objects":[]}\n'
            '{"stamp":"10.1","objects":[{"id":1,"class":"person","score":0.5,"box":[0,0,2,2]}]}\n'
            '{"stamp":"10.4","objects":[]}\n')
        return folder


class ThereAndBack(Folder):
    def table(self, name):
        return [line.split() for line in (self.folder / "long" / name).read_text().splitlines()]

    def test_goes_there_and_back(self):
        self.assertEqual([i for i, _ in there_and_back.walk(3, 9)], [0, 1, 2, 1, 0, 1, 2, 1, 0])
        self.assertEqual([d for _, d in there_and_back.walk(3, 6)], [1, 1, 1, -1, 1, 1])

    def test_stamps_go_on_as_frames_are_apart(self):
        there_and_back.write(self.sequence(), self.folder / "long", 6)
        rows = self.table("associations.txt")
        self.assertEqual([r[0] for r in rows], ["10.000000", "10.100000", "10.400000", "10.700000", "10.800000", "10.900000"])
        self.assertEqual([r[1] for r in rows], [f"rgb/{k}.png" for k in (0, 1, 2, 1, 0, 1)])
        # Backwards in time what came later comes earlier.
        self.assertEqual([r[2] for r in rows], ["10.005000", "10.105000", "10.405000", "10.695000", "10.805000", "10.905000"])
        self.assertEqual([r[3] for r in rows], [f"depth/{k}.png" for k in (0, 1, 2, 1, 0, 1)])
        self.assertEqual([r[:2] for r in rows], self.table("rgb.txt"))

    def test_images_are_those_of_the_original(self):
        there_and_back.write(self.sequence(), self.folder / "long", 6)
        texts = [(self.folder / "long" / row[1]).read_text() for row in self.table("rgb.txt")]
        self.assertEqual(texts, [f"colour {k}" for k in (0, 1, 2, 1, 0, 1)])

    def test_poses_are_those_of_the_frames(self):
        there_and_back.write(self.sequence(), self.folder / "long", 5)
        rows = self.table("groundtruth.txt")
        self.assertEqual([r[1] for r in rows], ["0", "1", "4", "1", "0"])
        self.assertEqual([r[0] for r in rows], ["10.002000", "10.102000", "10.402000", "10.698000", "10.802000"])

    def test_detections_have_the_new_stamps(self):
        folder = self.sequence()
        there_and_back.write(folder, self.folder / "long", 5, folder / "detections")
        found = self.folder / "long/detections"
        lines = [json.loads(line) for line in (found / "detections.jsonl").read_text().splitlines()]
        self.assertEqual([line["stamp"] for line in lines], [r[0] for r in self.table("rgb.txt")])
        self.assertEqual([len(line["objects"]) for line in lines], [0, 1, 0, 1, 0])
        self.assertEqual(sorted(p.name for p in (found / "masks").iterdir()), ["10.100000.png", "10.700000.png"])
        self.assertEqual((found / "masks/10.700000.png").read_text(), "mask 1")

    def test_own_length_unless_another_is_given(self):
        self.assertEqual(there_and_back.write(self.sequence(), self.folder / "long"), 3)

    def test_leads_nowhere_else(self):
        folder = self.sequence()
        (folder / "associations.txt").write_text("10.0 ../rgb/0.png 10.0 depth/0.png\n")
        with self.assertRaisesRegex(there_and_back.Broken, "leads out of the sequence"):
            there_and_back.write(folder, self.folder / "long")

    def test_closest_stamps_belong_together(self):
        self.assertEqual(there_and_back.closest_pairs([1.0, 1.01, 2.0], [1.009, 1.03, 2.5]), [(1, 0)])


PROGRAM = r'''#!/usr/bin/env python3
import json, pathlib, sys, time
a = sys.argv[1:]
if a[0] == "evaluate":
    assert a[1] == "map" and pathlib.Path(a[2]).is_file() and "--static" in a
    print(json.dumps({"map": {"sa": 0.96, "da": None, "points": 7}}))
    sys.exit()
assert a[0] == "run" and sys.stderr.isatty()
frames = len((pathlib.Path(a[1]) / "rgb.txt").read_text().splitlines())
if frames == 13:
    sys.exit("stillmap: a bad number")
held = []
for k in range(1, frames + 1):
    held.append(bytearray(2**20 if k > frames // 2 else 1))
    sys.stderr.write(f"\r[##] {100 * k // frames} %  {k}/{frames} frames")
    sys.stderr.flush()
    time.sleep(0.01)  # to be watched
time.sleep(0.2)
out = pathlib.Path(a[a.index("--out") + 1])
out.mkdir()
(out / "map.ply").write_text("ply")
time_ = {"mean": 2.0, "median": 2, "p95": 3, "max": 4}
stage = {"mean": 1.0 if frames < 50 else 1.5, "median": 1, "p95": 1, "max": 1}
(out / "report.json").write_text(json.dumps({
    "frames": {"total": frames, "ratio": 1}, "keyframes": frames // 10, "ate": {"rmse": None},
    "time": {"wall_s": 2, "frame_ms": time_, "stages_ms": {"tracking": stage}}, "memory": {"peak_mb": frames}}))
'''


class Runs(Folder):
    def setUp(self):
        super().setUp()
        self.program = self.folder / "stillmap"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)

    def bench(self, *arguments):
        return subprocess.run([TOOLS / "bench_runs", "--program", self.program, "--out", self.folder / "results.json",
                               f"office={self.sequence()}", *arguments], capture_output=True, text=True)

    def results(self):
        return json.loads((self.folder / "results.json").read_text())

    def test_runs_and_growth(self):
        done = self.bench("--lengths", "80,40")
        self.assertEqual(done.returncode, 0, done.stderr)
        results = self.results()
        self.assertEqual(list(results["runs"]), ["office, 3 frames, 1 thread", "office, 3 frames, 2 threads",
                                                 "office, 40 frames, 1 thread", "office, 80 frames, 1 thread"])
        run = results["runs"]["office, 80 frames, 1 thread"]
        self.assertEqual((run["fps"], run["key_frames"], run["frame_ms"]["p95"], run["ate_m"]), (40, 8, 3, None))
        first, _, last = run["thirds"]
        self.assertGreater(last["memory_mb"] - first["memory_mb"], 20)  # 40 MB in the second half
        grown = results["growth"]["office, from 40 to 80 frames"]
        self.assertEqual(grown["further_key_frames"], 4)
        self.assertEqual(grown["peak_mb_per_key_frame"], 10)
        self.assertEqual(grown["stages_ms"], {"tracking": 2.0})  # (80 * 1.5 - 40 * 1) / 40
        self.assertIn("last third against first", done.stdout)
        self.assertEqual(bench_compare.compare(results, results)[1:], ([], []))

    def test_page_has_the_figures(self):
        truth = self.folder / "office/truth"
        truth.mkdir(parents=True)
        (truth / "static_map.ply").write_text("ply")
        (truth / "objects.json").write_text("the camera")
        self.assertEqual(self.bench("--lengths", "40").returncode, 0)
        docs, page = self.folder / "docs.md", self.folder / "page.html"
        docs.write_text(f"What it is.\n{benchmark_page.MARKER}old figures\n")
        done = subprocess.run([TOOLS / "benchmark_page", self.folder / "results.json", "--docs", docs, "--html", page],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        text = docs.read_text()
        self.assertTrue(text.startswith(f"What it is.\n{benchmark_page.MARKER}"))
        self.assertNotIn("old figures", text)
        self.assertIn("| office | 3 |  | 100.0% | 0.960 |  |  |  |  |\n", text)
        self.assertIn("| office, 40 frames, 1 thread | 20.0 |", text)
        self.assertIn("| office, from 3 to 40 frames | 4 |", text)
        self.assertIn("<polyline", page.read_text())
        xml.etree.ElementTree.fromstring(re.search("<svg.*?</svg>", page.read_text()).group())
        (self.folder / "results.json").write_text("{}")
        bad = subprocess.run([TOOLS / "benchmark_page", self.folder / "results.json", "--docs", docs], capture_output=True, text=True)
        self.assertEqual((bad.returncode, bad.stderr.count("\n"), docs.read_text()), (1, 1, text))

    def test_data_are_the_sequences_with_ground_truth(self):
        folder = self.sequence("with")
        (self.sequence("without") / "groundtruth.txt").unlink()
        self.assertEqual(bench_runs.below(self.folder),
                         [{"name": "with", "folder": str(folder), "found": True, "detections": str(folder / "detections")}])

    def test_failure_is_one_line(self):
        done = self.bench("--lengths", "13")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr.count("\n"), 1)
        self.assertRegex(done.stderr, r"^tools/bench_runs: .*exit code 1: stillmap: a bad number$")
        self.assertFalse((self.folder / "results.json").exists())

    def test_missing_detections_are_one_line(self):
        done = subprocess.run([TOOLS / "bench_runs", "--program", self.program,
                               f"office={self.sequence()},detections=nowhere"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
        self.assertIn("nowhere/detections.jsonl", done.stderr)

    def test_parts(self):
        parts = self.folder / "parts"
        parts.mkdir()
        rows = [{"name": "extract", "cpu_time": 1500, "time_unit": "us"}, {"name": "a/2", "cpu_time": 2, "time_unit": "ms"}]
        (parts / "orb_bench").write_text(f"#!/bin/sh\ncat <<'END'\n{json.dumps({'benchmarks': rows})}\nEND\n")
        (parts / "orb_bench").chmod(0o755)
        done = self.bench("--parts", parts)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.results()["parts"], {"orb: extract": {"cpu_ms": 1.5}, "orb: a/2": {"cpu_ms": 2}})


class Thirds(unittest.TestCase):
    def test_time_a_frame(self):
        # 10 ms a frame, in the last third 40 ms; the processor has half of that.
        samples, wall = [], 0.5
        for frames in range(1, 302, 5):
            samples.append(watched_run.Sample(frames, wall, wall / 2, frames))
            wall += 5 * (0.04 if frames >= 201 else 0.01)
        found = watched_run.thirds(samples)
        self.assertEqual([round(t["wall_ms"], 6) for t in found], [10, 10, 40])
        self.assertEqual([round(t["cpu_ms"], 6) for t in found], [5, 5, 20])
        self.assertEqual([t["memory_mb"] for t in found], [101, 201, 301])


class Soak(unittest.TestCase):
    @staticmethod
    def readings(mb_per_frame=0.0, slower=1.0, handles=0):
        """10 ms of the processor a frame, and `slower` times that in the second half."""
        return [watched_run.Sample(f, f, 0.01 * (min(f, 5000) + slower * max(0, f - 5000)), 100 + mb_per_frame * f,
                                   9 + (handles if f > 5000 else 0)) for f in range(100, 10001, 100)]

    def test_a_level_run_has_nothing_wrong(self):
        figures, wrong = soak.judged(self.readings())
        self.assertEqual(wrong, [])
        self.assertAlmostEqual(figures["cpu_ms"][1], 10)

    def test_what_grows_is_named(self):
        figures, wrong = soak.judged(self.readings(mb_per_frame=2e-4))
        self.assertAlmostEqual(figures["mb_per_10000_frames"], 2.0)
        self.assertEqual(wrong, ["memory grows by 2.00 MB in 10,000 frames"])
        self.assertEqual(soak.judged(self.readings(slower=2.0))[1], ["a frame takes 20.00 ms at the end, 10.00 at first"])
        self.assertEqual(soak.judged(self.readings(handles=1))[1], ["10 handles stay open, 9 at first"])


class Compare(Folder):
    BEFORE = {"machine": {"cores": 2, "load_before": 9}, "parts": {"orb: extract": {"cpu_ms": 8}, "gone": {"cpu_ms": 1}},
              "runs": {"office": {"frame_ms": {"mean": 10, "max": 0}, "ate_m": None, "thirds": [{"wall_ms": 4}]}}}
    AFTER = {"machine": {"cores": 4, "load_before": 0}, "parts": {"orb: extract": {"cpu_ms": 4}, "new": {"cpu_ms": 1}},
             "runs": {"office": {"frame_ms": {"mean": 30, "max": 0}, "ate_m": 0.1, "thirds": [{"wall_ms": 5}]}}}

    def test_ratios_sorted_and_missing_rows_named(self):
        rows, gone, new = bench_compare.compare(self.BEFORE, self.AFTER)
        self.assertEqual(rows, [(3.0, "runs / office / frame_ms / mean", 10, 30),
                                (1.25, "runs / office / thirds / 1 / wall_ms", 4, 5),
                                (1.0, "runs / office / frame_ms / max", 0, 0),
                                (0.5, "parts / orb: extract / cpu_ms", 8, 4)])
        self.assertEqual(gone, ["parts / gone / cpu_ms"])
        self.assertEqual(new, ["parts / new / cpu_ms", "runs / office / ate_m"])

    def test_only(self):
        rows, gone, new = bench_compare.compare(self.BEFORE, self.AFTER, ["thirds"])
        self.assertEqual(([row[0] for row in rows], gone, new), ([1.25], [], []))

    def test_yardstick(self):
        # Twice as slow a machine takes twice the milliseconds; other figures stay as they are.
        rows, _, _ = bench_compare.compare(self.BEFORE, self.AFTER, ["mean", "extract"], 2.0)
        self.assertEqual([row[0] for row in rows], [1.5, 0.25])
        for name, results, ms in (("a.json", self.BEFORE, 10), ("b.json", self.AFTER, 20)):
            (self.folder / name).write_text(json.dumps(results | {"machine": {"yardstick_ms": ms}}))
        command = [TOOLS / "bench_compare", "a.json", "b.json", "--only", "mean", "--yardstick", "--at-most"]
        self.assertEqual(subprocess.run([*command, "1.6"], cwd=self.folder, capture_output=True).returncode, 0)
        bad = subprocess.run([*command, "1.4"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((bad.returncode, bad.stderr), (1, "tools/bench_compare: every figure is greater, runs / office / frame_ms / "
                                                           "mean least: 1.50 times that before, at most 1.4\n"))
        # A single slow figure is no slower program: `extract` has 0.25.
        one = subprocess.run([*command, "1.4", "--only", "extract"], cwd=self.folder, capture_output=True)
        self.assertEqual(one.returncode, 0)

    def test_program(self):
        for name, results in (("a.json", self.BEFORE), ("b.json", self.AFTER), ("c.json", [])):
            (self.folder / name).write_text(json.dumps(results))
        done = subprocess.run([TOOLS / "bench_compare", "a.json", "b.json"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("   3.000      10.0000      30.0000  runs / office / frame_ms / mean\n", done.stdout)
        self.assertIn("only in a.json: parts / gone / cpu_ms\n", done.stdout)
        self.assertIn("only in b.json: parts / new / cpu_ms\n", done.stdout)
        self.assertNotIn("load_before /", done.stdout)
        bad = subprocess.run([TOOLS / "bench_compare", "a.json", "c.json"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((bad.returncode, bad.stderr.count("\n")), (1, 1))


if __name__ == "__main__":
    unittest.main()
