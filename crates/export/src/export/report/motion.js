// @ts-check
import { floats, unpack } from './data.js';
import { normalised } from './vectors.js';
// Where bodies are at any time: nominally, at samples, and by polynomials anywhere in the box.

/** @typedef {import('./data.js').PackedMotion} PackedMotion */
/** @typedef {{values: number[], bodies: Float32Array, points: Float32Array}} Moving */
/** @typedef {{name: string, time?: number, bodies: Float32Array, points: Float32Array}} Worst */
/** @typedef {{name: string, reaction: boolean, at: number[], force: number[]}} Force */
/** @typedef {{pose: Float64Array, points: Float32Array}} Instant */

export class Movie {
  /** @param {PackedMotion} data */
  constructor(data) {
    this.drawing = data.drawing;
    this.visuals = data.visuals || [];
    this.parameters = data.parameters;
    this.perBody = data.per_body;
    this.between = data.between;
    this.rows = data.rows;
    this.times = floats(data.times);
    this.bodies = floats(data.nominal.bodies);
    this.points = floats(data.nominal.points);
    this.lines = this.bodies.length / this.times.length;
    /** Differences from the nominal motion. @type {Moving[]} */
    this.samples = data.samples.map((sample) => ({ values: sample.values, bodies: unpack(sample.bodies), points: floats(sample.points) }));
    /** Under the worst functions of excitations. @type {Worst[]} */
    this.worst = (data.worst || []).map(({ name, time, bodies, points }) => ({ name, time, bodies: unpack(bodies), points: floats(points) }));
    /** Of the nominal motion: six numbers a time. */
    this.forces = (data.forces || []).map(({ name, reaction, values }) => ({ name, reaction, values: unpack(values) }));
    /** How many times differences from the nominal motion are shown. */
    this.exaggeration = 1;
    const found = data.polynomials;
    const { times, deviations } = (found && found.events) || { times: '', deviations: '' };
    this.polynomials = found && { degrees: found.degrees, error: found.error, bodies: unpack(found.bodies), points: floats(found.points), events: floats(times), eventDeviations: floats(deviations) };
  }

  get duration() {
    return this.times[this.times.length - 1];
  }

  /** The pose before a time, and the share of the way to the next. @param {number} time @returns {[number, number]} */
  frame(time) {
    let [low, high] = [0, this.times.length - 1];
    if (high === 0 || time <= this.times[0]) return [0, 0];
    if (time >= this.times[high]) return [high - 1, 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.times[middle] <= time) low = middle;
      else high = middle;
    }
    return [low, (time - this.times[low]) / (this.times[high] - this.times[low])];
  }

  /** @param {number} time @param {(place: number) => number} difference from the nominal motion */
  interpolated(time, difference) {
    return this.onLines(time, (place) => this.bodies[place] + this.exaggeration * difference(place));
  }

  /** A pose on straight lines between those at the times. @param {number} time @param {(place: number) => number} at */
  onLines(time, at) {
    const [frame, share] = this.frame(time);
    const next = Math.min(frame + 1, this.times.length - 1);
    const pose = new Float64Array(this.lines);
    for (let line = 0; line < this.lines; line++) {
      const value = at(frame * this.lines + line);
      pose[line] = share === 0 ? value : value + share * (at(next * this.lines + line) - value);
    }
    return pose;
  }

  /** The motion of a sample, the nominal one where it has no number. @param {number} time @param {number} [sample] @returns {Instant} */
  at(time, sample) {
    if (sample === undefined) return { pose: this.interpolated(time, () => 0), points: this.points };
    return this.beside(time, this.samples[sample]);
  }

  /** A motion by its differences from the nominal one. @param {number} time @param {{bodies: Float32Array, points: Float32Array}} differences @returns {Instant} */
  beside(time, { bodies, points }) {
    return { pose: this.interpolated(time, (place) => bodies[place]), points: this.points.map((value, place) => value + this.exaggeration * points[place]) };
  }

  /** The forces at a time of the nominal motion. @param {number} time @returns {Force[]} */
  forcesAt(time) {
    const [frame, share] = this.frame(time);
    const next = Math.min(frame + 1, this.times.length - 1);
    return this.forces.map(({ name, reaction, values }) => {
      const six = [0, 1, 2, 3, 4, 5].map((part) => values[6 * frame + part] + share * (values[6 * next + part] - values[6 * frame + part]));
      return { name, reaction, at: six.slice(0, 3), force: six.slice(3) };
    });
  }

  /** A force that few of all times and forces exceed, N: what lasts, not what an impact has for an instant. */
  get usualForce() {
    const sizes = this.forces.flatMap(({ values }) => Array.from(this.times, (_, at) => Math.hypot(values[6 * at + 3], values[6 * at + 4], values[6 * at + 5])));
    sizes.sort((a, b) => a - b);
    return sizes[Math.floor(0.95 * (sizes.length - 1))] || sizes[sizes.length - 1] || 1;
  }

  /** Products of Chebyshev polynomials, term by term. @param {number[]} xi */
  terms(xi) {
    const degrees = this.polynomials ? this.polynomials.degrees : [];
    const made = [];
    for (let term = 0; term < degrees.length; term += xi.length) {
      made.push(xi.reduce((value, x, axis) => value * Math.cos(degrees[term + axis] * Math.acos(Math.max(-1, Math.min(1, x)))), 1));
    }
    return made;
  }

  /** The motion anywhere in the box. @param {number} time @param {number[]} xi in [−1, 1] @returns {Instant} */
  anywhere(time, xi) {
    if (!this.polynomials) return this.at(time);
    const terms = this.terms(xi);
    const sum = (/** @type {Float32Array} */ all) => (/** @type {number} */ place) => {
      let value = 0;
      for (let term = 0; term < terms.length; term++) value += terms[term] * all[place * terms.length + term];
      return value;
    };
    const { events, eventDeviations, bodies, points } = this.polynomials;
    const [point, body, event] = [points, bodies, eventDeviations].map(sum);
    const nominal = this.onLines(time, (place) => this.bodies[place]);
    const own = this.onLines(this.nominalTime(time, Array.from(events, (at, place) => at + event(place))), (place) => this.bodies[place] + body(place));
    return { pose: own.map((value, line) => nominal[line] + this.exaggeration * (value - nominal[line])), points: this.points.map((value, place) => value + this.exaggeration * point(place)) };
  }

  /** The nominal motion's time that belongs to a time of a motion with these events: linear from event to event. @param {number} time @param {number[]} events */
  nominalTime(time, events) {
    const [from, to] = [events, this.polynomials?.events || []].map((times) => [0, ...times, this.duration]);
    let next = 1;
    while (next <= events.length && from[next] <= time) next += 1;
    const share = (time - from[next - 1]) / (from[next] - from[next - 1]) || 0;
    return to[next - 1] + Math.min(1, share) * (to[next] - to[next - 1]);
  }

  /** Where a body is, the ground being 0. @param {Float64Array} pose @param {number} body @returns {{p: number[], q: number[]}} */
  place(pose, body) {
    if (body === 0) return { p: [0, 0, 0], q: [1, 0, 0, 0] };
    const own = pose.subarray((body - 1) * this.perBody, body * this.perBody);
    if (this.perBody === 3) return { p: [own[0], own[1], 0], q: [Math.cos(own[2] / 2), 0, 0, Math.sin(own[2] / 2)] };
    return { p: [own[0], own[1], own[2]], q: normalised([...own.subarray(3)]) };
  }

  /** ξ of a sample's parameters. @param {number[]} values */
  xi(values) {
    return this.parameters.map(({ lower, upper }, axis) => (upper > lower ? (2 * values[axis] - lower - upper) / (upper - lower) : 0));
  }
}
