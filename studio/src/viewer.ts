// The viewer: binds the views, time, plots and keys of some runs together.
import { Vector3 } from "three";
import { boundingRadius } from "./gap";
import { bindKeys } from "./keys";
import type { Run } from "./data";
import { Film, compose, filmType, save, type Caption } from "./export";
import { number, seconds } from "./format";
import { newState } from "./motion";
import { palette, type Palette } from "./palette";
import { pause } from "./pause";
import { Player } from "./player";
import { Plots } from "./plots";
import { Stage } from "./stage";
import { statusAt } from "./status";
import { Timeline } from "./timeline";
import { World, type Look } from "./world";

export const element = <T extends HTMLElement>(id: string): T => {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no ${id}`);
  return found as T;
};
export const box = (id: string) => element<HTMLInputElement>(id);
export const list = (id: string) => element<HTMLSelectElement>(id);

export function option(value: string, text: string): HTMLOptionElement {
  const made = document.createElement("option");
  made.value = value;
  made.textContent = text;
  return made;
}

const views = {
  fit: new Vector3(0.35, 0.32, 1), front: new Vector3(0, 0.02, 1), side: new Vector3(1, 0.02, 0), top: new Vector3(0, 1, 0.001),
};

export class Viewer {
  readonly player: Player;
  readonly plots: Plots;
  /** Somebody chose a body. */
  chosen: (body: number) => void = () => undefined;
  private readonly timeline: Timeline;
  /** Worlds that are shown no more; what they hold on the graphics card serves until others are drawn. */
  private past: World[] = [];
  private dirty = true;
  body: number;
  private film: Film | null = null;
  private readonly composed = document.createElement("canvas");
  private said = "";
  private listed = "";

  /** Piece by piece, so that the page is never blocked for long. */
  static async open(runs: Run[]): Promise<Viewer> {
    const colour = palette(matchMedia("(prefers-color-scheme: dark)").matches);
    const worlds: World[] = [];
    for (const run of runs) {
      worlds.push(new World(run, colour));
      await pause();
    }
    const stage = new Stage(element<HTMLCanvasElement>("canvas"), worlds);
    await pause();
    const viewer = new Viewer(runs, worlds, stage, colour);
    await pause();
    await stage.prepare(viewer.player.time, viewer.look, viewer.body);
    requestAnimationFrame(viewer.loop);
    return viewer;
  }

  private constructor(public runs: Run[], public worlds: World[], readonly stage: Stage, private readonly colour: Palette) {
    const changed = () => { this.dirty = true; };
    this.player = new Player(runs, changed);
    stage.changed = changed;
    this.timeline = new Timeline(element<HTMLCanvasElement>("ticks"), box("scrubber"), this.player, this.colour);
    this.plots = new Plots(element("plots"), this.worlds, this.player.end, this.colour,
      (t) => this.player.seek(t), (whole) => this.markRange(whole));
    this.plots.begin = this.player.begin;
    this.body = Math.max(0, runs[0].bodies.findIndex((body) => body.moves === "free"));
    this.texts();
    this.bind();
    this.choose(this.body);
    new ResizeObserver(() => { this.dirty = true; }).observe(element("view"));
    let width = window.innerWidth;
    window.addEventListener("resize", () => {
      if (width === window.innerWidth) return; // a phone's bars come and go
      width = window.innerWidth;
      this.timeline.draw();
      this.drawPlots();
    });
    this.timeline.draw();
    this.stage.fit();
  }

  /** Other runs in the place of these: time, view, and the body that is looked at stay. */
  replace(runs: Run[], refit: boolean): void {
    const name = this.runs[0].bodies[this.body]?.name;
    this.past.push(...this.worlds);
    this.runs = runs;
    this.worlds = runs.map((run) => new World(run, this.colour));
    this.player.load(runs);
    this.stage.load(this.worlds);
    this.plots.load(this.worlds, this.player.begin, this.player.end);
    this.timeline.draw();
    this.texts();
    const { bodies } = runs[0];
    const same = bodies.findIndex((body) => body.name === name);
    this.placed = "";
    if (refit) {
      box("follow").checked = false;
      this.stage.follow(-1);
      this.stage.fit();
    }
    this.choose(same >= 0 ? same : Math.max(0, bodies.findIndex((body) => body.moves === "free")));
  }

  /** What is known by now of runs that go on, at their end. */
  live(runs: Run[]): void {
    const same = runs.length === this.runs.length && runs.every((run, i) => run.method === this.runs[i].method &&
      run.bodies.length === this.runs[i].bodies.length && run.bodies.every((body, k) => body.name === this.runs[i].bodies[k].name));
    if (!same) this.replace(runs, false);
    this.runs = runs;
    this.worlds.forEach((world, i) => world.renew(runs[i]));
    this.player.load(runs);
    this.player.seek(this.player.end);
  }

  private texts(): void {
    const [run] = this.runs;
    document.title = `${run.title} – kairos`;
    element("title").textContent = run.title;
    element("summary").textContent = run.summary;
    const stops = this.runs.filter((each) => each.reason !== "");
    element("problem").hidden = stops.length === 0;
    element("problem-text").textContent = stops
      .map((each) => `${each.method}: stopped at ${seconds(each.end)}: ${each.reason}`).join(" — ");
    const notes = this.runs.filter((each) => each.note !== "").map((each) => `${each.method}: ${each.note}.`);
    element("notes").textContent = [...notes, "SI units; y is up."].join(" ");
    this.listBodies(run.bodies.map((body) => body.name));
    if (filmType() === "") {
      element<HTMLButtonElement>("film").disabled = true;
      element("film").title = "This browser records no films";
    }
    const present = (id: string, there: boolean) => {
      const label = box(id).closest("label");
      if (label) label.hidden = !there;
    };
    present("fields", run.bodies.some((body) => body.field));
    const keys = {
      field: run.bodies.some((body) => body.field), driven: run.bodies.some((body) => body.moves === "driven"),
      joint: run.joints.length > 0, belt: run.bodies.some((body) => body.belt !== undefined),
    };
    for (const [key, there] of Object.entries(keys)) document.querySelector<HTMLElement>(`.key.${key}`)!.hidden = !there;
  }

  /** The lists to choose a body from; a choice stays while the bodies do. */
  private listBodies(names: string[]): void {
    const now = names.join("\n");
    if (now === this.listed) return;
    this.listed = now;
    const options = () => names.map((name, i) => option(String(i), name));
    list("body").replaceChildren(...options());
    list("other").replaceChildren(option("-1", "nearest"), ...options());
  }

  private bind(): void {
    const { player, stage } = this;
    const click = (id: string, act: () => void) => element(id).addEventListener("click", act);
    click("play", () => player.play(!player.playing));
    click("frame-back", () => player.frame(-1));
    click("frame-on", () => player.frame(1));
    click("event-back", () => player.event(-1));
    click("event-on", () => player.event(1));
    for (const [id, direction] of Object.entries(views)) click(id, () => stage.fit(direction));
    click("problem-show", () => this.showProblem());
    click("picture", () => this.picture());
    click("film", () => void this.toggleFilm());
    for (const id of ["trail", "boxes", "fields", "inside", "impacts", "drawn"]) {
      element(id).addEventListener("change", () => { this.dirty = true; });
    }
    list("body").addEventListener("change", () => this.choose(Number(list("body").value)));
    list("other").addEventListener("change", () => this.drawPlots());
    box("follow").addEventListener("change", () => this.follow());
    list("range").addEventListener("change", () => this.setRange());
    box("speed").addEventListener("change", () => this.setSpeed(Number(box("speed").value)));
    this.bindPicking();
    bindKeys({
      player, stage, setSpeed: (factor) => this.setSpeed(player.speed * factor),
      toggle: (id) => box(id).click(),
      nextBody: (step) => this.choose((this.body + step + this.runs[0].bodies.length) % this.runs[0].bodies.length),
      nextTrail: () => {
        const trail = list("trail");
        trail.selectedIndex = (trail.selectedIndex + 1) % trail.options.length;
        this.dirty = true;
      },
      view: (name) => stage.fit(views[name]),
    });
  }

  /** Where a run stopped: at its end, near the first body that its reason names, those that move before others. */
  private showProblem(): void {
    const i = this.runs.findIndex((run) => run.reason !== "");
    const run = this.runs[i];
    const named = run.bodies.map((body, k) => ({ body, k, at: run.reason.indexOf(`'${body.name}'`) })).filter(({ at }) => at >= 0)
      .sort((a, b) => Number(b.body.moves === "free") - Number(a.body.moves === "free") || a.at - b.at);
    this.player.play(false);
    this.player.seek(run.end);
    if (named.length > 0) {
      const [{ k, body }] = named;
      this.choose(k);
      const state = this.worlds[i].motions.at(k, run.end, newState());
      const at = new Vector3(state.px, state.py, state.pz);
      box("follow").checked = false;
      this.stage.follow(-1);
      this.stage.lookAt(views.fit.clone().setLength(8 * boundingRadius(body.shape)).add(at), at);
    }
    element("canvas").focus({ preventScroll: true });
    this.dirty = true;
  }

  private bindPicking(): void {
    const canvas = this.stage.canvas;
    let down = { x: 0, y: 0 };
    canvas.addEventListener("pointerdown", (event) => { down = { x: event.offsetX, y: event.offsetY }; });
    canvas.addEventListener("click", (event) => {
      if (Math.hypot(event.offsetX - down.x, event.offsetY - down.y) > 4) return;
      const body = this.stage.pick(event.offsetX, event.offsetY);
      if (body >= 0) this.choose(body);
    });
  }

  choose(body: number): void {
    this.body = body;
    this.chosen(body);
    list("body").value = String(body);
    if (list("other").value === String(body)) list("other").value = "-1";
    this.drawPlots();
    this.dirty = true;
  }

  private drawPlots(): void {
    this.plots.draw(this.body, Number(list("other").value));
    this.dirty = true;
  }

  private follow(): void {
    this.stage.follow(box("follow").checked ? this.body : -1);
    this.dirty = true;
  }

  setSpeed(speed: number): void {
    const allowed = Number.isFinite(speed) && speed > 0 ? Math.min(1000, Math.max(1e-4, speed)) : 1;
    this.player.speed = Number(allowed.toPrecision(4));
    box("speed").value = String(this.player.speed);
  }

  private setRange(): void {
    const value = list("range").value;
    const half = Number(value) / 2;
    const t = this.player.time;
    if (value === "all") this.plots.setRange(NaN, NaN);
    else if (value !== "zoom") this.plots.setRange(t - half, t + half);
    if (value !== "zoom") list("range").value = value;
    this.dirty = true;
  }

  /** Shows again what may have changed. */
  touch(): void { this.dirty = true; }

  private markRange(whole: boolean): void {
    list("range").value = whole ? "all" : "zoom";
    this.dirty = true;
  }

  private get look(): Look {
    return {
      boxes: box("boxes").checked, fields: box("fields").checked, inside: box("inside").checked,
      impacts: box("impacts").checked, trail: Number(list("trail").value),
    };
  }

  /** The time that is shown: that of the last drawn frame where only those are wanted. */
  private shown(): number {
    const { time, frames } = this.player;
    return box("drawn").checked ? frames[this.worlds[0].frameAt(time)] ?? time : time;
  }

  private readonly loop = (now: number): void => {
    requestAnimationFrame(this.loop);
    this.player.tick(now);
    if (!this.dirty) return;
    this.dirty = false;
    this.draw();
  };

  draw(): void {
    const { player } = this;
    const t = this.shown();
    this.stage.draw(t, this.look, this.body);
    this.past.splice(0).forEach((world) => world.dispose());
    this.timeline.at(player.time);
    this.plots.at(player.time);
    this.writeClock(t);
    this.placeLabels();
    if (this.film) {
      compose(this.stage.canvas, this.captions(), this.colour.text, this.composed);
      if (!player.playing) void this.toggleFilm();
    }
  }

  private writeClock(t: number): void {
    const { player } = this;
    const frame = this.worlds[0].frameAt(player.time);
    const text = `${seconds(t)} of ${number(player.end)} s, frame ${frame}`;
    element("clock").textContent = text;
    box("scrubber").setAttribute("aria-valuetext", text);
    const play = element("play");
    play.classList.toggle("on", player.playing);
    play.setAttribute("aria-label", player.playing ? "Pause" : "Play");
    const say = statusAt(this.worlds, player.time, player.playing);
    if (say !== this.said) element("status").textContent = this.said = say;
  }

  private captions(): Caption[] {
    return this.stage.views().map((view, i) => ({
      x: view.x + 11, y: view.y + 8, text: `${this.name(i)}   t = ${seconds(this.shown())}`,
    }));
  }

  private name(i: number): string {
    return this.runs.length > 1 ? `${"AB"[i]}: ${this.runs[i].method}` : this.runs[i].method;
  }

  private placed = "";
  private placeLabels(): void {
    const rects = this.stage.views();
    const now = JSON.stringify(rects);
    if (now === this.placed) return;
    this.placed = now;
    element("labels").replaceChildren(...rects.flatMap((view, i) => {
      const label = document.createElement("div");
      label.textContent = this.name(i);
      Object.assign(label.style, { left: `${view.x}px`, top: `${view.y}px`, maxWidth: `${view.width}px` });
      if (i === 0) return [label];
      const split = document.createElement("div");
      split.className = view.x > 0 ? "split" : "split flat";
      Object.assign(split.style, view.x > 0
        ? { left: `${view.x}px`, top: "0", bottom: "0" } : { top: `${view.y}px`, left: "0", right: "0", width: "auto" });
      return [label, split];
    }));
  }

  private picture(): void {
    this.draw();
    compose(this.stage.canvas, this.captions(), this.colour.text, this.composed);
    this.composed.toBlob((blob) => { if (blob) save(blob, `${this.fileName()}-${this.shown().toFixed(4)}s.png`); });
  }

  private fileName(): string {
    return this.runs[0].title.replace(/[^\p{L}\p{N}_-]+/gu, "-") || "kairos";
  }

  /** Records from here to the end, or until it is asked again. */
  private async toggleFilm(): Promise<void> {
    const button = element("film");
    if (!this.film) {
      this.draw();
      compose(this.stage.canvas, this.captions(), this.colour.text, this.composed);
      this.film = new Film(this.composed);
      button.textContent = "Stop film";
      this.player.play(true);
      return;
    }
    const film = this.film;
    this.film = null;
    this.player.play(false);
    button.textContent = "Film";
    const blob = await film.stop();
    save(blob, `${this.fileName()}.${blob.type.includes("mp4") ? "mp4" : "webm"}`);
  }

  /** Position (m) and quaternion (w, x, y, z) of every body at t, for scripts. */
  poses(run: number, t: number): number[][] {
    const state = newState();
    return this.runs[run].bodies.map((_, i) => {
      const { px, py, pz, qw, qx, qy, qz } = this.worlds[run].motions.at(i, t, state);
      return [px, py, pz, qw, qx, qy, qz];
    });
  }
}
