// SPDX-License-Identifier: Apache-2.0
// The camera's image with masks, features and boxes.
import { LabelPlaces } from "./labels.js";
import { colorOf, ghostsOf } from "./objects.js";

const NAME_PX = 16, NAME_ROWS = 5;  // the height of a name on the page

const css = (color) => `rgb(${color[0]},${color[1]},${color[2]})`;

// A picture as a message has it, with its parts as arrays.
export function readPicture(json, body) {
  const [jpegAt, jpegSize] = json.jpeg, [featuresAt, features] = json.features;
  const [masksAt, runs, maskWidth, maskHeight] = json.masks;
  const picture = {
    n: json.n,
    stages: json.stages,
    blob: new Blob([new Uint8Array(body, jpegAt, jpegSize)], { type: "image/jpeg" }),
    features: new Uint16Array(body, featuresAt, 3 * features),
    masks: { width: maskWidth, height: maskHeight, runs: new Uint16Array(body, masksAt, runs) },
  };
  if (json.ghosts) picture.ghosts = ghostsOf(json.ghosts, body);
  return picture;
}

// The masks as a canvas: an outline of the network's, tints for the others.
function maskCanvas(masks, colors) {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [masks.width, masks.height];
  const bits = new Uint8Array(masks.width * masks.height);
  let at = 0;
  for (let i = 0; i < masks.runs.length; i += 2) {
    bits.fill(masks.runs[i], at, at + masks.runs[i + 1]);
    at += masks.runs[i + 1];
  }
  const context = canvas.getContext("2d");
  const image = context.createImageData(masks.width, masks.height);
  const inNetwork = (i) => (bits[i] & 1) !== 0;
  for (let i = 0; i < bits.length; ++i) {
    const edge = inNetwork(i) && !(inNetwork(i - 1) && inNetwork(i + 1) &&
                                   inNetwork(i - masks.width) && inNetwork(i + masks.width));
    const which = edge ? 0 : bits[i] & 4 ? 2 : bits[i] & 2 ? 1 : -1;
    if (which >= 0) image.data.set([...colors[which], which === 0 ? 230 : 110], 4 * i);
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

export class PicturePane {
  constructor(canvas, isShown) {
    this.canvas = canvas;
    this.isShown = isShown;  // of "masks", "features", "boxes"
  }

  // Draws the picture, with the objects of its frame. `onDrawn` is called when it is there.
  async show(picture, objects, start, onDrawn) {
    this.last = [picture, objects, start, onDrawn];
    if (!picture || picture.blob.size === 0 || !start.camera) return;
    const image = await createImageBitmap(picture.blob);
    if (this.last[0] !== picture) {  // a newer one is wanted by now
      image.close();
      return;
    }
    const width = 640, height = Math.round(width * start.camera.height / start.camera.width);
    if (this.canvas.width !== width || this.canvas.height !== height) {
      [this.canvas.width, this.canvas.height] = [width, height];
    }
    const context = this.canvas.getContext("2d");
    context.drawImage(image, 0, 0, width, height);
    if (this.isShown("masks") && picture.masks.width > 0) {
      context.drawImage(maskCanvas(picture.masks, start.masks), 0, 0, width, height);
    }
    const scale = width / start.camera.width;
    if (this.isShown("features")) this.drawFeatures(context, picture.features, start.styles, scale);
    if (this.isShown("boxes")) this.drawBoxes(context, objects, scale);
    image.close();
    onDrawn();
  }

  again() { if (this.last) this.show(...this.last); }

  drawFeatures(context, features, styles, scale) {
    context.lineWidth = 1.2;
    styles.forEach((style, kind) => {
      context.strokeStyle = css(style.color);
      context.beginPath();
      for (let i = 0; i < features.length; i += 3) {
        if (features[i + 2] !== kind) continue;
        const x = features[i] / 4 * scale, y = features[i + 1] / 4 * scale;
        context.moveTo(x + style.radius, y);
        context.arc(x, y, style.radius, 0, 2 * Math.PI);
      }
      context.stroke();
    });
  }

  drawBoxes(context, objects, scale) {
    const onPage = this.canvas.width / Math.max(1, this.canvas.clientWidth), high = NAME_PX * onPage;
    context.font = `600 ${0.75 * high}px system-ui, sans-serif`;
    context.lineWidth = 1.2 * onPage;
    const places = new LabelPlaces();
    for (const object of [...objects || []].sort((a, b) => (b.d || 0) - (a.d || 0))) {
      const [x0, y0, x1, y1] = object.b.map((value) => value * scale);
      context.strokeStyle = context.fillStyle = colorOf(object);
      context.strokeRect(x0, y0, x1 - x0, y1 - y0);
      const text = `${object.c} ${object.i}`, width = context.measureText(text).width + 0.4 * high;
      const left = Math.max(0, Math.min(x0, this.canvas.width - width)), top = Math.max(0, y0 - high);
      const row = places.take(left, top, width, high, high, NAME_ROWS);
      if (row === undefined) continue;
      context.fillStyle = "rgba(10,12,16,.75)";
      context.fillRect(left, top + row * high, width, high);
      context.fillStyle = colorOf(object);
      context.fillText(text, left + 0.2 * high, top + (row + 0.76) * high);
    }
  }
}

export function fillLegend(list, start) {
  const entry = (color, name, kind) => {
    const item = document.createElement("li"), key = document.createElement("span");
    key.className = kind;
    key.style.borderColor = css(color);
    item.append(key, name);
    return item;
  };
  list.replaceChildren(
    ...start.styles.map((style) => entry(style.color, style.name, "key")),
    ...["the network's mask", "mask extended by depth", "jump of depth"].map(
      (name, i) => entry(start.masks[i], name, "key area")));
}
