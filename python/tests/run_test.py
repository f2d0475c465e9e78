# SPDX-License-Identifier: Apache-2.0
"""Runs over recordings: the program's bits, its messages, own networks, interruption."""
import json
import os
import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest

import stillmap
from conftest import program

FILES = ("trajectory.txt", "keyframes.txt", "map.ply", "map.stillmap", "config.yaml", "camera.yaml")


def assert_same_files(a, b, files=FILES):
    for file in files:
        assert (a / file).read_bytes() == (b / file).read_bytes(), file


def test_has_the_bits_of_the_program(walking, program_run, tmp_path, capsys):
    run = stillmap.run(walking.folder, tmp_path / "result", segmenter="none")
    assert_same_files(program_run, run.folder)
    assert "tracked     40 of 40 frames" in capsys.readouterr().out
    assert len(run.trajectory) == 40 and len(run.map.points) == len(run.map.colors) > 1000
    assert run.report["ate"]["rmse"] < 0.5 and run.objects == []
    assert (run.folder / "report.html").exists() and run.session_file.exists()


def test_options_are_those_of_the_program(walking, tmp_path):
    detections = f"detections:{walking.folder}/detections"
    program("run", walking.folder, "--out", tmp_path / "a", "--segmenter", detections,
            "--dynamics", "paper", "--frames", "5:30", "--stride", "2",
            "--set", "tracking.features=900", "--set", "dynamics.fill_boxes=false")
    run = stillmap.run(walking.folder, tmp_path / "b", segmenter=detections, dynamics="paper",
                       frames="5:30", stride=2, threads=1,
                       settings={"tracking.features": 900, "dynamics.fill_boxes": False})
    assert_same_files(tmp_path / "a", run.folder, FILES + ("objects.jsonl",))
    assert len(run.objects) == 13


def test_any_function_can_find_the_objects(walking, tmp_path):
    """An own network gives what the folder of true detections has."""
    truth = stillmap.Segmenter(f"detections:{walking.folder}/detections")
    stamps = iter([frame.stamp_text for frame in walking])
    stillmap.segment(walking.folder, tmp_path / "found", lambda color: truth(color, next(stamps)))
    own, given = ([json.loads(line) for line in (folder / "detections.jsonl").open()]
                  for folder in (tmp_path / "found", walking.folder / "detections"))
    for line in own:  # any ids become 1, 2, ...
        assert [thing["id"] for thing in line["objects"]] == [*range(1, len(line["objects"]) + 1)]
    for thing in (thing for line in own + given for thing in line["objects"]):
        del thing["id"]
    assert own == given
    run = stillmap.run(walking.folder, tmp_path / "own", frames="0:12",
                       segmenter=f"detections:{tmp_path}/found")
    same = stillmap.run(walking.folder, tmp_path / "same", frames="0:12",
                        segmenter=f"detections:{walking.folder}/detections")
    assert_same_files(run.folder, same.folder, FILES + ("objects.jsonl",))


class Terminal:
    """A terminal on which somebody types Ctrl-C after some lines."""

    def __init__(self, lines):
        self.lines = lines

    def isatty(self):
        return True

    def write(self, text):
        self.lines -= 1
        if self.lines == 0:
            os.kill(os.getpid(), signal.SIGINT)
        return len(text)

    def flush(self):
        pass


def test_an_interruption_ends_a_run_without_results(walking, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "stderr", Terminal(10))
    with pytest.raises(KeyboardInterrupt):
        stillmap.run(walking.folder, tmp_path / "result", segmenter="none")
    monkeypatch.undo()
    assert not (tmp_path / "result/trajectory.txt").exists()
    stillmap.run(walking.folder, tmp_path / "result", segmenter="none", frames="0:5")
    assert (tmp_path / "result/trajectory.txt").exists()


def test_warnings_are_those_of_python(walking, tmp_path):
    """A network that never finds anybody: the program warns of it."""
    stillmap.segment(walking.folder, tmp_path / "nobody", lambda color: stillmap.Detections())
    with pytest.warns(UserWarning, match="no object of a dynamic class"):
        stillmap.run(walking.folder, tmp_path / "out", segmenter=f"detections:{tmp_path}/nobody")


def test_a_sequence_is_what_lies_in_its_folder(walking):
    frames = list(walking)
    assert [frame.id for frame in frames] == list(range(len(walking)))
    assert frames[0].color.shape == (240, 320, 3) and frames[0].color.dtype == np.uint8
    assert frames[0].depth.dtype == np.float32
    lines = [line for line in (walking.folder / "rgb.txt").open() if not line.startswith("#")]
    assert [frame.stamp_text for frame in frames] == [line.split()[0] for line in lines]
    assert len(list(walking)) == len(frames)  # once more, from the start


def test_models_runs_the_script_that_is_installed_beside_the_program(tmp_path):
    (tmp_path / "bin").mkdir()
    shutil.copy(os.environ["STILLMAP_PROGRAM"], tmp_path / "bin/stillmap")
    missing = subprocess.run([tmp_path / "bin/stillmap", "models"], capture_output=True, text=True)
    assert missing.returncode == 2
    assert "no share/stillmap/tools/fetch_models beside" in missing.stderr
    script = tmp_path / "share/stillmap/tools/fetch_models"
    script.parent.mkdir(parents=True)
    script.write_text("#!/bin/sh\necho fetched; exit 7\n")
    script.chmod(0o755)
    done = subprocess.run([tmp_path / "bin/stillmap", "models"], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (7, "fetched\n")
