// SPDX-License-Identifier: Apache-2.0
import { connect } from "./socket.js";
import { RunScene } from "./run_scene.js";
import { Scrubber } from "./scrubber.js";
import { PicturePane, fillLegend, readPicture } from "./picture.js";
import { Panel } from "./panel.js";

const element = (id) => document.getElementById(id);
const isShown = (what) => element(`show-${what}`).checked;

const run = new RunScene(element("scene"), isShown);
const { records, scene } = run;
const pane = new PicturePane(element("picture"), isShown);
const panel = new Panel();
const scrubber = new Scrubber(element("scrubber"), element("play"), () => records.frames, (place) => {
  setNewest(false);
  showFrame(place);
});
let connected = false, legend = null;
let shown = -1;        // the place of the frame that is shown
let newest = true;     // the newest frame is to be shown
let following = true;

function setNewest(value) {
  newest = value;
  element("newest").setAttribute("aria-pressed", String(value));
}

function setFollowing(value) {
  following = value;
  element("follow").setAttribute("aria-pressed", String(value));
}

function showStatus() {
  const now = records.frames[records.frames.length - 1];
  if (run.state.finished) panel.setStatus(`finished, ${records.frames.length} frames`, true);
  else if (!connected) panel.setStatus(run.start ? "the connection is lost; trying again" : "connecting", false);
  else if (now) panel.setStatus(now.s, Boolean(now.p));
  else panel.setStatus("waiting for the first frame", true);
}

// Shows the frame in that place: everything that depends on which frame it is.
function showFrame(place) {
  shown = place;
  const frame = records.frames[place], { start, state } = run;
  scrubber.setPlace(place);
  element("frame-number").textContent =
    `${frame.n}${start.frames ? ` / ${start.frames}` : ""}  ${(frame.t - records.frames[0].t).toFixed(1)} s`;
  element("image").hidden = records.pictures.size === 0;
  const picture = records.pictureAt(frame), ofPicture = picture && records.frameNumbered(picture.n);
  const known = run.show(place, picture);
  if (following && frame.p) scene.follow(frame.p);
  pane.show(picture, ofPicture && ofPicture.o, { ...legend, camera: start.camera }, () => {
    scene.camera.pictureChanged();
    scene.changed();
  });
  panel.show(records.frames.slice(0, place + 1), state, scene.points.size);
  panel.showObjects(known);
  if (picture) panel.showStages(picture.stages);
}

function begin(start) {
  shown = -1;
  element("title").textContent = start.title;
  document.title = `${start.title} - stillmap`;
}

function onMessage(head, body) {
  if (head.start) begin(head.start);
  if (head.legend) {
    legend = head.legend;
    fillLegend(element("legend"), legend);
  }
  run.take(head, body, element("picture"));
  if (head.picture) {
    records.addPicture(readPicture(head.picture, body));
    element("scene").dataset.pictures = String(records.pictures.size);
  }
  showStatus();
  if (records.frames.length > 0 && !head.more) {
    showFrame(newest || shown < 0 ? records.frames.length - 1 : Math.min(shown, records.frames.length - 1));
  }
}

// Looks at the map from elsewhere, with its ceiling or without.
function look(withCeiling, from) {
  setFollowing(false);
  element("show-ceiling").checked = withCeiling;
  from();
}

element("newest").addEventListener("click", () => {
  scrubber.stop();
  setNewest(true);
  if (records.frames.length > 0) showFrame(records.frames.length - 1);
});
element("follow").addEventListener("click", () => {
  setFollowing(!following);
  if (shown >= 0) showFrame(shown);
});
element("whole").addEventListener("click", () => look(true, () => scene.lookAtAll()));
element("above").addEventListener("click", () => look(false, () => scene.lookFromAbove()));
scene.onTouched = () => setFollowing(false);
for (const what of ["path", "keyframes", "objects", "ceiling"]) {
  element(`show-${what}`).addEventListener("change", () => scene.changed());
}
for (const what of ["masks", "features", "boxes"]) {
  element(`show-${what}`).addEventListener("change", () => pane.again());
}
connect(onMessage, (value) => {
  connected = value;
  showStatus();
});
