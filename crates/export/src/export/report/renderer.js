// @ts-check
import { ball, box, cone, cylinder } from './solids.js';
// A small renderer on WebGL2: instances of meshes with one light, opaque ones first, then the others from far to near,
// then those on top of
// all; and flat triangles and lines.

/** @typedef {import('./solids.js').Mesh} Mesh */
/** @typedef {{columns: number[][], origin: number[], stretch: number[], color: number[], mesh: string, top?: boolean}} Instance */
/** @typedef {{points: number[], color: number[], lines: boolean}} Flat */

const VERTEX = `#version 300 es
layout(location=0) in vec3 place; layout(location=1) in vec3 normal; layout(location=2) in float end;
layout(location=3) in vec3 c0; layout(location=4) in vec3 c1; layout(location=5) in vec3 c2;
layout(location=6) in vec3 origin; layout(location=7) in vec3 stretch; layout(location=8) in vec4 tint;
uniform mat4 camera; out vec3 n; out vec4 color;
void main() {
  mat3 m = mat3(c0, c1, c2);
  vec3 s = vec3(dot(c0, c0), dot(c1, c1), dot(c2, c2));
  n = m * (normal / max(s, vec3(1e-30)));
  color = tint;
  gl_Position = camera * vec4(m * place + end * stretch + origin, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float; in vec3 n; in vec4 color; uniform vec3 light; uniform vec3 eye; out vec4 shown;
void main() {
  vec3 u = normalize(n); float d = dot(u, light);
  float shade = 0.58 + 0.42 * max(d, 0.0) + 0.10 * min(d, 0.0);
  float gloss = pow(max(dot(u, normalize(light + eye)), 0.0), 40.0) * 0.16;
  float rim = color.a < 1.0 ? mix(1.0, 1.7, pow(1.0 - abs(dot(u, eye)), 2.0)) : 1.0;
  float alpha = min(color.a * rim, 1.0);
  shown = vec4((color.rgb * shade + gloss) * alpha, alpha);
}`;

const FLAT_VERTEX = `#version 300 es
layout(location=0) in vec3 place; uniform mat4 camera; void main() { gl_Position = camera * vec4(place, 1.0); }`;

const FLAT_FRAGMENT = `#version 300 es
precision highp float; uniform vec4 tint; out vec4 shown; void main() { shown = vec4(tint.rgb * tint.a, tint.a); }`;

const NUMBERS = 19;

export class Renderer {
  /** @param {HTMLCanvasElement} canvas @param {WebGL2RenderingContext} gl */
  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    this.solid = this.program(VERTEX, FRAGMENT);
    this.flat = this.program(FLAT_VERTEX, FLAT_FRAGMENT);
    /** @type {Map<string, {array: WebGLVertexArrayObject | null, count: number}>} */
    this.meshes = new Map();
    this.instances = gl.createBuffer();
    this.flatBuffer = gl.createBuffer();
    this.flatArray = gl.createVertexArray();
    gl.bindVertexArray(this.flatArray);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.flatBuffer);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    for (const [name, mesh] of /** @type {[string, Mesh][]} */ ([['box', box()], ['ball', ball(false)], ['capsule', ball(true)], ['cylinder', cylinder()], ['cone', cone()]])) this.add(name, mesh);
  }

  /** @param {string} vertex @param {string} fragment */
  program(vertex, fragment) {
    const gl = this.gl;
    const made = gl.createProgram();
    for (const [kind, text] of /** @type {[number, string][]} */ ([[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]])) {
      const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made) || 'the shaders cannot be linked');
    return made;
  }

  /** @param {string} name @param {Mesh} mesh */
  add(name, mesh) {
    const gl = this.gl;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, mesh.vertices, gl.STATIC_DRAW);
    [[0, 3, 0], [1, 3, 12], [2, 1, 24]].forEach(([place, size, offset]) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 28, offset);
    });
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
    for (let place = 3; place <= 8; place++) {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribDivisor(place, 1);
    }
    this.meshes.set(name, { array, count: mesh.count });
  }

  /** Draws all. @param {Instance[]} instances @param {Flat[]} flats @param {number[]} camera @param {{light: number[], eye: number[], background: number[]}} scene */
  draw(instances, flats, camera, scene) {
    const gl = this.gl;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(scene.background[0], scene.background[1], scene.background[2], 1);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const depth = (/** @type {Instance} */ item) => {
      const at = [0, 1, 2].map((k) => item.origin[k] + item.stretch[k] / 2);
      return (camera[2] * at[0] + camera[6] * at[1] + camera[10] * at[2] + camera[14]) / (camera[3] * at[0] + camera[7] * at[1] + camera[11] * at[2] + camera[15]);
    };
    const byMesh = (/** @type {Instance[]} */ items) => items.sort((a, b) => (a.mesh < b.mesh ? -1 : a.mesh > b.mesh ? 1 : 0));
    const opaque = byMesh(instances.filter((item) => item.color[3] >= 1 && !item.top));
    const clear = instances.filter((item) => item.color[3] < 1).map((item) => ({ item, depth: depth(item) }));
    clear.sort((a, b) => b.depth - a.depth);
    // Regions on the ground plane cover each pixel once: whatever of them comes second is not nearer.
    gl.depthFunc(gl.LESS);
    this.drawFlats(flats.filter((flat) => !flat.lines), camera);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.depthFunc(gl.LEQUAL);
    gl.useProgram(this.solid);
    gl.uniformMatrix4fv(gl.getUniformLocation(this.solid, 'camera'), false, camera);
    gl.uniform3fv(gl.getUniformLocation(this.solid, 'light'), scene.light);
    gl.uniform3fv(gl.getUniformLocation(this.solid, 'eye'), scene.eye);
    this.drawInstances(opaque);
    this.drawFlats(flats.filter((flat) => flat.lines), camera);
    gl.useProgram(this.solid);
    gl.depthMask(false);
    // What is as far as an opaque side is behind it: a ghost that is where its body is does not tint it.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 4);
    this.drawInstances(clear.map(({ item }) => item));
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.depthMask(true);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this.drawInstances(byMesh(instances.filter((item) => item.top)));
  }

  /** Instances in their order, those of one mesh that follow each other together. @param {Instance[]} items */
  drawInstances(items) {
    if (items.length === 0) return;
    const gl = this.gl;
    const numbers = new Float32Array(items.length * NUMBERS);
    items.forEach((item, place) => numbers.set([...item.columns[0], ...item.columns[1], ...item.columns[2], ...item.origin, ...item.stretch, ...item.color], place * NUMBERS));
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.STREAM_DRAW);
    for (let from = 0, to = 0; from < items.length; from = to) {
      while (to < items.length && items[to].mesh === items[from].mesh) to++;
      const mesh = this.meshes.get(items[from].mesh);
      if (!mesh) continue;
      gl.bindVertexArray(mesh.array);
      gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
      for (let place = 0; place < 6; place++) gl.vertexAttribPointer(3 + place, place < 5 ? 3 : 4, gl.FLOAT, false, 4 * NUMBERS, 4 * (from * NUMBERS + 3 * place));
      gl.drawArraysInstanced(gl.TRIANGLES, 0, mesh.count, to - from);
    }
  }

  /** @param {Flat[]} flats @param {number[]} camera */
  drawFlats(flats, camera) {
    const gl = this.gl;
    gl.useProgram(this.flat);
    gl.uniformMatrix4fv(gl.getUniformLocation(this.flat, 'camera'), false, camera);
    gl.bindVertexArray(this.flatArray);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.flatBuffer);
    for (const { points, color, lines } of flats) {
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(points), gl.STREAM_DRAW);
      gl.uniform4fv(gl.getUniformLocation(this.flat, 'tint'), color);
      gl.drawArrays(lines ? gl.LINE_STRIP : gl.TRIANGLES, 0, points.length / 3);
    }
  }
}
