// SPDX-License-Identifier: Apache-2.0
// The camera, its path, and key frames. A pose is [x, y, z, qx, qy, qz, qw] in the world frame.

export function poseMatrix(pose) {
  return new THREE.Matrix4().compose(new THREE.Vector3(pose[0], pose[1], pose[2]),
                                     new THREE.Quaternion(pose[3], pose[4], pose[5], pose[6]),
                                     new THREE.Vector3(1, 1, 1));
}

// The corners of the image at a distance, in camera coordinates.
function corners(camera, distance) {
  const x = (u) => (u - camera.cx) / camera.fx * distance;
  const y = (v) => (v - camera.cy) / camera.fy * distance;
  return [[0, 0], [camera.width, 0], [camera.width, camera.height], [0, camera.height]].map(
    ([u, v]) => new THREE.Vector3(x(u), y(v), distance));
}

// The eight edges of a pyramid, as pairs of points.
function pyramidEdges(camera, distance) {
  const at = corners(camera, distance), tip = new THREE.Vector3();
  return at.flatMap((corner, i) => [tip, corner, corner, at[(i + 1) % 4]]);
}

const TYPICAL = { width: 640, height: 480, fx: 525, fy: 525, cx: 320, cy: 240 };

// The camera's pyramid with its image.
export class CameraFigure {
  constructor(group) {
    this.object = new THREE.Group();
    this.object.matrixAutoUpdate = false;
    this.object.visible = false;
    group.add(this.object);
  }

  // `canvas`: what it sees, if that is known.
  setCamera(camera, canvas) {
    this.object.remove(...this.object.children);
    const distance = 0.42;
    const lines = new THREE.BufferGeometry().setFromPoints(pyramidEdges(camera || TYPICAL, distance));
    this.object.add(new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ color: 0xffd166 })));
    if (!camera || !canvas) return;
    const [a, b, c, d] = corners(camera, distance);
    const plane = new THREE.BufferGeometry().setFromPoints([a, b, c, a, c, d]);
    plane.setAttribute("uv", new THREE.Float32BufferAttribute([0, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0], 2));
    this.texture = new THREE.CanvasTexture(canvas);
    this.texture.minFilter = THREE.LinearFilter;
    this.texture.generateMipmaps = false;
    this.object.add(new THREE.Mesh(plane, new THREE.MeshBasicMaterial({
      map: this.texture, side: THREE.DoubleSide, transparent: true, opacity: 0.85 })));
  }

  setPose(pose) {
    this.object.visible = Boolean(pose);
    if (!pose) return;
    this.object.matrix.copy(poseMatrix(pose));
    this.object.matrixWorldNeedsUpdate = true;
  }

  pictureChanged() { if (this.texture) this.texture.needsUpdate = true; }
}

// The path through the frames so far; lost frames leave gaps.
export class Path {
  constructor(group) {
    this.object = new THREE.LineSegments(new THREE.BufferGeometry(),
                                         new THREE.LineBasicMaterial({ color: 0x56b4e9 }));
    this.object.frustumCulled = false;
    group.add(this.object);
    this.clear();
  }

  clear() {
    this.last = null;
    this.segments = 0;
    this.ends = [];  // of segments, by frame
    this.reserve(1024);
  }

  reserve(segments) {
    const positions = new Float32Array(6 * segments);
    if (this.positions && this.segments > 0) positions.set(this.positions);
    this.positions = positions;
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry();
    this.object.geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  }

  add(pose) {
    if (pose && this.last) {
      if (6 * (this.segments + 1) > this.positions.length) this.reserve(2 * this.segments);
      this.positions.set([...this.last.slice(0, 3), ...pose.slice(0, 3)], 6 * this.segments);
      this.object.geometry.attributes.position.needsUpdate = true;
      ++this.segments;
    }
    this.last = pose || null;
    this.ends.push(this.segments);
  }

  // About `count` of its places, in world coordinates.
  sample(count) {
    const every = Math.max(1, Math.floor(this.segments / count)), places = this.last ? [this.last] : [];
    for (let i = 0; i < this.segments; i += every) places.push(this.positions.slice(6 * i, 6 * i + 3));
    return places;
  }

  showUpTo(place) { this.object.geometry.setDrawRange(0, 2 * (this.ends[place] || 0)); }
}

// Small pyramids: { object, set(poses, camera) }.
export function keyframeLines(group) {
  const object = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({
    color: 0x9aa4b1, transparent: true, opacity: 0.55 }));
  object.frustumCulled = false;
  group.add(object);
  const set = (poses, camera) => {
    const edges = pyramidEdges(camera || TYPICAL, 0.09);
    const points = poses.flatMap((pose) => {
      const matrix = poseMatrix(pose);
      return edges.map((p) => p.clone().applyMatrix4(matrix));
    });
    object.geometry.dispose();
    object.geometry = new THREE.BufferGeometry().setFromPoints(points);
  };
  return { object, set };
}
