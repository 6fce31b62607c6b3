// The methods and what else a run can be told: controls made from the program's own table of options.
import type { About, Choice, Complaint } from "./protocol";

const choices: Choice[] = ["scheme", "integrator", "detector", "impact"];
/** What both methods get: the same input. */
const frames = ["frame", "frame_jitter", "spike_probability", "spike_factor", "frame_seed", "duration"];

export type Values = Record<string, string>;

/** What was chosen: of each method its four names, and what holds for both. */
export interface Chosen {
  a: Values;
  b: Values;
  shared: Values;
  beside: boolean;
}

export const thesis: Values = { scheme: "original", integrator: "thesis-euler", detector: "sat", impact: "thesis" };
const words = (name: string) => name.replaceAll("_", " ");

export class Methods {
  private readonly problems: HTMLElement[] = [];
  private readonly inputs = new Map<string, HTMLInputElement | HTMLSelectElement>();
  private readonly beside: HTMLInputElement;
  private readonly second: HTMLFieldSetElement;

  constructor(place: HTMLElement, private readonly about: About, private readonly changed: () => void) {
    const first = this.method("a", "Method A");
    this.second = this.method("b", "Method B");
    this.beside = document.createElement("input");
    this.beside.type = "checkbox";
    this.beside.id = "beside";
    this.beside.checked = true;
    this.beside.addEventListener("change", () => { this.second.disabled = !this.beside.checked; this.changed(); });
    const label = document.createElement("label");
    label.append(this.beside, " Beside it, on the same input");
    const methods = document.createElement("div");
    methods.className = "pair";
    methods.append(first, this.second);
    place.append(label, methods, this.group("Frames and time", frames));
    const more = document.createElement("details");
    const summary = document.createElement("summary");
    summary.textContent = "More options";
    const rest = Object.keys(about.options).filter((name) => !frames.includes(name) && !choices.includes(name as Choice));
    more.append(summary, this.group("Of both methods", rest));
    place.append(more);
  }

  private method(which: "a" | "b", title: string): HTMLFieldSetElement {
    const group = document.createElement("fieldset");
    const legend = document.createElement("legend");
    legend.textContent = title;
    group.append(legend);
    for (const choice of choices) {
      const select = document.createElement("select");
      select.id = `${which}-${choice}`;
      for (const [name, summary] of Object.entries(this.about.names[choice])) {
        const option = document.createElement("option");
        option.value = option.textContent = name;
        option.title = summary;
        select.append(option);
      }
      select.value = which === "a" ? this.about.options[choice].default : thesis[choice];
      select.title = this.about.options[choice].help;
      select.addEventListener("change", this.changed);
      this.inputs.set(select.id, select);
      const label = document.createElement("label");
      label.append(`${choice} `, select);
      group.append(label);
    }
    const problem = document.createElement("p");
    problem.className = "refused";
    problem.setAttribute("role", "alert");
    problem.hidden = true;
    this.problems.push(problem);
    group.append(problem);
    return group;
  }

  private group(title: string, names: string[]): HTMLFieldSetElement {
    const group = document.createElement("fieldset");
    group.className = "options";
    const legend = document.createElement("legend");
    legend.textContent = title;
    group.append(legend);
    for (const name of names) {
      const info = this.about.options[name];
      const input = document.createElement("input");
      input.id = `option-${name}`;
      if (info.kind === "flag") input.type = "checkbox";
      else {
        input.type = "text";
        input.inputMode = info.kind === "number" || info.kind === "count" ? "decimal" : "text";
        input.placeholder = info.default === "" ? "the scene's" : info.default;
        input.size = 10;
      }
      const unit = info.unit === "" ? "" : ` (${info.unit})`;
      input.title = `${info.help}${info.allowed === "" ? "" : `; ${info.allowed}`}`;
      input.addEventListener("change", this.changed);
      this.inputs.set(input.id, input);
      const label = document.createElement("label");
      label.append(`${words(name)}${unit} `, input);
      group.append(label);
    }
    return group;
  }

  get chosen(): Chosen {
    const of = (which: string) => Object.fromEntries(choices.map((choice) => [choice, this.inputs.get(`${which}-${choice}`)!.value]));
    const shared: Values = {};
    for (const [id, input] of this.inputs) {
      if (!id.startsWith("option-") || !(input instanceof HTMLInputElement)) continue;
      const value = input.type === "checkbox" ? (input.checked ? "true" : "") : input.value.trim();
      if (value !== "") shared[id.slice("option-".length)] = value;
    }
    return { a: of("a"), b: of("b"), shared, beside: this.beside.checked };
  }

  set chosen(values: Chosen) {
    for (const which of ["a", "b"] as const) {
      for (const [name, value] of Object.entries(values[which])) {
        const select = this.inputs.get(`${which}-${name}`);
        if (select) select.value = value;
      }
    }
    for (const [id, input] of this.inputs) {
      if (!id.startsWith("option-") || !(input instanceof HTMLInputElement)) continue;
      const value = values.shared[id.slice("option-".length)] ?? "";
      if (input.type === "checkbox") input.checked = value === "true";
      else input.value = value;
    }
    this.beside.checked = values.beside;
    this.second.disabled = !values.beside;
  }

  /** The lines `option=value` of each method that runs. */
  settings(): string[] {
    const { a, b, shared, beside } = this.chosen;
    // Jitter needs to know of what.
    const jittered = ["frame_jitter", "spike_probability", "spike_factor", "frame_seed"].some((name) => name in shared);
    const both = jittered && !("frame" in shared) ? { ...shared, frame: "1/60" } : shared;
    return (beside ? [a, b] : [a]).map((own) => Object.entries({ ...own, ...both }).map(([name, value]) => `${name}=${value}`).join("\n"));
  }

  /** Why a method is refused, beside it; what belongs to the scene is not shown here. */
  refuse(errors: (Complaint | null)[]): void {
    this.problems.forEach((problem, i) => {
      const error = errors[i];
      problem.hidden = !error;
      problem.textContent = error ? `${error.key === "" ? "" : `${words(error.key)}: `}${error.reason}` : "";
    });
    for (const [id, input] of this.inputs) {
      const name = id.slice(id.indexOf("-") + 1);
      input.toggleAttribute("aria-invalid", errors.some((error) => error?.key === name));
      if (input.hasAttribute("aria-invalid")) input.setAttribute("aria-invalid", "true");
    }
  }
}
