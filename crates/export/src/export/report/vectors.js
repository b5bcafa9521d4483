// @ts-check
// Vectors of three, quaternions [w, x, y, z], and 4×4 matrices by columns.

/** @typedef {number[]} Vector */

/** @param {Vector} a @param {Vector} b */
export const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
/** @param {Vector} a @param {Vector} b */
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** @param {number} s @param {Vector} a */
export const times = (s, a) => [s * a[0], s * a[1], s * a[2]];
/** @param {Vector} a @param {Vector} b */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @param {Vector} a @param {Vector} b */
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
/** @param {Vector} a */
export const norm = (a) => Math.hypot(a[0], a[1], a[2]);
/** A unit vector; along z where there is no direction. @param {Vector} a */
export const unit = (a) => (norm(a) > 1e-300 ? times(1 / norm(a), a) : [0, 0, 1]);

/** Two unit vectors across one. @param {Vector} axis */
export function across(axis) {
  const first = unit(cross(axis, Math.abs(axis[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
  return [first, cross(axis, first)];
}

/** @param {number[]} q @param {Vector} v */
export function turned(q, v) {
  const [w, ...u] = q;
  const t = times(2, cross(u, v));
  return plus(plus(v, times(w, t)), cross(u, t));
}

/** @param {number[]} q */
export const inverse = (q) => [q[0], -q[1], -q[2], -q[3]];

/** @param {number[]} a @param {number[]} b */
export function product(a, b) {
  const v = plus(plus(times(a[0], b.slice(1)), times(b[0], a.slice(1))), cross(a.slice(1), b.slice(1)));
  return [a[0] * b[0] - dot(a.slice(1), b.slice(1)), ...v];
}

/** @param {number[]} q */
export function normalised(q) {
  const size = Math.hypot(...q) || 1;
  return q.map((part) => part / size);
}

/** @param {number[]} a @param {number[]} b */
export function matrixProduct(a, b) {
  const made = new Array(16).fill(0);
  for (let c = 0; c < 4; c++) for (let r = 0; r < 4; r++) for (let k = 0; k < 4; k++) made[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return made;
}

/** @param {number[]} m @param {Vector} p */
export const transformed = (m, p) => [0, 1, 2, 3].map((r) => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
