#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""One step of a batch: runs a command of the program and writes down how it ended, as JSON.

A step that ends for a reason (bad input, camera lost) has an outcome, which names the reason and is that
of all steps after it. A step that was killed, ran out of memory or was interrupted has none: it fails, and
Snakemake tries again.
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import time

BAD_INPUT, LOST = 2, 3  # exit codes of the program
OUT_OF_MEMORY = "out of memory"


def write(path, text):
    """Whole or not at all, also where two jobs write the same."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.uname().nodename}.{os.getpid()}")
    temporary.write_text(text)
    os.replace(temporary, path)


def write_outcome(path, state, message="", **figures):
    write(path, json.dumps({"state": state, "message": message, **figures}, indent=1) + "\n")


def last_message(text):
    """The program's last line that is no warning, without its name."""
    lines = [line.removeprefix("stillmap: ") for line in text.splitlines()
             if line.startswith("stillmap: ") and not line.startswith("stillmap: warning")]
    return lines[-1] if lines else "no message"


def state_of(code, message):
    """What an exit code means for the batch; nothing where another try may end otherwise."""
    if code == 0:
        return "done"
    if code == LOST:
        return "lost"
    if code == BAD_INPUT and OUT_OF_MEMORY not in message:
        return "failed"
    return None


def not_done(outcomes):
    """The first outcome of an earlier step that did not succeed."""
    for path in outcomes:
        outcome = json.loads(path.read_text())
        if outcome["state"] != "done":
            return outcome
    return None


def run(arguments):
    before = not_done(arguments.after)
    if before:
        write_outcome(arguments.outcome, before["state"], before["message"])
        return 0
    began = time.monotonic()
    done = subprocess.run(arguments.command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace")
    sys.stderr.write(done.stdout + done.stderr)
    message = last_message(done.stderr)
    state = state_of(done.returncode, message)
    if state is None:
        print(f"step: ended with {done.returncode}: {' '.join(arguments.command)}", file=sys.stderr)
        return 1
    if arguments.stdout and state == "done":
        write(arguments.stdout, done.stdout)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    write_outcome(arguments.outcome, state, "" if state == "done" else message,
                  seconds=round(time.monotonic() - began, 2), processor_s=round(used.ru_utime + used.ru_stime, 2),
                  peak_mb=used.ru_maxrss // 1024)
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("outcome", type=pathlib.Path, help="file for how it ended")
    parser.add_argument("--stdout", type=pathlib.Path, help="file for what the command prints, if it succeeds")
    parser.add_argument("--after", type=pathlib.Path, action="append", default=[], help="an earlier step's outcome")
    parser.add_argument("command", nargs="+", help="after --")
    return run(parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
