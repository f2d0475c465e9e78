// SPDX-License-Identifier: Apache-2.0
// The scene in three dimensions. `world` has the world frame's axes; it is turned so that the floor
// is level, y up.
import { MapPoints } from "./points.js";
import { CameraFigure, Path, keyframeLines } from "./cameras.js";
import { Objects } from "./objects.js";

const FEWEST_POINTS = 60000, MOST_POINTS = 3000000;
const SLOW_MS = 50, FAST_MS = 24;
const SETTLED_MS = 350;  // after the last motion, all points are drawn

export class Scene {
  constructor(element, isShown) {
    this.element = element;
    this.isShown = isShown;
    this.renderer = new THREE.WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setClearColor(0x0e1116);
    element.appendChild(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.eye = new THREE.PerspectiveCamera(55, 1, 0.05, 500);
    this.controls = new THREE.OrbitControls(this.eye, this.renderer.domElement);
    this.controls.screenSpacePanning = true;
    this.controls.addEventListener("change", () => this.changed());
    this.controls.addEventListener("start", () => this.onTouched());
    this.onTouched = () => {};
    this.world = new THREE.Group();
    this.world.matrixAutoUpdate = false;
    this.scene.add(this.world);
    this.points = new MapPoints(this.world);
    this.path = new Path(this.world);
    this.camera = new CameraFigure(this.world);
    this.objects = new Objects(this.world, this.scene);
    this.keyframes = keyframeLines(this.world);
    this.budget = 400000;
    this.setLevel([1, 0, 0, 0, 1, 0, 0, 0, 1]);
    this.lookFrom(new THREE.Vector3(0, 0, 0), new THREE.Vector3(0, 0, -1));
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
    requestAnimationFrame((time) => this.tick(time));
  }

  clear() {
    this.points.clear();
    this.path.clear();
    this.objects.clear();
    this.keyframes.set([]);
    this.placed = false;
    this.changed();
  }

  // The rotation of the level axes (x right, y down, z forward), row by row.
  setLevel(m) {
    this.world.matrix.set(m[0], m[1], m[2], 0, -m[3], -m[4], -m[5], 0,
                          -m[6], -m[7], -m[8], 0, 0, 0, 0, 1);
    this.world.updateMatrixWorld(true);
    this.changed();
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
  place(p) { return new THREE.Vector3(p[0], p[1], p[2]).applyMatrix4(this.world.matrix); }

  // From behind and above a camera of that pose: at once, or some of the way.
  follow(pose) {
    const at = this.place(pose);
    const ahead = new THREE.Vector3(0, 0, 1)
      .applyQuaternion(new THREE.Quaternion(pose[3], pose[4], pose[5], pose[6]))
      .transformDirection(this.world.matrix);
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

  lookFromAbove() {
    const box = new THREE.Box3();
    for (const chunk of this.points.chunks) {
      if (chunk && chunk.size > 500) box.expandByPoint(chunk.middle.clone().applyMatrix4(this.world.matrix));
    }
    if (box.isEmpty()) return;
    box.expandByScalar(1);
    const middle = box.getCenter(new THREE.Vector3()), size = box.getSize(new THREE.Vector3());
    this.controls.target.copy(middle);
    this.eye.position.set(middle.x, box.max.y + Math.max(size.x, size.z), middle.z + 0.01);
    this.controls.update();
  }

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
    const eye = this.eye.position.clone();
    const toWorld = new THREE.Matrix4().getInverse(this.world.matrix);
    this.points.choose(eye.applyMatrix4(toWorld), most);
    this.path.object.visible = this.isShown("path");
    this.keyframes.object.visible = this.isShown("keyframes");
    this.objects.setVisible(this.isShown("objects"));
    this.renderer.render(this.scene, this.eye);
    this.drew = this.dirty;
    this.dirty = false;
  }
}
