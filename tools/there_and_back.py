# SPDX-License-Identifier: Apache-2.0
"""A longer sequence made of a given one: its frames there and back, again and again.

Only lists are written; images and masks are links to those of the given sequence. Stamps go on as the
frames are apart in the original, whichever way they are gone through.
"""
import bisect
import json
import pathlib

MAX_APART_S = 0.02  # of stamps that belong together, as stillmap has it
MICRO = 1_000_000


class Broken(Exception):
    """What is wrong with the given sequence, in one line."""


def rows(path, columns):
    """The rows of a text table, without comments."""
    found = []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        if len(words) < columns:
            raise Broken(f"{path}:{number}: expected {columns} columns")
        found.append(words)
    if not found:
        raise Broken(f"{path}: no rows")
    return found


def closest_pairs(a, b):
    """Indices of stamps that belong together, the closest first, each once; in the order of `a`. Both are sorted."""
    near = []
    for i, stamp in enumerate(a):
        for j in range(bisect.bisect_left(b, stamp - MAX_APART_S), bisect.bisect_right(b, stamp + MAX_APART_S)):
            near.append((abs(stamp - b[j]), i, j))
    taken_a, taken_b, pairs = set(), set(), []
    for _, i, j in sorted(near):
        if i not in taken_a and j not in taken_b:
            taken_a.add(i)
            taken_b.add(j)
            pairs.append((i, j))
    return sorted(pairs)


def frames_of(folder):
    """(stamp of colour, file, stamp of depth, file) of every frame, stamps as texts."""
    if (folder / "associations.txt").is_file():
        return [tuple(row[:4]) for row in rows(folder / "associations.txt", 4)]
    color, depth = rows(folder / "rgb.txt", 2), rows(folder / "depth.txt", 2)
    pairs = closest_pairs([float(r[0]) for r in color], [float(r[0]) for r in depth])
    return [(*color[i][:2], *depth[j][:2]) for i, j in pairs]


def walk(count, steps):
    """(index, direction of time) there and back over `count` frames: 0 1 2 1 0 1 ..."""
    period = max(1, 2 * (count - 1))
    for step in range(steps):
        at = step % period
        yield (at, 1) if at < count else (period - at, -1)


def micro(text):
    """Microseconds, exactly where the text has six decimals or fewer."""
    whole, _, part = text.partition(".")
    return int(whole) * MICRO + int((part + "000000")[:6])


def text_of(microseconds):
    return f"{microseconds // MICRO}.{microseconds % MICRO:06d}"


def steps_of(frames, length):
    """(frame, new stamp in microseconds, direction of time) for each of `length` steps."""
    if len(frames) == 1 and length > 1:
        raise Broken("a single frame cannot be gone through there and back")
    stamps = [micro(frame[0]) for frame in frames]
    now, before = stamps[0], 0
    for index, direction in walk(len(frames), length):
        now += abs(stamps[index] - stamps[before])
        before = index
        yield frames[index], now, direction


def link(target, at):
    at.parent.mkdir(parents=True, exist_ok=True)
    if not at.is_symlink():
        at.symlink_to(target)


def link_images(source, out, frames):
    """Links to whatever holds the images: their folders, or the files themselves."""
    for name in {file for frame in frames for file in (frame[1], frame[3])}:
        path = pathlib.PurePath(name)
        if path.is_absolute() or ".." in path.parts:
            raise Broken(f"{source}: '{name}' leads out of the sequence")
        link((source / path.parts[0]).resolve(), out / path.parts[0])


def write_groundtruth(source, out, steps):
    poses = sorted((float(row[0]), row[1:8]) for row in rows(source / "groundtruth.txt", 8))
    stamps = [stamp for stamp, _ in poses]
    lines, last = [], -1
    for frame, now, direction in steps:
        stamp = float(frame[0])
        after = bisect.bisect_left(stamps, stamp)
        nearest = min((i for i in (after - 1, after) if 0 <= i < len(stamps)), key=lambda i: abs(stamps[i] - stamp))
        at = now + direction * round((stamps[nearest] - stamp) * MICRO)
        if abs(stamps[nearest] - stamp) <= MAX_APART_S and at > last:
            lines.append(" ".join((text_of(at), *poses[nearest][1])))
            last = at
    (out / "groundtruth.txt").write_text("\n".join(lines) + "\n")


def write_detections(source, out, steps):
    """Frames that the folder does not have stay away here, too."""
    found = {}
    for line in (source / "detections.jsonl").read_text().splitlines():
        entry = json.loads(line)
        found[float(entry["stamp"])] = entry
    (out / "masks").mkdir(parents=True, exist_ok=True)
    lines = []
    for frame, now, _ in steps:
        entry = found.get(float(frame[0]))
        if entry is None:
            continue
        mask = source / "masks" / f"{entry['stamp']}.png"
        if mask.is_file():
            link(mask.resolve(), out / "masks" / f"{text_of(now)}.png")
        lines.append(json.dumps(entry | {"stamp": text_of(now)}))
    (out / "detections.jsonl").write_text("\n".join(lines) + "\n")


def write(source, out, length=None, detections=None):
    """Writes a sequence of `length` frames (as many as `source` has unless given) into the new folder `out`, with
    detections/ where a folder of them is given. Of truth/ only objects.json goes along, which may tell the camera, so
    that nothing is evaluated but the trajectory. Returns the number of frames."""
    source, out = pathlib.Path(source), pathlib.Path(out)
    frames = frames_of(source)
    steps = list(steps_of(frames, length or len(frames)))
    out.mkdir(parents=True)
    link_images(source, out, frames)
    for name in ("camera.yaml", "truth/objects.json"):
        if (source / name).is_file():
            link((source / name).resolve(), out / name)
    if (source / "groundtruth.txt").is_file():
        write_groundtruth(source, out, steps)
    if detections:
        write_detections(pathlib.Path(detections), out / "detections", steps)
    depth_at = [now + d * (micro(f[2]) - micro(f[0])) for f, now, d in steps]
    (out / "associations.txt").write_text("".join(
        f"{text_of(now)} {f[1]} {text_of(at)} {f[3]}\n" for (f, now, _), at in zip(steps, depth_at)))
    (out / "rgb.txt").write_text("".join(f"{text_of(now)} {f[1]}\n" for f, now, _ in steps))
    return len(steps)
