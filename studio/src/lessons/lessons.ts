// The room of lessons: what is asked, what one can turn, what is seen, and the plot that answers.
import type { Run } from "../data";
import type { EngineClient } from "../lab/client";
import { element, option, type Viewer } from "../viewer";
import { accuracy } from "./accuracy";
import { draw, legend, table } from "./chart";
import { gain, ledger } from "./energy";
import type { Ask, Control, Lesson, Told, Values } from "./lesson";
import { bat, figure15, wall } from "./passing";

export const lessons: Lesson[] = [gain, wall, figure15, bat, ledger, accuracy];

export class Lessons {
  private shown = -1;
  private values: Values = {};
  private asked = 0;
  private pending = 0;
  /** Of questions that were answered and drawn. */
  drawn = 0;

  constructor(private readonly client: EngineClient, private readonly viewer: Viewer) {
    element("lesson-list").replaceChildren(...lessons.map((lesson, i) => {
      const item = document.createElement("li");
      const link = document.createElement("a");
      link.href = `#lesson-${i + 1}`;
      link.textContent = lesson.title;
      item.append(link);
      return item;
    }));
  }

  enter(hash: string): void {
    const wanted = Number(hash.slice("lesson-".length)) - 1;
    this.shown = Number.isInteger(wanted) && wanted >= 0 && wanted < lessons.length ? wanted : 0;
    const lesson = lessons[this.shown];
    [...element("lesson-list").querySelectorAll("a")].forEach((link, i) => {
      if (i === this.shown) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    });
    element("lesson-title").textContent = `${this.shown + 1}. ${lesson.title}`;
    element("lesson-question").textContent = lesson.question;
    element("lesson-text").textContent = lesson.text;
    element("lesson-answer").textContent = lesson.answer;
    element<HTMLDetailsElement>("lesson-folded").open = false;
    const next = element<HTMLAnchorElement>("lesson-next");
    next.hidden = this.shown + 1 === lessons.length;
    next.href = `#lesson-${this.shown + 2}`;
    this.values = Object.fromEntries(lesson.controls.map((control) => [control.key, control.start]));
    element("lesson-controls").replaceChildren(...lesson.controls.map((control) => this.control(control)));
    void this.show(true);
  }

  leave(): void {
    this.shown = -1;
    ++this.asked;
    this.viewer.player.play(false);
  }

  private control(control: Control): HTMLLabelElement {
    const label = document.createElement("label");
    const value = document.createElement("output");
    const input = control.choices ? document.createElement("select") : document.createElement("input");
    input.id = `lesson-${control.key}`;
    if (input instanceof HTMLSelectElement) {
      input.append(...control.choices!.map((choice) => option(choice.value, choice.text)));
    } else if (control.range) {
      input.type = "range";
      Object.assign(input, { min: String(control.range.least), max: String(control.range.most), step: String(control.range.step) });
    }
    input.value = String(control.start);
    const write = () => { value.textContent = control.range ? `${input.value} ${control.range.unit}` : ""; };
    write();
    input.addEventListener("input", () => {
      this.values[control.key] = input.value;
      write();
      clearTimeout(this.pending);
      this.pending = window.setTimeout(() => void this.show(false), 120);
    });
    label.append(`${control.label} `, input, value);
    return label;
  }

  private async show(first: boolean): Promise<void> {
    const question = ++this.asked;
    const lesson = lessons[this.shown];
    const values = { ...this.values };
    element("lesson-says").textContent = "computing…";
    let refused = "";
    const ask: Ask = async (asked) => {
      const outcome = await this.client.run(asked.map(({ scene, settings }) => ({ scene, path: "/scenes/lesson.toml", settings, start: "", seconds: 10 })));
      if (!outcome || question !== this.asked) return null;
      refused = outcome.errors.find((error) => error !== null)?.reason ?? "";
      if (refused !== "") return null;
      return outcome.runs.map((run: Run, i): Told => ({ run, answer: outcome.answers[i] }));
    };
    const seen = await ask(lesson.seen(values));
    if (seen) {
      this.viewer.replace(seen.map(({ run }) => run), first);
      if (first) {
        this.viewer.setSpeed(this.viewer.player.end < 1 ? Number((this.viewer.player.end / 4).toPrecision(1)) : 1);
        this.viewer.player.seek(0);
      }
      if (!matchMedia("(prefers-reduced-motion: reduce)").matches) this.viewer.player.play(true);
      const chart = await lesson.plot(values, seen, ask);
      if (chart) {
        draw(element("lesson-plot"), chart);
        element("lesson-plot-title").textContent = chart.title;
        element("lesson-legend").replaceChildren(...legend(chart));
        element("lesson-numbers").replaceChildren(table(chart));
        element("lesson-says").textContent = chart.says;
        ++this.drawn;
      }
    }
    if (refused !== "") element("lesson-says").textContent = `Refused: ${refused}`;
  }
}
