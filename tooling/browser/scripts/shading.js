// SPDX-License-Identifier: Apache-2.0
// Eye-dome lighting: a point that lies behind its neighbours on the screen is darkened, which shows the shape of clouds
// that have no shadows.

const VERTEX = "void main() { gl_Position = vec4(position, 1.0); }";
const FRAGMENT = `
  uniform sampler2D colors, depths;
  uniform vec2 size_px, near_far;
  uniform float reach_px;
  float level(vec2 at_px) {
    float z = 2.0 * texture2D(depths, at_px / size_px).r - 1.0;
    return 4.0 * log(2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - z * (near_far.y - near_far.x)));
  }
  void main() {
    vec2 at_px = gl_FragCoord.xy;
    vec4 color = texture2D(colors, at_px / size_px);
    if (color.a == 0.0) discard;
    float here = level(at_px), behind = 0.0;
    for (int k = 0; k < 8; ++k) {
      float angle = 0.785398 * float(k);
      vec2 beside_px = at_px + floor(reach_px * vec2(cos(angle), sin(angle)) + 0.5);
      behind += clamp(here - level(clamp(beside_px, vec2(0.5), size_px - 0.5)), 0.0, 0.5);
    }
    gl_FragColor = vec4(color.rgb * exp(-0.25 * behind), 1.0);
    DEPTH = texture2D(depths, at_px / size_px).r;
  }`;

export class Shading {
  constructor(renderer) {
    this.renderer = renderer;
    const isWebGL2 = renderer.capabilities.isWebGL2;
    this.target = new THREE.WebGLRenderTarget(1, 1, {
      minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter, stencilBuffer: false });
    this.target.depthTexture = new THREE.DepthTexture(1, 1, isWebGL2 ? THREE.FloatType : THREE.UnsignedIntType);
    this.uniforms = {
      colors: { value: this.target.texture }, depths: { value: this.target.depthTexture },
      size_px: { value: new THREE.Vector2() }, near_far: { value: new THREE.Vector2() }, reach_px: { value: 1 } };
    const material = new THREE.ShaderMaterial({
      uniforms: this.uniforms, vertexShader: VERTEX, extensions: { fragDepth: true }, depthFunc: THREE.AlwaysDepth,
      fragmentShader: FRAGMENT.replace("DEPTH", isWebGL2 ? "gl_FragDepth" : "gl_FragDepthEXT") });
    const quad = new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2), material);
    quad.frustumCulled = false;
    this.quad = new THREE.Scene();
    this.quad.add(quad);
  }

  // Draws `points` with this light, and what `figures` has between and over them.
  draw(points, figures, eye) {
    const { renderer, target, uniforms } = this;
    renderer.getDrawingBufferSize(uniforms.size_px.value);
    const { x: width, y: height } = uniforms.size_px.value;
    if (target.width !== width || target.height !== height) target.setSize(width, height);
    uniforms.near_far.value.set(eye.near, eye.far);
    uniforms.reach_px.value = Math.max(1, Math.round(renderer.getPixelRatio()));
    const background = renderer.getClearColor().clone();
    renderer.autoClear = true;
    renderer.setRenderTarget(target);
    renderer.setClearColor(background, 0);
    renderer.render(points, eye);
    renderer.setRenderTarget(null);
    renderer.setClearColor(background, 1);
    renderer.render(this.quad, eye);
    renderer.autoClear = false;
    renderer.render(figures, eye);
  }
}
