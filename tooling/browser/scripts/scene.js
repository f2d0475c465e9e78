// SPDX-License-Identifier: Apache-2.0
// The scene in three dimensions. `worlds` have the world frame's axes; they are turned so that the floor is level, y up.
import { MapPoints } from "./points.js";
import { CameraFigure, Path, keyframeLines } from "./cameras.js";
import { Objects } from "./objects.js";
import { Shading } from "./shading.js";
import { addKeys } from "./keys.js";

const FEWEST_POINTS = 60000, MOST_POINTS = 3000000;
const SLOW_MS = 50, FAST_MS = 24;
const SETTLED_MS = 350;  // after the last motion, all points are drawn
const FIELD_OF_VIEW = 50;
const LOOK_DOWN = 25 * Math.PI / 180;  // of the view of the whole
const FILLED = 0.94;     // of the picture, by the whole
const SAMPLE_POINTS = 4000;
const HEADROOM_M = 0.4;  // what is higher above the cameras is the ceiling

function newRenderer() {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("webgl2", { antialias: true, alpha: false });
  const renderer = new THREE.WebGLRenderer(context ? { canvas, context } : { canvas, antialias: true });
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
  renderer.setClearColor(0x0e1116);
  renderer.localClippingEnabled = true;
  return renderer;
}

function newWorld(scene) {
  const world = new THREE.Group();
  world.matrixAutoUpdate = false;
  scene.add(world);
  return world;
}

export class Scene {
  // Throws where the browser draws nothing in three dimensions.
  constructor(element, isShown) {
    this.element = element;
    this.isShown = isShown;
    this.renderer = newRenderer();
    this.shading = new Shading(this.renderer);
    element.appendChild(this.renderer.domElement);
    this.pointScene = new THREE.Scene();
    this.figureScene = new THREE.Scene();
    this.worlds = [newWorld(this.pointScene), newWorld(this.figureScene)];
    this.eye = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.05, 500);
    this.makeControls();
    this.points = new MapPoints(this.worlds[0]);
    this.path = new Path(this.worlds[1]);
    this.camera = new CameraFigure(this.worlds[1]);
    this.objects = new Objects(this.worlds[1], this.figureScene);
    this.keyframes = keyframeLines(this.worlds[1]);
    this.budget = 400000;
    this.clear();
    this.setLevel([1, 0, 0, 0, 1, 0, 0, 0, 1]);
    this.lookFrom(new THREE.Vector3(0, 0, 0), new THREE.Vector3(0, 0, -1));
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
    requestAnimationFrame((time) => this.tick(time));
  }

  makeControls() {
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    this.controls = new THREE.OrbitControls(this.eye, canvas);
    this.controls.screenSpacePanning = true;
    this.controls.maxDistance = 400;
    this.controls.addEventListener("change", () => this.changed());
    this.controls.addEventListener("start", () => this.onTouched());
    this.onTouched = () => {};
    addKeys(canvas, this.controls);
    canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));
  }

  clear() {
    this.points.clear();
    this.points.setSpacing();
    this.path.clear();
    this.objects.clear();
    this.keyframes.set([]);
    this.placed = false;
    this.box = null;
    this.head = null;  // the height over which the ceiling is
    this.changed();
  }

  // The rotation of the level axes (x right, y down, z forward), row by row.
  setLevel(m) {
    for (const world of this.worlds) {
      world.matrix.set(m[0], m[1], m[2], 0, -m[3], -m[4], -m[5], 0, -m[6], -m[7], -m[8], 0, 0, 0, 0, 1);
      world.updateMatrixWorld(true);
    }
    this.changed();
  }

  // `layout`, in level axes, as a message's state has it at the end.
  setLayout(layout) {
    this.setLevel(layout.level);
    this.points.setSpacing(layout.spacing);
    if (!layout.box) return;
    const [x0, y0, z0, x1, y1, z1] = layout.box;
    this.box = new THREE.Box3(new THREE.Vector3(x0, -y1, -z1), new THREE.Vector3(x1, -y0, -z0));
    this.head = -layout.head;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.eye.aspect = width / height;
    this.eye.updateProjectionMatrix();
    this.changed();
  }

  changed() {
    this.dirty = true;
    this.moved_ms = performance.now();
  }

  // A place of the world frame as one of the scene.
  place(p) { return new THREE.Vector3(p[0], p[1], p[2]).applyMatrix4(this.worlds[0].matrix); }

  // From behind and above a camera of that pose: at once, or some of the way.
  follow(pose) {
    const at = this.place(pose);
    const ahead = new THREE.Vector3(0, 0, 1)
      .applyQuaternion(new THREE.Quaternion(pose[3], pose[4], pose[5], pose[6]))
      .transformDirection(this.worlds[0].matrix);
    ahead.y = 0;
    if (ahead.lengthSq() < 0.01) return;
    this.lookFrom(at, ahead.normalize(), this.placed ? 0.06 : 1);
    this.placed = true;
  }

  lookFrom(at, ahead, share = 1) {
    const target = at.clone().addScaledVector(ahead, 1.2);
    const eye = at.clone().addScaledVector(ahead, -1.7);
    eye.y += 1.1;
    target.y -= 0.15;
    this.controls.target.lerp(target, share);
    this.eye.position.lerp(eye, share);
    this.controls.update();
  }

  // Some points of the map, evenly spread and without strays, and of the camera's path.
  samplePlaces() {
    const places = this.points.sample(SAMPLE_POINTS).map((p) => this.place(p));
    const inside = this.box ? places.filter((p) => this.box.containsPoint(p)) : places;
    return [...inside, ...this.path.sample(SAMPLE_POINTS / 10).map((p) => this.place(p))];
  }

  // All of the map, `down` radians from above the horizon, as near as possible.
  lookAtAll(down = LOOK_DOWN) {
    const places = this.samplePlaces();
    if (places.length === 0) return;
    const right = new THREE.Vector3(1, 0, 0), above = new THREE.Vector3(0, Math.cos(down), -Math.sin(down));
    const back = new THREE.Vector3(0, Math.sin(down), Math.cos(down));
    const high = FILLED * Math.tan(FIELD_OF_VIEW * Math.PI / 360), wide = high * this.eye.aspect;
    // A point is in the picture if it is not farther aside of the eye than `wide` times its distance.
    const fit = (axis, slope) => {
      const ends = [1, -1].map((side) => Math.max(...places.map((p) => side * p.dot(axis) + slope * p.dot(back))));
      return { middle: (ends[0] - ends[1]) / 2, distance: (ends[0] + ends[1]) / 2 / slope };
    };
    const x = fit(right, wide), y = fit(above, high), distance = Math.max(x.distance, y.distance);
    const depths = places.map((p) => p.dot(back)).sort((a, b) => a - b);
    const at = (depth) => new THREE.Vector3().addScaledVector(right, x.middle).addScaledVector(above, y.middle)
      .addScaledVector(back, depth);
    this.controls.target.copy(at(Math.min(depths[depths.length >> 1], distance - 0.1)));
    this.eye.position.copy(at(distance));
    this.controls.update();
  }

  lookFromAbove() { this.lookAtAll(Math.PI / 2 - 0.001); }

  // Draws where something has changed: with as many points as this device manages while it moves,
  // with all of them when it rests.
  tick(time) {
    requestAnimationFrame((next) => this.tick(next));
    const took = time - (this.last_ms || time);
    this.last_ms = time;
    if (this.dirty) {
      if (this.drew) {
        if (took > SLOW_MS) this.budget = Math.max(FEWEST_POINTS, this.budget * 0.8);
        if (took < FAST_MS) this.budget = Math.min(MOST_POINTS, this.budget * 1.1);
      }
      this.draw(this.budget);
      this.rough = this.points.size > this.budget;
    } else if (this.rough && performance.now() - this.moved_ms > SETTLED_MS) {
      this.draw(MOST_POINTS);
      this.rough = false;
      this.drew = false;  // this one may take long
    }
  }

  draw(most) {
    const toWorld = new THREE.Matrix4().getInverse(this.worlds[0].matrix);
    this.points.choose(this.eye.position.clone().applyMatrix4(toWorld), most);
    this.points.cutAt(this.isShown("ceiling") ? null : this.headNow());
    this.path.object.visible = this.isShown("path");
    this.keyframes.object.visible = this.isShown("keyframes");
    this.objects.setVisible(this.isShown("objects"));
    this.objects.placeNames(this.eye, this.element.clientWidth, this.element.clientHeight);
    this.shading.draw(this.pointScene, this.figureScene, this.eye);
    this.drew = this.dirty;
    this.dirty = false;
    if (this.points.size > 0 && !this.isMarked) {
      performance.mark("the map is drawn");  // how long the page took
      this.isMarked = true;
    }
  }

  headNow() {
    if (this.head !== null) return this.head;
    return this.path.last ? this.place(this.path.last).y + HEADROOM_M : Infinity;
  }
}
