// @ts-check
import { alongAxis } from './camera.js';
import { floats } from './data.js';
import { triangles } from './solids.js';
import { across, cross, dot, inverse, minus, norm, plus, product, times, turned, unit } from './vectors.js';
// A mechanism at an instant as solids: bodies as bars through their points, joints and effects by their symbols.

/** @typedef {import('./motion.js').Movie} Movie */
/** @typedef {import('./motion.js').Instant} Instant */
/** @typedef {import('./renderer.js').Instance} Instance */
/** @typedef {{body: number, local: number[], point: number}} Anchor */
/** @typedef {{color: number[] | null, alpha: number, shift: number, symbols: boolean, forces?: boolean}} Look */

/** Colours that remain apart for the colour-blind (Okabe and Ito, 2008). */
const COLORS = ['0072b2', 'e69f00', '009e73', 'd55e00', 'cc79a7', '56b4e9'].map((text) => [0, 2, 4].map((at) => parseInt(text.slice(at, at + 2), 16) / 255));

/** @param {number} body @param {boolean} dark */
export const colorOf = (body, dark) => COLORS[(body - 1 + COLORS.length) % COLORS.length].map((part) => (dark ? 0.85 * part + 0.15 : part));

/** Meshes of the renderer that have other names. @type {Record<string, string>} */
const MESHES = { sphere: 'ball', plane: 'box' };

export class Mechanism {
  /** @param {Movie} movie */
  constructor(movie) {
    this.movie = movie;
    const { bodies, elements } = movie.drawing;
    const start = movie.at(0);
    /** First number of each body's points. */
    this.first = [0];
    bodies.forEach((body) => this.first.push(this.first[this.first.length - 1] + body.points.length + (body.center_of_mass ? 1 : 0)));
    /** Points that can be chosen. @type {{name: string, anchor: Anchor}[]} */
    this.named = bodies.flatMap((body, number) => body.points.filter((point) => point.name && number > 0).map((point) => ({ name: `${body.name}.${point.name}`, anchor: this.anchorOf(number, body.points.indexOf(point)) })));
    bodies.forEach((body, number) => number > 0 && body.center_of_mass && this.named.push({ name: `${body.name}, centre of mass`, anchor: this.anchorOf(number, body.points.length) }));
    this.elements = elements.filter((one) => one.glyph !== 'nothing').map((one) => ({
      ...one,
      anchors: one.ends.map((end, place) => this.anchor(start, one.bodies[place], end)),
      // The axis turns with the first body.
      local: one.axis ? turned(inverse(movie.place(start.pose, one.bodies[0] || 0).q), one.axis) : null,
    }));
    this.visuals = movie.visuals.map((visual, number) => ({ ...visual, mesh: visual.vertices ? `mesh${number}` : MESHES[visual.shape] || visual.shape }));
    /** Bodies that are seen without bars: a surface alone is all that one with a single place has. */
    this.shown = new Set(this.visuals.filter(({ body, surface }) => !surface || bodies[body].points.length < 2).map(({ body }) => body));
    this.extent = this.measure();
    const size = norm(minus(this.extent[1], this.extent[0])) || 1;
    /** Half the thickness of bars, m. */
    this.thickness = 0.011 * size;
    /** Length of an arrow, m/N. */
    this.perNewton = (18 * this.thickness) / movie.usualForce;
  }

  /** Meshes of the model's own. */
  meshes() {
    return this.visuals.filter((visual) => visual.vertices).map((visual) => /** @type {const} */ ([visual.mesh, triangles(floats(visual.vertices || ''))]));
  }

  /** @param {number} body @param {number} point @returns {Anchor} */
  anchorOf(body, point) {
    return { body, local: [0, 0, 0], point: this.first[body] + point };
  }

  /** A place as a point of a body, by its number where it is one of those that are known. @param {Instant} instant @param {number} body @param {number[]} place @returns {Anchor} */
  anchor(instant, body, place) {
    const { p, q } = this.movie.place(instant.pose, body);
    const local = turned(inverse(q), minus(place, p));
    const near = 1e-6 * (1e-6 + norm(local));
    for (let point = this.first[body]; point < this.first[body + 1]; point++) {
      const known = [...instant.points.subarray(3 * point, 3 * point + 3)];
      if (norm(minus(known, local)) <= near) return { body, local, point };
    }
    return { body, local, point: -1 };
  }

  /** @param {Instant} instant @param {Anchor} anchor */
  where(instant, anchor) {
    const { p, q } = this.movie.place(instant.pose, anchor.body);
    const local = anchor.point < 0 ? anchor.local : [...instant.points.subarray(3 * anchor.point, 3 * anchor.point + 3)];
    return plus(p, turned(q, local));
  }

  /** Points of a body that its bars go through. @param {Instant} instant @param {number} body */
  joints(instant, body) {
    const { points, center_of_mass } = this.movie.drawing.bodies[body];
    const places = points.map((_, point) => this.where(instant, this.anchorOf(body, point)));
    if (center_of_mass && (places.length < 2 || this.movie.drawing.spatial)) places.push(this.where(instant, this.anchorOf(body, points.length)));
    return places.length ? places : [this.movie.place(instant.pose, body).p];
  }

  /** The box that all samples stay in. */
  measure() {
    const { movie } = this;
    const [least, greatest] = [[1e300, 1e300, 1e300], [-1e300, -1e300, -1e300]];
    const include = (/** @type {number[]} */ place) => place.forEach((x, axis) => {
      least[axis] = Math.min(least[axis], x);
      greatest[axis] = Math.max(greatest[axis], x);
    });
    for (let step = 0; step <= 60; step++) {
      const instant = movie.at((movie.duration * step) / 60);
      movie.drawing.bodies.forEach((_, body) => (body > 0 || this.first[1] > 0) && this.joints(instant, body).forEach(include));
      this.visuals.forEach((visual) => this.corners(instant, visual).forEach(include));
    }
    this.elements.forEach((one) => one.ends.forEach(include));
    const margin = 0.06 * Math.max(...greatest.map((x, axis) => x - least[axis]), 1e-6);
    return [least.map((x) => x - margin), greatest.map((x) => x + margin)];
  }

  /** Corners of the box that holds a visual. @param {Instant} instant @param {import('./data.js').Visual} visual */
  corners(instant, { body, position, orientation, within }) {
    const { p, q } = this.movie.place(instant.pose, body);
    const corner = (/** @type {number} */ number) => [0, 1, 2].map((axis) => within[(number >> axis) & 1][axis]);
    return [0, 1, 2, 3, 4, 5, 6, 7].map((number) => plus(p, turned(q, plus(position, turned(orientation, corner(number))))));
  }

  /** All solids of an instant. @param {Instant} instant @param {Look} look @param {boolean} dark @returns {Instance[]} */
  solids(instant, look, dark) {
    /** @type {Instance[]} */
    const made = [];
    const neutral = dark ? [0.78, 0.8, 0.84] : [0.25, 0.27, 0.3];
    const { bodies } = this.movie.drawing;
    for (let body = 1; body < bodies.length; body++) {
      if (this.shown.has(body)) continue;
      this.body(made, instant, body, [...(look.color || colorOf(body, dark)), look.alpha], look.shift);
    }
    // Bodies that do not move have no ghosts, and planes without an end neither.
    for (const visual of this.visuals) if (look.symbols || (visual.body > 0 && visual.shape !== 'plane')) this.visual(made, instant, visual, look, dark);
    if (!look.symbols) return made;
    const first = made.length;
    // A force has its arrow, or its symbol.
    this.elements.forEach((one) => (look.forces && one.glyph === 'force') || this.symbol(made, instant, one, [...neutral, 1], look.shift));
    // In the plane shapes are as thick as they are, and symbols before them.
    if (!this.movie.drawing.spatial) made.slice(first).forEach((item) => (item.top = true));
    return made;
  }

  /** Forces as arrows, and their tips. @param {number} time @param {boolean} dark @returns {{made: Instance[], tips: {name: string, place: number[], size: number}[]}} */
  arrows(time, dark) {
    /** @type {Instance[]} */
    const made = [];
    const r = this.thickness;
    const tips = this.movie.forcesAt(time).flatMap(({ name, reaction, at, force }) => {
      const size = norm(force);
      const long = Math.min(size * this.perNewton, 40 * r);
      if (long < 0.3 * r) return [];
      const color = [...(reaction ? (dark ? [1, 0.44, 0.71] : [0.75, 0, 0.36]) : dark ? [1, 0.75, 0.2] : [0.85, 0.45, 0]), 1];
      const along = unit(force);
      const head = Math.min(3.2 * r, 0.5 * long);
      const [first, second] = across(along);
      const foot = this.movie.drawing.spatial ? at : plus(at, [0, 0, 4 * r + 0.35 * r * this.movie.drawing.bodies.length]);
      const neck = plus(foot, times(long - head, along));
      made.push({ mesh: 'cylinder', columns: alongAxis(along, 0.32 * r), origin: foot, stretch: times(long - head, along), color, top: true });
      made.push({ mesh: 'cone', columns: [times(0.36 * head, first), times(0.36 * head, second), times(head, along)], origin: neck, stretch: [0, 0, 0], color, top: true });
      return [{ name, place: plus(foot, times(long, along)), size }];
    });
    return { made, tips };
  }

  /** @param {Instance[]} made @param {Instant} instant @param {number} body @param {number[]} color @param {number} shift */
  body(made, instant, body, color, shift) {
    const r = this.thickness;
    // In the plane, bodies lie one above the other.
    const lift = this.movie.drawing.spatial ? [0, 0, 0] : [0, 0, (body * 0.35 - shift) * r];
    const places = this.joints(instant, body).map((place) => plus(place, lift));
    const guide = this.movie.drawing.bodies[body].guide;
    if (guide || places.length === 1) {
      const { q } = this.movie.place(instant.pose, body);
      const middle = times(1 / places.length, places.reduce(plus));
      const along = guide ? unit(guide) : turned(q, [1, 0, 0]);
      if (guide || this.movie.drawing.spatial) made.push({ mesh: 'box', columns: this.block(along, r), origin: middle, stretch: [0, 0, 0], color });
      else made.push({ mesh: 'ball', columns: alongAxis([0, 0, 1], 2 * r), origin: middle, stretch: [0, 0, 0], color });
      if (places.length > 1) places.forEach((place) => this.bar(made, middle, place, 0.7 * r, color));
      return;
    }
    if (places.length === 2) return this.bar(made, places[0], places[1], r, color);
    if (!this.movie.drawing.spatial) {
      const corners = hull(places);
      corners.forEach((corner, place) => (corners.length > 2 || place === 0) && this.bar(made, corner, corners[(place + 1) % corners.length], r, color));
      places.filter((place) => !corners.includes(place)).forEach((place) => this.bar(made, place, nearest(place, corners), 0.8 * r, color));
      return;
    }
    const middle = times(1 / places.length, places.reduce(plus));
    places.forEach((place) => this.bar(made, middle, place, r, color));
  }

  /** @param {number[]} along @param {number} r */
  block(along, r) {
    const [first, second] = across(along);
    return [times(6 * r, along), times(3.6 * r, first), times(3.6 * r, second)];
  }

  /** @param {Instance[]} made @param {number[]} from @param {number[]} to @param {number} r @param {number[]} color */
  bar(made, from, to, r, color) {
    made.push({ mesh: 'capsule', columns: alongAxis(unit(minus(to, from)), r), origin: from, stretch: minus(to, from), color });
  }

  /** @param {Instance[]} made @param {Instant} instant @param {import('./data.js').Visual & {mesh: string}} visual @param {Look} look @param {boolean} dark */
  visual(made, instant, visual, look, dark) {
    const { p, q } = this.movie.place(instant.pose, visual.body);
    const turn = product(q, visual.orientation);
    const origin = plus(p, turned(q, visual.position));
    const [x, y, z] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => turned(turn, axis));
    const neutral = dark ? [0.42, 0.44, 0.48] : [0.72, 0.73, 0.75];
    const color = [...(look.color || visual.color || (visual.body > 0 ? colorOf(visual.body, dark) : neutral)).slice(0, 3), look.alpha];
    const { shape, size } = visual;
    const put = (/** @type {number[]} */ scale, /** @type {number[]} */ at = origin, /** @type {number[]} */ stretch = [0, 0, 0]) =>
      made.push({ mesh: visual.mesh, columns: [times(scale[0], x), times(scale[1], y), times(scale[2], z)], origin: at, stretch, color });
    if (shape === 'plane') {
      const [wide, thick] = [22 * this.thickness, 0.6 * this.thickness];
      put([wide, wide, thick], minus(origin, times(0.5 * thick, z)));
    } else if (shape === 'cylinder' || shape === 'capsule') {
      // A line has no radius of its own.
      const radius = size[0] || 0.3 * this.thickness;
      put([radius, radius, radius], minus(origin, times(0.5 * size[1], z)), times(size[1], z));
    } else put(shape === 'sphere' ? [size[0], size[0], size[0]] : size);
  }

  /** @param {Instance[]} made @param {Instant} instant @param {Mechanism['elements'][number]} one @param {number[]} color @param {number} shift */
  symbol(made, instant, one, color, shift) {
    const r = this.thickness;
    const lift = this.movie.drawing.spatial ? [0, 0, 0] : [0, 0, (this.movie.drawing.bodies.length * 0.35 + 1 - shift) * r];
    const ends = one.anchors.map((anchor) => plus(this.where(instant, anchor), lift));
    if (ends.length === 0) return;
    const axis = one.local ? turned(this.movie.place(instant.pose, one.bodies[0] || 0).q, one.local) : [0, 0, 1];
    const grounded = one.anchors.findIndex((anchor) => anchor.body === 0);
    const pin = (/** @type {number[]} */ at, /** @type {number} */ size) => made.push({ mesh: 'cylinder', columns: alongAxis(unit(axis), size * r), origin: minus(at, times(1.3 * r, unit(axis))), stretch: times(2.6 * r, unit(axis)), color });
    const spring = { spring: 5, cable: 0, belt: 0, rod: 0, beam: 0 }[one.glyph];
    if (spring !== undefined && ends.length > 1) {
      for (let place = 0; place + 1 < ends.length; place++) this.coil(made, ends[place], ends[place + 1], spring, color, one.glyph === 'beam' ? 0.8 : 0.3);
    } else if (one.glyph === 'ball' || one.glyph === 'universal') {
      made.push({ mesh: 'ball', columns: alongAxis([0, 0, 1], 1.5 * r), origin: ends[0], stretch: [0, 0, 0], color });
    } else if (one.glyph === 'slider' || one.glyph === 'cylinder' || one.glyph === 'screw') {
      const at = ends[grounded < 0 ? 0 : grounded];
      const reach = Math.max(8 * r, 1.1 * norm(minus(ends[ends.length - 1], ends[0])));
      this.bar(made, minus(at, times(reach, unit(axis))), plus(at, times(reach, unit(axis))), 0.35 * r, color);
    } else if (one.glyph === 'slot') {
      const [at, reach] = [ends[ends.length - 1], 6 * r];
      const side = times(1.1 * r, this.movie.drawing.spatial ? across(unit(axis))[0] : unit(cross(axis, [0, 0, 1])));
      for (const rail of [plus(at, side), minus(at, side)]) this.bar(made, minus(rail, times(reach, unit(axis))), plus(rail, times(reach, unit(axis))), 0.3 * r, color);
      made.push({ mesh: 'ball', columns: alongAxis([0, 0, 1], 0.7 * r), origin: at, stretch: [0, 0, 0], color });
    } else if (one.glyph === 'force') {
      this.arrow(made, ends[0], minus(ends[0], times(12 * r, unit(axis))), color);
    } else if (['pin', 'motor', 'torque', 'gear', 'weld', 'torsion_spring', 'plane'].includes(one.glyph)) {
      pin(ends[0], one.glyph === 'motor' || one.glyph === 'gear' ? 1.1 : 0.7);
    }
    if (grounded >= 0 && ['pin', 'ball', 'weld', 'motor', 'universal'].includes(one.glyph)) {
      const base = this.movie.drawing.spatial ? [[1, 0, 0], [0, 1, 0], [0, 0, 1]] : [[1, 0, 0], [0, 1, 0], [0, 0, 0.3]];
      const at = minus(ends[grounded], this.movie.drawing.spatial ? [0, 0, 0] : [0, 2.1 * r, 1.5 * r + lift[2]]);
      const scale = this.movie.drawing.spatial ? [2.6, 2.6, 2.6] : [6, 1.6, 1];
      made.push({ mesh: 'box', columns: base.map((column, place) => times(scale[place] * r, column)), origin: at, stretch: [0, 0, 0], color: [...color.slice(0, 3).map((part) => 0.55 * part + 0.25), 1] });
    }
  }

  /** A straight line, or a zigzag of so many turns. @param {Instance[]} made @param {number[]} from @param {number[]} to @param {number} turns @param {number[]} color @param {number} thick */
  coil(made, from, to, turns, color, thick) {
    const r = this.thickness;
    const along = minus(to, from);
    let [side] = across(unit(along));
    if (!this.movie.drawing.spatial) side = unit(cross(along, [0, 0, 1]));
    let last = from;
    for (let place = 1; place <= 2 * turns; place++) {
      const next = plus(plus(from, times((place - 0.5 + 0.25) / (2 * turns + 0.5), along)), times((place % 2 ? 2 : -2) * r, side));
      this.bar(made, last, next, thick * r, color);
      last = next;
    }
    this.bar(made, last, to, thick * r, color);
  }

  /** @param {Instance[]} made @param {number[]} tip @param {number[]} from @param {number[]} color */
  arrow(made, tip, from, color) {
    const along = unit(minus(tip, from));
    const [side] = this.movie.drawing.spatial ? across(along) : [cross(along, [0, 0, 1])];
    const r = this.thickness;
    this.bar(made, from, tip, 0.35 * r, color);
    for (const sign of [-1, 1]) this.bar(made, tip, plus(minus(tip, times(3 * r, along)), times(1.6 * sign * r, side)), 0.35 * r, color);
  }
}

/** Corners of the convex hull in the plane, in order. @param {number[][]} places */
export function hull(places) {
  const sorted = [...places].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const chain = (/** @type {number[][]} */ all) => {
    /** @type {number[][]} */
    const kept = [];
    for (const place of all) {
      while (kept.length > 1) {
        const [a, b] = kept.slice(-2);
        if ((b[0] - a[0]) * (place[1] - a[1]) - (b[1] - a[1]) * (place[0] - a[0]) > 0) break;
        kept.pop();
      }
      kept.push(place);
    }
    return kept.slice(0, -1);
  };
  return sorted.length < 3 ? sorted : [...chain(sorted), ...chain([...sorted].reverse())];
}

/** The nearest place on the sides of a polygon. @param {number[]} place @param {number[][]} corners */
function nearest(place, corners) {
  let best = corners[0];
  corners.forEach((from, number) => {
    const along = minus(corners[(number + 1) % corners.length], from);
    const share = Math.max(0, Math.min(1, dot(minus(place, from), along) / (dot(along, along) || 1)));
    const at = plus(from, times(share, along));
    if (norm(minus(at, place)) < norm(minus(best, place))) best = at;
  });
  return best;
}
