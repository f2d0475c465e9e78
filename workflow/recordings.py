# SPDX-License-Identifier: Apache-2.0
"""The table of a batch: which recordings are processed, and how (docs/cluster.md)."""
import csv
import dataclasses
import os
import pathlib
import re

COLUMNS = ("name", "sequence", "modes", "segmenter", "camera", "groundtruth", "frames", "settings", "room")
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*")  # also of a folder
IMAGES = (".png", ".jpg", ".jpeg", ".pgm", ".ppm", ".tif", ".tiff")
BYTES_OF_A_FRAME = 200_000  # of a recording in one file, a low estimate, so that the frames are not too few


class Failure(Exception):
    """A message for the user, in one line."""


@dataclasses.dataclass(frozen=True)
class Recording:
    """A row of the table, as it is written there; `folder` is where the table is."""
    folder: pathlib.Path
    name: str
    sequence: str
    modes: tuple = ("full",)
    segmenter: str = "auto"
    camera: str = ""
    groundtruth: str = ""
    frames: str = ""
    settings: tuple = ()
    room: str = ""

    def path(self, text):
        """A path in the table, relative to the table."""
        return self.folder / os.path.expanduser(text)

    def needs_network(self):
        return self.segmenter == "auto" or self.segmenter.startswith("onnx:")

    def segmenter_with_path(self):
        """The segmenter as the program takes it from any folder."""
        kind, colon, path = self.segmenter.partition(":")
        return f"{kind}:{self.path(path)}" if colon else kind

    def camera_with_path(self):
        """A camera's name, or the path of its file."""
        return str(self.path(self.camera)) if self.path(self.camera).is_file() else self.camera

    def truth(self):
        """The ground truth's path; nothing where there is none."""
        if self.groundtruth == "none":
            return None
        if self.groundtruth:
            return self.path(self.groundtruth)
        own = self.path(self.sequence) / "groundtruth.txt"
        return own if own.is_file() else None


@dataclasses.dataclass(frozen=True)
class Run:
    """One recording in one mode."""
    recording: Recording
    mode: str

    @property
    def name(self):
        return f"{self.recording.name}/{self.mode}"


def runs(recordings):
    return [Run(recording, mode) for recording in recordings for mode in recording.modes]


def rooms(recordings):
    """By room and mode, the names of the runs whose maps are merged, in an order that is not the table's."""
    found = {}
    for run in runs(recordings):
        if run.recording.room:
            found.setdefault(f"{run.recording.room}/{run.mode}", []).append(run.name)
    return {room: sorted(names) for room, names in sorted(found.items())}


def read(table):
    """The recordings of a table: CSV, or TSV by its name. Throws Failure with the line that is wrong."""
    table = pathlib.Path(table).resolve()
    try:
        with open(table, newline="", encoding="utf-8-sig") as file:
            rows = csv.DictReader(file, delimiter="\t" if table.suffix == ".tsv" else ",", strict=True)
            recordings = _recordings(table, rows)
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise Failure(f"{table}: cannot be read as a table ({error})") from error
    if not recordings:
        raise Failure(f"{table}: no recording; expected a line of column names and a line for each recording")
    return recordings


def _recordings(table, rows):
    unknown = [str(column) for column in rows.fieldnames or () if column not in COLUMNS]
    if unknown or not {"name", "sequence"} <= set(rows.fieldnames or ()):
        raise Failure(f"{table}: {'unknown columns ' + ', '.join(unknown) if unknown else 'no column name or sequence'};"
                      f" expected name, sequence and any of {', '.join(COLUMNS[2:])}")
    recordings, seen = [], set()
    for row in rows:
        recording = _recording(table, rows.line_num, row)
        if recording.name in seen:
            raise Failure(f"{table}:{rows.line_num}: a second recording named {recording.name}; expected one")
        seen.add(recording.name)
        recordings.append(recording)
    return recordings


def _recording(table, line, row):
    if None in row or None in row.values():
        raise Failure(f"{table}:{line}: expected as many values as there are columns")
    given = {column: text.strip() for column, text in row.items() if text.strip()}
    if "modes" in given:
        given["modes"] = tuple(dict.fromkeys(given["modes"].split()))
    if "settings" in given:
        given["settings"] = tuple(given["settings"].split())
    for text in (given.get("name", ""), given.get("room", "none"), *given.get("modes", ())):
        if not NAME.fullmatch(text):
            raise Failure(f"{table}:{line}: '{text}' cannot be a name; expected letters, digits, _ . and -")
    if "sequence" not in given:
        raise Failure(f"{table}:{line}: {given['name']} has no sequence; expected a folder or a file")
    if not re.fullmatch(r"(\d*:\d*)?", given.get("frames", "")):
        raise Failure(f"{table}:{line}: frames '{given['frames']}'; expected A:B, as for `stillmap run --frames`")
    for setting in given.get("settings", ()):
        if "=" not in setting:
            raise Failure(f"{table}:{line}: setting '{setting}'; expected key=value")
    return Recording(folder=table.parent, **given)


def frame_count(recording):
    """About how many frames a recording has: never fewer, for limits of time and memory. 0 if it is not there."""
    begin, _, end = recording.frames.partition(":")
    if end:
        return max(0, int(end) - int(begin or 0))
    path = recording.path(recording.sequence)
    if path.is_file():
        return path.stat().st_size // BYTES_OF_A_FRAME + 1
    images = sum(name.lower().endswith(IMAGES) for _, _, names in os.walk(path) for name in names)
    return images // 2 + 1 if images else 0
