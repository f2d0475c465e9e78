#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Gathers a batch: table.json, table.md and index.html, which depend on the results alone, and times.json."""
import argparse
import html
import json
import pathlib
import sys

import recordings
import step
import tree

NO_OUTCOME = "no result: killed or out of its limits in every attempt, or not begun"
STEPS = ("segment", "run", "evaluate")
COLUMNS = (  # heading, key of a row, format
    ("tracked", "tracked_ratio", "{:.1%}"),
    ("ATE rmse m", "ate_rmse_m", "{:.4f}"),
    ("ATE max m", "ate_max_m", "{:.4f}"),
    ("RPE m/s", "rpe_rmse_m", "{:.4f}"),
    ("key frames", "keyframes", "{}"),
    ("loops", "loops", "{}"),
    ("map points", "map_points", "{}"),
    ("map complete", "map_complete_ratio", "{:.1%}"),
    ("ghosts", "map_ghost_ratio", "{:.3%}"),
)


def read_json(path):
    return json.loads(path.read_text()) if path.is_file() else None


def outcome_of(out, name, run):
    """How a step ended; as a failure if there is no outcome."""
    path = out / "outcomes" / name / f"{run}.json"
    return read_json(path) or {"state": "failed", "message": f"{NO_OUTCOME}; see logs/{name}/{run}.log"}


def figures(report):
    """What is taken from a run's report.json: nothing that depends on time or machine."""
    return {"frames": report["frames"]["total"], "tracked": report["frames"]["tracked"],
            "tracked_ratio": report["frames"]["ratio"], "keyframes": report["keyframes"], "loops": len(report["loops"]),
            "map_points": report["map"]["points"], "map_complete_ratio": report["map"]["completeness_ratio"],
            "map_ghost_ratio": report["map"]["ghost_ratio"], "version": report["version"], "warnings": report["warnings"]}


def errors(evaluation):
    return {"ate_rmse_m": evaluation["ate"]["rmse"], "ate_max_m": evaluation["ate"]["max"],
            "rpe_rmse_m": evaluation["rpe"]["trans"]["rmse"]}


def as_in_table(message, recording):
    """A message without the folder that the table is in."""
    return message.replace(f"{recording.folder}/", "")


def row_of(out, run):
    recording = run.recording
    outcome = outcome_of(out, "run", run.name)
    row = {"name": recording.name, "mode": run.mode, "sequence": recording.sequence, "room": recording.room or None}
    if outcome["state"] == "done":
        row |= figures(json.loads((out / "runs" / run.name / "report.json").read_text()))
        if recording.truth():
            outcome = outcome_of(out, "evaluate", run.name)
            if outcome["state"] == "done":
                row |= errors(json.loads((out / "evaluations" / f"{run.name}.json").read_text()))
    return {**row, "state": outcome["state"], "message": as_in_table(outcome["message"], recording)}


def room_of(out, room, runs):
    outcome = outcome_of(out, "merge", f"{room}/{tree.root(len(runs))}")
    name, mode = room.split("/")
    return {"name": name, "mode": mode, "state": outcome["state"], "message": outcome["message"],
            "maps": outcome.get("maps", []), "without_map": outcome.get("without_map", [])}


def gather(table, out):
    listed = recordings.read(table)
    rows = [row_of(out, run) for run in recordings.runs(listed)]
    rooms = [room_of(out, room, runs) for room, runs in recordings.rooms(listed).items()]
    ended = [*rows, *rooms]
    return {"failed": sum(row["state"] == "failed" for row in ended), "lost": sum(row["state"] == "lost" for row in ended),
            "rows": rows, "rooms": rooms}


def times(table, out):
    """What each step took."""
    found = []
    for path in sorted((out / "outcomes").rglob("*.json")):
        outcome = json.loads(path.read_text())
        if "seconds" in outcome:
            found.append({"step": str(path.relative_to(out / "outcomes").with_suffix("")),
                          **{key: outcome[key] for key in ("seconds", "processor_s", "peak_mb")}})
    return found


def cells(row):
    """The texts of a row, one for each heading."""
    texts = [row["name"], row["mode"]]
    for _, key, form in COLUMNS:
        texts.append("" if row.get(key) is None else form.format(row[key]))
    return [*texts, row["state"] + (f": {row['message']}" if row["message"] else "")]


HEADINGS = ("recording", "mode", *(heading for heading, _, _ in COLUMNS), "ended")
ROOM_HEADINGS = ("room", "mode", "map", "key frames", "of the runs", "ended")


def room_rows(rooms):
    for room in rooms:
        ended = room["state"] + (f": {room['message']}" if room["message"] else "")
        if room["without_map"]:
            ended += f"; no map of {', '.join(room['without_map'])}"
        for found in room["maps"] or [{"file": "", "keyframes": "", "runs": []}]:
            yield [room["name"], room["mode"], found["file"], str(found["keyframes"]), ", ".join(found["runs"]), ended]


def markdown_table(headings, rows):
    lines = [headings, ["---"] * len(headings), *([text.replace("|", "\\|") for text in row] for row in rows)]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def markdown(result):
    text = "# Batch\n\n" + markdown_table(HEADINGS, map(cells, result["rows"]))
    if result["rooms"]:
        text += "\n## Rooms\n\n" + markdown_table(ROOM_HEADINGS, room_rows(result["rooms"]))
    return text


STYLE = ("body{font:15px sans-serif;margin:2em}table{border-collapse:collapse;margin:1em 0}"
         "td,th{border:1px solid #ccc;padding:.3em .6em;text-align:left}tr.failed{background:#fdd}tr.lost{background:#ffd}")


def html_table(headings, rows):
    """`rows`: the class of each row, and its cells as HTML."""
    text = "<table>\n<tr>" + "".join(f"<th>{html.escape(heading)}</th>" for heading in headings) + "</tr>\n"
    for state, texts in rows:
        text += f'<tr class="{state}">' + "".join(f"<td>{cell}</td>" for cell in texts) + "</tr>\n"
    return text + "</table>\n"


def html_cells(row):
    texts = [html.escape(text) for text in cells(row)]
    if row["state"] == "done":
        texts[0] = f'<a href="runs/{row["name"]}/{row["mode"]}/report.html">{texts[0]}</a>'
    return texts


def page(result):
    text = f'<!DOCTYPE html>\n<meta charset="utf-8">\n<title>Batch</title>\n<style>{STYLE}</style>\n<h1>Batch</h1>\n'
    text += html_table(HEADINGS, [(row["state"], html_cells(row)) for row in result["rows"]])
    if result["rooms"]:
        rows = [("", map(html.escape, texts)) for texts in room_rows(result["rooms"])]
        text += "<h2>Rooms</h2>\n" + html_table(ROOM_HEADINGS, rows)
    return text


def summary(result):
    """The lines for the terminal: how many, and each that has no result."""
    ended = [*result["rows"], *result["rooms"]]
    lines = [f"batch       {len(result['rows'])} runs, {len(result['rooms'])} rooms: "
             f"{result['failed']} failed, {result['lost']} lost; see table.md, index.html"]
    lines += [f"{row['state']:<11} {row['name']}/{row['mode']}: {row['message']}" for row in ended if row["state"] != "done"]
    return "\n".join(lines)


def forget_failures(out):
    """So that Snakemake tries them again, and what came after them."""
    for path in (out / "outcomes").rglob("*.json"):
        if json.loads(path.read_text())["state"] == "failed":
            path.unlink()


def write(table, out):
    result = gather(table, out)
    as_json = {"indent": 1, "ensure_ascii": False}
    step.write(out / "table.json", json.dumps(result, **as_json) + "\n")
    step.write(out / "table.md", markdown(result))
    step.write(out / "index.html", page(result))
    step.write(out / "times.json", json.dumps(times(table, out), **as_json) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--summary", action="store_true", help="say what was gathered; exit code 1 if anything failed")
    parser.add_argument("--forget-failures", action="store_true", help="let the next batch try them again")
    arguments = parser.parse_args()
    try:
        if arguments.forget_failures:
            recordings.read(arguments.table)
            forget_failures(arguments.out)
        elif arguments.summary:
            result = json.loads((arguments.out / "table.json").read_text())
            print(summary(result))
            return 1 if result["failed"] else 0
        else:
            write(arguments.table, arguments.out)
    except recordings.Failure as failure:
        print(f"batch: {failure}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
