// SPDX-License-Identifier: Apache-2.0
// What the page knows of the run: the records of its frames, and some of its pictures.

const MOST_PICTURES = 600;
const STATIC_SECONDS = 10;  // for which an object at rest is shown after it was last seen
const MOVING_SECONDS = 0.5;
const SURE_SIGHTINGS = 5;   // before an object that does not move is shown

export class Records {
  constructor() { this.clear(); }

  // `step_s`: of the frames that tell their objects, where not all of them do.
  clear(step_s = 0) {
    this.staticSeconds = Math.max(STATIC_SECONDS, 12 * step_s);
    this.movingSeconds = Math.max(MOVING_SECONDS, 1.5 * step_s);
    this.frames = [];
    this.placeOf = new Map();  // of a frame's number in `frames`
    this.pictures = new Map();  // by the frame's number, in order
  }

  clearFrames() {
    this.frames = [];
    this.placeOf.clear();
  }

  add(frames) {
    for (const frame of frames) {
      this.placeOf.set(frame.n, this.frames.length);
      this.frames.push(frame);
    }
  }

  // Every second picture goes when there are too many.
  addPicture(picture) {
    this.pictures.set(picture.n, picture);
    if (this.pictures.size <= MOST_PICTURES) return;
    let odd = false;
    for (const number of [...this.pictures.keys()].slice(0, -1)) {
      odd = !odd;
      if (odd) this.pictures.delete(number);
    }
  }

  frameNumbered(number) { return this.frames[this.placeOf.get(number)]; }

  // The last picture up to that frame.
  pictureAt(frame) {
    let found;
    for (const [number, picture] of this.pictures) {
      if (number > frame.n) break;
      found = picture;
    }
    return found;
  }

  // The objects known at the frame in that place, each as it was last seen: { object, frame }.
  objectsAt(place) {
    const now = this.frames[place];
    const seen = new Map();
    for (let i = place; i >= 0 && now.t - this.frames[i].t < this.staticSeconds; --i) {
      const frame = this.frames[i];
      for (const object of frame.o || []) {
        if (!object.p) continue;
        const known = seen.get(object.i);
        if (known) ++known.sightings;
        else seen.set(object.i, { object, frame, sightings: 1 });
      }
    }
    return [...seen.values()].filter(({ object, frame, sightings }) =>
      object.d ? now.t - frame.t < this.movingSeconds : sightings >= SURE_SIGHTINGS);
  }
}
