// Signed gaps between shapes: m, negative inside.
import { convexGap, marginOf, support } from "./convex";
import type { Part, Shape } from "./data";
import type { State } from "./motion";

/** Columns of the rotation of a unit quaternion. */
function axes(s: State, out: Float64Array): Float64Array {
  const { qw: w, qx: x, qy: y, qz: z } = s;
  out[0] = 1 - 2 * (y * y + z * z); out[1] = 2 * (x * y + w * z); out[2] = 2 * (x * z - w * y);
  out[3] = 2 * (x * y - w * z); out[4] = 1 - 2 * (x * x + z * z); out[5] = 2 * (y * z + w * x);
  out[6] = 2 * (x * z + w * y); out[7] = 2 * (y * z - w * x); out[8] = 1 - 2 * (x * x + y * y);
  return out;
}

const A = new Float64Array(9);
const B = new Float64Array(9);

export const boundingRadius = (shape: Shape): number =>
  shape.kind === "half-space" ? Infinity
  : shape.kind === "sphere" ? shape.x
  : shape.kind === "capsule" ? shape.radius! + shape.length! / 2
  : shape.kind === "hull" ? Math.sqrt(farthestSquare(shape.points!)) + shape.rounding!
  : Math.hypot(shape.x, shape.y, shape.z);

function farthestSquare(points: number[]): number {
  let most = 0;
  for (let k = 0; k < points.length; k += 3) most = Math.max(most, points[k] ** 2 + points[k + 1] ** 2 + points[k + 2] ** 2);
  return most;
}

const simple = (shape: Shape) => shape.kind === "box" || shape.kind === "sphere";

function sphereBox(r: number, sphere: State, box: Shape, at: State): number {
  axes(at, B);
  const dx = sphere.px - at.px, dy = sphere.py - at.py, dz = sphere.pz - at.pz;
  const u = Math.abs(dx * B[0] + dy * B[1] + dz * B[2]) - box.x;
  const v = Math.abs(dx * B[3] + dy * B[4] + dz * B[5]) - box.y;
  const w = Math.abs(dx * B[6] + dy * B[7] + dz * B[8]) - box.z;
  const outside = Math.hypot(Math.max(u, 0), Math.max(v, 0), Math.max(w, 0));
  return (outside > 0 ? outside : Math.max(u, v, w)) - r;
}

/** The world normal of a half-space. */
export function normalOf(shape: Shape, at: State, out: Float64Array): Float64Array {
  axes(at, A);
  for (let k = 0; k < 3; ++k) out[k] = A[k] * shape.x + A[3 + k] * shape.y + A[6 + k] * shape.z;
  return out;
}

const n = new Float64Array(3);
function halfSpaceGap(plane: Shape, on: State, shape: Shape, at: State): number {
  normalOf(plane, on, n);
  const height = n[0] * (at.px - on.px) + n[1] * (at.py - on.py) + n[2] * (at.pz - on.pz);
  if (shape.kind === "sphere") return height - shape.x;
  if (!simple(shape)) {
    const [x, y, z] = support(shape, at, [-n[0], -n[1], -n[2]]);
    return height + n[0] * x + n[1] * y + n[2] * z - marginOf(shape);
  }
  axes(at, B);
  const reach =
    shape.x * Math.abs(n[0] * B[0] + n[1] * B[1] + n[2] * B[2]) +
    shape.y * Math.abs(n[0] * B[3] + n[1] * B[4] + n[2] * B[5]) +
    shape.z * Math.abs(n[0] * B[6] + n[1] * B[7] + n[2] * B[8]);
  return height - reach;
}

/**
 * Box against box: the widest separation along the 15 axes of the separating axis theorem. Inside
 * it is the depth; outside it is the distance where a face is nearest, and below it elsewhere.
 */
function boxBox(a: Shape, sa: State, b: Shape, sb: State): number {
  axes(sa, A);
  axes(sb, B);
  const ha = [a.x, a.y, a.z], hb = [b.x, b.y, b.z];
  const dx = sb.px - sa.px, dy = sb.py - sa.py, dz = sb.pz - sa.pz;
  let widest = -Infinity;
  const along = (x: number, y: number, z: number) => {
    const length = Math.hypot(x, y, z);
    if (length < 1e-6) return; // parallel edges: the faces' axes tell
    let gap = Math.abs(dx * x + dy * y + dz * z);
    for (let k = 0; k < 3; ++k) {
      gap -= ha[k] * Math.abs(A[3 * k] * x + A[3 * k + 1] * y + A[3 * k + 2] * z);
      gap -= hb[k] * Math.abs(B[3 * k] * x + B[3 * k + 1] * y + B[3 * k + 2] * z);
    }
    widest = Math.max(widest, gap / length);
  };
  for (let k = 0; k < 9; k += 3) {
    along(A[k], A[k + 1], A[k + 2]);
    along(B[k], B[k + 1], B[k + 2]);
  }
  for (let i = 0; i < 9; i += 3) {
    for (let j = 0; j < 9; j += 3) {
      along(
        A[i + 1] * B[j + 2] - A[i + 2] * B[j + 1],
        A[i + 2] * B[j] - A[i] * B[j + 2],
        A[i] * B[j + 1] - A[i + 1] * B[j],
      );
    }
  }
  return widest;
}

/** Where a part of a body is, whose own place is `at`. */
function placed({ place, turn }: Part, at: State): State {
  axes(at, A);
  const { qw: w, qx: x, qy: y, qz: z } = at;
  return {
    ...at,
    px: at.px + A[0] * place.x + A[3] * place.y + A[6] * place.z,
    py: at.py + A[1] * place.x + A[4] * place.y + A[7] * place.z,
    pz: at.pz + A[2] * place.x + A[5] * place.y + A[8] * place.z,
    qw: w * turn.w - x * turn.x - y * turn.y - z * turn.z,
    qx: w * turn.x + x * turn.w + y * turn.z - z * turn.y,
    qy: w * turn.y - x * turn.z + y * turn.w + z * turn.x,
    qz: w * turn.z + x * turn.y - y * turn.x + z * turn.w,
  };
}

/** The gap between two shapes; two half-spaces have none, and of a mesh the page knows none. */
export function gap(a: Shape, sa: State, b: Shape, sb: State): number {
  if (a.kind === "mesh" || b.kind === "mesh") return Infinity;
  if (a.parts) return Math.min(...a.parts.map((part) => gap(part.shape, placed(part, sa), b, sb)));
  if (b.parts) return gap(b, sb, a, sa);
  if (a.kind === "half-space") return b.kind === "half-space" ? Infinity : halfSpaceGap(a, sa, b, sb);
  if (b.kind === "half-space") return halfSpaceGap(b, sb, a, sa);
  if (!simple(a) || !simple(b)) return convexGap(a, sa, b, sb);
  if (a.kind === "sphere") {
    return b.kind === "sphere"
      ? Math.hypot(sb.px - sa.px, sb.py - sa.py, sb.pz - sa.pz) - a.x - b.x
      : sphereBox(a.x, sa, b, sb);
  }
  return b.kind === "sphere" ? sphereBox(b.x, sb, a, sa) : boxBox(a, sa, b, sb);
}
