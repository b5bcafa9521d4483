// @ts-check
// Meshes of unit size: of each vertex its position, its normal, and whether it is at the far end of a stretched part.

/** @typedef {{vertices: Float32Array, count: number}} Mesh */

/** @param {number[][]} quads corners [place, normal, end] each, four a face @returns {Mesh} */
function ofQuads(quads) {
  const flat = [];
  for (let face = 0; face < quads.length; face += 4) for (const corner of [0, 1, 2, 0, 2, 3]) flat.push(...quads[face + corner]);
  return { vertices: new Float32Array(flat), count: flat.length / 7 };
}

/** A cube from −½ to ½. @returns {Mesh} */
export function box() {
  const quads = [];
  for (let axis = 0; axis < 3; axis++) {
    for (const side of [-1, 1]) {
      for (const [u, v] of side > 0 ? [[-1, -1], [1, -1], [1, 1], [-1, 1]] : [[-1, -1], [-1, 1], [1, 1], [1, -1]]) {
        const [place, normal] = [[0, 0, 0], [0, 0, 0]];
        [place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3], normal[axis]] = [side / 2, u / 2, v / 2, side];
        quads.push([...place, ...normal, 0]);
      }
    }
  }
  return ofQuads(quads);
}

/** A surface of revolution about z. @param {number[][]} profile [radius, z, normal's radius, normal's z, end] @param {number} around */
function revolved(profile, around) {
  const quads = [];
  for (let step = 0; step < around; step++) {
    for (let ring = 0; ring + 1 < profile.length; ring++) {
      for (const [place, turn] of [[ring, step], [ring, step + 1], [ring + 1, step + 1], [ring + 1, step]]) {
        const [r, z, nr, nz, end] = profile[place];
        const [c, s] = [Math.cos((2 * Math.PI * turn) / around), Math.sin((2 * Math.PI * turn) / around)];
        quads.push([r * c, r * s, z, nr * c, nr * s, nz, end]);
      }
    }
  }
  return ofQuads(quads);
}

/** A sphere of radius 1, or a capsule: its upper half at the far end. @param {boolean} stretched */
export function ball(stretched) {
  const profile = [];
  for (let ring = 0; ring <= 12; ring++) {
    const angle = Math.PI * (ring / 12 - 0.5);
    const [r, z] = [Math.cos(angle), Math.sin(angle)];
    if (ring === 6 && stretched) profile.push([1, 0, 1, 0, 0]);
    profile.push([r, z, r, z, stretched && ring >= 6 ? 1 : 0]);
  }
  return revolved(profile, 24);
}

/** A cylinder of radius 1 with flat ends, the upper one at the far end. */
export const cylinder = () => revolved([[0, 0, 0, -1, 0], [1, 0, 0, -1, 0], [1, 0, 1, 0, 0], [1, 0, 1, 0, 1], [1, 0, 0, 1, 1], [0, 0, 0, 1, 1]], 28);

/** A cone of radius and height 1. */
export const cone = () => revolved([[0, 0, 0, -1, 0], [1, 0, 0, -1, 0], [1, 0, 0.7, 0.7, 0], [0, 1, 0.7, 0.7, 0]], 20);

/** Triangles of a file: their normals are those of their planes. @param {Float32Array} corners @returns {Mesh} */
export function triangles(corners) {
  const flat = [];
  for (let at = 0; at + 8 < corners.length; at += 9) {
    const [a, b, c] = [0, 3, 6].map((offset) => corners.subarray(at + offset, at + offset + 3));
    const [u, v] = [b, c].map((corner) => [corner[0] - a[0], corner[1] - a[1], corner[2] - a[2]]);
    const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    for (const corner of [a, b, c]) flat.push(...corner, ...normal, 0);
  }
  return { vertices: new Float32Array(flat), count: flat.length / 7 };
}
