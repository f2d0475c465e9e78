// SPDX-License-Identifier: Apache-2.0
import { connect } from "./socket.js";
import { Records } from "./records.js";
import { Scene } from "./scene.js";
import { PicturePane, fillLegend, readPicture } from "./picture.js";
import { Panel } from "./panel.js";

const element = (id) => document.getElementById(id);
const isShown = (what) => element(`show-${what}`).checked;

const records = new Records();
const scene = new Scene(element("scene"), isShown);
const pane = new PicturePane(element("picture"), isShown);
const panel = new Panel();
let start = null, state = {}, connected = false;
let shown = -1;        // the place of the frame that is shown
let newest = true;     // the newest frame is to be shown
let following = true;
let playing = null;

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
  if (state.finished) panel.setStatus(`finished, ${records.frames.length} frames`, true);
  else if (!connected) panel.setStatus(start ? "the connection is lost; trying again" : "connecting", false);
  else if (now) panel.setStatus(now.s, Boolean(now.p));
  else panel.setStatus("waiting for the first frame", true);
}

// Shows the frame in that place: everything that depends on which frame it is.
function showFrame(place) {
  shown = place;
  const frame = records.frames[place];
  element("scrubber").max = String(records.frames.length - 1);
  element("scrubber").value = String(place);
  element("frame-number").textContent =
    `${frame.n}${start.frames ? ` / ${start.frames}` : ""}  ${(frame.t - records.frames[0].t).toFixed(1)} s`;
  element("image").hidden = records.pictures.size === 0;
  const picture = records.pictureAt(frame), known = records.objectsAt(place);
  // The picture may be of a frame shortly before.
  const ofPicture = picture && records.frameNumbered(picture.n);
  const near = ofPicture && frame.t - ofPicture.t < 0.25 ? ofPicture : frame;
  scene.path.showUpTo(place);
  scene.camera.setPose(near.p || frame.p);
  scene.objects.show(known, near, picture);
  if (following && frame.p) scene.follow(frame.p);
  pane.show(picture, ofPicture && ofPicture.o, start, () => {
    scene.camera.pictureChanged();
    scene.changed();
  });
  panel.show(records.frames.slice(0, place + 1), state, scene.points.size);
  panel.showObjects(known);
  if (picture) panel.showStages(picture.stages);
  scene.changed();
}

function showKeyframes() {
  const poses = state.keyframes || records.frames.filter((f) => f.k && f.p).map((f) => f.p);
  scene.keyframes.set(poses, start.camera);
}

function begin(message) {
  start = message;
  state = {};
  shown = -1;
  records.clear();
  scene.clear();
  scene.setLevel([1, 0, 0, 0, 1, 0, 0, 0, 1]);
  scene.camera.setCamera(start.camera, element("picture"));
  element("title").textContent = start.title;
  document.title = `${start.title} - stillmap`;
  fillLegend(element("legend"), start);
}

function takeFrames(frames) {
  records.add(frames);
  for (const frame of frames) scene.path.add(frame.p);
  if (frames.some((frame) => frame.k)) showKeyframes();
}

function onMessage(head, body) {
  if (head.start) begin(head.start);
  if (head.state) {
    state = head.state;
    // What few views show of floor and tables may mislead: until the end, the first camera's axes.
    if (state.finished) scene.setLevel(state.level);
    if (state.keyframes) showKeyframes();
  }
  if (head.framesAnew) {
    records.clearFrames();
    scene.path.clear();
  }
  if (head.frames) takeFrames(head.frames);
  if (head.pointsAnew) scene.points.clear();
  if (head.points) scene.points.add(head.points, body, start.side);
  if (head.picture) records.addPicture(readPicture(head.picture, body));
  element("scene").dataset.points = String(scene.points.size);
  showStatus();
  scene.changed();
  if (records.frames.length > 0 && !head.more) {
    showFrame(newest || shown < 0 ? records.frames.length - 1 : Math.min(shown, records.frames.length - 1));
  }
}

function stop() {
  clearTimeout(playing);
  playing = null;
  element("play").textContent = "\u25B6";
}

// From the shown frame on, at the times of the frames.
function play() {
  if (shown + 1 >= records.frames.length) return stop();
  const wait_s = records.frames[shown + 1].t - records.frames[shown].t;
  playing = setTimeout(() => {
    showFrame(shown + 1);
    play();
  }, 1000 * Math.min(1, Math.max(0, wait_s)));
}

element("scrubber").addEventListener("input", (event) => {
  stop();
  setNewest(false);
  if (records.frames.length > 0) showFrame(Number(event.target.value));
});
element("newest").addEventListener("click", () => {
  stop();
  setNewest(true);
  if (records.frames.length > 0) showFrame(records.frames.length - 1);
});
element("play").addEventListener("click", () => {
  if (playing) return stop();
  if (records.frames.length === 0) return;
  setNewest(false);
  element("play").textContent = "\u275A\u275A";
  if (shown + 1 >= records.frames.length) showFrame(0);
  play();
});
element("follow").addEventListener("click", () => {
  setFollowing(!following);
  if (shown >= 0) showFrame(shown);
});
element("above").addEventListener("click", () => {
  setFollowing(false);
  scene.lookFromAbove();
});
scene.onTouched = () => setFollowing(false);
for (const what of ["path", "keyframes", "objects"]) {
  element(`show-${what}`).addEventListener("change", () => scene.changed());
}
for (const what of ["masks", "features", "boxes"]) {
  element(`show-${what}`).addEventListener("change", () => pane.again());
}
connect(onMessage, (value) => {
  connected = value;
  showStatus();
});
