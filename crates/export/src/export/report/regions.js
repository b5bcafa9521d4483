// @ts-check
import { colorOf, hull } from './mechanism.js';
import { minus, norm } from './vectors.js';
// What a point sweeps over: in the plane the hulls of all samples' places from one time to the next, in space their
// paths.

/** @typedef {import('./mechanism.js').Mechanism} Mechanism */
/** @typedef {import('./mechanism.js').Anchor} Anchor */
/** @typedef {import('./renderer.js').Flat} Flat */

/** Places of a point at all poses, path by path: the nominal one first. @param {Mechanism} mechanism @param {Anchor} anchor */
export function paths(mechanism, anchor) {
  const { movie } = mechanism;
  const samples = [undefined, ...movie.samples.keys()];
  const path = (/** @type {number | undefined} */ sample) => Array.from(movie.times, (time) => mechanism.where(movie.at(time, sample), anchor));
  return samples.map(path);
}

/** @param {Mechanism} mechanism @param {Anchor} anchor @param {number[]} color @returns {Flat[]} */
export function sweptRegion(mechanism, anchor, color) {
  const all = paths(mechanism, anchor);
  const { spatial } = mechanism.movie.drawing;
  const depth = -6 * mechanism.thickness;
  const nominal = { points: all[0].flat(), color: [...color, 1], lines: true };
  if (spatial) return [...all.slice(1).map((path) => ({ points: path.flat(), color: [...color, 0.35], lines: true })), nominal];
  const points = [];
  for (let place = 0; place + 1 < all[0].length; place++) {
    const corners = hull(all.flatMap((path) => [path[place], path[place + 1]]));
    for (let corner = 1; corner + 1 < corners.length; corner++) {
      for (const at of [corners[0], corners[corner], corners[corner + 1]]) points.push(at[0], at[1], depth);
    }
  }
  return [{ points, color: [...color, 0.28], lines: false }, nominal];
}

/** The nominal paths of all points that move, in the colours of their bodies. @param {Mechanism} mechanism @param {boolean} dark @returns {Flat[]} */
export function traces(mechanism, dark) {
  const { movie, named, extent } = mechanism;
  const small = 1e-3 * norm(minus(extent[1], extent[0]));
  const moving = named.map(({ anchor }) => ({ body: anchor.body, path: Array.from(movie.times, (time) => mechanism.where(movie.at(time), anchor)) }));
  return moving
    .filter(({ path }) => path.some((place) => norm(minus(place, path[0])) > small))
    .map(({ body, path }) => ({ points: path.flat(), color: [...colorOf(body, dark), 0.9], lines: true }));
}
