// Every key of a table of the scene, with its unit, default, range and meaning, and what the scene says of it.
import { valuesOf } from "./toml_edit";

export interface KeyInfo { key: string; unit: string; default: string; allowed: string; meaning: string }
/** By table: "" (top), body, body.drive, entity.NAME; from the page that documents the format. */
export type KeyTable = Record<string, KeyInfo[]>;

export class KeysPanel {
  private line = -1;
  private rows = new Map<string, HTMLInputElement>();
  private shown = "";

  constructor(private readonly place: HTMLElement, private readonly title: HTMLElement, private readonly keys: KeyTable,
              private readonly set: (line: number, key: string, value: string) => void) {}

  /** The table whose header stands in `line` (0: the top of the file), of a body of that entity. */
  show(name: string, entity: string, line: number, text: string): void {
    const which = line === 0 ? "" : entity;
    const infos = line === 0 ? this.keys[""] : [...this.keys["body"], ...(this.keys[`entity.${entity}`] ?? [])];
    if (this.shown !== `${which}/${line === 0}`) this.build(infos, which, line === 0);
    this.title.textContent = line === 0 ? "Keys of the scene" : `Keys of ${name}`;
    this.line = line;
    const values = valuesOf(text, line);
    for (const [key, input] of this.rows) {
      const value = values.get(key) ?? "";
      if (document.activeElement !== input && input.value !== value) input.value = value;
    }
  }

  private build(infos: KeyInfo[], which: string, top: boolean): void {
    this.shown = `${which}/${top}`;
    this.rows = new Map();
    const tables = ["body", "force", "exact", "drive"];
    this.place.replaceChildren(...infos.filter((info) => !tables.includes(info.key)).map((info) => {
      const row = document.createElement("div");
      const label = document.createElement("label");
      const input = document.createElement("input");
      const about = document.createElement("p");
      input.type = "text";
      input.spellcheck = false;
      input.id = `key-${info.key}`;
      input.placeholder = info.default;
      input.setAttribute("aria-describedby", `about-${info.key}`);
      input.addEventListener("change", () => this.set(this.line, info.key, input.value.trim()));
      label.append(`${info.key}${info.unit === "" ? "" : ` (${info.unit})`} `, input);
      about.id = `about-${info.key}`;
      const fallback = info.default === "" || info.default.startsWith("needed") ? info.default : `default ${info.default}`;
      const allowed = [fallback, info.allowed].filter((part) => part !== "").join("; ");
      about.textContent = [info.meaning, allowed].filter((part) => part !== "").join(" — ");
      row.append(label, about);
      this.rows.set(info.key, input);
      return row;
    }));
  }
}
