// SPDX-License-Identifier: Apache-2.0
// A slider over the frames of a run, and a button that plays them.

export class Scrubber {
  // `frames()`: those there are now. `show(place)` is called for the frame that is wanted.
  constructor(slider, button, frames, show) {
    Object.assign(this, { slider, button, frames, show });
    this.playing = null;
    slider.addEventListener("input", () => {
      this.stop();
      if (frames().length > 0) show(Number(slider.value));
    });
    button.addEventListener("click", () => {
      if (this.playing) return this.stop();
      if (frames().length === 0) return;
      button.textContent = "\u275A\u275A";
      button.setAttribute("aria-label", "Pause");
      const place = Number(slider.value);
      show(place + 1 < frames().length ? place : 0);
      this.play();
    });
  }

  // The frame in that place is shown now.
  setPlace(place) {
    this.slider.max = String(this.frames().length - 1);
    this.slider.value = String(place);
  }

  stop() {
    clearTimeout(this.playing);
    this.playing = null;
    this.button.textContent = "\u25B6";
    this.button.setAttribute("aria-label", "Play");
  }

  // From the shown frame on, at the times of the frames.
  play() {
    const frames = this.frames(), place = Number(this.slider.value);
    if (place + 1 >= frames.length) return this.stop();
    const wait_s = frames[place + 1].t - frames[place].t;
    this.playing = setTimeout(() => {
      this.show(place + 1);
      this.play();
    }, 1000 * Math.min(1, Math.max(0, wait_s)));
  }
}
