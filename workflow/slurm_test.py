#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A batch on a real Slurm loses a job, its node and its own process, goes on, and has the table of a batch that lost nothing."""
import os
import pathlib
import signal
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
import one_machine_slurm  # noqa: E402
from batch_fixture import PROGRAM, RESULTS, BatchTest  # noqa: E402
from one_machine_slurm import wait_until  # noqa: E402


@unittest.skipIf(one_machine_slurm.why_not(), one_machine_slurm.why_not())
class BatchOnSlurm(BatchTest):
    def setUp(self):
        (self.folder / "slurm").mkdir()
        self.slurm = one_machine_slurm.Slurm(self.folder / "slurm")
        self.enterContext(self.slurm)
        # With CI=true Snakemake asks Slurm every second, not every ten.
        self.environment = {**self.slurm.environment, "CI": "true", "STILLMAP": PROGRAM}
        self.profile = ("--profile", str(pathlib.Path(__file__).parent / "slurm"))

    def process_of_a_job(self):
        """A `stillmap run` that is at work in a job."""
        for process, command in self.slurm.job_processes().items():
            if command[:2] == [os.path.realpath(PROGRAM), "run"]:
                return process
        return None

    def outcomes(self):
        return sorted(path.name for path in (self.folder / "out" / "outcomes").rglob("*.json"))

    def lose_everything(self):
        """A job, then the node with all its jobs, then the process that submits them."""
        log_file = self.folder / "interrupted.log"
        with open(log_file, "w") as log:
            main = subprocess.Popen(self.command("out", *self.profile), env=self.environment, stdout=log, stderr=log,
                                    start_new_session=True)
        try:
            os.kill(wait_until(self.process_of_a_job, "a job that runs"), signal.SIGKILL)
            wait_until(lambda: "Trying to restart job" in log_file.read_text(), "another attempt at the killed job")
            wait_until(self.process_of_a_job, "a job that runs after the kill")
            self.slurm.lose_node()
        finally:
            os.killpg(main.pid, signal.SIGKILL)
            main.wait()
        self.slurm.start_node()

    def test_the_same_table_whatever_is_lost(self):
        undisturbed = self.batch("undisturbed", "--cores", "2")
        self.assertEqual(undisturbed.returncode, 1, undisturbed.stderr)  # one recording is broken
        self.lose_everything()
        self.assertFalse((self.folder / "out" / "table.json").exists())
        self.assertLess(len(self.outcomes()), 5)  # three runs, two evaluations and a merge are to come
        resumed = self.batch("out", *self.profile, environment=self.environment)
        self.assertEqual(resumed.returncode, 1, resumed.stderr)
        self.assertIn("3 runs, 1 rooms: 1 failed", resumed.stdout)
        for name in RESULTS:
            self.assertEqual(self.content("out", name), self.content("undisturbed", name), name)


if __name__ == "__main__":
    unittest.main()
