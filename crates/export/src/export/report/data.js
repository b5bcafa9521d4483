// @ts-check
// What the page brings along: types of its JSON, and packed numbers.

/**
 * @typedef {{name: string, position: number[]}} DrawnPoint
 * @typedef {{name: string, position: number[], angle?: number, orientation?: number[], center_of_mass?: number[], guide?: number[], points: DrawnPoint[]}} DrawnBody
 * @typedef {{name: string, kind: string, glyph: string, ends: number[][], bodies: number[], axis?: number[]}} DrawnElement
 * @typedef {{body: number, surface: boolean, position: number[], orientation: number[], shape: string, size: number[], color?: number[], vertices?: string, within: number[][]}} Visual
 * @typedef {{model: string, spatial: boolean, bodies: DrawnBody[], elements: DrawnElement[], gravity: number[] | null}} Drawing
 * @typedef {{name: string, unit: string, nominal: number, lower: number, upper: number}} Parameter
 * @typedef {{scales: number[], data: string}} Packed
 * @typedef {{values: number[], bodies: Packed, points: string}} PackedSample
 * @typedef {{name: string, reaction: boolean, values: Packed}} PackedForce
 * @typedef {{degrees: number[], bodies: Packed, points: string, error: number, events?: {times: string, deviations: string}}} PackedPolynomials
 * @typedef {{name: string, time?: number, bodies: Packed, points: string}} PackedWorst
 * @typedef {{drawing: Drawing, visuals: Visual[], times: string, rows: number, between: number, per_body: number, parameters: Parameter[], nominal: {bodies: string, points: string}, forces: PackedForce[], samples: PackedSample[], worst?: PackedWorst[], stopped: number, polynomials?: PackedPolynomials}} PackedMotion
 * @typedef {{name: string, unit: string, half_width: number, values: string}} PackedSlope
 * @typedef {{times: string, outputs: {name: string, unit: string, parameters: PackedSlope[]}[]}} PackedDerivatives
 * @typedef {{name: string, duration: number, outputs: string[], motion: PackedMotion | null, derivatives?: PackedDerivatives | null}} Scene
 */

/** @param {string} text @returns {ArrayBuffer} */
const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;

/** 32-bit floats. @param {string} text */
export const floats = (text) => new Float32Array(bytes(text));

/** Whole numbers times scales that repeat. @param {Packed} packed */
export function unpack(packed) {
  const whole = new Int16Array(bytes(packed.data));
  const places = packed.scales.length;
  return Float32Array.from(whole, (value, place) => value * packed.scales[place % places]);
}

/** @returns {Scene[]} */
export const readData = () => JSON.parse(document.getElementById('mbint-data')?.textContent || '[]');

/** A number of four digits. @param {number} value */
export function digits(value) {
  if (value === 0 || !Number.isFinite(value)) return value === 0 ? '0' : '–';
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e5) return String(Number(value.toPrecision(4)));
  const [mantissa, exponent] = value.toExponential(2).split('e');
  return `${mantissa}·10${superscript(exponent)}`;
}

/** @param {string} exponent */
const superscript = (exponent) =>
  exponent.replace('+', '').replace('-', '⁻').replace(/\d/g, (digit) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(digit)]);

/** An element with attributes and children. @param {string} tag @param {Record<string, string>} [attributes] @param {(Node | string)[]} [children] @returns {HTMLElement} */
export function element(tag, attributes = {}, children = []) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}
