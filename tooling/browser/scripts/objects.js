// SPDX-License-Identifier: Apache-2.0
// Objects with their names, boxes and velocities, and what moves as ghosts: its points where the
// image of the frame is at hand, else a shape of its size.
import { poseMatrix } from "./cameras.js";
import { LabelPlaces } from "./labels.js";

const SLOWEST_M_S = 0.12;  // that an arrow is drawn for
const MOVING_COLORS = ["#ff7f5c", "#ffb347", "#ff6fae", "#ffd166", "#c792ea", "#ff9d9d"];
const RESTING_COLOR = "#7fd4ff";
const NAME_PX = 19, NAME_ROWS = 6;  // the height of a name on the page; the rows that it may be moved up

export function colorOf(object) {
  return object.d ? MOVING_COLORS[object.i % MOVING_COLORS.length] : RESTING_COLOR;
}

// Whether an object is known to move: what has no such motion may have a velocity that is noise.
export function isMoving(object) { return object.m.startsWith("mov"); }

// The points of what moves, from where a message says that they are: positions, colours, count.
export function ghostsOf([positionsAt, colorsAt, count], body) {
  return { positions: new Uint16Array(body, positionsAt, 3 * count), colors: new Uint8Array(body, colorsAt, 4 * count) };
}

function nameSprite(text, color) {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d"), font = "600 30px system-ui, sans-serif";
  context.font = font;
  [canvas.width, canvas.height] = [Math.ceil(context.measureText(text).width) + 16, 40];
  context.font = font;
  context.fillStyle = "rgba(10,12,16,.7)";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = color;
  context.fillText(text, 8, 30);
  const texture = new THREE.CanvasTexture(canvas);
  texture.minFilter = THREE.LinearFilter;
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: texture, depthTest: false, sizeAttenuation: false }));
  sprite.aspect = canvas.width / canvas.height;
  sprite.renderOrder = 2;
  return sprite;
}

const BOX = new THREE.EdgesGeometry(new THREE.BoxBufferGeometry(1, 1, 1));
const SHAPE = new THREE.SphereBufferGeometry(0.5, 20, 14);

// The figure of one object: made once, then placed.
class Figure {
  constructor(object) {
    const color = colorOf(object);
    this.color = color;
    this.moves = Boolean(object.d);
    this.group = new THREE.Group();
    this.box = new THREE.LineSegments(BOX, new THREE.LineBasicMaterial({
      color, transparent: true, opacity: object.d ? 0.9 : 0.5 }));
    this.name = nameSprite(`${object.c} ${object.i}`, color);
    this.shape = new THREE.Mesh(SHAPE, new THREE.MeshBasicMaterial({
      color, transparent: true, opacity: 0.22, depthWrite: false }));
    this.arrow = new THREE.ArrowHelper(new THREE.Vector3(1, 0, 0), new THREE.Vector3(), 1, color, 0.12, 0.08);
    this.group.add(this.box, this.name, this.shape, this.arrow);
  }

  // `turn`: the rotation about the vertical that puts the box as the camera saw it.
  place(object, at, turn, velocity, hasGhost) {
    const [width, height, forward] = object.z;
    const size = new THREE.Vector3(Math.max(width, 0.05), Math.max(height, 0.05), Math.max(forward, 0.05));
    this.group.position.copy(at);
    for (const part of [this.box, this.shape]) {
      part.scale.copy(size);
      part.quaternion.copy(turn);
    }
    this.name.position.set(0, size.y / 2 + 0.04, 0);
    this.shape.visible = Boolean(object.d) && !hasGhost;
    const speed = velocity.length();
    this.arrow.visible = isMoving(object) && speed > SLOWEST_M_S;
    if (this.arrow.visible) {
      this.arrow.setDirection(velocity.clone().normalize());
      this.arrow.setLength(Math.min(2, speed) * 0.6 + 0.1, 0.1, 0.06);
    }
  }

  // Places the name for an eye, beside those placed before; hides it where there is no room.
  placeName(eye, width_px, height_px, places) {
    const at = this.name.getWorldPosition(new THREE.Vector3()).project(eye);
    const isAhead = Math.abs(at.z) < 1 && Math.abs(at.x) < 1.1 && Math.abs(at.y) < 1.1;
    const x = (at.x + 1) / 2 * width_px, y = (1 - at.y) / 2 * height_px, wide = NAME_PX * this.name.aspect;
    const row = isAhead ? places.take(x - wide / 2, y - NAME_PX, wide, NAME_PX, -NAME_PX, NAME_ROWS) : undefined;
    this.name.visible = row !== undefined;
    if (!this.name.visible) return;
    const scale = 2 * NAME_PX / height_px / eye.projectionMatrix.elements[5];  // the same at every distance
    this.name.scale.set(scale * this.name.aspect, scale, 1);
    this.name.center.set(0.5, -row);
  }

  dispose() {
    this.name.material.map.dispose();
    for (const part of [this.name, this.box, this.shape]) part.material.dispose();
  }
}

export class Objects {
  // `world` has the world's axes, `scene` those with y up.
  constructor(world, scene) {
    this.world = world;
    this.all = new THREE.Group();
    scene.add(this.all);
    this.figures = new Map();  // by track and kind
    this.ghost = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({
      size: 0.03, vertexColors: THREE.VertexColors, transparent: true, opacity: 0.6, depthWrite: false }));
    this.ghost.matrixAutoUpdate = false;
    this.ghost.frustumCulled = false;
    world.add(this.ghost);
  }

  clear() {
    this.show([], null, null);
  }

  setVisible(visible) {
    this.all.visible = visible;
    this.ghost.visible = visible && this.hasGhost;
  }

  // What moves gets its name first, then what is near.
  placeNames(eye, width_px, height_px) {
    const places = new LabelPlaces();
    const rank = (figure) => (figure.moves ? 0 : 1000) + figure.group.position.distanceTo(eye.position);
    eye.updateMatrixWorld();
    this.all.updateMatrixWorld();
    for (const figure of [...this.figures.values()].sort((a, b) => rank(a) - rank(b))) {
      figure.placeName(eye, width_px, height_px, places);
    }
  }

  // `known` as Records.objectsAt gives it; `frame` and `picture` of now.
  show(known, frame, picture) {
    this.showGhost(frame, picture);
    const shown = new Map();
    for (const { object, frame: seenIn } of known) {
      const key = `${object.i} ${object.c} ${object.d || 0}`;
      const figure = this.figures.get(key) || new Figure(object);
      const at = new THREE.Vector3(...object.p).applyMatrix4(this.world.matrix);
      const velocity = new THREE.Vector3(...object.v).applyMatrix4(this.world.matrix);
      figure.place(object, at, this.turnOf(seenIn), velocity, this.hasGhost && seenIn === frame);
      shown.set(key, figure);
      this.all.add(figure.group);
    }
    for (const [key, figure] of this.figures) {
      if (shown.has(key)) continue;
      this.all.remove(figure.group);
      figure.dispose();
    }
    this.figures = shown;
  }

  turnOf(frame) {
    if (!frame.p) return new THREE.Quaternion();
    const ahead = new THREE.Vector3(0, 0, 1).applyMatrix4(poseMatrix(frame.p).setPosition(0, 0, 0))
      .applyMatrix4(this.world.matrix);
    return new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(0, 1, 0), Math.atan2(ahead.x, ahead.z));
  }

  showGhost(frame, picture) {
    const ghosts = picture && frame && frame.p && picture.n === frame.n ? picture.ghosts : null;
    this.hasGhost = Boolean(ghosts) && ghosts.colors.length > 0;
    if (!this.hasGhost) return;
    const count = ghosts.colors.length / 4;
    const positions = new Float32Array(3 * count), colors = new Float32Array(3 * count);
    const tints = (frame.o || []).map((object) => new THREE.Color(colorOf(object)).toArray());
    for (let i = 0; i < count; ++i) {
      const tint = tints[ghosts.colors[4 * i + 3]] || [1, 1, 1];
      for (let k = 0; k < 3; ++k) {
        positions[3 * i + k] = (ghosts.positions[3 * i + k] - 32768) / 1000;
        colors[3 * i + k] = 0.6 * ghosts.colors[4 * i + k] / 255 + 0.4 * tint[k];
      }
    }
    this.ghost.geometry.dispose();
    this.ghost.geometry = new THREE.BufferGeometry();
    this.ghost.geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    this.ghost.geometry.setAttribute("color", new THREE.BufferAttribute(colors, 3));
    this.ghost.matrix.copy(poseMatrix(frame.p));
    this.ghost.matrixWorldNeedsUpdate = true;
  }
}
