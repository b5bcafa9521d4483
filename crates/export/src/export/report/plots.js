// @ts-check
import { Clock } from './clock.js';
import { digits, element } from './data.js';
// The figures of a run, brought to life by the scales and the data that they carry: a cursor at the time, values under
// the pointer, zoom in time, series on and off. Figures over something else than the time, as frequencies, have a
// cursor of their own.

/** @typedef {{min: number, max: number, from_px: number, to_px: number}} Scale */
/** @typedef {{id: string, group?: string, label: string, kind: string, panel: string, time?: number[], lower: (number | null)[], upper: (number | null)[]}} Series */
/** @typedef {{output: string, unit: string, across?: {name: string, unit: string}, time: number[], panels: {id: string, unit?: string, x: Scale, y: Scale}[], series: Series[]}} FigureData */

const SVG = 'http://www.w3.org/2000/svg';

/** The part of the run that all plots show. */
export class Window {
  /** @param {number} first @param {number} last */
  constructor(first, last) {
    this.first = first;
    this.last = last;
    this.from = first;
    this.to = last;
    /** @type {(() => void)[]} */
    this.listeners = [];
  }

  /** @param {number} from @param {number} to */
  show(from, to) {
    [this.from, this.to] = [Math.max(this.first, from), Math.min(this.last, to)];
    this.listeners.forEach((listener) => listener());
  }
}

/** @param {string} tag @param {Record<string, string | number>} attributes */
function drawn(tag, attributes) {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  return made;
}

/** Round times within a part of the run. @param {number} from @param {number} to */
function ticks(from, to) {
  const rough = (to - from) / 6;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = ([1, 2, 5].find((nice) => nice * power >= rough) || 10) * power;
  const made = [];
  for (let number = Math.ceil(from / step); number * step <= to; number++) made.push(Number((number * step).toPrecision(10)));
  return made;
}

/** The row nearest to a time. @param {number[]} times @param {number} time */
export function nearestRow(times, time) {
  let row = times.findIndex((at) => at >= time);
  if (row < 0) row = times.length - 1;
  return row > 0 && time - times[row - 1] < times[row] - time ? row - 1 : row;
}

export class Plot {
  /** @param {SVGSVGElement} svg @param {FigureData} data @param {Clock} clock @param {Window} shown */
  constructor(svg, data, clock, shown) {
    Object.assign(this, { svg, data, clock, shown });
    this.svg = svg;
    this.data = data;
    this.clock = clock;
    this.shown = shown;
    /** @type {number | null} */
    this.hovered = null;
    /** Told the time that the plot tells. @type {((time: number) => void)[]} */
    this.followers = [];
    /** @type {number | null} */
    this.begun = null;
    this.overlay = drawn('g', { class: 'overlay' });
    this.cursors = data.panels.map(({ y }) => drawn('line', { class: 'cursor', y1: y.from_px, y2: y.to_px }));
    this.brush = drawn('rect', { class: 'brush', visibility: 'hidden' });
    this.ticks = drawn('g', { class: 'axis ticks' });
    this.overlay.append(...this.cursors, this.brush, this.ticks);
    svg.append(this.overlay);
    this.readout = this.legend();
    svg.addEventListener('pointermove', (event) => this.hover(event));
    svg.addEventListener('pointerleave', () => this.leave());
    svg.addEventListener('pointerdown', (event) => this.press(event));
    svg.addEventListener('pointerup', (event) => this.release(event));
    svg.addEventListener('dblclick', () => shown.show(shown.first, shown.last));
    clock.listen(() => this.update());
    shown.listeners.push(() => this.zoom());
    this.update();
  }

  /** @param {(time: number) => void} follower */
  follow(follower) {
    this.followers.push(follower);
    this.update();
  }

  /** Buttons that switch series, with their values at the time. */
  legend() {
    const holder = element('div', { class: 'readout' });
    this.time = element('output', { class: 'at' });
    holder.append(this.time);
    /** @type {Map<string, {series: Series[], value: HTMLElement}>} */
    this.entries = new Map();
    for (const series of this.data.series) {
      const group = series.group || series.id;
      const known = this.entries.get(group);
      if (known) {
        known.series.push(series);
        continue;
      }
      const value = element('span', { class: 'value' });
      const button = element('button', { type: 'button', 'aria-pressed': 'true' }, [element('span', { class: 'name' }, [series.label]), value]);
      button.addEventListener('click', () => {
        const on = button.getAttribute('aria-pressed') !== 'true';
        button.setAttribute('aria-pressed', String(on));
        this.svg.querySelectorAll('[data-group], [data-series]').forEach((part) => {
          if ((part.getAttribute('data-group') || part.getAttribute('data-series')) === group) part.classList.toggle('off', !on);
        });
      });
      this.entries.set(group, { series: [series], value });
      holder.append(button);
    }
    this.svg.parentElement?.append(holder);
    return holder;
  }

  /** px of a time. @param {Scale} x @param {number} time */
  px(x, time) {
    const share = (time - this.shown.from) / (this.shown.to - this.shown.from);
    return x.from_px + share * (x.to_px - x.from_px);
  }

  /** The time under the pointer; null outside the panels. @param {PointerEvent} event */
  timeAt(event) {
    const matrix = this.svg.getScreenCTM();
    if (!matrix) return null;
    const { x: at } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
    const { x } = this.data.panels[0];
    const share = (at - x.from_px) / (x.to_px - x.from_px);
    return share < -0.02 || share > 1.02 ? null : this.shown.from + Math.max(0, Math.min(1, share)) * (this.shown.to - this.shown.from);
  }

  /** @param {PointerEvent} event */
  hover(event) {
    this.hovered = this.timeAt(event);
    if (this.begun !== null && this.hovered !== null) {
      const { x, y } = this.data.panels[0];
      const last = this.data.panels[this.data.panels.length - 1].y;
      const [from, to] = [this.begun, this.hovered].sort((a, b) => a - b).map((time) => this.px(x, time));
      const top = Math.min(y.from_px, y.to_px);
      const all = { x: from, width: to - from, y: top, height: Math.max(last.from_px, last.to_px) - top, visibility: to - from > 4 ? 'visible' : 'hidden' };
      Object.entries(all).forEach(([name, value]) => this.brush.setAttribute(name, String(value)));
    }
    this.update();
  }

  leave() {
    [this.hovered, this.begun] = [null, null];
    this.brush.setAttribute('visibility', 'hidden');
    this.update();
  }

  /** @param {PointerEvent} event */
  press(event) {
    if (event.button === 0) this.begun = this.timeAt(event);
  }

  /** A click shows its time; a stretch becomes all that is shown. @param {PointerEvent} event */
  release(event) {
    const [from, to] = [this.begun, this.timeAt(event)];
    this.begun = null;
    this.brush.setAttribute('visibility', 'hidden');
    if (from === null || to === null) return;
    if (Math.abs(to - from) > 0.01 * (this.shown.to - this.shown.from)) this.shown.show(Math.min(from, to), Math.max(from, to));
    else this.clock.seek(to);
  }

  /** Moves the cursors, and tells the values at the pointer, or else at the cursor. */
  update() {
    const { time } = this.clock;
    this.data.panels.forEach(({ x }, number) => {
      const at = this.px(x, time);
      const inside = time >= this.shown.from && time <= this.shown.to;
      this.cursors[number].setAttribute('x1', at.toFixed(2));
      this.cursors[number].setAttribute('x2', at.toFixed(2));
      this.cursors[number].setAttribute('visibility', inside ? 'visible' : 'hidden');
    });
    const told = this.hovered === null ? time : this.hovered;
    const { name, unit } = this.data.across || { name: 't', unit: 's' };
    if (this.time) this.time.textContent = `${name} = ${digits(told)} ${unit}`;
    this.entries?.forEach(({ series, value }) => (value.textContent = this.valueOf(series, told)));
    this.followers.forEach((follower) => follower(told));
  }

  /** The extremes of a series in the row nearest to a time. @param {Series | undefined} series @param {number} time */
  extremes(series, time) {
    const times = series?.time || this.data.time;
    const row = nearestRow(times, time);
    const [lower, upper] = [series?.lower[row], series?.upper[row]];
    return typeof lower === 'number' && typeof upper === 'number' ? [lower, upper] : null;
  }

  /** What the first panel shows of series that belong together: a value, or bounds and their error. @param {Series[]} group @param {number} time */
  valueOf(group, time) {
    const [first] = group;
    const found = this.extremes(first, time);
    if (!found) return '–';
    const panel = this.data.panels.find(({ id }) => id === first.panel);
    const unit = panel?.unit ?? this.data.unit;
    const [lower, upper] = found;
    const with_unit = (/** @type {string} */ text) => (unit ? `${text} ${unit}` : text);
    // Without a nominal course, shares are stacked: what counts is their thickness.
    if (!this.data.series.some(({ kind }) => kind === 'nominal')) return with_unit(digits(upper - lower));
    if (first.kind === 'nominal' || lower === upper) return with_unit(digits(upper));
    const error = this.extremes(group.find(({ kind, panel: where }) => kind === 'error' && where === first.panel), time);
    const beyond = error ? Math.max(error[1] - upper, lower - error[0]) : 0;
    return with_unit(`${digits(lower)} … ${digits(upper)}${beyond > 0 ? ` ± ${digits(beyond)}` : ''}`);
  }

  /** Shows a part of the run: the courses are stretched, and have times of their own below. */
  zoom() {
    const { from, to, first, last } = this.shown;
    const whole = from <= first && to >= last;
    this.svg.classList.toggle('zoomed', !whole);
    this.svg.querySelectorAll('[data-panel]').forEach((group) => {
      const panel = this.data.panels.find(({ id }) => id === group.getAttribute('data-panel'));
      if (!panel) return;
      const { x } = panel;
      const stretch = (x.max - x.min) / (to - from);
      const shift = x.from_px - stretch * (x.from_px + ((from - x.min) / (x.max - x.min)) * (x.to_px - x.from_px));
      group.querySelectorAll('.data > *').forEach((part) => {
        if (whole) part.removeAttribute('transform');
        else part.setAttribute('transform', `matrix(${stretch} 0 0 1 ${shift} 0)`);
      });
    });
    this.ticks.replaceChildren();
    if (whole) return this.update();
    const { x, y } = this.data.panels[this.data.panels.length - 1];
    for (const time of ticks(from, to)) {
      const label = drawn('text', { x: this.px(x, time), y: Math.max(y.from_px, y.to_px) + 19, 'text-anchor': 'middle' });
      label.textContent = String(time);
      this.ticks.append(label);
    }
    this.update();
  }
}

/** All figures of an element that carry data. @param {Element} holder @param {Clock} clock @param {Window} shown */
export function bringToLife(holder, clock, shown) {
  /** @type {Plot[]} */
  const plots = [];
  /** Of what is not over the time, by its scale. @type {Map<string, [Clock, Window]>} */
  const others = new Map();
  /** @param {FigureData} data @returns {[Clock, Window]} */
  const runOf = (data) => {
    if (!data.across) return [clock, shown];
    const { min, max } = data.panels[0].x;
    const scale = `${data.across.name} ${min} ${max}`;
    const known = others.get(scale) || [new Clock(max, min), new Window(min, max)];
    others.set(scale, known);
    return known;
  };
  holder.querySelectorAll('.plot svg').forEach((svg) => {
    const text = svg.querySelector('metadata')?.textContent;
    const data = text ? JSON.parse(text) : null;
    if (data && data.panels && data.time) plots.push(new Plot(/** @type {SVGSVGElement} */ (svg), data, ...runOf(data)));
  });
  return plots;
}
