// @ts-check
import { digits, element, floats } from './data.js';
import { Plot, nearestRow } from './plots.js';
// Below the plot of an output, its derivatives at the time that the plot tells.

/** @typedef {import('./data.js').PackedDerivatives} PackedDerivatives */

/** A number with its unit. @param {number} value @param {string} unit */
const quantity = (value, unit) => (unit && Number.isFinite(value) ? `${digits(value)} ${unit}` : digits(value));

/** @param {Plot[]} plots @param {PackedDerivatives | null | undefined} derivatives */
export function addSlopes(plots, derivatives) {
  if (!derivatives) return;
  const times = [...floats(derivatives.times)];
  for (const { name, unit, parameters } of derivatives.outputs) {
    const plot = plots.find(({ data }) => data.output === name && !data.across);
    if (!plot) continue;
    const entries = parameters.map((parameter) => {
      const value = element('span', { class: 'value' });
      const influence = element('small', { title: 'the derivative times half of the interval' });
      const entry = element('span', { class: 'slope' }, [element('span', { class: 'name' }, [parameter.name]), value, influence]);
      return { value, influence, entry, values: floats(parameter.values), unit: parameter.unit, half: parameter.half_width };
    });
    const title = `change of ${name} where a parameter rises, the others at their nominal values`;
    const holder = element('div', { class: 'slopes', title }, [element('span', { class: 'name' }, ['by parameters']), ...entries.map(({ entry }) => entry)]);
    plot.readout.after(holder);
    plot.follow((time) => {
      const row = nearestRow(times, time);
      for (const own of entries) {
        const slope = own.values[row];
        own.value.textContent = quantity(slope, own.unit);
        own.influence.textContent = Number.isFinite(slope) ? ` ± ${quantity(Math.abs(slope) * own.half, unit)}` : '';
      }
    });
  }
}
