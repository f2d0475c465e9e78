# SPDX-License-Identifier: Apache-2.0
"""Runs of the program over sequences with ground truth, for the tools that make tables of them."""
import json
import math
import os
import pathlib
import re
import statistics
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("STILLMAP", ROOT / "build/release/bin/stillmap")
LOST_FOR_GOOD = 3  # the exit code of a run that ends without a pose


class Failure(Exception):
    """A message for the user, in one line."""


def parse(argument, further=()):
    """The sequence of an argument NAME=FOLDER[,camera=NAME][,detections=FOLDER], with `further` options."""
    name, _, rest = argument.partition("=")
    folder, *options = rest.split(",")
    sequence = {"name": name, "folder": folder}
    sequence |= dict(option.split("=", 1) for option in options if "=" in option)
    known = set(sequence) <= {"name", "folder", "camera", "detections", *further}
    known = known and all("=" in option for option in options)
    if not re.fullmatch(r"\w[\w-]*", name) or not pathlib.Path(folder).is_dir() or not known:
        more = "".join(f"[,{option}=...]" for option in further)
        raise Failure(f"{argument}: expected NAME=FOLDER[,camera=NAME][,detections=FOLDER]{more}")
    return sequence


def call(*arguments, program=None):
    """Runs the program; its standard output."""
    command = [str(program or PROGRAM), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, LOST_FOR_GOOD):
        raise Failure(f"{' '.join(command)}: {done.stderr.strip()}")
    return done.stdout


def run(sequence, mode, out, start=0, settings=()):
    """The report of a run from frame `start` on; of the run that is in `out` already, if there is one."""
    report = pathlib.Path(out) / "report.json"
    if not report.is_file():
        command = ["run", sequence["folder"], "--out", out, "--dynamics", mode, "--threads", 1, "--frames", f"{start}:"]
        if "camera" in sequence:
            command += ["--camera", sequence["camera"]]
        command += ["--segmenter", "detections:" + sequence["detections"] if "detections" in sequence else "auto"]
        for setting in settings:
            command += ["--set", setting]
        pathlib.Path(out).mkdir(parents=True, exist_ok=True)
        call(*command)
        (pathlib.Path(out) / "map.stillmap").unlink(missing_ok=True)
    found = json.loads(report.read_text())
    if found["ate"]["rmse"] is None:
        raise Failure(f"{sequence['folder']}: no ground truth for the frames that were tracked")
    return found


def evaluate_map(map_file, sequence_folder, trajectory, program=None):
    """The figures of a map against the truth of its sequence; `trajectory` is that of the run. None without a truth."""
    folder = pathlib.Path(sequence_folder)
    truth = folder / "truth"
    if not (truth / "static_map.ply").is_file():
        return None
    command = ["evaluate", "map", map_file, "--static", truth / "static_map.ply", "--dynamic", truth / "dynamic_map.ply",
               "--groundtruth", folder / "groundtruth.txt", "--trajectory", trajectory, "--json"]
    if (truth / "resting_map.ply").is_file():
        command += ["--resting", truth / "resting_map.ply"]
    return json.loads(call(*command, program=program))["map"]


def replace_file(path, text):
    """Writes a text file under another name first, so that an interrupted one is not taken for the whole."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(path.name + ".partial")
    partial.write_text(text)
    partial.replace(path)


def median(values):
    return statistics.median(values)


def sign_test(better, worse):
    """The chance that as many or more of the pairs differ in one direction if neither is better (two-sided)."""
    n, k = better + worse, max(better, worse)
    return min(1.0, 2 * sum(math.comb(n, i) for i in range(k, n + 1)) / 2 ** n) if n else 1.0
