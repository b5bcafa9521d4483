// @ts-check
import { element } from './data.js';
import { Window, bringToLife } from './plots.js';
// The bounds, as the report shows them, and the curve of a sample over them.

/** @typedef {import('./clock.js').Clock} Clock */
/** @typedef {{times: number[], outputs: {name: string, unit: string, values: (number | null)[]}[]}} Curves */
/** @typedef {import('./plots.js').FigureData & {panels: {id: string, si?: number}[]}} Data */

const SVG = 'http://www.w3.org/2000/svg';

export class Bounds {
  /** @param {HTMLElement} holder @param {HTMLElement} tabs */
  constructor(holder, tabs) {
    this.holder = holder;
    this.tabs = tabs;
    /** Number of the model. */
    this.number = 0;
    /** The output that is looked at. */
    this.chosen = '';
    /** @type {import('./plots.js').Plot[]} */
    this.plots = [];
    /** Of the figures that are shown. @type {(() => void)[]} */
    this.listeners = [];
    /** @type {Clock | null} */
    this.clock = null;
    /** @type {{sample: Curves, nominal: Curves | null} | null} */
    this.curves = null;
  }

  /** Shows an article of results. @param {string} html of this program, in which every name is escaped @param {Clock} clock */
  show(html, clock) {
    this.forget();
    this.clock = clock;
    this.holder.innerHTML = html;
    const known = clock.listeners.length;
    this.plots = bringToLife(this.holder, clock, new Window(0, clock.duration));
    this.listeners = clock.listeners.slice(known);
    this.switches();
    this.overlay(this.curves);
  }

  /** Shows a sentence in place of bounds. @param {string} text @param {HTMLElement[]} [more] */
  say(text, more = []) {
    this.forget();
    this.holder.replaceChildren(element('p', { class: 'absent' }, [text]), ...more);
    this.tabs.replaceChildren();
  }

  /** Figures that are gone do not listen. */
  forget() {
    const { clock } = this;
    if (clock) clock.listeners = clock.listeners.filter((own) => !this.listeners.includes(own));
    this.listeners = [];
    this.plots = [];
  }

  switches() {
    const figures = [...this.holder.querySelectorAll('figure[data-output]')];
    const names = figures.map((figure) => figure.querySelector('figcaption')?.textContent || '');
    if (!names.includes(this.chosen)) this.chosen = names[0] || '';
    const choose = (/** @type {string} */ name) => {
      this.chosen = name;
      figures.forEach((figure, place) => figure.classList.toggle('hidden', names[place] !== name));
      buttons.forEach((button, place) => button.setAttribute('aria-pressed', String(names[place] === name)));
    };
    const buttons = names.map((name) => {
      const button = element('button', { type: 'button', title: name }, [name]);
      button.addEventListener('click', () => choose(name));
      return button;
    });
    this.tabs.replaceChildren(...buttons);
    choose(this.chosen);
  }

  /** Draws a sample over the bounds, and its distance from the nominal motion; nothing where there is none. @param {{sample: Curves, nominal: Curves | null} | null} curves */
  overlay(curves) {
    this.curves = curves;
    this.holder.querySelectorAll('.sample').forEach((line) => line.remove());
    if (!curves) return;
    for (const { svg, data } of this.plots) {
      const place = curves.sample.outputs.findIndex(({ name }) => name === data.output);
      // Shares of parameters have no nominal curve.
      if (place < 0 || data.across || !data.series.some(({ kind }) => kind === 'nominal')) continue;
      const { values } = curves.sample.outputs[place];
      const nominal = curves.nominal?.outputs[place].values;
      const [value, deviation] = /** @type {Data} */ (data).panels;
      this.line(svg, value, curves.sample.times, values);
      if (deviation && nominal && data.panels.length === 2) this.line(svg, deviation, curves.sample.times, values.map((own, row) => (own === null || nominal[row] === null || nominal[row] === undefined ? null : own - Number(nominal[row]))));
    }
  }

  /** @param {SVGSVGElement} svg @param {Data['panels'][number]} panel @param {number[]} times @param {(number | null)[]} values SI */
  line(svg, { id, x, y, si = 1 }, times, values) {
    const at = (/** @type {import('./plots.js').Scale} */ scale, /** @type {number} */ value) => scale.from_px + ((value - scale.min) / (scale.max - scale.min)) * (scale.to_px - scale.from_px);
    let path = '';
    let isBegun = false;
    values.forEach((value, row) => {
      if (value === null || times[row] === undefined) {
        isBegun = false;
        return;
      }
      path += `${isBegun ? 'L' : 'M'}${at(x, times[row]).toFixed(2)} ${at(y, value / si).toFixed(2)}`;
      isBegun = true;
    });
    const line = document.createElementNS(SVG, 'path');
    line.setAttribute('class', 'sample');
    line.setAttribute('d', path);
    svg.querySelector(`[data-panel="${id}"] .data`)?.append(line);
    // What is zoomed is zoomed with its own.
    const zoomed = line.previousElementSibling?.getAttribute('transform');
    if (zoomed) line.setAttribute('transform', zoomed);
  }
}
