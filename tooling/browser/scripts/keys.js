// SPDX-License-Identifier: Apache-2.0
// The view turned by the arrow keys, nearer and farther by + and -.

const TURN = 0.1, NEARER = 0.85;

export function addKeys(canvas, controls) {
  controls.enableKeys = false;  // theirs move the view
  const change = (right, up, factor) => {
    const offset = controls.object.position.clone().sub(controls.target);
    const place = new THREE.Spherical().setFromVector3(offset);
    place.theta += right;
    place.phi = Math.min(Math.PI - 0.01, Math.max(0.01, place.phi + up));
    place.radius *= factor;
    controls.object.position.copy(controls.target).add(offset.setFromSpherical(place));
    controls.update();
  };
  const keys = {
    ArrowLeft: [-TURN, 0, 1], ArrowRight: [TURN, 0, 1], ArrowUp: [0, -TURN, 1], ArrowDown: [0, TURN, 1],
    "+": [0, 0, NEARER], "-": [0, 0, 1 / NEARER],
  };
  canvas.addEventListener("keydown", (event) => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    controls.dispatchEvent({ type: "start" });
    change(...keys[event.key]);
  });
}
