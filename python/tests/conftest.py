# SPDX-License-Identifier: Apache-2.0
"""What several tests share: the program, and rendered sequences."""
import os
import pathlib
import subprocess

import pytest

import stillmap

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def program(*arguments):
    """Runs the program; gives what it printed."""
    done = subprocess.run([os.environ["STILLMAP_PROGRAM"], *map(str, arguments)],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="session")
def walking(tmp_path_factory):
    """A small sequence in which people walk, with true detections."""
    folder = tmp_path_factory.mktemp("walking") / "office"
    return stillmap.synth(folder, "walking_xyz", frames=40, size="320x240", detections="perfect",
                          assets="none")


@pytest.fixture(scope="session")
def program_run(walking, tmp_path_factory):
    """The program's run over it, without a network."""
    out = tmp_path_factory.mktemp("program") / "result"
    program("run", walking.folder, "--out", out, "--segmenter", "none")
    return out
