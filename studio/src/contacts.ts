// Which solids are inside each other at an instant, and how near a body is to the others.
import type { Run } from "./data";
import { boundingRadius, gap } from "./gap";
import { Motions, newState, type State } from "./motion";

export interface Overlap {
  a: number;
  b: number;
  /** m, > 0. */
  depth: number;
}

/** What rounding makes of touching, as a share of the coordinates. */
const touching = 1e-9;

/** Solids meet where at least one can move; a hand holds what it touches. */
function meet(run: Run, a: number, b: number): boolean {
  const x = run.bodies[a], y = run.bodies[b];
  return (
    !x.field && !y.field && (x.moves === "free" || y.moves === "free") &&
    x.entity !== "hand" && y.entity !== "hand"
  );
}

export class Contacts {
  private readonly radius: Float64Array;
  private readonly order: number[];
  private readonly planes: number[];
  /** Pairs that a joint holds together, and that do not meet as solids. */
  private readonly held: Set<number>;

  constructor(private readonly run: Run) {
    this.radius = Float64Array.from(run.bodies, (body) => boundingRadius(body.collides));
    const count = run.bodies.length;
    this.held = new Set(run.joints.filter((joint) => !joint.collide && joint.a.body >= 0 && joint.b.body >= 0)
      .flatMap(({ a, b }) => [a.body * count + b.body, b.body * count + a.body]));
    const solids = run.bodies.map((_, i) => i).filter((i) => !run.bodies[i].field);
    this.order = solids.filter((i) => Number.isFinite(this.radius[i]));
    this.planes = solids.filter((i) => !Number.isFinite(this.radius[i]));
  }

  private meets(a: number, b: number): boolean {
    return meet(this.run, a, b) && !this.held.has(a * this.run.bodies.length + b);
  }

  /** All that overlap, by sweep and prune along x; `states` by body. */
  overlaps(states: State[]): Overlap[] {
    const { run, radius, order } = this;
    const left = (i: number) => states[i].px - radius[i];
    // Nearly sorted already: insertion.
    for (let k = 1; k < order.length; ++k) {
      const body = order[k];
      const x = left(body);
      let at = k;
      for (; at > 0 && left(order[at - 1]) > x; --at) order[at] = order[at - 1];
      order[at] = body;
    }
    const found: Overlap[] = [];
    const test = (a: number, b: number) => {
      if (!this.meets(a, b)) return;
      const depth = -gap(run.bodies[a].collides, states[a], run.bodies[b].collides, states[b]);
      const s = states[a];
      const scale = 1 + Math.abs(s.px) + Math.abs(s.py) + Math.abs(s.pz);
      if (depth > touching * scale) found.push({ a, b, depth });
    };
    for (let k = 0; k < order.length; ++k) {
      const right = states[order[k]].px + radius[order[k]];
      for (let n = k + 1; n < order.length && left(order[n]) <= right; ++n) test(order[k], order[n]);
      for (const plane of this.planes) test(order[k], plane);
    }
    return found.sort((x, y) => y.depth - x.depth);
  }

  private readonly own = newState();
  private readonly other = newState();

  /** The gap of body i at t to `to`, or to the nearest solid where `to` is -1. */
  gapAt(motions: Motions, i: number, t: number, to: number): number {
    const { run, radius } = this;
    motions.at(i, t, this.own);
    let least = Infinity;
    const look = (k: number) => {
      const s = motions.at(k, t, this.other);
      const far = Math.hypot(s.px - this.own.px, s.py - this.own.py, s.pz - this.own.pz);
      if (far - radius[i] - radius[k] < least || !Number.isFinite(radius[k])) {
        least = Math.min(least, gap(run.bodies[i].collides, this.own, run.bodies[k].collides, s));
      }
    };
    if (to >= 0) {
      look(to);
    } else {
      for (let k = 0; k < run.bodies.length; ++k) {
        if (k !== i && this.meets(i, k)) look(k);
      }
    }
    return least;
  }
}
