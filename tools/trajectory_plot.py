# SPDX-License-Identifier: Apache-2.0
"""Trajectories beside the true one, as an SVG seen from above."""
import bisect
import math

COLORS = ("#d62728", "#ff7f0e", "#2ca02c", "#1f77b4", "#9467bd", "#8c564b")
NEAREST_S = 0.02
SIZE, MARGIN = 480, 20


def read(path):
    """Sorted (stamp, position) of a trajectory in TUM's format."""
    lines = [line.split() for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")]
    return sorted((float(fields[0]), tuple(map(float, fields[1:4]))) for fields in lines)


def paired(truth, estimate):
    """(true position, estimated position) of every estimated pose with a true one near in time."""
    stamps, pairs = [stamp for stamp, _ in truth], []
    for stamp, position in estimate:
        i = bisect.bisect(stamps, stamp)
        near = min(truth[max(0, i - 1):i + 1], key=lambda pose: abs(pose[0] - stamp), default=None)
        if near and abs(near[0] - stamp) <= NEAREST_S:
            pairs.append((near[1], position))
    return pairs


def mean(points):
    return [sum(axis) / len(points) for axis in zip(*points)]


def largest_eigenvector(matrix):
    """By power iteration on the matrix, shifted so that its largest eigenvalue is the largest in size."""
    shift = sum(abs(value) for row in matrix for value in row)
    vector = [1.0, 0.1, 0.2, 0.3]
    for _ in range(2000):
        vector = [sum(m * v for m, v in zip(row, vector)) + shift * v0 for row, v0 in zip(matrix, vector)]
        length = math.sqrt(sum(v * v for v in vector))
        vector = [v / length for v in vector]
    return vector


def rotation(pairs):
    """The rotation from estimate to truth that fits centred pairs best (Horn 1987), as rows."""
    s = [[sum(e[i] * t[j] for t, e in pairs) for j in range(3)] for i in range(3)]
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = s
    w, x, y, z = largest_eigenvector([[xx + yy + zz, yz - zy, zx - xz, xy - yx],
                                      [yz - zy, xx - yy - zz, xy + yx, zx + xz],
                                      [zx - xz, xy + yx, yy - xx - zz, yz + zy],
                                      [xy - yx, zx + xz, yz + zy, zz - xx - yy]])
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def aligned(truth, estimate):
    """The estimated positions in the coordinates of the truth."""
    pairs = paired(truth, estimate)
    if len(pairs) < 3:
        return []
    true_mean, own_mean = mean([t for t, _ in pairs]), mean([e for _, e in pairs])
    centred = [([a - b for a, b in zip(t, true_mean)], [a - b for a, b in zip(e, own_mean)]) for t, e in pairs]
    rows = rotation(centred)
    return [[sum(r * (p - m) for r, p, m in zip(row, position, own_mean)) + t for row, t in zip(rows, true_mean)]
            for _, position in estimate]


def svg(truth_file, estimates):
    """`estimates` maps names to files. x of the truth's world to the right, y up."""
    truth = read(truth_file)
    lines = {name: aligned(truth, read(path)) for name, path in estimates.items()}
    begin, end = truth[0][0], truth[-1][0]
    stamps = [stamp for path in estimates.values() for stamp, _ in read(path)]
    if stamps:
        begin, end = min(stamps) - NEAREST_S, max(stamps) + NEAREST_S
    true_line = [position for stamp, position in truth if begin <= stamp <= end]
    points = [p for line in (true_line, *lines.values()) for p in line]
    low = [min(p[i] for p in points) for i in range(2)]
    extent = max(max(p[i] for p in points) - low[i] for i in range(2)) or 1.0
    scale = (SIZE - 2 * MARGIN) / extent

    def path(line, color, width):
        at = " ".join(f"{MARGIN + (p[0] - low[0]) * scale:.1f},{SIZE - MARGIN - (p[1] - low[1]) * scale:.1f}" for p in line)
        return f'<polyline points="{at}" fill="none" stroke="{color}" stroke-width="{width}"/>'

    colors = dict(zip(lines, COLORS))
    texts = [f'<text x="{SIZE + 10}" y="30">truth</text>']
    texts += [f'<text x="{SIZE + 10}" y="{50 + 20 * i}" fill="{colors[name]}">{name}</text>' for i, name in enumerate(lines)]
    texts += [f'<text x="{SIZE + 10}" y="{SIZE - MARGIN}">{extent:.2f} m across</text>']
    curves = [path(line, colors[name], 1) for name, line in lines.items()] + [path(true_line, "#000000", 1.5)]
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE + 140} {SIZE}" width="{SIZE + 140}" height="{SIZE}" '
            f'font-family="sans-serif" font-size="14"><rect width="100%" height="100%" fill="#ffffff"/>'
            + "".join(curves + texts) + "</svg>\n")
