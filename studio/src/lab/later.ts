// Where everything is by now, so that a run goes on from there with what was changed.
import type { Motions, State } from "../motion";
import { newState } from "../motion";
import type { Run } from "../data";
import { valuesOf } from "./toml_edit";

const stateKeys = ["position", "orientation", "axis_angle", "velocity", "angular_velocity"];

/** What the text says of where a body starts. */
const written = (text: string, line: number) => {
  const values = valuesOf(text, line);
  return stateKeys.map((key) => values.get(key) ?? "").join("|");
};

interface Known { state: State; said: string }

/** The states of the free bodies of one run at a time. */
export class Later {
  private readonly known = new Map<string, Known>();

  constructor(readonly time: number, run: Run, motions: Motions, lines: Map<string, number>, text: string) {
    run.bodies.forEach((body, i) => {
      if (body.moves !== "free") return;
      const state = { ...motions.at(i, time, newState()) };
      this.known.set(body.name, { state, said: written(text, lines.get(body.name) ?? -1) });
    });
  }

  /** The body is elsewhere now, and the text says so. */
  move(name: string, change: (state: State) => void, text: string, line: number): void {
    const known = this.known.get(name);
    if (!known) return;
    change(known.state);
    known.said = written(text, line);
  }

  /** As the engine reads it; a body whose start the text has changed since starts as it says. */
  text(lines: Map<string, number>, text: string): string {
    let out = `${this.time}\n`;
    for (const [name, { state: s, said }] of this.known) {
      const line = lines.get(name);
      if (line === undefined || written(text, line) !== said) continue;
      const numbers = [s.px, s.py, s.pz, s.qw, s.qx, s.qy, s.qz, s.vx, s.vy, s.vz, s.wx, s.wy, s.wz];
      out += `${name}\t${numbers.join(" ")}\n`;
    }
    return out;
  }
}

/** A run that began later than 0, on the clock of the whole. */
export function delayed(run: Run, by: number): Run {
  if (by === 0) return run;
  const shift = (times: Float64Array) => times.map((t) => t + by);
  return {
    ...run, start: shift(run.start), frames: shift(run.frames), events: { ...run.events, time: shift(run.events.time) },
    begin: run.begin + by, end: run.end + by,
  };
}
