// What became of a stroke: told from where bat and ball were, and not from what the method says of it.
import { Quaternion, Vector3 } from "three";
import type { Run } from "../data";
import { Motions, newState } from "../motion";

export type Outcome = "hit" | "passed" | "missed";

export interface Verdict {
  outcome: Outcome;
  /** Of the hit or the passage, s: when the middle of the ball crossed that of the bat. */
  time: number;
  /** Of ball and bat along the bat's normal, m/s. */
  speed: number;
  /** How often the middle of the ball crossed that of the bat, back and forth. */
  crossings: number;
}

/** Looks between two frames. */
const looks = 24;

/** The stroke between `from` and the end of the run. A ball whose middle went from one side of the bat's middle
 *  plane to the other, within its outline, and was not brought back by an impact, has passed. */
export function judge(run: Run, from: number): Verdict {
  const index = (name: string) => run.bodies.findIndex((body) => body.name === name);
  const [bat, ball] = [index("bat"), index("ball")];
  const motions = new Motions(run);
  const [b, p] = [newState(), newState()];
  const at = new Vector3(), turn = new Quaternion(), v = new Vector3();
  const { x: hx, y: hy } = run.bodies[bat].shape;
  /** The ball in the bat's frame. */
  const look = (t: number) => {
    motions.at(bat, t, b);
    motions.at(ball, t, p);
    turn.set(b.qx, b.qy, b.qz, b.qw).invert();
    at.set(p.px - b.px, p.py - b.py, p.pz - b.pz).applyQuaternion(turn);
    v.set(p.vx - b.vx, p.vy - b.vy, p.vz - b.vz).applyQuaternion(turn);
  };
  const { frames } = run;
  let before: { x: number; y: number; z: number } | null = null;
  const crossed: { time: number; speed: number }[] = [];
  for (let f = 0; f + 1 < frames.length; ++f) {
    for (let k = 0; k < looks; ++k) {
      const t = frames[f] + ((frames[f + 1] - frames[f]) * (k + 1)) / looks;
      if (t <= from) continue;
      look(t);
      if (before && before.z < 0 !== at.z < 0) {
        const share = before.z / (before.z - at.z);
        const x = before.x + share * (at.x - before.x), y = before.y + share * (at.y - before.y);
        if (Math.abs(x) <= hx && Math.abs(y) <= hy) crossed.push({ time: t, speed: Math.abs(v.z) });
      }
      before = { x: at.x, y: at.y, z: at.z };
    }
  }
  const crossings = crossed.length;
  const { events } = run;
  const impacts = Array.from(events.time, (time, e) => ({ time, kind: events.kind[e], pair: [events.pair[2 * e], events.pair[2 * e + 1]] }))
    .filter((each) => each.kind === 0 && each.time > from && each.pair.includes(bat) && each.pair.includes(ball));
  // Brought back: an impact between the way there and the way back. A bat that is drawn back brings nothing back.
  const brought = crossings % 2 === 0 && impacts.some(({ time }) => time > crossed[0]?.time && time < crossed[crossings - 1].time);
  if (crossings > 0 && !brought) return { outcome: "passed", ...crossed[0], crossings };
  if (impacts.length > 0) {
    look(impacts[0].time);
    return { outcome: "hit", time: impacts[0].time, speed: Math.abs(v.z), crossings };
  }
  return { outcome: "missed", time: NaN, speed: NaN, crossings };
}
