# SPDX-License-Identifier: Apache-2.0
"""Runs over recorded sequences."""
from __future__ import annotations

import json
import pathlib
import warnings
from functools import cached_property
from typing import Any, Mapping

from ._core import PointCloud, Trajectory
from .command_line import Path, Setting, options_of, run_command, settings_options

_LOST_FOR_GOOD = 3


class Run:
    """The results of a run in its folder, as `run` and the program `stillmap run` leave them.

    Each is read when it is asked for. `folder / "report.html"` is for people.
    """

    def __init__(self, folder: Path) -> None:
        """Opens the folder of a run."""
        self.folder = pathlib.Path(folder)

    def __repr__(self) -> str:
        return f"<stillmap.Run {self.folder}>"

    @cached_property
    def trajectory(self) -> Trajectory:
        """The poses of the tracked frames."""
        return Trajectory.load(self.folder / "trajectory.txt")

    @cached_property
    def keyframes(self) -> Trajectory:
        """The poses of the key frames."""
        return Trajectory.load(self.folder / "keyframes.txt")

    @cached_property
    def map(self) -> PointCloud:
        """The dense map."""
        return PointCloud.load(self.folder / "map.ply")

    @cached_property
    def report(self) -> dict[str, Any]:
        """report.json: errors against ground truth where there is any, times, counts, warnings."""
        report: dict[str, Any] = json.loads((self.folder / "report.json").read_text())
        return report

    @cached_property
    def objects(self) -> list[dict[str, Any]]:
        """objects.jsonl: a dict for each frame; empty without a source of objects."""
        file = self.folder / "objects.jsonl"
        return [json.loads(line) for line in file.open()] if file.exists() else []

    @property
    def session_file(self) -> pathlib.Path:
        """The session, for `Session.load` and for `load=` of the next run."""
        return self.folder / "map.stillmap"


def run(sequence: Path, out: Path, *, camera: Path | None = None, segmenter: str | None = None,
        settings: Mapping[str, Setting] | None = None, dynamics: str | None = None,
        frames: str | None = None, stride: int = 1, threads: int = 2, load: Path | None = None,
        localize_only: bool = False, **options: object) -> Run:
    """Runs over a recorded sequence as `stillmap run` does it, and gives the same bits.

    `sequence` is a folder, `out` the folder for the results. `segmenter` says what finds people and
    things: "none", "detections:DIR" (see `segment`), "masks:DIR", "onnx:MODEL.onnx" or "auto"; the
    default is auto where its networks are, else none. `settings` is a dict by key, `dynamics` the
    mode of motion, `frames` a part such as "0:300", `load` a map.stillmap to go on from. Further
    keywords are the options of `stillmap run --help` with underscores: `live=True`,
    `groundtruth="truth.txt"`.

    Prints what the program prints. Its warnings are Python's. Ctrl-C ends it without results.
    """
    code = run_command("run", sequence, [
        *options_of({"out": out, "camera": camera, "segmenter": segmenter, "dynamics": dynamics,
                     "frames": frames, "stride": stride, "threads": threads, "load": load,
                     "localize_only": localize_only, **options}),
        *settings_options(settings)])
    if code == _LOST_FOR_GOOD:
        warnings.warn("tracking was lost for good: the results end before the sequence does",
                      stacklevel=2)
    return Run(out)
