// @ts-check
import { across, cross, dot, matrixProduct, minus, norm, plus, times, transformed, unit } from './vectors.js';
// Where the reader looks from: along z and without perspective in the plane, from any side in space.

export class Camera {
  /** @param {boolean} spatial @param {number[][]} extent least and greatest corner of all that moves */
  constructor(spatial, extent) {
    this.spatial = spatial;
    this.extent = extent;
    const [least, greatest] = extent;
    this.target = times(0.5, plus(least, greatest));
    this.size = minus(greatest, least);
    this.radius = Math.max(norm(this.size) / 2, 1e-9);
    this.yaw = 0;
    this.pitch = 0;
    this.zoom = 1;
    this.reset();
  }

  reset() {
    this.target = times(0.5, plus(this.extent[0], this.extent[1]));
    [this.yaw, this.pitch, this.zoom] = [-0.9, 0.42, 1];
  }

  /** Right, up and towards the reader. */
  axes() {
    if (!this.spatial) return [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const [c, s] = [Math.cos(this.pitch), Math.sin(this.pitch)];
    const back = [c * Math.cos(this.yaw), c * Math.sin(this.yaw), s];
    const right = [-Math.sin(this.yaw), Math.cos(this.yaw), 0];
    return [right, cross(back, right), back];
  }

  /** m that half the height of the picture shows, at the target. @param {number} aspect */
  halfHeight(aspect) {
    const fit = this.spatial ? this.radius * Math.max(1, 1 / aspect) : Math.max(this.size[1] / 2, this.size[0] / 2 / aspect, 1e-9);
    return (fit * (this.spatial ? 1.02 : 1.08)) / this.zoom;
  }

  /** @param {number} aspect width over height */
  matrix(aspect) {
    const [right, up, back] = this.axes();
    const half = this.halfHeight(aspect);
    const depth = 4 * this.radius + half;
    const view = [right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0, -dot(right, this.target), -dot(up, this.target), -dot(back, this.target), 1];
    if (!this.spatial) return matrixProduct([1 / (half * aspect), 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, -1 / depth, 0, 0, 0, 0, 1], view);
    const focal = 3.2;
    const distance = focal * half;
    const [near, far] = [Math.max(distance - depth, 0.02 * distance), distance + depth];
    const [a, b] = [(far + near) / (near - far), (2 * far * near) / (near - far)];
    const shifted = view.slice();
    shifted[14] -= distance;
    return matrixProduct([focal / aspect, 0, 0, 0, 0, focal, 0, 0, 0, 0, a, -1, 0, 0, b, 0], shifted);
  }

  /** Where a place is seen, px. @param {number[]} place @param {number} width @param {number} height */
  pixel(place, width, height) {
    const [x, y, , w] = transformed(this.matrix(width / height), place);
    return [(0.5 + (0.5 * x) / w) * width, (0.5 - (0.5 * y) / w) * height];
  }

  /** @param {number} dx @param {number} dy px */
  orbit(dx, dy) {
    this.yaw -= 0.008 * dx;
    this.pitch = Math.max(-1.55, Math.min(1.55, this.pitch + 0.008 * dy));
  }

  /** @param {number} dx @param {number} dy px @param {number} width @param {number} height */
  pan(dx, dy, width, height) {
    const scale = (2 * this.halfHeight(width / height)) / height;
    const [right, up] = this.axes();
    this.target = plus(plus(this.target, times(-dx * scale, right)), times(dy * scale, up));
  }

  /** Nearer, while the point under the pointer stays there. @param {number} factor @param {number} x @param {number} y px from the middle, upwards @param {number} height */
  approach(factor, x, y, height, width = height) {
    const before = (2 * this.halfHeight(width / height)) / height;
    this.zoom = Math.max(0.1, Math.min(200, this.zoom * factor));
    const after = (2 * this.halfHeight(width / height)) / height;
    const [right, up] = this.axes();
    this.target = plus(this.target, plus(times(x * (before - after), right), times(y * (before - after), up)));
  }

  /** Where light comes from: over the reader's left shoulder. */
  light() {
    const [right, up, back] = this.axes();
    return unit(plus(plus(times(-0.35, right), times(0.6, up)), back));
  }
}

/** Columns of a frame whose z is along an axis. @param {number[]} axis @param {number} radius */
export function alongAxis(axis, radius) {
  const [first, second] = across(axis);
  return [times(radius, first), times(radius, second), times(radius, axis)];
}
