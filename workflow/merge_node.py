#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A node of a room's tree: merges the maps of the steps below it. Maps without a place in common stay apart."""
import argparse
import json
import pathlib
import sys
import tempfile

import step

RUNS = pathlib.Path("outcomes/run")


def maps_below(outcome_file):
    """The maps that a step left, each with its runs; and the runs without a map."""
    outcome = json.loads(outcome_file.read_text())
    if not outcome_file.is_relative_to(RUNS):
        return outcome["maps"], outcome["without_map"]
    run = str(outcome_file.relative_to(RUNS).with_suffix(""))
    if outcome["state"] != "done":
        return [], [run]
    keyframes = json.loads(pathlib.Path("runs", run, "report.json").read_text())["keyframes"]
    return [{"file": f"runs/{run}/map.stillmap", "keyframes": keyframes, "runs": [run]}], []


def maps_of_parts(folder, maps):
    """What `stillmap merge --parts` left: its parts name the files that it was given."""
    runs = {found["file"]: found["runs"] for found in maps}
    parts = json.loads((folder / "parts.json").read_text())
    return [{"file": str(folder / part["file"]), "keyframes": part["keyframes"],
             "runs": sorted(run for name in part["sessions"] for run in runs[name])} for part in parts]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path, help="for the maps")
    parser.add_argument("outcome", type=pathlib.Path)
    parser.add_argument("below", type=pathlib.Path, nargs="+", help="outcomes of runs or of nodes")
    arguments = parser.parse_args()
    failed = step.not_done([path for path in arguments.below if not path.is_relative_to(RUNS)])
    if failed:
        step.write_outcome(arguments.outcome, "failed", failed["message"])
        return 0
    maps, without = [], []
    for path in arguments.below:
        found, none = maps_below(path)
        maps += found
        without += none
    used = {}
    if len(maps) > 1:
        with tempfile.TemporaryDirectory() as scratch:
            ended = pathlib.Path(scratch, "outcome.json")
            command = [arguments.program, "merge", *(found["file"] for found in maps), "--parts", str(arguments.folder)]
            code = step.run(argparse.Namespace(outcome=ended, stdout=None, after=[], command=command))
            if code != 0:
                return code
            used = json.loads(ended.read_text())
        if used["state"] != "done":
            step.write_outcome(arguments.outcome, **used)
            return 0
        maps = maps_of_parts(arguments.folder, maps)
    step.write_outcome(arguments.outcome, **{"state": "done", **used}, maps=maps, without_map=sorted(without))
    return 0


if __name__ == "__main__":
    sys.exit(main())
