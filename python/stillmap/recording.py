# SPDX-License-Identifier: Apache-2.0
"""Recorded sequences: rendered ones, and the objects in their images."""
from __future__ import annotations

import os
from typing import Any, Callable

from ._core import Detections, DetectionsWriter, Error, Segmenter, Sequence
from .command_line import Path, options_of, run_command


def synth(out: Path, scene: str, *, frames: int | None = None, size: str = "640x480",
          seed: int = 0, detections: str = "none", **options: object) -> Sequence:
    """Renders a sequence with exact truth, as `stillmap synth` does it, and opens it.

    `scene` is one of those that `stillmap synth --help` lists, such as "walking_xyz". `detections`:
    "none", "perfect" or "imperfect", written to OUT/detections. Further keywords are the options of
    that command with underscores: `clean=True`, `assets="none"`.
    """
    run_command("synth", out, options_of({"scene": scene, "frames": frames, "size": size,
                                          "seed": seed, "detections": detections, **options}))
    return Sequence(out)


def segment(sequence: Path, out: Path,
            segmenter: str | Segmenter | Callable[[Any], Detections]) -> None:
    """Finds the objects in every image of a sequence and writes them as a folder of detections.

    `run(..., segmenter="detections:OUT")` uses them. `segmenter` is a description as of
    `Segmenter`, or any function from an image (height x width x 3 uint8, red, green, blue) to
    Detections: a network of your own.
    """
    if isinstance(segmenter, str):
        run_command("segment", sequence, options_of({"out": out, "segmenter": segmenter}))
        return
    if os.path.realpath(out) == os.path.realpath(sequence):
        raise Error(f"{os.fspath(out)}: this is the sequence; name another folder")
    frames = Sequence(sequence)
    writer = DetectionsWriter(out, frames.camera.width, frames.camera.height)
    for frame in frames:
        writer.add(frame.stamp_text, segmenter(frame.color))
    writer.finish()
