// The time that is shown, and how it goes on.
import { after, before } from "./search";
import type { Run } from "./data";

export class Player {
  time = 0;
  speed = 1;
  playing = false;
  readonly end: number;
  readonly frames: Float64Array;
  /** Instants of the events of all runs, each once. */
  readonly instants: Float64Array;
  private last = 0;

  constructor(runs: Run[], private readonly changed: () => void) {
    this.end = Math.max(...runs.map((run) => run.end));
    this.frames = runs.reduce((longest, run) => (run.end > longest.end ? run : longest)).frames;
    const all = new Float64Array(runs.reduce((n, run) => n + run.events.time.length, 0));
    let at = 0;
    for (const run of runs) {
      all.set(run.events.time, at);
      at += run.events.time.length;
    }
    this.instants = all.sort().filter((t, i) => i === 0 || t !== all[i - 1]);
  }

  seek(t: number): void {
    this.time = Math.min(Math.max(t, 0), this.end);
    this.changed();
  }

  play(on: boolean): void {
    if (on === this.playing) return;
    if (on && this.time >= this.end) this.time = 0;
    this.playing = on;
    this.last = performance.now();
    this.changed();
  }

  /** Call once per displayed picture. */
  tick(now: number): void {
    if (!this.playing) return;
    const passed = Math.min(0.25, Math.max(0, (now - this.last) / 1000));
    this.last = now;
    this.time = Math.min(this.end, this.time + passed * this.speed);
    if (this.time >= this.end) this.playing = false;
    this.changed();
  }

  private go(instants: Float64Array, direction: 1 | -1): void {
    this.playing = false;
    const slack = 1e-12 * (1 + this.time);
    const k = direction > 0 ? after(instants, this.time + slack) : before(instants, this.time - slack);
    if (k >= 0 && k < instants.length) this.time = Math.min(instants[k], this.end);
    this.changed();
  }

  frame(direction: 1 | -1): void { this.go(this.frames, direction); }
  event(direction: 1 | -1): void { this.go(this.instants, direction); }
}
