# SPDX-License-Identifier: Apache-2.0
"""What the tests of batches share: small rendered recordings, one that is broken, and their table."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
BATCH = ROOT / "workflow" / "batch"
PROGRAM = os.environ.get("STILLMAP", str(ROOT / "build/release/bin/stillmap"))
RESULTS = ("table.json", "table.md", "index.html")
TABLE = """\
name,sequence,modes,segmenter,frames,room
walk,walk,full,detections:walk/detections,,office
again,walk,full,detections:walk/detections,10:,office
broken,broken,full,none,,
"""


class BatchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if shutil.which("snakemake") is None:
            raise unittest.SkipTest("no snakemake: tools/setup --cluster installs it")
        temporary = tempfile.TemporaryDirectory(prefix="stillmap-batch-")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        subprocess.run([PROGRAM, "synth", cls.folder / "walk", "--scene", "walking_xyz", "--frames", "40", "--size", "160x120",
                        "--detections", "perfect", "--assets", "none"], check=True, stdout=subprocess.DEVNULL)
        (cls.folder / "broken").mkdir()
        (cls.folder / "broken" / "rgb.txt").write_text("no stamp\n")
        cls.table = cls.folder / "table.csv"
        cls.table.write_text(TABLE)

    def command(self, out, *arguments, table="table.csv"):
        return [str(BATCH), str(self.folder / table), str(self.folder / out), *arguments]

    def batch(self, out, *arguments, table="table.csv", environment=None):
        environment = {**(environment or os.environ), "STILLMAP": PROGRAM}
        return subprocess.run(self.command(out, *arguments, table=table), env=environment, capture_output=True, text=True)

    def content(self, out, name):
        return (self.folder / out / name).read_bytes()
