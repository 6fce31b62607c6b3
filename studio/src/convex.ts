// Distances between convex shapes that are told by their support: boxes, capsules, cylinders, cones, hulls.
import type { Shape } from "./data";
import type { State } from "./motion";

type Point = [number, number, number];

const dot = (a: Point, b: Point) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a: Point, b: Point): Point => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scaled = (a: Point, k: number): Point => [a[0] * k, a[1] * k, a[2] * k];
const cross = (a: Point, b: Point): Point => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** How far the surface is from the core: a ball is a point, a capsule a line, a rounded hull its hull. */
export const marginOf = (shape: Shape): number =>
  shape.kind === "sphere" ? shape.x : shape.kind === "capsule" ? shape.radius! : shape.rounding ?? 0;

/** The point of the core that is farthest along d; both in the body's frame. */
function farthest(shape: Shape, d: Point): Point {
  const aside = Math.hypot(d[0], d[2]);
  const rim = (radius: number, y: number): Point => (aside > 0 ? [(radius * d[0]) / aside, y, (radius * d[2]) / aside] : [0, y, 0]);
  const { radius = 0, length = 0 } = shape;
  switch (shape.kind) {
    case "sphere": return [0, 0, 0];
    case "capsule": return [0, d[1] < 0 ? -length / 2 : length / 2, 0];
    case "cylinder": return rim(radius, d[1] < 0 ? -length / 2 : length / 2);
    case "cone": return d[1] * length > aside * radius ? [0, 0.75 * length, 0] : rim(radius, -0.25 * length);
    case "hull": {
      const points = shape.points!;
      let best = 0, most = -Infinity;
      for (let k = 0; k < points.length; k += 3) {
        const along = points[k] * d[0] + points[k + 1] * d[1] + points[k + 2] * d[2];
        if (along > most) { most = along; best = k; }
      }
      return [points[best], points[best + 1], points[best + 2]];
    }
    default: return [d[0] < 0 ? -shape.x : shape.x, d[1] < 0 ? -shape.y : shape.y, d[2] < 0 ? -shape.z : shape.z];
  }
}

/** v turned by the orientation of a body, or back. */
function turned(s: State, v: Point, back = false): Point {
  const sign = back ? -1 : 1;
  const q: Point = [sign * s.qx, sign * s.qy, sign * s.qz];
  const t = cross(q, v).map((x, k) => x + s.qw * v[k]) as Point;
  const c = cross(q, t);
  return [v[0] + 2 * c[0], v[1] + 2 * c[1], v[2] + 2 * c[2]];
}

/** The point of a body's core that is farthest along d, world frame, from the body's own place. */
export const support = (shape: Shape, at: State, d: Point): Point => turned(at, farthest(shape, turned(at, d, true)));

/** The nearest point to the origin of a simplex, and the corners that it takes: by all its parts, of which there are few. */
function nearest(simplex: Point[]): { v: Point; kept: Point[] } {
  let best: { v: Point; kept: Point[] } = { v: simplex[0], kept: [simplex[0]] };
  let least = Infinity;
  for (let part = 1; part < 1 << simplex.length; ++part) {
    const kept = simplex.filter((_, i) => part & (1 << i));
    const v = inside(kept);
    const size = v ? dot(v, v) : Infinity;
    if (v && size < least) { least = size; best = { v, kept }; }
  }
  return best;
}

/** The nearest point of the plane of 1 to 4 corners, where it lies between them; otherwise null. */
function inside(corners: Point[]): Point | null {
  const [a, b, c, d] = corners;
  if (corners.length === 1) return a;
  const ab = minus(b, a);
  if (corners.length === 2) {
    const t = -dot(a, ab) / dot(ab, ab);
    return t > 0 && t < 1 ? [a[0] + t * ab[0], a[1] + t * ab[1], a[2] + t * ab[2]] : null;
  }
  const ac = minus(c, a);
  const n = cross(ab, ac);
  if (corners.length === 3) {
    const square = dot(n, n);
    const u = dot(cross(minus(b, scaled(n, dot(n, a) / square)), minus(c, scaled(n, dot(n, a) / square))), n);
    const foot = scaled(n, dot(n, a) / square);
    const v = dot(cross(minus(c, foot), minus(a, foot)), n);
    const w = dot(cross(minus(a, foot), minus(b, foot)), n);
    return u > 0 && v > 0 && w > 0 ? foot : null;
  }
  const whole = dot(n, minus(d, a));
  const side = (p: Point, q: Point, r: Point, other: Point) => {
    const m = cross(minus(q, p), minus(r, p));
    return dot(m, minus(other, p)) * -dot(m, p) > 0;
  };
  return whole !== 0 && side(a, b, c, d) && side(a, b, d, c) && side(a, c, d, b) && side(b, c, d, a) ? [0, 0, 0] : null;
}

/** Directions to try where cores overlap: of the corners, edges and faces of a cube. */
const around: Point[] = [-1, 0, 1].flatMap((x) => [-1, 0, 1].flatMap((y) => [-1, 0, 1].map((z): Point => [x, y, z])))
  .filter((d) => dot(d, d) > 0).map((d) => scaled(d, 1 / Math.sqrt(dot(d, d))));

/**
 * The gap between two shapes with cores, m: their distance (Gilbert, Johnson and Keerthi's), less their margins. Where
 * the cores themselves overlap it is the least depth along 54 directions, which is at least the true one.
 */
export function convexGap(a: Shape, sa: State, b: Shape, sb: State): number {
  const between: Point = [sb.px - sa.px, sb.py - sa.py, sb.pz - sa.pz];
  const difference = (d: Point): Point => {
    const far = support(b, sb, d), near = support(a, sa, scaled(d, -1));
    return [between[0] + far[0] - near[0], between[1] + far[1] - near[1], between[2] + far[2] - near[2]];
  };
  const margins = marginOf(a) + marginOf(b);
  let simplex: Point[] = [];
  let v = difference(scaled(between, -1));
  for (let round = 0; round < 64; ++round) {
    const size = dot(v, v);
    const w = difference(scaled(v, -1));
    if (size - dot(v, w) <= 1e-14 * size) return Math.sqrt(size) - margins;
    if (simplex.some((corner) => corner.every((x, k) => x === w[k]))) return Math.sqrt(size) - margins;
    const next = nearest([...simplex, w]);
    if (next.kept.length === 4 || dot(next.v, next.v) < 1e-28 * Math.max(dot(w, w), dot(between, between))) break;
    if (dot(next.v, next.v) >= size && round > 0) return Math.sqrt(size) - margins;
    simplex = next.kept;
    v = next.v;
  }
  let widest = -Infinity;
  for (const s of [sa, sb]) {
    for (const d of around) {
      const n = turned(s, d);
      widest = Math.max(widest, dot(difference(scaled(n, -1)), n));
    }
  }
  return widest - margins;
}
