// Plots under the view: energy by ledger line, height, gap and speed of a body; tied to the time.
import uPlot from "uplot";
import type { Run } from "./data";
import { number } from "./format";
import { newState } from "./motion";
import type { Palette } from "./palette";
import { inSlices } from "./pause";
import { after, before } from "./search";
import type { World } from "./world";

/** A line of a plot: per run the values at the plot's times. */
interface Line { label: string; run: number; colour: string; values: (number | null)[] }
interface Series { times: number[]; lines: Line[] }

const samples = 700;
const mostFrames = 3000;

function plotOptions(width: number, height: number, unit: string, lines: Line[], colour: Palette,
                     from: number, to: number): uPlot.Options {
  const axis = {
    stroke: colour.text,
    font: "12px system-ui, sans-serif",
    grid: { stroke: colour.dark ? "#ffffff1a" : "#0000001a", width: 1 },
    ticks: { stroke: colour.dark ? "#ffffff33" : "#00000033", width: 1 },
  };
  return {
    width, height,
    legend: { show: false },
    cursor: { points: { show: false }, drag: { x: true, y: false, setScale: false, dist: 8 } },
    scales: {
      x: { time: false, min: from, max: to },
      // What is zero all the time needs no scale to a hundred.
      y: { range: (_, low, high) => (low === 0 && high === 0 ? [-1, 1] : uPlot.rangeNum(low, high, 0.1, true)) },
    },
    axes: [
      { ...axis, size: 30, label: "time (s)", labelSize: 16, labelFont: "12px system-ui, sans-serif", values: (_, ticks) => ticks.map((t) => number(t, 6)) },
      { ...axis, size: 64, label: unit, labelSize: 18, labelFont: "12px system-ui, sans-serif",
        values: (_, ticks) => ticks.map((y) => number(y)) },
    ],
    series: [{}, ...lines.map((line) => ({
      label: line.label, stroke: line.colour, width: line.run === 0 ? 2 : 1.75,
      ...(line.run > 0 ? { dash: [7, 4] } : {}), spanGaps: true, points: { show: false },
    }))],
  };
}

/** One plot with its caption, legend and the line at the time that is shown. */
class Plot {
  readonly figure = document.createElement("figure");
  private readonly caption = document.createElement("figcaption");
  private readonly legend = document.createElement("ul");
  private readonly place = document.createElement("div");
  private readonly now = document.createElement("div");
  private plot: uPlot | null = null;
  private series: Series = { times: [], lines: [] };
  private readonly hidden = new Set<string>();
  private values: HTMLElement[] = [];

  constructor(readonly title: string, readonly unit: string, private readonly seek: (t: number) => void,
              private readonly zoom: (from: number, to: number) => void, quiet: string[] = []) {
    this.figure.className = "plot";
    this.now.className = "now";
    this.legend.className = "legend";
    this.place.className = "place";
    this.place.setAttribute("role", "img");
    this.place.setAttribute("aria-label", title);
    quiet.forEach((label) => this.hidden.add(label));
    this.figure.append(this.caption, this.place, this.legend);
  }

  set(series: Series, caption: string, from: number, to: number, colour: Palette): void {
    this.series = series;
    this.caption.textContent = caption;
    this.place.setAttribute("aria-label", `${caption}, from ${number(from)} to ${number(to)} seconds`);
    this.plot?.destroy();
    const width = Math.max(200, this.figure.clientWidth - 2);
    this.plot = new uPlot(
      plotOptions(width, 205, this.unit, series.lines, colour, from, to),
      [series.times, ...series.lines.map((line) => line.values)] as uPlot.AlignedData,
      this.place,
    );
    this.plot.over.append(this.now);
    this.bind(this.plot);
    this.showLegend();
    series.lines.forEach((line, i) => this.plot?.setSeries(i + 1, { show: !this.hidden.has(line.label) }));
  }

  private bind(plot: uPlot): void {
    plot.over.addEventListener("click", (click) => {
      if (plot.select.width < 8) this.seek(plot.posToVal(click.offsetX, "x"));
    });
    plot.over.addEventListener("dblclick", () => this.zoom(NaN, NaN));
    plot.hooks.setSelect = [(of) => {
      if (of.select.width < 8) return;
      const from = of.posToVal(of.select.left, "x");
      const to = of.posToVal(of.select.left + of.select.width, "x");
      requestAnimationFrame(() => this.zoom(from, to));
    }];
  }

  private showLegend(): void {
    this.values = [];
    this.legend.replaceChildren(...this.series.lines.map((line, i) => {
      const item = document.createElement("li");
      const button = document.createElement("button");
      button.type = "button";
      const mark = document.createElement("span");
      mark.className = line.run > 0 ? "mark dashed" : "mark";
      mark.style.borderColor = line.colour;
      const value = document.createElement("b");
      this.values.push(value);
      button.append(mark, `${line.label} `, value);
      button.setAttribute("aria-pressed", String(!this.hidden.has(line.label)));
      button.addEventListener("click", () => {
        const hide = !this.hidden.has(line.label);
        if (hide) this.hidden.add(line.label);
        else this.hidden.delete(line.label);
        button.setAttribute("aria-pressed", String(!hide));
        this.plot?.setSeries(i + 1, { show: !hide });
      });
      item.append(button);
      return item;
    }));
  }

  /** The line at t, and the values there. */
  at(t: number): void {
    if (!this.plot) return;
    const x = this.plot.valToPos(t, "x");
    this.now.style.transform = `translateX(${x}px)`;
    this.now.hidden = !(x >= 0 && x <= this.plot.over.clientWidth);
    const k = Math.max(0, before(this.series.times, t + 1e-12));
    this.series.lines.forEach((line, i) => {
      let n = k;
      while (n > 0 && line.values[n] == null) --n;
      const value = line.values[n];
      const text = value == null ? "–" : number(value);
      if (this.values[i].textContent !== text) this.values[i].textContent = text;
    });
  }
}

function energyOf(runs: Run[], from: number, to: number, colour: Palette, names: string[]): Series {
  const tables = runs.map((run) => {
    const first = Math.max(0, before(run.frames, from) - 1);
    const last = Math.min(run.frames.length - 1, after(run.frames, to));
    const stride = Math.max(1, Math.ceil((last - first) / mostFrames));
    const rows: number[] = [];
    for (let k = first; k < last; k += stride) rows.push(k);
    rows.push(last);
    return { times: rows.map((k) => run.frames[k]), rows };
  });
  const times = [...new Set(tables.flatMap((table) => table.times))].sort((a, b) => a - b);
  const place = new Map(times.map((t, i) => [t, i]));
  const lines: Line[] = [];
  names.forEach((name, n) => runs.forEach((run, r) => {
    const of = (label: string) => run.energy.find((entry) => entry.name === label)?.values;
    const kinetic = of("kinetic"), potential = of("potential"), own = of(name);
    const total = name === "kinetic + potential";
    if (!total && !own) return;
    const values: (number | null)[] = new Array<number | null>(times.length).fill(null);
    tables[r].rows.forEach((k, i) => {
      values[place.get(tables[r].times[i])!] = total ? kinetic![k] + potential![k] : own![k];
    });
    lines.push({ label: runs.length > 1 ? `${name} ${"AB"[r]}` : name, run: r, colour: colour.lines[n % colour.lines.length], values });
  }));
  return { times, lines };
}

/** The four plots of the page. */
export class Plots {
  private readonly energy: Plot;
  private readonly bodyPlots: Plot[];
  private range: [number, number];
  private job = 0;
  private names: string[];

  /** Where the whole run begins, s. */
  begin = 0;

  constructor(place: HTMLElement, private worlds: World[], private end: number,
              private readonly colour: Palette, seek: (t: number) => void,
              private readonly zoomed: (whole: boolean) => void) {
    this.range = [0, end];
    const zoom = (from: number, to: number) => this.setRange(from, to);
    const names = ["kinetic + potential", ...new Set(worlds.flatMap((w) => w.run.energy.map((e) => e.name)))];
    this.names = names;
    const quiet = names.filter((name) => name === "unexplained" || (worlds.length > 1 && (name === "kinetic" || name === "potential")));
    this.energy = new Plot("Energy", "J", seek, zoom, worlds.length > 1 ? quiet.flatMap((q) => [`${q} A`, `${q} B`]) : quiet);
    this.bodyPlots = [new Plot("Height", "m", seek, zoom), new Plot("Gap", "m", seek, zoom), new Plot("Speed", "m/s", seek, zoom)];
    place.append(this.energy.figure, ...this.bodyPlots.map((plot) => plot.figure));
  }

  /** Other runs; a stretch that was marked stays, where they have it. */
  load(worlds: World[], begin: number, end: number): void {
    const whole = this.range[0] === this.begin && this.range[1] === this.end;
    this.worlds = worlds;
    this.begin = begin;
    this.end = end;
    this.names = ["kinetic + potential", ...new Set(worlds.flatMap((w) => w.run.energy.map((e) => e.name)))];
    this.range = whole || this.range[0] >= end ? [begin, end] : [Math.max(begin, this.range[0]), Math.min(end, this.range[1])];
    this.zoomed(this.range[0] === begin && this.range[1] === end);
  }

  /** NaN: the whole run. */
  setRange(from: number, to: number): void {
    const whole = !(to > from);
    this.range = whole ? [this.begin, this.end] : [Math.max(this.begin, from), Math.min(this.end, to)];
    this.zoomed(whole);
    this.draw(this.body, this.other);
  }

  private body = 0;
  private other = -1;

  /** All plots anew, those of `body` in slices that leave the page alive. */
  draw(body: number, other: number): void {
    this.body = body;
    this.other = other;
    const job = ++this.job;
    const [from, to] = this.range;
    const runs = this.worlds.map((world) => world.run);
    const times = this.sampleTimes(body, from, to);
    const lines = this.bodyPlots.map(() => runs.map((_, r): Line => ({
      label: runs.length > 1 ? "AB"[r] : "", run: r, colour: this.colour.lines[r], values: [],
    })));
    const { energy, colour, names } = this;
    const work = function* (this: Plots): Generator<void> {
      energy.set(energyOf(runs, from, to, colour, names), "Energy and where it went", from, to, colour);
      for (const _ of this.sample(body, other, times, lines)) {
        if (job !== this.job) return;
        yield;
      }
      yield* this.finish(job, body, other, times, lines);
    };
    void inSlices(work.call(this));
  }

  /** Even times, and those just before and after the body's own events. */
  private sampleTimes(body: number, from: number, to: number): number[] {
    const times = Array.from({ length: samples + 1 }, (_, k) => from + ((to - from) * k) / samples);
    for (const { run } of this.worlds) {
      const first = Math.max(0, before(run.events.time, from) + 1);
      const last = after(run.events.time, to);
      if (last - first > 20000) continue;
      const own: number[] = [];
      for (let e = first; e < last; ++e) {
        if (run.events.pair[2 * e] === body || run.events.pair[2 * e + 1] === body) own.push(run.events.time[e]);
      }
      if (own.length <= samples) own.forEach((t) => times.push(t, t + 1e-9 * (1 + t)));
    }
    return times.sort((a, b) => a - b);
  }

  private *sample(body: number, other: number, times: number[], lines: Line[][]): Generator<void> {
    const state = newState();
    for (const t of times) {
      this.worlds.forEach((world, r) => {
        const known = t <= world.run.end * (1 + 1e-12) && body < world.run.bodies.length;
        const at = known ? world.motions.at(body, t, state) : null;
        lines[0][r].values.push(at ? at.py : null);
        lines[2][r].values.push(at ? Math.hypot(at.vx, at.vy, at.vz) : null);
        const gap = at ? world.contacts.gapAt(world.motions, body, t, other) : Infinity;
        lines[1][r].values.push(Number.isFinite(gap) ? gap : null);
      });
      yield;
    }
  }

  private *finish(job: number, body: number, other: number, times: number[], lines: Line[][]): Generator<void> {
    const bodies = this.worlds[0].run.bodies;
    const name = bodies[body].name;
    const captions = [
      `Height of ${name}`,
      `Gap of ${name} to ${other >= 0 ? bodies[other].name : "the nearest"}`,
      `Speed of ${name}`,
    ];
    for (const [i, plot] of this.bodyPlots.entries()) {
      lines[i].forEach((line) => { line.label = line.label || plot.title.toLowerCase(); });
      plot.set({ times, lines: lines[i] }, captions[i], this.range[0], this.range[1], this.colour);
      yield;
      if (job !== this.job) return;
    }
    this.at(this.shown);
  }

  private shown = 0;
  at(t: number): void {
    this.shown = t;
    this.energy.at(t);
    this.bodyPlots.forEach((plot) => plot.at(t));
  }
}
