// Belts: dashes that run along a surface as fast as it does.
import { Color, Quaternion, Vector3 } from "three";
import type { Body } from "./data";
import { FatLines } from "./fat";
import type { State } from "./motion";

const dashes = 40;
const linesOfABody = 5;

export class Belts {
  readonly lines: FatLines;
  private readonly bodies: number[];

  constructor(private readonly all: Body[], private readonly size: number, private readonly colour: Color) {
    this.bodies = all.map((_, i) => i).filter((i) => all[i].belt !== undefined);
    this.lines = new FatLines(Math.max(1, this.bodies.length * linesOfABody * (dashes + 1)), 3);
  }

  /** `middle`: of what is seen, world frame; a belt without an end is shown around it. */
  show(t: number, states: State[], middle: Vector3, origin: Vector3, background: Color): void {
    this.lines.clear();
    for (const i of this.bodies) {
      const { shape } = this.all[i];
      const belt = new Vector3(this.all[i].belt!.x, this.all[i].belt!.y, this.all[i].belt!.z);
      const speed = belt.length();
      const along = belt.divideScalar(speed);
      const at = states[i];
      const q = new Quaternion(at.qx, at.qy, at.qz, at.qw);
      const place = new Vector3(at.px, at.py, at.pz);
      const seen = middle.clone().sub(place).applyQuaternion(q.clone().invert());
      const endless = shape.kind === "half-space";
      const n = endless ? new Vector3(shape.x, shape.y, shape.z) : new Vector3();
      const half = endless ? 1.5 * this.size : Math.abs(along.x * shape.x) + Math.abs(along.y * shape.y) + Math.abs(along.z * shape.z);
      // Dashes go with the belt: what leaves at one end comes in at the other.
      const step = Math.max((2 * half) / dashes, 0.12 * this.size);
      const phase = (speed * t) % step;
      const line = (aside: Vector3) => {
        for (let x = -half + phase - step; x < half; x += step) {
          const [from, to] = [Math.max(x, -half), Math.min(x + 0.45 * step, half)];
          if (to <= from) continue;
          const [a, b] = [from, to].map((s) => aside.clone().addScaledVector(along, s).applyQuaternion(q).add(place).sub(origin));
          this.lines.add(a.x, a.y, a.z, b.x, b.y, b.z, this.colour, background, 0.75);
        }
      };
      if (endless) {
        for (const k of [-1, 0, 1]) {
          const across = n.clone().cross(along).multiplyScalar(0.5 * k * this.size);
          line(across.add(seen.clone().addScaledVector(n, -seen.dot(n)).addScaledVector(along, -seen.dot(along))).addScaledVector(n, 1e-3 * this.size));
        }
        continue;
      }
      const [one, other] = [new Vector3(shape.x, 0, 0), new Vector3(0, shape.y, 0), new Vector3(0, 0, shape.z)]
        .filter((v) => Math.abs(v.clone().normalize().dot(along)) < 0.9);
      for (const a of [-1, 1]) for (const b of [-1, 1]) line(one.clone().multiplyScalar(a * 1.002).addScaledVector(other, b * 1.002));
    }
    this.lines.commit();
  }
}
