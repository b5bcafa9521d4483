// @ts-check
import { Clock } from './clock.js';
import { player } from './controls.js';
import { element } from './data.js';
import { Movie } from './motion.js';
import { latest, post } from './server.js';
import { View } from './view.js';
import { minus, norm, plus, times } from './vectors.js';
// The mechanism: its motion under the clock, that of the sliders' sample, and where a hand has taken it.

/** @typedef {import('./motion.js').Instant} Instant */
/** @typedef {{body: number, point: number, name: string}} Grip */
/** @typedef {{pose: number[], points: number[], at: number[], residual: number, freedom: number}} Held */

/** How near to a point the pointer takes hold of it, px. */
const NEAR = 14;

/** A motion that a hand may interrupt, and that a sample's may stand for. */
class Moved extends Movie {
  /** @param {import('./data.js').PackedMotion} data */
  constructor(data) {
    super(data);
    /** @type {Instant | null} */
    this.held = null;
    /** @type {Movie | null} */
    this.sampled = null;
  }

  /** @param {number} time @param {number} [sample] @returns {Instant} */
  at(time, sample) {
    if (this.held) return this.held;
    return this.sampled ? this.sampled.at(time) : super.at(time, sample);
  }

  /** The nominal motion, which is shown beside a sample's. @param {number} time @returns {Instant} */
  anywhere(time) {
    return super.at(time);
  }
}

export class Stage {
  /** @param {HTMLElement} holder @param {() => number[]} values of the parameters */
  constructor(holder, values) {
    this.holder = holder;
    this.values = values;
    this.number = 0;
    this.clock = new Clock(0);
    /** @type {View | null} */
    this.view = null;
    /** @type {Moved | null} */
    this.movie = null;
    /** @type {{grip: Grip, place: number[], from: number[] | null} | null} */
    this.drag = null;
    this.isDriven = false;
    /** @type {Held | null} */
    this.last = null;
    this.note = element('output', { class: 'hand', 'aria-live': 'polite' });
    this.back = /** @type {HTMLButtonElement} */ (element('button', { type: 'button', hidden: '' }, ['Back to the motion']));
    this.back.addEventListener('click', () => this.release());
    this.pull = latest((/** @type {any} */ question) => post('drag', question), (held, { place }) => this.hold(held, place), (error) => this.tell(error.message));
    this.sample = latest((/** @type {number[]} */ wanted) => post('motion', { number: this.number, values: wanted }), (motion) => this.follow(new Movie(motion)), (error) => this.tell(error.message));
  }

  /** @param {string} text */
  tell(text) {
    this.note.textContent = text;
  }

  /** Shows a mechanism, or why there is none. @param {{number: number, motion?: import('./data.js').PackedMotion, absent?: string}} found @param {Clock} clock */
  show({ number, motion, absent }, clock) {
    const before = this.view;
    this.number = number;
    this.clock = clock;
    this.tell('');
    this.back.hidden = true;
    this.drag = null;
    this.last = null;
    before?.canvas.getContext('webgl2')?.getExtension('WEBGL_lose_context')?.loseContext();
    this.view = null;
    this.movie = motion ? new Moved(motion) : null;
    if (!this.movie) {
      this.holder.replaceChildren(element('p', { class: 'absent' }, [absent || '']));
      return;
    }
    const canvas = /** @type {HTMLCanvasElement} */ (element('canvas', { tabindex: '0', role: 'img', 'aria-label': 'The mechanism. Drag a point to move it, drag elsewhere to turn or move the picture, turn the wheel to come nearer.' }));
    const gl = canvas.getContext('webgl2', { antialias: true, alpha: false, preserveDrawingBuffer: true });
    const picture = element('div', { class: 'picture' });
    const controls = clock.duration > 0 ? [player(clock)] : [];
    const below = element('div', { class: 'row' }, [this.note, this.back]);
    if (!gl) {
      this.holder.replaceChildren(element('p', { class: 'absent' }, ['This browser shows no WebGL: there is no picture of the mechanism.']), ...controls);
      return;
    }
    // Before the view's own, which turn and move the picture.
    for (const [kind, act] of /** @type {[string, (event: PointerEvent) => void][]} */ ([['pointerdown', (event) => this.grasp(event)], ['pointermove', (event) => this.draw(event)], ['pointerup', (event) => this.let(event)], ['pointercancel', (event) => this.let(event)]])) {
      picture.addEventListener(kind, (event) => act(/** @type {PointerEvent} */ (event)), { capture: true });
    }
    this.view = new View(picture, this.movie, clock, gl, canvas);
    if (before && before.movie.drawing.spatial === this.movie.drawing.spatial) {
      const { yaw, pitch, zoom } = before.camera;
      Object.assign(this.view.camera, { yaw, pitch, zoom });
    }
    let time = clock.time;
    clock.listen(() => {
      if (clock.time !== time && this.movie?.held) this.release();
      time = clock.time;
    });
    this.holder.replaceChildren(picture, ...controls, below);
    this.view.changed();
  }

  /** Shows a sample's motion, with the nominal one as a shade; the nominal one alone where there is none. @param {Movie | null} sampled */
  follow(sampled) {
    if (!this.movie || !this.view) return;
    this.movie.sampled = sampled;
    this.movie.held = null;
    this.back.hidden = true;
    this.tell('');
    this.view.set({ xi: sampled ? [] : null });
  }

  release() {
    if (!this.movie) return;
    this.movie.held = null;
    this.last = null;
    this.drag = null;
    this.back.hidden = true;
    this.tell('');
    this.view?.changed();
  }

  /** Where a point of the grip is now. @param {Grip} grip */
  where({ body, point }) {
    const { movie, view } = this;
    if (!movie || !view) return [0, 0, 0];
    const { mechanism } = view;
    return mechanism.where(movie.at(this.clock.time), mechanism.anchorOf(body, point));
  }

  /** The place in the plane through the grip, square to the view, that is under the pointer. @param {Grip} grip @param {PointerEvent} event */
  under(grip, event) {
    const view = /** @type {View} */ (this.view);
    const { canvas, camera } = view;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    const { left, top } = canvas.getBoundingClientRect();
    const [right, up] = camera.axes();
    let place = this.where(grip);
    // Perspective makes it a little more than one step.
    for (let round = 0; round < 3; round++) {
      const [x, y] = camera.pixel(place, width, height);
      const step = (2 * camera.halfHeight(width / height)) / height;
      const [ax] = camera.pixel(plus(place, times(step, right)), width, height);
      const [, by] = camera.pixel(plus(place, times(step, up)), width, height);
      place = plus(place, plus(times((step * (event.clientX - left - x)) / (ax - x || 1), right), times((step * (event.clientY - top - y)) / (by - y || -1), up)));
    }
    return place;
  }

  /** @param {PointerEvent} event */
  grasp(event) {
    const { view, movie } = this;
    if (!view || !movie || event.button !== 0 || event.shiftKey) return;
    const { canvas, camera, mechanism } = view;
    const { left, top } = canvas.getBoundingClientRect();
    const instant = movie.at(this.clock.time);
    const seen = mechanism.named.map(({ name, anchor }) => {
      const [x, y] = camera.pixel(mechanism.where(instant, anchor), canvas.clientWidth, canvas.clientHeight);
      return { grip: { name, body: anchor.body, point: anchor.point - mechanism.first[anchor.body] }, far: Math.hypot(x - event.clientX + left, y - event.clientY + top) };
    });
    const best = seen.reduce((near, one) => (one.far < near.far ? one : near), { grip: { name: '', body: 0, point: 0 }, far: NEAR });
    if (best.grip.body === 0) return;
    event.stopPropagation();
    event.preventDefault();
    canvas.setPointerCapture(event.pointerId);
    view.label.hidden = true;
    this.clock.pause();
    this.isDriven = false;
    this.drag = { grip: best.grip, place: this.where(best.grip), from: this.last ? null : [...instant.pose] };
  }

  /** @param {PointerEvent} event */
  draw(event) {
    const { drag } = this;
    if (!drag) return;
    event.stopPropagation();
    drag.place = this.under(drag.grip, event);
    if (this.isDriven) return this.seek(drag.grip, drag.place);
    const { body, point } = drag.grip;
    this.pull({ number: this.number, values: this.values(), body, point, place: drag.place, from: this.last ? null : drag.from });
  }

  /** @param {PointerEvent} event */
  let(event) {
    if (!this.drag) return;
    event.stopPropagation();
    this.drag = null;
  }

  /** @param {Held} held @param {number[]} wanted */
  hold(held, wanted) {
    const { movie, drag } = this;
    if (!movie) return;
    if (held.freedom === 0) {
      this.isDriven = true;
      this.tell(this.clock.duration > 0 ? 'Every coordinate is driven: dragging goes along the motion' : 'Nothing is free to move');
      return;
    }
    // A search that has not ended goes on while the point is held.
    const before = this.last ? norm(minus(wanted, this.last.at)) : Infinity;
    const far = norm(minus(wanted, held.at));
    if (drag && drag.place === wanted && far > 1e-6 * sizeOf(movie) && far < 0.99 * before) {
      this.pull({ number: this.number, values: this.values(), body: drag.grip.body, point: drag.grip.point, place: wanted, from: null });
    }
    this.last = held;
    movie.held = { pose: Float64Array.from(held.pose), points: Float32Array.from(held.points) };
    this.back.hidden = false;
    const place = held.at.slice(0, movie.drawing.spatial ? 3 : 2).map((x) => x.toFixed(4)).join(', ');
    this.tell(`${drag ? `${drag.grip.name} ` : ''}${place} m, closed to ${held.residual.toExponential(0)}${far > 1e-3 * sizeOf(movie) ? ': as near as it can come' : ''}`);
    this.view?.changed();
  }

  /** Goes to the time at which a driven point is nearest to a place. @param {Grip} grip @param {number[]} place */
  seek(grip, place) {
    const { movie, view } = this;
    if (!movie || !view) return;
    const anchor = view.mechanism.anchorOf(grip.body, grip.point);
    const far = (/** @type {number} */ time) => norm(minus(view.mechanism.where(movie.at(time), anchor), place));
    const now = this.clock.time;
    let [best, least] = [now, far(now)];
    const steps = 400;
    for (let step = 0; step <= steps; step++) {
      const time = (movie.duration * step) / steps;
      // Of several times the nearest to now.
      const cost = far(time) * (1 + (0.2 * Math.abs(time - now)) / movie.duration);
      if (cost < least) [best, least] = [time, cost];
    }
    this.clock.seek(best);
  }
}

/** The size of a mechanism, m. @param {Movie} movie */
function sizeOf(movie) {
  const places = movie.drawing.bodies.flatMap((body) => [body.position, ...body.points.map((point) => point.position)]);
  return Math.max(...places.map((place) => norm(minus(place, places[0]))), 1e-9);
}
