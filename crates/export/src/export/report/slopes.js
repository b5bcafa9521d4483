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
    const holder = element('div', { class: 'slopes' }, ['by parameters']);
    const entries = parameters.map((own) => {
      const [value, influence] = [element('b'), element('small', { title: 'times half of the interval' })];
      holder.append(element('span', { class: 'slope' }, [element('span', { class: 'name' }, [own.name]), value, influence]));
      return { ...own, value, influence, slopes: floats(own.values) };
    });
    plot.readout.after(holder);
    plot.follow((time) => {
      const row = nearestRow(times, time);
      entries.forEach((own) => {
        const slope = own.slopes[row];
        own.value.textContent = quantity(slope, own.unit);
        own.influence.textContent = Number.isFinite(slope) ? ` ± ${quantity(Math.abs(slope) * own.half_width, unit)}` : '';
      });
    });
  }
}
