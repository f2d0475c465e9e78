// SPDX-License-Identifier: Apache-2.0
// Figures, times and the list of objects.
import { colorOf, isMoving } from "./objects.js";

const SHOWN_FRAMES = 200;

const element = (id) => document.getElementById(id);

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted.length > 0 ? sorted[Math.floor(sorted.length / 2)] : 0;
}

function line(...parts) {
  const item = document.createElement("li");
  item.append(...parts.map(([tag, text, color]) => {
    const part = document.createElement(tag);
    part.textContent = text;
    if (color) part.style.color = color;
    return part;
  }));
  return item;
}

export class Panel {
  constructor() { this.figures = new Map(); }

  setFigure(name, value) {
    if (!this.figures.has(name)) {
      const group = document.createElement("div");
      const term = document.createElement("dt"), data = document.createElement("dd");
      term.textContent = name;
      group.append(term, data);
      element("figures").append(group);
      this.figures.set(name, data);
    }
    const data = this.figures.get(name);
    if (data.textContent !== value) data.textContent = value;
  }

  // `frames` up to the one shown; `state` and `pointCount` of the run so far.
  show(frames, state, pointCount) {
    const recent = frames.slice(-SHOWN_FRAMES), now = frames[frames.length - 1];
    const times = recent.map((frame) => frame.ms);
    const isTimed = times.some((ms) => ms > 0);  // a finished run's folder has no times of frames
    this.setFigure("ms per frame", isTimed ? median(times).toFixed(1) : "-");
    this.setFigure("features", isTimed ? String(now.f) : "-");
    element("times").hidden = !isTimed;
    this.setFigure("key frames", String(state.keyframes ? state.keyframes.length
                                        : frames.reduce((sum, frame) => sum + (frame.k || 0), 0)));
    this.setFigure("dropped", String(state.dropped || 0));
    this.setFigure("lost", String(frames.reduce((sum, frame) => sum + (frame.p ? 0 : 1), 0)));
    this.setFigure("points", pointCount < 1e5 ? String(pointCount) : `${(pointCount / 1e6).toFixed(2)} M`);
    this.drawTimes(times);
  }

  drawTimes(times) {
    const canvas = element("times"), context = canvas.getContext("2d");
    [canvas.width, canvas.height] = [2 * canvas.clientWidth, 2 * canvas.clientHeight];
    const { width, height } = canvas, most = Math.max(40, ...times);
    const y = (ms) => height - ms / most * (height - 4) - 2;
    context.strokeStyle = "#2a303a";
    context.beginPath();
    context.moveTo(0, y(33.3));
    context.lineTo(width, y(33.3));
    context.stroke();
    context.strokeStyle = "#56b4e9";
    context.lineWidth = 2;
    context.beginPath();
    times.forEach((ms, i) => context.lineTo(i / SHOWN_FRAMES * width, y(ms)));
    context.stroke();
  }

  showStages(stages) {
    const most = Math.max(1, ...Object.values(stages));
    element("stages").replaceChildren(...Object.entries(stages).map(([name, ms]) => {
      const row = document.createElement("div");
      row.className = "stage";
      const bar = document.createElement("i");
      bar.style.width = `${100 * ms / most}%`;
      const label = document.createElement("span"), value = document.createElement("span");
      label.textContent = name;
      value.textContent = `${ms.toFixed(1)} ms`;
      row.append(label, bar, value);
      return row;
    }));
  }

  showObjects(known) {
    const motion = ({ m, v }) => isMoving({ m }) ? `${m}, ${Math.hypot(...v).toFixed(2)} m/s` : m;
    const rows = [...known].sort((a, b) => (b.object.d || 0) - (a.object.d || 0) || a.object.i - b.object.i);
    element("objects").replaceChildren(...rows.map((entry) => line(
      ["b", `${entry.object.c} ${entry.object.i}`, colorOf(entry.object)],
      ["span", motion(entry.object)])));
    element("objects").parentElement.hidden = rows.length === 0;
  }

  setStatus(text, isGood) {
    element("status").textContent = text;
    element("status").classList.toggle("bad", !isGood);
  }
}
