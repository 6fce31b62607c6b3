// Poses and velocities at any time, from the motions of a run.
import type { Run } from "./data";
import { before } from "./search";

const derived = 255;
const constantRate = 1;
const polynomial = 2;
const upright = 3;

const size = (degree: number, dimension: number) =>
  degree === derived ? 0 : (degree + 1) * dimension;

/** A body's place at a time: position (m), unit quaternion (w, x, y, z), velocities (m/s, rad/s). */
export interface State {
  px: number; py: number; pz: number;
  qw: number; qx: number; qy: number; qz: number;
  vx: number; vy: number; vz: number;
  wx: number; wy: number; wz: number;
}

export const newState = (): State => ({
  px: 0, py: 0, pz: 0, qw: 1, qx: 0, qy: 0, qz: 0, vx: 0, vy: 0, vz: 0, wx: 0, wy: 0, wz: 0,
});

/**
 * Evaluates the motions of a run. A motion counts after its start, up to and including the start of
 * the next one: what arrives at an instant is what a frame shows.
 */
export class Motions {
  private readonly offset: Uint32Array;
  private readonly cursor: Uint32Array;

  constructor(private readonly run: Run) {
    const count = run.start.length;
    this.offset = new Uint32Array(count);
    this.cursor = run.first.slice(0, run.bodies.length);
    let at = 0;
    for (let i = 0; i < count; ++i) {
      this.offset[i] = at;
      const [position, velocity, rotation, quaternion, angular] = run.layout.subarray(5 * i, 5 * i + 5);
      at += size(position, 3) + size(velocity, 3) + (rotation === upright ? 0 : size(quaternion, 4));
      at += (rotation === constantRate ? 3 : 0) + size(angular, 3);
    }
  }

  /** The motion of body i that counts at t; the last one is tried first, then the next. */
  private find(i: number, t: number): number {
    const { start, first } = this.run;
    const begin = first[i];
    const end = first[i + 1];
    let k = this.cursor[i];
    const counts = (n: number) =>
      (n === begin || start[n] < t) && (n + 1 === end || start[n + 1] >= t);
    if (!counts(k)) {
      k = k + 1 < end && counts(k + 1) ? k + 1 : Math.max(begin, before(start, t, begin, end));
      this.cursor[i] = k;
    }
    return k;
  }

  /** Where body i is at t. */
  at(i: number, t: number, out: State): State {
    const { layout, coefficients: c, start, duration } = this.run;
    const k = this.find(i, t);
    const s = Math.min(Math.max(t - start[k], 0), duration[k]);
    let at = this.offset[k];
    const n = layout[5 * k];
    const nv = layout[5 * k + 1];
    const rotation = layout[5 * k + 2];
    const nq = layout[5 * k + 3];
    const nw = layout[5 * k + 4];

    let x = 0, y = 0, z = 0, dx = 0, dy = 0, dz = 0;
    for (let j = n; j >= 0; --j) {
      dx = dx * s + x; dy = dy * s + y; dz = dz * s + z;
      x = x * s + c[at + 3 * j]; y = y * s + c[at + 3 * j + 1]; z = z * s + c[at + 3 * j + 2];
    }
    out.px = x; out.py = y; out.pz = z;
    at += 3 * (n + 1);
    if (nv === derived) {
      out.vx = dx; out.vy = dy; out.vz = dz;
    } else {
      x = 0; y = 0; z = 0;
      for (let j = nv; j >= 0; --j) {
        x = x * s + c[at + 3 * j]; y = y * s + c[at + 3 * j + 1]; z = z * s + c[at + 3 * j + 2];
      }
      out.vx = x; out.vy = y; out.vz = z;
      at += 3 * (nv + 1);
    }
    at = this.turn(at, s, rotation, nq, out);
    if (nw !== derived) {
      x = 0; y = 0; z = 0;
      for (let j = nw; j >= 0; --j) {
        x = x * s + c[at + 3 * j]; y = y * s + c[at + 3 * j + 1]; z = z * s + c[at + 3 * j + 2];
      }
      out.wx = x; out.wy = y; out.wz = z;
    }
    return out;
  }

  private turn(at: number, s: number, rotation: number, degree: number, out: State): number {
    const c = this.run.coefficients;
    out.wx = 0; out.wy = 0; out.wz = 0;
    if (rotation === upright) {
      out.qw = 1; out.qx = 0; out.qy = 0; out.qz = 0;
      return at;
    }
    let w = 0, x = 0, y = 0, z = 0;
    for (let j = degree; j >= 0; --j) {
      w = w * s + c[at + 4 * j]; x = x * s + c[at + 4 * j + 1];
      y = y * s + c[at + 4 * j + 2]; z = z * s + c[at + 4 * j + 3];
    }
    at += 4 * (degree + 1);
    if (rotation === constantRate) {
      const rx = c[at], ry = c[at + 1], rz = c[at + 2];
      out.wx = rx; out.wy = ry; out.wz = rz;
      at += 3;
      const rate = Math.hypot(rx, ry, rz);
      if (rate > 0) {
        // exp(r s / 2) q
        const a = Math.cos(0.5 * rate * s);
        const f = Math.sin(0.5 * rate * s) / rate;
        const bx = f * rx, by = f * ry, bz = f * rz;
        const nw = a * w - bx * x - by * y - bz * z;
        const nx = a * x + bx * w + by * z - bz * y;
        const ny = a * y - bx * z + by * w + bz * x;
        const nz = a * z + bx * y - by * x + bz * w;
        w = nw; x = nx; y = ny; z = nz;
      }
    } else if (rotation === polynomial) {
      const f = 1 / Math.hypot(w, x, y, z);
      w *= f; x *= f; y *= f; z *= f;
    }
    out.qw = w; out.qx = x; out.qy = y; out.qz = z;
    return at;
  }
}
