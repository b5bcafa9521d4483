// @ts-check
import { digits, element } from './data.js';
// A slider for each uncertain parameter.

/** @typedef {{name: string, unit: string, nominal: number, lower: number, upper: number, display?: {unit: string, si: number}}} Parameter */

export class Sliders {
  /** @param {HTMLElement} holder @param {(values: number[] | null) => void} changed null where all are nominal */
  constructor(holder, changed) {
    this.holder = holder;
    this.changed = changed;
    /** @type {Parameter[]} */
    this.parameters = [];
    /** @type {number[]} */
    this.values = [];
    /** @type {(() => void)[]} */
    this.updates = [];
    this.note = element('small', { 'aria-live': 'polite' });
    this.reset = /** @type {HTMLButtonElement} */ (element('button', { type: 'button' }, ['Nominal']));
    this.reset.addEventListener('click', () => this.set(this.parameters.map(({ nominal }) => nominal)));
  }

  get isNominal() {
    return this.values.every((value, place) => value === this.parameters[place].nominal);
  }

  /** Shows sliders; a parameter that was there keeps its value where it can. @param {Parameter[]} parameters */
  show(parameters) {
    const before = new Map(this.parameters.map(({ name, nominal }, place) => [name, this.values[place] === nominal ? null : this.values[place]]));
    this.parameters = parameters;
    this.values = parameters.map(({ name, nominal, lower, upper }) => {
      const known = before.get(name);
      return known !== null && known !== undefined && known >= lower && known <= upper ? known : nominal;
    });
    this.updates = [];
    const rows = parameters.map((parameter, place) => this.row(parameter, place));
    this.note.textContent = '';
    const legend = element('div', { class: 'row' }, [element('h2', {}, ['What if']), this.reset, this.note]);
    this.holder.replaceChildren(...(rows.length ? [legend, element('div', { class: 'rows' }, rows)] : [element('small', {}, ['No parameter is uncertain.'])]));
    this.update();
  }

  /** @param {Parameter} parameter @param {number} place */
  row({ name, unit, nominal, lower, upper, display }, place) {
    const id = `parameter-${place}`;
    const slider = /** @type {HTMLInputElement} */ (element('input', { type: 'range', id, min: '0', max: '1', step: '0.001' }));
    const shown = element('output', { for: id });
    slider.addEventListener('input', () => {
      const share = Number(slider.value);
      // The ends and the middle are met exactly.
      this.values[place] = share === 0 ? lower : share === 1 ? upper : lower + share * (upper - lower);
      this.update();
      this.changed(this.isNominal ? null : this.values);
    });
    slider.addEventListener('dblclick', () => this.set(this.values.map((value, own) => (own === place ? nominal : value))));
    this.updates.push(() => {
      const value = this.values[place];
      slider.value = String((value - lower) / (upper - lower || 1));
      const percent = nominal === 0 || value === nominal ? '' : ` (${value > nominal ? '+' : '−'}${digits(Math.abs((100 * (value - nominal)) / nominal))} %)`;
      shown.textContent = `${digits(display ? value / display.si : value)} ${display ? display.unit : unit}${percent}`;
      slider.setAttribute('aria-valuetext', shown.textContent);
    });
    return element('div', { class: 'parameter' }, [element('label', { for: id, title: name }, [name]), slider, shown]);
  }

  /** @param {number[]} values */
  set(values) {
    this.values = values;
    this.update();
    this.changed(this.isNominal ? null : values);
  }

  update() {
    this.updates.forEach((update) => update());
    this.reset.disabled = this.isNominal;
  }

  /** @param {string} text */
  tell(text) {
    this.note.textContent = text;
  }
}
