// The time that is shown, and how it goes on.
import { after, before } from "./search";
import type { Run } from "./data";

export class Player {
  time = 0;
  speed = 1;
  playing = false;
  begin = 0;
  end = 0;
  frames: Float64Array = new Float64Array();
  /** Instants of the events of all runs, each once. */
  instants: Float64Array = new Float64Array();
  private last = 0;

  constructor(runs: Run[], private readonly changed: () => void) {
    this.load(runs);
    this.time = this.begin;
  }

  /** Other runs: time stays where they know it. */
  load(runs: Run[]): void {
    this.begin = Math.min(...runs.map((run) => run.frames[0] ?? 0));
    this.end = Math.max(...runs.map((run) => run.end));
    this.frames = runs.reduce((longest, run) => (run.end > longest.end ? run : longest)).frames;
    const all = new Float64Array(runs.reduce((n, run) => n + run.events.time.length, 0));
    let at = 0;
    for (const run of runs) {
      all.set(run.events.time, at);
      at += run.events.time.length;
    }
    this.instants = all.sort().filter((t, i) => i === 0 || t !== all[i - 1]);
    this.time = Math.min(Math.max(this.time, this.begin), this.end);
  }

  seek(t: number): void {
    this.time = Math.min(Math.max(t, this.begin), this.end);
    this.changed();
  }

  play(on: boolean): void {
    if (on === this.playing) return;
    if (on && this.time >= this.end) this.time = this.begin;
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
