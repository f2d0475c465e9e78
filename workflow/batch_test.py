#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Batches on this machine: what is named, what goes on, what stays the same."""
import json
import os
import re
import signal
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
from batch_fixture import PROGRAM, RESULTS, BatchTest  # noqa: E402
from one_machine_slurm import wait_until  # noqa: E402


class Batch(BatchTest):
    def rows(self, out):
        return json.loads(self.content(out, "table.json"))["rows"]

    def kill_halfway(self, out):
        """Kills a batch with all its processes when the first run has its outcome."""
        environment = {**os.environ, "STILLMAP": PROGRAM}
        main = subprocess.Popen(self.command(out, "--cores", "1"), env=environment, stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL, start_new_session=True)
        try:
            wait_until(lambda: list((self.folder / out / "outcomes").glob("run/*/*.json")), "the first run")
        finally:
            os.killpg(main.pid, signal.SIGKILL)
            main.wait()

    def test_what_is_broken_is_named_and_the_rest_goes_on(self):
        done = self.batch("whole", "--cores", "2")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("failed      broken/full: broken/rgb.txt:1: ", done.stdout)
        walk, again, broken = self.rows("whole")
        self.assertEqual([walk["state"], again["state"], broken["state"]], ["done", "done", "failed"])
        self.assertEqual((walk["frames"], again["frames"]), (40, 30))
        for row in (walk, again):  # the run itself compares with the ground truth, too
            report = json.loads(self.content("whole", f"runs/{row['name']}/full/report.json"))
            self.assertAlmostEqual(row["ate_rmse_m"], report["ate"]["rmse"], places=6)
        room, = json.loads(self.content("whole", "table.json"))["rooms"]
        self.assertEqual([found["runs"] for found in room["maps"]], [["again/full", "walk/full"]])
        for name in ("table.md", "index.html"):
            self.assertIn(b"broken/rgb.txt:1", self.content("whole", name))

        self.kill_halfway("resumed")
        self.assertFalse((self.folder / "resumed" / "table.json").exists())
        self.assertEqual(self.batch("resumed", "--cores", "1").returncode, 1)
        for name in RESULTS:
            self.assertEqual(self.content("resumed", name), self.content("whole", name), name)

    def test_what_failed_is_tried_again_when_asked(self):
        self.table.with_name("one.csv").write_text("name,sequence,segmenter,groundtruth\none,later,none,none\n")
        one = ("again", "--cores", "1")
        self.assertEqual(self.batch(*one, table="one.csv").returncode, 1)
        (self.folder / "later").symlink_to("walk")
        self.assertEqual(self.batch(*one, table="one.csv").returncode, 1)
        mended = self.batch("again", "--again", "--cores", "1", table="one.csv")
        self.assertEqual(mended.returncode, 0, mended.stderr)
        row, = self.rows("again")
        self.assertEqual((row["state"], row["frames"], row.get("ate_rmse_m")), ("done", 40, None))

    def test_a_network_looks_once_for_all_modes(self):
        self.table.with_name("net.csv").write_text("name,sequence,modes\nwalk,walk,full off\n")
        listed = self.batch("net", "--cores", "1", "--dry-run", "--printshellcmds", table="net.csv")
        commands = re.findall(r"stillmap (segment|run) (.*)", listed.stdout + listed.stderr)
        self.assertEqual(sorted(command for command, _ in commands), ["run", "run", "segment"])
        for command, arguments in commands:
            self.assertIn("detections/walk", arguments)
            self.assertEqual(command == "segment", "--segmenter auto" in arguments)

    def test_a_wrong_table_is_one_line(self):
        self.table.with_name("wrong.csv").write_text("name,sequence\nwalk,walk\nwalk,walk\n")
        refused = self.batch("wrong", "--cores", "1", table="wrong.csv")
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("wrong.csv:3: a second recording named walk", refused.stderr)


if __name__ == "__main__":
    unittest.main()
