# SPDX-License-Identifier: Apache-2.0
"""Runs `stillmap run` and watches from outside how time and memory go along.

The program's progress bar, which it shows on a terminal, tells how many frames are done; at each step of it the
kernel is asked how much processor time and memory the process has used so far.
"""
import dataclasses
import os
import pathlib
import pty
import re
import subprocess
import time

DONE = re.compile(rb"(\d+)/(\d+) frames")
TICKS_PER_S = os.sysconf("SC_CLK_TCK")
PAGE_MB = os.sysconf("SC_PAGE_SIZE") / 2**20


class Failed(Exception):
    """Why the program gave no result, in one line."""


@dataclasses.dataclass
class Sample:
    """What the process has used when `frames` were done."""
    frames: int
    wall_s: float
    cpu_s: float  # in user mode, of all threads
    memory_mb: float  # resident
    handles: int = 0  # open files, sockets and the like


@dataclasses.dataclass
class Watched:
    samples: list
    wall_s: float
    user_s: float
    system_s: float


def used(pid):
    """Processor time in user mode, resident memory, and open handles."""
    stat = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    resident = int(pathlib.Path(f"/proc/{pid}/statm").read_text().split()[1])
    return int(stat[11]) / TICKS_PER_S, resident * PAGE_MB, len(os.listdir(f"/proc/{pid}/fd"))


def chunks(terminal):
    """What the program writes, as it comes."""
    while True:
        try:
            data = os.read(terminal, 65536)
        except OSError:  # how Linux says that nobody writes to it any more
            return
        if not data:
            return
        yield data


def last_line(text):
    lines = [line for line in re.split(r"[\r\n]+", text) if "stillmap:" in line]
    return lines[-1] if lines else "no message"


def watch(command):
    """Runs a command of stillmap. Exit code 3 (tracking lost for good) is a result, too."""
    terminal, writer = pty.openpty()
    began = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=writer, stdin=subprocess.DEVNULL)
    os.close(writer)
    samples, text = [], b""
    for data in chunks(terminal):
        text = (text + data)[-65536:]
        found = DONE.findall(data)
        if found:
            cpu_s, memory_mb, handles = used(process.pid)
            if memory_mb > 0:  # else it has ended meanwhile
                samples.append(Sample(int(found[-1][0]), time.monotonic() - began, cpu_s, memory_mb, handles))
    os.close(terminal)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 3):
        raise Failed(f"{' '.join(map(str, command))}: exit code {process.returncode}: "
                     f"{last_line(text.decode(errors='replace'))}")
    return Watched(samples, time.monotonic() - began, usage.ru_utime, usage.ru_stime)


def thirds(samples):
    """Per third of the frames: milliseconds a frame on the clock and of the processor, and memory at its end. Empty
    where too few steps were seen."""
    if len(samples) < 10:
        return []
    first, last = samples[0].frames, samples[-1].frames
    ends = [min(samples, key=lambda s: abs(s.frames - (first + (last - first) * k / 3))) for k in range(4)]
    return [{"wall_ms": 1000 * (b.wall_s - a.wall_s) / (b.frames - a.frames),
             "cpu_ms": 1000 * (b.cpu_s - a.cpu_s) / (b.frames - a.frames),
             "memory_mb": b.memory_mb} for a, b in zip(ends, ends[1:])]
