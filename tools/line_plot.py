# SPDX-License-Identifier: Apache-2.0
"""Curves as an SVG with axes and a legend."""
import html
import math

COLORS = ("#1f77b4", "#d62728", "#2ca02c", "#ff7f0e", "#9467bd", "#8c564b", "#e377c2", "#555555", "#a6a61f", "#17becf")
WIDTH, HEIGHT = 760, 320
LEFT, TOP, RIGHT, BOTTOM = 60, 30, 24, 40
TICKS = 5


def tick_step(most):
    """The least 1, 2 or 5 times a power of ten of which TICKS reach `most`."""
    power = 10 ** math.floor(math.log10(most / TICKS))
    return next(step * power for step in (1, 2, 5, 10) if step * power * TICKS >= most)


def ticks(most):
    step = tick_step(most)
    return [k * step for k in range(TICKS + 1) if k * step <= most * 1.0001]


def svg(title, x_name, y_name, curves):
    """`curves`: name -> [(x, y)], both from 0 on and some of both above it."""
    most_x = max(x for points in curves.values() for x, _ in points)
    most_y = max(y for points in curves.values() for _, y in points)

    def at(x, y):
        return (LEFT + x / most_x * (WIDTH - LEFT - RIGHT), HEIGHT - BOTTOM - y / most_y * (HEIGHT - TOP - BOTTOM))

    def text(x, y, words, anchor="middle"):
        return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{html.escape(words)}</text>'

    parts = [text(WIDTH / 2, 18, title), text(WIDTH / 2, HEIGHT - 6, x_name), text(6, 18, y_name, "start")]
    for x in ticks(most_x):
        parts.append(text(at(x, 0)[0], HEIGHT - BOTTOM + 16, f"{x:g}"))
    for y in ticks(most_y):
        (x0, height), (x1, _) = at(0, y), at(most_x, y)
        parts.append(f'<path d="M{x0:.1f} {height:.1f}H{x1:.1f}" stroke="#ddd"/>' + text(LEFT - 6, height + 4, f"{y:g}", "end"))
    for k, (name, points) in enumerate(curves.items()):
        color = COLORS[k % len(COLORS)]
        line = " ".join("{:.1f},{:.1f}".format(*at(*point)) for point in points)
        parts.append(f'<polyline points="{line}" fill="none" stroke="{color}" stroke-width="2"/>'
                     f'<g fill="{color}">{text(LEFT + 8, TOP + 14 * (k + 1), name, "start")}</g>')
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" '
            f'font-family="sans-serif" font-size="12">{"".join(parts)}</svg>')
