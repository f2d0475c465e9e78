// SPDX-License-Identifier: Apache-2.0
// A run in three dimensions, from messages: what the viewer's page and the report have in common.
import { ghostsOf } from "./objects.js";
import { Records } from "./records.js";
import { Scene } from "./scene.js";

const LEVEL_OF_FIRST_CAMERA = [1, 0, 0, 0, 1, 0, 0, 0, 1];

export class RunScene {
  // `isShown(what)`: whether "path", "keyframes", "objects" and "ceiling" are to be drawn.
  constructor(element, isShown) {
    this.element = element;
    this.records = new Records();
    this.scene = new Scene(element, isShown);
    this.start = null;
    this.state = {};
  }

  // `image`: the canvas that the camera's pyramid shows, if there is one.
  begin(start, image) {
    this.start = start;
    this.state = {};
    this.records.clear(start.step);
    this.scene.clear();
    this.scene.setLevel(LEVEL_OF_FIRST_CAMERA);
    this.scene.camera.setCamera(start.camera, image);
  }

  // Takes all of a message but its picture.
  take(head, body, image) {
    if (head.start) this.begin(head.start, image);
    if (head.state) {
      this.state = head.state;
      // What few views show of floor and tables may mislead: until the end, the first camera's axes.
      if (this.state.finished) this.scene.setLayout(this.state);
      if (this.state.keyframes) this.showKeyframes();
    }
    if (head.framesAnew) {
      this.records.clearFrames();
      this.scene.path.clear();
    }
    if (head.frames) this.takeFrames(head.frames);
    if (head.movers) this.takeMovers(head.movers, body);
    if (head.pointsAnew) this.scene.points.clear();
    if (head.points) this.scene.points.add(head.points, body, this.start.side);
    this.element.dataset.points = String(this.scene.points.size);
    this.scene.changed();
  }

  takeFrames(frames) {
    this.records.add(frames);
    for (const frame of frames) this.scene.path.add(frame.p);
    if (frames.some((frame) => frame.k)) this.showKeyframes();
  }

  // What moved in frames, as a report has it: pictures that have nothing else.
  takeMovers(movers, body) {
    for (const [n, ghosts] of movers) this.records.addPicture({ n, ghosts: ghostsOf(ghosts, body) });
  }

  showKeyframes() {
    const poses = this.state.keyframes || this.records.frames.filter((f) => f.k && f.p).map((f) => f.p);
    this.scene.keyframes.set(poses, this.start.camera);
  }

  // Shows the frame in that place, and what its picture says, which may be of a frame shortly before. Returns the
  // objects that are known then.
  show(place, picture) {
    const frame = this.records.frames[place], known = this.records.objectsAt(place);
    const ofPicture = picture && this.records.frameNumbered(picture.n);
    const near = ofPicture && frame.t - ofPicture.t < 0.25 ? ofPicture : frame;
    this.scene.path.showUpTo(place);
    this.scene.camera.setPose(near.p || frame.p);
    this.scene.objects.show(known, near, picture);
    this.element.dataset.moving = String(this.scene.objects.hasGhost ? picture.ghosts.colors.length / 4 : 0);
    this.scene.changed();
    return known;
  }
}
