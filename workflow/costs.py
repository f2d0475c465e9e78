# SPDX-License-Identifier: Apache-2.0
"""Limits of time and memory for each step of a batch, from its measured cost (docs/cluster.md)."""
import dataclasses
import math


@dataclasses.dataclass(frozen=True)
class Cost:
    """What a step was measured to take: seconds of a processor and MB, before the first frame and for each."""
    seconds: float
    seconds_a_frame: float
    mb: float
    mb_a_frame: float


# Measured at 640x480, rounded up (docs/cluster.md). A merge has the frames of all its sessions.
MEASURED = {
    "segment": Cost(seconds=1, seconds_a_frame=0.1, mb=300, mb_a_frame=0),
    "run": Cost(seconds=1, seconds_a_frame=0.08, mb=150, mb_a_frame=0.2),
    "merge": Cost(seconds=2, seconds_a_frame=0.03, mb=100, mb_a_frame=0.8),
}
START_S = 60  # Python and Snakemake on a node, a cold file system
SLACK = 4  # a slower node, a fuller one, larger images
MEMORY_SLACK = 1.5


def minutes(step, frames, attempt):
    cost = MEASURED[step]
    seconds = START_S + SLACK * (cost.seconds + cost.seconds_a_frame * frames)
    return math.ceil(seconds / 60) * attempt


def megabytes(step, frames, attempt):
    cost = MEASURED[step]
    return math.ceil(MEMORY_SLACK * (cost.mb + cost.mb_a_frame * frames)) * attempt
