// SPDX-License-Identifier: Apache-2.0
// The map of the report in three dimensions. The page works without this script: it shows pictures instead.
import { fromBase64, parseMessage } from "./message.js";
import { RunScene } from "./run_scene.js";
import { Scrubber } from "./scrubber.js";

const figure = document.getElementById("map-view");
const tool = (name) => figure.querySelector(`[data-tool=${name}]`);

function showFigure(yes) {
  figure.hidden = !yes;
  document.getElementById("map-note").hidden = yes;
}

function addTools(run, scrubber) {
  const { scene } = run, ceiling = tool("ceiling");
  tool("whole").addEventListener("click", () => {
    ceiling.checked = true;
    scene.lookAtAll();
  });
  tool("above").addEventListener("click", () => {
    ceiling.checked = false;
    scene.lookFromAbove();
  });
  tool("size").addEventListener("input", (event) => {
    scene.points.scale = 2 ** Number(event.target.value);
    scene.changed();
  });
  for (const what of ["path", "keyframes", "objects", "ceiling"]) {
    tool(what).addEventListener("change", () => scene.changed());
  }
  tool("frames").hidden = run.records.frames.length < 2;
  const canvas = scene.renderer.domElement;
  // The wheel scrolls the page until the view has been clicked.
  scene.controls.enableZoom = false;
  canvas.addEventListener("focus", () => { scene.controls.enableZoom = true; });
  canvas.addEventListener("blur", () => { scene.controls.enableZoom = false; });
  canvas.addEventListener("webglcontextlost", () => {
    scrubber.stop();
    showFigure(false);
  });
}

function draw() {
  showFigure(true);  // it needs its size
  const run = new RunScene(tool("scene"), (what) => tool(what).checked);
  const { head, body } = parseMessage(fromBase64(document.getElementById("map-data").textContent));
  run.take(head, body);
  const { frames } = run.records;
  const show = (place) => {
    scrubber.setPlace(place);
    run.show(place, run.records.pictureAt(frames[place]));
    tool("time").textContent = `${(frames[place].t - frames[0].t).toFixed(1)} s`;
  };
  const scrubber = new Scrubber(tool("scrubber"), tool("play"), () => frames, show);
  if (frames.length > 0) show(frames.length - 1);
  addTools(run, scrubber);
  run.scene.lookAtAll();
}

try {
  draw();
} catch (error) {
  showFigure(false);
  console.warn(`no view in three dimensions: ${error.message}`);
}
