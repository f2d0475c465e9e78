// SPDX-License-Identifier: Apache-2.0
// The interactive view of the map, in plain WebGL 2. Axes of the data: x right, y DOWN, z forward;
// a camera's axes are the same. The page works without this script: it shows pictures instead.
(() => {
  "use strict";

  const figure = document.getElementById("map-view");
  const holder = document.getElementById("map-data");
  if (!figure || !holder) return;
  const data = JSON.parse(holder.textContent);
  const canvas = figure.querySelector("canvas");
  const gl = canvas.getContext("webgl2", { antialias: false, preserveDrawingBuffer: false });
  if (!gl || data.points === 0) return;
  figure.hidden = false;
  document.getElementById("map-note").hidden = true;

  // --- programs -------------------------------------------------------------------------------
  const POINT_VERTEX = `#version 300 es
    in vec3 code; in vec3 color;
    uniform mat4 clip_from_level; uniform vec3 low, size; uniform float point_px, highest_y;
    out vec3 shade;
    void main() {
      vec3 place = low + code * size;
      gl_Position = clip_from_level * vec4(place, 1.0);
      if (place.y < highest_y) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside: not drawn
      gl_PointSize = clamp(point_px / gl_Position.w, 1.5, 40.0);
      shade = color;
    }`;
  const POINT_FRAGMENT = `#version 300 es
    precision mediump float;
    in vec3 shade; out vec4 result;
    void main() {
      vec2 from_middle = gl_PointCoord - 0.5;
      if (dot(from_middle, from_middle) > 0.25) discard;
      result = vec4(shade, 1.0);
    }`;
  // A line is a strip of two triangles, moved apart on the screen: WebGL draws no thick lines.
  const LINE_VERTEX = `#version 300 es
    in vec3 here, other; in float side;
    uniform mat4 clip_from_level; uniform vec2 canvas_px; uniform float width_px;
    void main() {
      vec4 a = clip_from_level * vec4(here, 1.0);
      vec4 b = clip_from_level * vec4(other, 1.0);
      vec2 along = (b.xy / max(b.w, 1e-3) - a.xy / max(a.w, 1e-3)) * canvas_px;
      vec2 across = length(along) > 0.0 ? normalize(vec2(-along.y, along.x)) : vec2(0.0);
      gl_Position = a;
      gl_Position.xy += side * across * width_px / canvas_px * a.w;
    }`;
  const LINE_FRAGMENT = `#version 300 es
    precision mediump float;
    uniform vec3 color; out vec4 result;
    void main() { result = vec4(color, 1.0); }`;
  // Eye-dome lighting: what lies behind its neighbours on the screen is darkened.
  const SCREEN_VERTEX = `#version 300 es
    void main() {
      vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
      gl_Position = vec4(4.0 * corner - 1.0, 0.0, 1.0);
    }`;
  const SCREEN_FRAGMENT = `#version 300 es
    precision highp float;
    uniform sampler2D colors, depths; uniform vec2 near_far; uniform int reach;
    out vec4 result;
    float level(ivec2 at) {
      float z = 2.0 * texelFetch(depths, clamp(at, ivec2(0), textureSize(depths, 0) - 1), 0).r - 1.0;
      float n = near_far.x, f = near_far.y;
      return 4.0 * log(2.0 * n * f / (f + n - z * (f - n)));
    }
    void main() {
      ivec2 at = ivec2(gl_FragCoord.xy);
      vec4 color = texelFetch(colors, at, 0);
      if (color.a == 0.0) { result = vec4(0.0); return; }
      float here = level(at), behind = 0.0;
      for (int k = 0; k < 8; ++k) {
        float angle = 0.785398 * float(k);
        ivec2 step_px = ivec2(round(float(reach) * vec2(cos(angle), sin(angle))));
        behind += clamp(here - level(at + step_px), 0.0, 0.5);
      }
      result = vec4(color.rgb * exp(-0.25 * behind), 1.0);
    }`;

  function compile(kind, source) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    return shader;
  }

  function program(vertex, fragment) {
    const made = gl.createProgram();
    gl.attachShader(made, compile(gl.VERTEX_SHADER, vertex));
    gl.attachShader(made, compile(gl.FRAGMENT_SHADER, fragment));
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
    return { made, at: (name) => gl.getUniformLocation(made, name) };
  }

  // --- geometry -------------------------------------------------------------------------------
  function bytes(base64) {
    const text = atob(base64);
    const out = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) out[i] = text.charCodeAt(i);
    return out;
  }

  // parts: [{name, values, size, type, normalized}], one buffer each.
  function vertex_array(made, parts) {
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    for (const part of parts) {
      const location = gl.getAttribLocation(made, part.name);
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, part.values, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, part.size, part.type, part.normalized === true, 0, 0);
    }
    return array;
  }

  function strips(made, segments) {  // segments: [[ax, ay, az, bx, by, bz], ...]
    const here = [], other = [], side = [];
    for (const s of segments) {
      const a = s.slice(0, 3), b = s.slice(3, 6);
      for (const [p, q, sign] of [[a, b, 1], [a, b, -1], [b, a, 1], [b, a, 1], [a, b, -1], [b, a, -1]]) {
        // Seen from the other end, left is right: the sign is turned so that corners match.
        here.push(...p); other.push(...q); side.push(p === b ? -sign : sign);
      }
    }
    const floats = (values, size, name) => ({ name, values: new Float32Array(values), size, type: gl.FLOAT });
    return {
      array: vertex_array(made, [floats(here, 3, "here"), floats(other, 3, "other"), floats(side, 1, "side")]),
      count: side.length,
    };
  }

  function path_segments() {
    const out = [];
    for (const path of data.paths) {
      for (let i = 0; i + 5 < path.length; i += 3) out.push(path.slice(i, i + 6));
    }
    return out;
  }

  function frustum_segments() {
    const out = [];
    for (let i = 0; i + 5 < data.frusta.length; i += 6) out.push(data.frusta.slice(i, i + 6));
    return out;
  }

  const draw_points = program(POINT_VERTEX, POINT_FRAGMENT);
  const draw_lines = program(LINE_VERTEX, LINE_FRAGMENT);
  const draw_screen = program(SCREEN_VERTEX, SCREEN_FRAGMENT);
  const cloud = vertex_array(draw_points.made, [
    { name: "code", values: new Uint16Array(bytes(data.positions).buffer), size: 3, type: gl.UNSIGNED_SHORT, normalized: true },
    { name: "color", values: bytes(data.colors), size: 3, type: gl.UNSIGNED_BYTE, normalized: true },
  ]);
  const path = strips(draw_lines.made, path_segments());
  const frusta = strips(draw_lines.made, frustum_segments());

  // --- the picture that is shaded afterwards -----------------------------------------------------
  const target = { frame: gl.createFramebuffer(), color: gl.createTexture(), depth: gl.createTexture() };

  function resize() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    canvas.height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    const kinds = [[target.color, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, gl.COLOR_ATTACHMENT0],
      [target.depth, gl.DEPTH_COMPONENT24, gl.DEPTH_COMPONENT, gl.UNSIGNED_INT, gl.DEPTH_ATTACHMENT]];
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
    for (const [texture, stored, format, type, attachment] of kinds) {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texImage2D(gl.TEXTURE_2D, 0, stored, canvas.width, canvas.height, 0, format, type, null);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, attachment, gl.TEXTURE_2D, texture, 0);
    }
    redraw();
  }

  // --- the eye ---------------------------------------------------------------------------------
  const first = () => ({ ...data.view, target: [...data.view.target] });
  let view = first();
  const shown = { path: true, frusta: true, ceiling: true, size: 1 };

  function axes() {  // right, down, forward of the eye, and its place
    const [cy, sy, cp, sp] = [Math.cos(view.yaw), Math.sin(view.yaw), Math.cos(view.pitch), Math.sin(view.pitch)];
    const forward = [-cp * sy, sp, cp * cy];
    const right = [cy, 0, sy];
    const down = [sp * sy, cp, -sp * cy];
    return { right, down, forward, eye: view.target.map((t, i) => t - view.distance * forward[i]) };
  }

  function clip_from_level(near, far) {
    const { right, down, forward, eye } = axes();
    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    // On a narrow screen the first view's width is kept, not its height.
    const aspect = canvas.width / canvas.height;
    const fy = Math.min(1, aspect / 1.78) / view.tan_half_fov;
    const a = (far + near) / (far - near), b = -2 * far * near / (far - near);
    const rows = [right.map((v) => v * fy / aspect), down.map((v) => -v * fy), forward.map((v) => v * a), forward];
    const offsets = rows.map((row) => -dot(row, eye));
    offsets[2] += b;
    const matrix = new Float32Array(16);
    for (let r = 0; r < 4; ++r) {
      for (let c = 0; c < 3; ++c) matrix[4 * c + r] = rows[r][c];
      matrix[12 + r] = offsets[r];
    }
    return { matrix, fy };
  }

  // --- drawing ---------------------------------------------------------------------------------
  const rgb = { path: [0.88, 0.42, 0.0], frusta: [0.0, 0.45, 0.7] };

  function draw_strips(lines, color, width_px, matrix) {
    gl.useProgram(draw_lines.made);
    gl.uniformMatrix4fv(draw_lines.at("clip_from_level"), false, matrix);
    gl.uniform2f(draw_lines.at("canvas_px"), canvas.width, canvas.height);
    gl.uniform1f(draw_lines.at("width_px"), width_px * canvas.width / Math.max(1, canvas.clientWidth));
    gl.uniform3fv(draw_lines.at("color"), color);
    gl.bindVertexArray(lines.array);
    gl.drawArrays(gl.TRIANGLES, 0, lines.count);
  }

  function draw() {
    const near = Math.max(0.02, view.distance / 200), far = near * 4000;
    const { matrix, fy } = clip_from_level(near, far);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
    gl.clearColor(0, 0, 0, 0);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(draw_points.made);
    gl.uniformMatrix4fv(draw_points.at("clip_from_level"), false, matrix);
    gl.uniform3fv(draw_points.at("low"), data.low);
    gl.uniform3fv(draw_points.at("size"), data.step.map((s) => s * 65535));
    gl.uniform1f(draw_points.at("point_px"), 2.8 * shown.size * data.spacing * fy * canvas.height / 2);
    gl.uniform1f(draw_points.at("highest_y"), shown.ceiling ? -1e9 : data.head_y);
    gl.bindVertexArray(cloud);
    gl.drawArrays(gl.POINTS, 0, data.points);
    if (shown.path) draw_strips(path, rgb.path, 3, matrix);
    if (shown.frusta) draw_strips(frusta, rgb.frusta, 1.5, matrix);

    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.disable(gl.DEPTH_TEST);
    gl.useProgram(draw_screen.made);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, target.color);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, target.depth);
    gl.activeTexture(gl.TEXTURE0);
    gl.uniform1i(draw_screen.at("colors"), 0);
    gl.uniform1i(draw_screen.at("depths"), 1);
    gl.uniform2f(draw_screen.at("near_far"), near, far);
    gl.uniform1i(draw_screen.at("reach"), canvas.width > 1.4 * canvas.clientWidth ? 2 : 1);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  let asked = false;
  function redraw() {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => { asked = false; draw(); });
  }

  // --- hands -----------------------------------------------------------------------------------
  function orbit(dx, dy) {
    view.yaw -= dx * 0.006;
    view.pitch = Math.min(1.57, Math.max(-1.57, view.pitch + dy * 0.006));
    redraw();
  }

  function pan(dx, dy) {
    const { right, down } = axes();
    const metres = 2 * view.distance * view.tan_half_fov / Math.max(1, canvas.clientHeight);
    view.target = view.target.map((t, i) => t - metres * (dx * right[i] + dy * down[i]));
    redraw();
  }

  function zoom(factor) {
    view.distance = Math.min(1000, Math.max(0.05, view.distance * factor));
    redraw();
  }

  const fingers = new Map();
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)) };
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    event.preventDefault();
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const [dx, dy] = [event.clientX - before.x, event.clientY - before.y];
    const old = fingers.size === 2 ? spread() : null;
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (old) {
      const now = spread();
      pan(now.x - old.x, now.y - old.y);
      zoom(old.apart / now.apart);
    } else if (event.shiftKey || event.buttons === 2 || event.buttons === 4) {
      pan(dx, dy);
    } else {
      orbit(dx, dy);
    }
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
  }
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    // The wheel scrolls the page until the view has been clicked.
    if (document.activeElement !== canvas && !event.ctrlKey) return;
    event.preventDefault();
    zoom(Math.exp(Math.max(-60, Math.min(60, event.deltaY * (event.deltaMode === 1 ? 16 : 1))) * 0.002));
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const keys = {
      ArrowLeft: () => orbit(-20, 0), ArrowRight: () => orbit(20, 0), ArrowUp: () => orbit(0, -20),
      ArrowDown: () => orbit(0, 20), "+": () => zoom(0.85), "-": () => zoom(1 / 0.85), 0: () => reset(),
    };
    if (!keys[event.key] || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    keys[event.key]();
  });

  const tool = (name) => figure.querySelector(`[data-tool=${name}]`);
  function show_ceiling(yes) { shown.ceiling = tool("ceiling").checked = yes; redraw(); }
  function reset() { view = first(); show_ceiling(true); }
  function from_above() { view = { ...first(), yaw: 0, pitch: 1.57, distance: 1.15 * data.view.distance }; show_ceiling(false); }
  tool("reset").addEventListener("click", reset);
  tool("above").addEventListener("click", from_above);
  tool("path").addEventListener("change", (event) => { shown.path = event.target.checked; redraw(); });
  tool("frusta").addEventListener("change", (event) => { shown.frusta = event.target.checked; redraw(); });
  tool("ceiling").addEventListener("change", (event) => show_ceiling(event.target.checked));
  tool("size").addEventListener("input", (event) => { shown.size = Math.pow(2, Number(event.target.value)); redraw(); });
  canvas.addEventListener("webglcontextlost", () => {
    figure.hidden = true;
    document.getElementById("map-note").hidden = false;
  });
  new ResizeObserver(resize).observe(canvas);
  resize();
})();
