// SPDX-License-Identifier: Apache-2.0
// The points of the map. Each chunk keeps its points in random order, so that its first ones are an
// even sample: what is far, or too much for this device, is drawn with fewer and larger points.

const NEAR_M = 3;
const LEAST_SHARE = 0.08;
const USUAL_SPACING_M = 0.016; // of the sketch of a map that grows
const SIZE = 2.2;              // of a point, in spacings

// Round points, neither too small to be seen nor so large that they hide others.
function pointMaterial(plane) {
  const material = new THREE.PointsMaterial({ vertexColors: THREE.VertexColors, clippingPlanes: [plane] });
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace("#include <logdepthbuf_vertex>", `
      gl_PointSize = clamp(gl_PointSize, 1.5, 48.0);
      #include <logdepthbuf_vertex>`);
    shader.fragmentShader = shader.fragmentShader.replace("#include <clipping_planes_fragment>", `
      #include <clipping_planes_fragment>
      vec2 fromMiddle = gl_PointCoord - 0.5;
      if (dot(fromMiddle, fromMiddle) > 0.25) discard;`);
  };
  return material;
}

class Chunk {
  constructor(cell, side, plane) {
    this.size = 0;
    this.room = 0;
    this.side = side;
    this.material = pointMaterial(plane);
    this.object = new THREE.Points(new THREE.BufferGeometry(), this.material);
    this.object.position.set(cell[0] * side, cell[1] * side, cell[2] * side);
    this.object.scale.setScalar(side * 65535 / 65536);  // 65535 is 1
    this.middle = this.object.position.clone().addScalar(side / 2);
  }

  makeRoom(size) {
    if (size <= this.room) return;
    this.room = Math.max(size, 2 * this.room, 256);
    const positions = new Uint16Array(3 * this.room), colors = new Uint8Array(3 * this.room);
    if (this.positions) positions.set(this.positions);
    if (this.colors) colors.set(this.colors);
    Object.assign(this, { positions, colors });
    this.object.geometry.dispose();
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3, true));
    geometry.setAttribute("color", new THREE.BufferAttribute(colors, 3, true));
    geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(0.5, 0.5, 0.5), 0.87);
    this.object.geometry = geometry;
  }

  add(positions, colors) {
    const count = colors.length / 3;
    this.makeRoom(this.size + count);
    for (let i = 0; i < count; ++i) {
      // The new point takes the place of a random one, which goes to the end.
      const end = 3 * this.size, place = 3 * Math.floor(Math.random() * (this.size + 1));
      for (let k = 0; k < 3; ++k) {
        this.positions[end + k] = this.positions[place + k];
        this.colors[end + k] = this.colors[place + k];
        this.positions[place + k] = positions[3 * i + k];
        this.colors[place + k] = colors[3 * i + k];
      }
      ++this.size;
    }
    this.object.geometry.attributes.position.needsUpdate = true;
    this.object.geometry.attributes.color.needsUpdate = true;
  }

  sample(count) {
    const corner = this.object.position, step = this.side / 65536;
    return Array.from({ length: count }, (_, i) => [
      corner.x + step * this.positions[3 * i], corner.y + step * this.positions[3 * i + 1],
      corner.z + step * this.positions[3 * i + 2]]);
  }

  draw(count, size_m) {
    this.object.geometry.setDrawRange(0, count);
    this.material.size = size_m * Math.min(3, Math.sqrt(this.size / Math.max(1, count)));
  }
}

export class MapPoints {
  constructor(group) {
    this.group = group;
    this.ceiling = new THREE.Plane(new THREE.Vector3(0, -1, 0), 1e6);
    this.scale = 1;  // of the points, as the reader of the page likes them
    this.setSpacing();
    this.clear();
  }

  clear() {
    for (const chunk of this.chunks || []) {
      if (!chunk) continue;
      this.group.remove(chunk.object);
      chunk.object.geometry.dispose();
      chunk.material.dispose();
    }
    this.chunks = [];
    this.size = 0;
  }

  // The typical distance of neighbouring points.
  setSpacing(spacing_m = USUAL_SPACING_M) { this.spacing_m = spacing_m; }

  // Nothing above that height of the scene is drawn; null: everything is.
  cutAt(height) { this.ceiling.constant = height === null ? 1e6 : height; }

  // `parts` as the message has them: [place, x, y, z, count, offset of positions, of colours].
  add(parts, body, side) {
    for (const [place, x, y, z, count, positionsAt, colorsAt] of parts) {
      if (!this.chunks[place]) {
        this.chunks[place] = new Chunk([x, y, z], side, this.ceiling);
        this.group.add(this.chunks[place].object);
      }
      this.chunks[place].add(new Uint16Array(body, positionsAt, 3 * count),
                             new Uint8Array(body, colorsAt, 3 * count));
      this.size += count;
    }
  }

  // About `count` points of all, in world coordinates.
  sample(count) {
    const share = Math.min(1, count / Math.max(1, this.size));
    return this.chunks.flatMap((chunk) => chunk.sample(Math.floor(chunk.size * share)));
  }

  // Chooses about `most` points for a camera at that place (world coordinates): all, if they are no
  // more, else fewer of what is far.
  choose(eye, most) {
    // three.js takes a size for a field of view of 90 degrees.
    const size_m = 2 * SIZE * this.scale * this.spacing_m;
    if (this.size <= most) {
      for (const chunk of this.chunks) chunk.draw(chunk.size, size_m);
      return;
    }
    const wanted = this.chunks.map((chunk) => {
      const distance = Math.max(NEAR_M, eye.distanceTo(chunk.middle) - chunk.side);
      return chunk.size * Math.max(LEAST_SHARE, (NEAR_M / distance) ** 2);
    });
    const sum = wanted.reduce((a, b) => a + b, 0);
    const share = Math.min(1, most / Math.max(1, sum));
    this.chunks.forEach((chunk, i) => chunk.draw(Math.ceil(wanted[i] * share), size_m));
  }
}
