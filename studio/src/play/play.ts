// Table tennis with the pointer: reads the bat, lets both methods run up to it, counts what passes.
import { Vector3 } from "three";
import type { Run } from "../data";
import { save } from "../export";
import { newState } from "../motion";
import { box, element, list, type Viewer } from "../viewer";
import type { EngineClient } from "../lab/client";
import type { Task } from "../lab/protocol";
import { delayed } from "../lab/later";
import { Grip } from "./grip";
import { judge, type Verdict } from "./verdict";
import { Rally, type Files } from "./rally";
import { comes, faceAt, machineTakes } from "./table";

/** What was played: each stroke under both methods, and the scene that it is. */
export interface Stroke { number: number; verdicts: Verdict[]; runs: Run[]; files: Files }

const methods = [
  "scheme=event-driven\nintegrator=auto\ndetector=certified\nimpact=newton",
  "scheme=original\nintegrator=thesis-euler\ndetector=sat\nimpact=thesis",
];
export const names = ["event-driven", "original"];
const original = "original + thesis-euler + sat + thesis";
const folder = "/scenes/";
const frame = 1 / 60;
/** Kept for a look in slow motion. */
const mostReplays = 30;

export interface Host {
  client: EngineClient;
  viewer: Viewer;
  /** The rally as a scene in the studio. */
  open(text: string, path: string): void;
}

export class Play {
  rally!: Rally;
  strokes: Stroke[] = [];
  paused = false;
  readonly grip: Grip;
  /** ms from the reading of the pointer to the picture that shows it, and of computing. */
  readonly latency: number[] = [];
  private on = false;
  private waiting = false;
  private last = 0;
  private due = 0;
  /** The stretch of time that is shown again and again, s. */
  private loopFrom = 0;
  private loopTo = Infinity;
  private replaying: Stroke | null = null;
  private shown: Run[] = [];

  constructor(private readonly host: Host) {
    this.grip = new Grip(host.viewer.stage, () => this.on && this.replaying === null, {
      serve: () => this.serve(), pause: () => this.pause(!this.paused),
    });
    const click = (id: string, act: () => void) => element(id).addEventListener("click", act);
    click("play-serve", () => this.serve());
    click("play-swing", () => this.grip.swing());
    click("play-pause", () => this.pause(!this.paused));
    click("play-new", () => this.begin());
    click("play-back", () => this.resume());
    click("play-save", () => this.saveFiles());
    click("play-open", () => this.openScene());
    for (const id of ["play-threshold", "play-scale", "play-nudge"]) element(id).addEventListener("change", () => this.begin());
    requestAnimationFrame(this.loop);
  }

  enter(): void {
    this.on = true;
    document.body.classList.add("live");
    list("trail").value = "0.25";
    this.begin();
    element("canvas").focus({ preventScroll: true });
  }

  leave(): void {
    this.on = false;
    this.replaying = null;
    document.body.classList.remove("live");
    this.host.viewer.stage.controls.enabled = true;
  }

  private number(id: string, fallback: number): number {
    const value = Number(box(id).value);
    return box(id).value.trim() !== "" && Number.isFinite(value) && value >= 0 ? value : fallback;
  }

  /** A new rally; nothing of the old one stays. */
  begin(): void {
    this.grip.rest();
    this.rally = new Rally(
      { threshold: this.number("play-threshold", 0.01), scale: this.number("play-scale", 1), nudge: this.number("play-nudge", 0.0025) },
      { p: this.grip.position(0), q: faceAt(0, this.grip.lift) });
    this.strokes = [];
    this.showCounts();
    this.say("Serve, or click into the view: the hand tosses the ball up. When it falls, flick the pointer or the finger up.");
    this.resume();
  }

  private resume(): void {
    this.replaying = null;
    this.loopTo = Infinity;
    this.host.viewer.player.play(false);
    document.body.classList.add("live");
    element("play-back").hidden = true;
    const { stage } = this.host.viewer;
    stage.lookAt(new Vector3(0, 1.5, 3.75), new Vector3(0, 0.98, 0));
    stage.controls.enabled = false;
    this.pause(false);
  }

  pause(on: boolean): void {
    this.paused = on;
    this.last = performance.now();
    element("play-pause").textContent = on ? "Go on" : "Pause";
    element("play-pause").setAttribute("aria-pressed", String(on));
  }

  serve(): void {
    if (this.replaying) return;
    if (this.paused) this.pause(false);
    this.rally.serve();
  }

  private readonly loop = (now: number): void => {
    requestAnimationFrame(this.loop);
    if (!this.on) return;
    const { player } = this.host.viewer;
    if (this.replaying && player.playing && player.time > this.loopTo) player.seek(this.loopFrom);
    if (this.paused || this.waiting || this.replaying) return;
    const dt = this.step(now);
    if (dt > 0) void this.advance(dt);
  };

  /** How much time goes on now, s; 0: not yet. The world rather slows down than runs ahead of its engine. */
  private step(now: number): number {
    const passed = Math.min(0.1, (now - this.last) / 1000) * Number(list("play-pace").value);
    this.last = now;
    if (list("play-frame").value === "drawn") return Math.max(passed, 1e-3);
    this.due = Math.min(this.due + passed, 2 * frame);
    // A display's 60th of a second is not exactly one.
    if (this.due < 0.9 * frame) return 0;
    this.due -= frame;
    return frame;
  }

  private async advance(dt: number): Promise<void> {
    const { rally, grip } = this;
    // Nothing is asked of a point that has not begun to be played.
    if (rally.released === Infinity && rally.time - rally.began > 0.5) rally.point(rally.kind);
    const read = grip.readAt();
    const p = grip.position(dt);
    rally.sample(dt, p, faceAt(p.x, grip.lift));
    this.waiting = true;
    const outcome = await this.host.client.run(this.tasks());
    this.waiting = false;
    if (!outcome || rally !== this.rally || !this.on || this.replaying) return;
    const wrong = outcome.errors.find((error) => error !== null);
    if (wrong) {
      this.say(`The engine refuses: ${wrong.reason}`);
      return this.pause(true);
    }
    const [whole, stroke] = outcome.runs;
    // Before the stroke there is one ball.
    this.shown = [whole, stroke ? delayed(stroke, rally.met - rally.began) : { ...whole, method: original }];
    this.host.viewer.live(this.shown);
    requestAnimationFrame(() => this.measure(performance.now() - read, outcome.answers.map((answer) => answer.milliseconds)));
    this.referee();
  }

  private tasks(): Task[] {
    const { rally } = this;
    const task = (name: string, files: Files, settings: string): Task => {
      this.put(name, files);
      return { scene: files.scene, path: `${folder}${name}.toml`, settings, start: "", seconds: 5 };
    };
    const whole = task("point", rally.pointFiles("point", 0), methods[0]);
    return rally.met >= rally.time ? [whole] : [whole, task("stroke", rally.strokeFiles("stroke", rally.options.nudge), methods[1])];
  }

  private put(name: string, files: Files): void {
    this.host.client.addFile(`${folder}${name}-bat.csv`, files.bat);
    this.host.client.addFile(`${folder}${name}-hand.csv`, files.hand);
    this.host.client.addFile(`${folder}${name}-frames.csv`, files.frames);
  }

  /** Whether the point is over, and what the machine does then. */
  private referee(): void {
    const { rally } = this;
    const [run] = this.shown;
    const flying = rally.time - rally.released;
    if (!(flying > 0.05)) return;
    const at = this.host.viewer.worlds[0].motions.at(run.bodies.findIndex((body) => body.name === "ball"), run.end, newState());
    if (rally.met === Infinity && comes(rally.kind, at)) rally.meet({ p: [at.px, at.py, at.pz], v: [at.vx, at.vy, at.vz] });
    const taken = at.pz < machineTakes;
    const lost = at.py < 0.06 || at.pz > 2.7 || Math.abs(at.px) > 2 || flying > 2.2 || this.shown.some((each) => each.reason !== "");
    if (!taken && !lost) return;
    if (flying < 0.15) return;
    this.count(taken);
    rally.point("return");
  }

  private count(taken: boolean): void {
    const verdicts = this.shown.map((run) => judge(run, this.rally.met - this.rally.began));
    const met = verdicts.some(({ outcome }) => outcome !== "missed");
    const stopped = this.shown.map((run, i) => (run.reason === "" ? "" : ` ${names[i]} stopped: ${run.reason}.`)).join("");
    if (!met) return this.say(`The ball was not met.${stopped} The machine throws another.`);
    const stroke = { number: this.strokes.length + 1, verdicts, runs: this.shown, files: this.rally.strokeFiles("stroke", 0) };
    this.strokes.push(stroke);
    // Old pictures make room; their counts stay.
    const kept = this.strokes.filter((each) => each.runs.length > 0);
    if (kept.length > mostReplays) kept[0].runs = [];
    const told = verdicts.map(({ outcome, speed }, i) => `${names[i]} ${outcome}${outcome === "missed" ? "" : ` at ${speed.toFixed(1)} m/s`}`);
    this.say(`Stroke ${stroke.number}: ${told.join("; ")}.${taken ? "" : " The ball is lost; the machine throws another."}${stopped}`);
    this.showCounts();
  }

  counts(): Record<string, { met: number; passed: number }> {
    return Object.fromEntries(names.map((name, i) => {
      const of = this.strokes.map((stroke) => stroke.verdicts[i].outcome);
      return [name, { met: of.filter((o) => o !== "missed").length, passed: of.filter((o) => o === "passed").length }];
    }));
  }

  private showCounts(): void {
    const counts = this.counts();
    names.forEach((name, i) => {
      element(`play-met-${i}`).textContent = String(counts[name].met);
      element(`play-passed-${i}`).textContent = String(counts[name].passed);
    });
    element("play-replays").replaceChildren(...this.strokes.flatMap((stroke) => {
      if (stroke.runs.length === 0) return [];
      return stroke.verdicts.flatMap((verdict, i) => (verdict.outcome === "passed" ? [this.replayButton(stroke, i)] : []));
    }));
    element("play-none").hidden = element("play-replays").childElementCount > 0;
  }

  private replayButton(stroke: Stroke, i: number): HTMLLIElement {
    const item = document.createElement("li");
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = `Stroke ${stroke.number}: ${names[i]}, ${stroke.verdicts[i].speed.toFixed(1)} m/s`;
    button.addEventListener("click", () => this.replay(stroke, i));
    item.append(button);
    return item;
  }

  /** The moment of a passage, a twentieth as fast, from beside the bat. */
  replay(stroke: Stroke, i: number): void {
    const { viewer } = this.host;
    this.pause(true);
    this.replaying = stroke;
    document.body.classList.remove("live");
    element("play-back").hidden = false;
    viewer.replace(stroke.runs, false);
    const { time } = stroke.verdicts[i];
    const bat = viewer.worlds[i].motions.at(stroke.runs[i].bodies.findIndex((body) => body.name === "bat"), time, newState());
    const at = new Vector3(bat.px, bat.py, bat.pz);
    viewer.stage.controls.enabled = true;
    viewer.stage.lookAt(at.clone().add(new Vector3(0.95, 0.25, 0.35)), at);
    viewer.setSpeed(0.05);
    this.loopFrom = time - 0.06;
    this.loopTo = time + 0.03;
    viewer.player.seek(this.loopFrom);
    viewer.player.play(true);
    this.say(`Stroke ${stroke.number}, twenty times slower, again and again (Space stops it): ${names[i]} let the ball through at ${stroke.verdicts[i].speed.toFixed(1)} m/s; a frame brought them ${(100 * stroke.verdicts[i].speed * frame).toFixed(0)} cm nearer, and bat and ball are 5.5 cm thick.`);
  }

  private measure(latency: number, computing: number[]): void {
    this.latency.push(latency);
    if (this.latency.length > 60) this.latency.shift();
    if (this.rally.count % 15 !== 0) return;
    const mean = this.latency.reduce((sum, each) => sum + each, 0) / this.latency.length;
    element("play-latency").textContent = `What you see is ${mean.toFixed(0)} ms behind the pointer; the last frame took ${computing.map((ms) => ms.toFixed(1)).join(" and ")} ms to compute.`;
  }

  private say(text: string): void { element("play-said").textContent = text; }

  private saveFiles(): void {
    const { name, files } = this.chosen();
    const text = (content: string, type: string, name: string) => save(new Blob([content], { type }), name);
    text(files.scene, "application/toml", `${name}.toml`);
    text(files.bat, "text/csv", `${name}-bat.csv`);
    if (!this.replaying) text(files.hand, "text/csv", `${name}-hand.csv`);
    text(files.frames, "text/csv", `${name}-frames.csv`);
    this.say(`Saved. For the program: kairos run ${name}.toml; or kairos run ${name}.toml --thesis --set body.bat.nudge=${this.rally.options.nudge}`);
  }

  private openScene(): void {
    const { name, files } = this.chosen();
    this.put(name, files);
    this.host.open(files.scene, `${folder}${name}.toml`);
  }

  /** The stroke that is looked at; else all that was played. */
  private chosen(): { name: string; files: Files } {
    return this.replaying ? { name: "stroke", files: this.replaying.files } : { name: "rally", files: this.rally.allFiles("rally", 0) };
  }
}
