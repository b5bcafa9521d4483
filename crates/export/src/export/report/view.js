// @ts-check
import { Camera } from './camera.js';
import { length } from './controls.js';
import { digits, element } from './data.js';
import { Mechanism } from './mechanism.js';
import { sweptRegion, traces } from './regions.js';
import { Renderer } from './renderer.js';
import { dot, norm, times } from './vectors.js';
// The picture of the mechanism: its contents, and the pointer on it. It is drawn when something has changed.

/** @typedef {import('./motion.js').Movie} Movie */
/** @typedef {import('./clock.js').Clock} Clock */
/** @typedef {{ghosts?: boolean, colorBy?: number, swept?: number, xi?: number[] | null, worst?: number, exaggeration?: number, forces?: boolean, traced?: boolean}} Choices */

/** From the least to the greatest value, apart for the colour-blind too. */
const [LOW, MIDDLE, HIGH] = [[0.05, 0.36, 0.78], [0.72, 0.72, 0.72], [0.88, 0.45, 0]];

/** @param {number} xi in [−1, 1] */
export function scaleColor(xi) {
  const [from, to, share] = xi < 0 ? [LOW, MIDDLE, xi + 1] : [MIDDLE, HIGH, xi];
  return from.map((part, place) => part + share * (to[place] - part));
}

export class View {
  /** @param {HTMLElement} holder @param {Movie} movie @param {Clock} clock @param {WebGL2RenderingContext} gl @param {HTMLCanvasElement} canvas */
  constructor(holder, movie, clock, gl, canvas) {
    this.movie = movie;
    this.clock = clock;
    this.canvas = canvas;
    this.mechanism = new Mechanism(movie);
    this.camera = new Camera(movie.drawing.spatial, this.mechanism.extent);
    this.renderer = new Renderer(canvas, gl);
    this.mechanism.meshes().forEach(([name, mesh]) => this.renderer.add(name, mesh));
    this.ghosts = movie.samples.length > 0;
    this.colorBy = 0;
    this.swept = -1;
    /** @type {number[] | null} */
    this.xi = null;
    this.worst = -1;
    /** @type {import('./renderer.js').Flat[]} */
    this.region = [];
    this.forces = false;
    this.traced = false;
    /** @type {import('./renderer.js').Flat[]} */
    this.traces = [];
    /** @type {{name: string, place: number[], size: number}[]} */
    this.tips = [];
    this.isWaiting = false;
    this.drawings = 0;
    this.label = element('div', { class: 'tip', hidden: '' });
    this.bar = element('div', { class: 'bar' });
    this.exaggerated = element('div', { class: 'exaggerated' });
    this.forceBar = element('div', { class: 'bar force', hidden: '' });
    this.gravity = element('div', { class: 'gravity', hidden: '', title: `gravity, ${digits(norm(movie.drawing.gravity || [0, 0, 0]))} m/s²` }, [element('i'), 'g']);
    holder.append(canvas, this.label, this.bar, this.forceBar, this.gravity, this.exaggerated);
    this.dark = matchMedia('(prefers-color-scheme: dark)');
    this.dark.addEventListener('change', () => this.set({ traced: this.traced }));
    new ResizeObserver(() => this.changed()).observe(canvas);
    clock.listen(() => this.changed());
    this.listen();
  }

  /** @param {Choices} choices */
  set(choices) {
    const { exaggeration, ...own } = choices;
    Object.assign(this, own);
    if (exaggeration) this.movie.exaggeration = exaggeration;
    if (exaggeration || choices.swept !== undefined) {
      const chosen = this.mechanism.named[this.swept];
      this.region = chosen ? sweptRegion(this.mechanism, chosen.anchor, [0.8, 0.35, 0.6]) : [];
    }
    if (choices.traced !== undefined) this.traces = this.traced ? traces(this.mechanism, this.dark.matches) : [];
    this.changed();
  }

  resetCamera() {
    this.camera.reset();
    this.changed();
  }

  changed() {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      this.draw();
    });
  }

  draw() {
    const { canvas, movie, mechanism, clock } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (width === 0 || height === 0) return;
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const size = [Math.round(width * ratio), Math.round(height * ratio)];
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
    const dark = this.dark.matches;
    const look = { color: null, alpha: 1, shift: 0, symbols: true, forces: this.forces };
    const items = mechanism.solids(movie.at(clock.time), look, dark);
    if (this.ghosts) {
      movie.samples.forEach(({ values }, sample) => {
        const color = scaleColor(movie.xi(values)[this.colorBy]);
        items.push(...mechanism.solids(movie.at(clock.time, sample), { color, alpha: 0.16, shift: 40 + sample, symbols: false }, dark));
      });
    }
    if (this.xi) {
      const color = dark ? [1, 0.85, 1] : [0.42, 0.12, 0.5];
      items.push(...mechanism.solids(movie.anywhere(clock.time, this.xi), { color, alpha: 0.38, shift: -20, symbols: false }, dark));
    }
    const worst = movie.worst[this.worst];
    if (worst) {
      const color = dark ? [1, 0.45, 0.4] : [0.72, 0.1, 0.08];
      items.push(...mechanism.solids(movie.beside(clock.time, worst), { color, alpha: 0.5, shift: -30, symbols: false }, dark));
    }
    this.tips = [];
    if (this.forces) {
      const { made, tips } = mechanism.arrows(clock.time, dark);
      items.push(...made);
      this.tips = tips;
    }
    const flats = [...this.region, ...this.traces];
    const background = dark ? [0.071, 0.078, 0.09] : [0.975, 0.98, 0.985];
    const [, , eye] = this.camera.axes();
    this.renderer.draw(items, flats, this.camera.matrix(width / height), { light: this.camera.light(), eye, background });
    this.drawings++;
    this.scaleBars(width, height);
    this.pull();
  }

  /** A round length and a round force, where all of one depth have one scale. @param {number} width @param {number} height */
  scaleBars(width, height) {
    const metres = (2 * this.camera.halfHeight(width / height)) / height;
    const round = (/** @type {number} */ wanted) => {
      const power = 10 ** Math.floor(Math.log10(wanted));
      return ([5, 2].find((nice) => nice * power <= wanted) || 1) * power;
    };
    const long = round(metres * 110);
    this.bar.style.width = `${long / metres}px`;
    this.bar.textContent = length(long);
    this.forceBar.hidden = !this.forces;
    const newtons = metres / this.mechanism.perNewton;
    const force = round(newtons * 110);
    this.forceBar.style.width = `${force / newtons}px`;
    this.forceBar.textContent = force < 1e4 ? `${digits(force)} N` : `${digits(force / 1e3)} kN`;
    this.exaggerated.textContent = this.movie.exaggeration > 1 ? `deviations shown × ${this.movie.exaggeration}` : '';
  }

  /** Gravity's direction, as it is seen. */
  pull() {
    const { gravity } = this.movie.drawing;
    const [right, up] = this.camera.axes();
    const [x, y] = gravity ? [dot(gravity, right), dot(gravity, up)] : [0, 0];
    const seen = gravity ? Math.hypot(x, y) / (norm(gravity) || 1) : 0;
    this.gravity.hidden = seen < 0.05;
    const arrow = /** @type {HTMLElement} */ (this.gravity.firstChild);
    arrow.style.transform = `rotate(${Math.atan2(-x, -y)}rad) scaleY(${seen})`;
  }

  listen() {
    const { canvas, camera } = this;
    /** @type {Map<number, PointerEvent>} */
    const down = new Map();
    canvas.addEventListener('pointerdown', (event) => {
      down.set(event.pointerId, event);
      canvas.setPointerCapture(event.pointerId);
    });
    const up = (/** @type {PointerEvent} */ event) => down.delete(event.pointerId);
    canvas.addEventListener('pointerup', up);
    canvas.addEventListener('pointercancel', up);
    canvas.addEventListener('pointermove', (event) => {
      const before = down.get(event.pointerId);
      if (!before) return this.point(event);
      const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
      if (down.size === 2) {
        const other = [...down.values()].find((one) => one.pointerId !== event.pointerId);
        const apart = (/** @type {PointerEvent} */ one) => Math.hypot(one.clientX - (other?.clientX || 0), one.clientY - (other?.clientY || 0));
        camera.approach(apart(event) / Math.max(apart(before), 1), 0, 0, canvas.clientHeight, canvas.clientWidth);
      } else if (this.movie.drawing.spatial && !event.shiftKey && event.buttons === 1) camera.orbit(dx, dy);
      else camera.pan(dx, dy, canvas.clientWidth, canvas.clientHeight);
      down.set(event.pointerId, event);
      this.changed();
    });
    canvas.addEventListener('pointerleave', () => (this.label.hidden = true));
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      const [width, height] = [canvas.clientWidth, canvas.clientHeight];
      camera.approach(Math.exp(-0.0015 * event.deltaY), event.offsetX - width / 2, height / 2 - event.offsetY, height, width);
      this.changed();
    }, { passive: false });
    canvas.addEventListener('dblclick', () => this.resetCamera());
    canvas.addEventListener('keydown', (event) => {
      const step = { ArrowLeft: [40, 0], ArrowRight: [-40, 0], ArrowUp: [0, 40], ArrowDown: [0, -40] }[event.key];
      if (step && this.movie.drawing.spatial && !event.shiftKey) camera.orbit(step[0] / 2, step[1] / 2);
      else if (step) camera.pan(step[0], step[1], canvas.clientWidth, canvas.clientHeight);
      else if (event.key === '+' || event.key === '-') camera.approach(event.key === '+' ? 1.2 : 1 / 1.2, 0, 0, canvas.clientHeight, canvas.clientWidth);
      else return;
      event.preventDefault();
      event.stopPropagation();
      this.changed();
    });
  }

  /** Names the point under the pointer, and says where it is. @param {PointerEvent} event */
  point(event) {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    const instant = this.movie.at(this.clock.time);
    const { spatial } = this.movie.drawing;
    const place = (/** @type {number[]} */ at) => `${at.slice(0, spatial ? 3 : 2).map((x) => (Math.abs(x) < 1e-9 * norm(at) ? 0 : x).toFixed(4)).join(', ')} m`;
    const points = this.mechanism.named.map(({ name, anchor }) => {
      const at = this.mechanism.where(instant, anchor);
      return { name, at, text: place(at) };
    });
    const forces = this.tips.map(({ name, place: at, size }) => ({ name, at, text: `${digits(size)} N` }));
    const seen = [...points, ...forces].map(({ name, at, text }) => {
      const [x, y] = this.camera.pixel(at, width, height);
      return { name, text, x, y, far: Math.hypot(x - event.offsetX, y - event.offsetY) };
    });
    const near = seen.reduce((best, one) => (one.far < best.far ? one : best), { name: '', text: '', x: 0, y: 0, far: 14 });
    this.label.hidden = near.name === '';
    if (near.name === '') return;
    this.label.replaceChildren(element('b', {}, [near.name]), ` ${near.text}`);
    const [left, top] = times(1, [Math.min(near.x + 12, width - 180), Math.max(near.y - 34, 4), 0]);
    this.label.style.transform = `translate(${left}px, ${top}px)`;
  }
}
