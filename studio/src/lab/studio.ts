// The studio: a scene that one changes by hand, by text and by keys, and what becomes of it, at once.
import { Quaternion } from "three";
import { fromBase64, type Run } from "../data";
import { save } from "../export";
import { seconds } from "../format";
import { inSlices, pause } from "../pause";
import { box, element, list, option, Viewer } from "../viewer";
import { EngineClient, type Outcome } from "./client";
import { Drag, type Deed, type Tool } from "./drag";
import { Editor } from "./editor";
import { KeysPanel, type KeyTable } from "./keys_panel";
import { delayed, Later } from "./later";
import { fromHash, toHash, unzip } from "./link";
import { Methods } from "./methods";
import type { About, Complaint, Task } from "./protocol";
import { newBody } from "./shapes";
import { addTable, bodyAt, bodyLines, numbersOf, removeBody, setKey, tomlNumber, tomlVector, valuesOf, type Change } from "./toml_edit";

const emptyScene = `name = "mine"\nduration = 10.0\nframe = "1/60"\nG = 9.8\n
[[body]]\nname = "floor"\nentity = "wall"\nshape = "half-space"\n
[[body]]\nname = "ball"\nentity = "ball"\nradius = 0.5\nmass = 1.0\nposition = [0.0, 3.0, 0.0]\n`;

/** What of a body's text is a size, as it is written. */
function sizesOf(values: Map<string, string>): Map<string, number[]> {
  const found = new Map<string, number[]>();
  for (const key of ["radius", "length", "height", "half_extents"]) {
    const text = values.get(key);
    if (text !== undefined) found.set(key, key === "half_extents" ? numbersOf(text, [1, 1, 1]) : numbersOf(`[${text}]`, [1]));
  }
  return found;
}

/** A run is stopped after so long a computation, s. */
const longest = 20;

const button = (id: string) => element<HTMLButtonElement>(id);
const embedded = (id: string): string => {
  const text = element(id).textContent ?? "";
  element(id).remove();
  return text;
};

export class Studio {
  viewer: Viewer | null = null;
  readonly client: EngineClient;
  readonly editor: Editor;
  private readonly methods: Methods;
  private readonly panel: KeysPanel;
  /** Whether the page shows scenes, and not another room. */
  mine = true;
  private path = "/scenes/mine.toml";
  private later: Later[] | null = null;
  private refit = true;
  private pending = 0;
  private taken = { position: [0, 0, 0], orientation: new Quaternion(), sizes: new Map<string, number[]>(), name: "" };
  /** What was answered last, and how long it took, ms. */
  outcome: Outcome | null = null;

  static async open(): Promise<Studio> {
    await pause(); // what the script itself took is long enough
    const files = JSON.parse(embedded("studio-files")) as Record<string, string>;
    const keys = JSON.parse(embedded("studio-keys")) as KeyTable;
    const wasm = await unzip(new Uint8Array(await inSlices(fromBase64(embedded("studio-engine").trim()))));
    const client = new EngineClient(embedded("studio-worker"), wasm.buffer as ArrayBuffer, files);
    const about = await client.loaded();
    await pause();
    const studio = new Studio(client, about, files, keys);
    await pause();
    await studio.begin();
    return studio;
  }

  private constructor(client: EngineClient, readonly about: About, private readonly files: Record<string, string>, keys: KeyTable) {
    this.client = client;
    this.editor = new Editor(element("editor"), () => this.changed(), (line) => this.choose(bodyAt(this.editor.text, line)));
    this.methods = new Methods(element("methods"), about, () => this.changed(0));
    this.panel = new KeysPanel(element("keys-rows"), element("keys-title"), keys, (line, key, value) => {
      this.takeNow();
      this.editor.separate();
      this.editor.change([setKey(this.editor.text, line, key, value)]);
    });
    const shipped = list("scene");
    shipped.append(option("", "empty scene"), ...Object.keys(about.scenes).map((name) => option(name, name)));
    shipped.addEventListener("change", () => this.load(shipped.value));
    this.bind();
  }

  private async begin(): Promise<void> {
    element("engine").textContent = `kairos ${this.about.version}`;
    try {
      const carried = await fromHash(location.hash);
      if (carried) {
        this.methods.chosen = carried.chosen;
        return this.openText(carried.scene, carried.path, "");
      }
    } catch (error) {
      this.say(`The link cannot be read: ${error instanceof Error ? error.message : String(error)}`);
    }
    const named = new URLSearchParams(location.search).get("scene") ?? "bounce";
    return this.load(named in this.about.scenes ? named : "bounce");
  }

  private bind(): void {
    const click = (id: string, act: () => void) => element(id).addEventListener("click", act);
    click("undo", () => { this.editor.undo(); });
    click("redo", () => { this.editor.redo(); });
    click("save", () => save(new Blob([this.editor.text], { type: "application/toml" }), this.path.slice(this.path.lastIndexOf("/") + 1)));
    click("open", () => box("file").click());
    click("link", () => void this.link());
    click("tables", () => void this.saveTables());
    click("from-start", () => { this.later = null; this.changed(0); });
    click("delete", () => this.remove());
    click("stop", () => this.client.stop());
    list("add").addEventListener("change", () => {
      if (list("add").value !== "") this.add(list("add").value);
      list("add").value = "";
    });
    box("file").addEventListener("change", () => {
      const [file] = box("file").files ?? [];
      if (file) void this.openFile(file);
      box("file").value = "";
    });
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      for (const file of event.dataTransfer?.files ?? []) void this.openFile(file);
    });
    document.addEventListener("keydown", (event) => this.key(event));
  }

  /** Runs what there is now, `wait` ms from here; a later call counts instead. */
  private changed(wait = 60): void {
    clearTimeout(this.pending);
    this.pending = window.setTimeout(() => void this.simulate(), wait);
    button("undo").disabled = !this.editor.canUndo;
    button("redo").disabled = !this.editor.canRedo;
    this.showKeys();
  }

  private tasks(): Task[] {
    const lines = bodyLines(this.editor.text);
    return this.methods.settings().map((settings, i) => ({
      scene: this.editor.text, path: this.path, settings, seconds: longest,
      start: this.later ? (this.later[i] ?? this.later[0]).text(lines, this.editor.text) : "",
    }));
  }

  private async simulate(): Promise<void> {
    if (!this.mine) return;
    const slow = window.setTimeout(() => { element("working").hidden = false; button("stop").hidden = false; }, 300);
    const by = this.later?.[0].time ?? 0;
    const outcome = await this.client.run(this.tasks());
    clearTimeout(slow);
    if (!outcome || !this.mine) return;
    element("working").hidden = true;
    button("stop").hidden = true;
    this.outcome = outcome;
    this.complain(outcome.errors);
    if (outcome.runs.length > 0) await this.show(outcome.runs.map((run) => delayed(run, by)));
    const times = outcome.answers.map((answer, i) => `${"AB"[i]} ${answer.milliseconds.toFixed(answer.milliseconds < 10 ? 1 : 0)} ms`);
    element("cost").textContent = `computed in ${times.join(", ")}`;
  }

  /** Belongs to the scene what names a line, or a key of its file; to a method the rest. */
  private complain(errors: (Complaint | null)[]): void {
    const ofScene = (error: Complaint | null) => error !== null && (error.line > 0 || (error.file !== "" && error.key !== ""));
    const scene = errors.filter(ofScene).slice(0, 1) as Complaint[];
    this.editor.mark(scene);
    this.methods.refuse(errors.map((error) => (ofScene(error) ? null : error)));
    const wrong = element("wrong");
    wrong.hidden = scene.length === 0;
    wrong.textContent = scene.map((error) => `${error.line > 0 ? `line ${error.line}: ` : ""}${error.key === "" ? "" : `${error.key}: `}${error.reason}`).join("; ");
  }

  private opening: Promise<Viewer> | null = null;

  private async show(runs: Run[]): Promise<void> {
    if (!this.viewer && !this.opening) {
      this.opening = Viewer.open(runs);
      this.viewer = await this.opening;
      new Drag(this.viewer.stage, {
        tool: () => (this.mine ? (list("tool").value as Tool) : "view"),
        take: (body) => this.take(body),
        deed: (body, deed) => this.deed(body, deed),
        done: () => this.editor.separate(),
      });
      this.viewer.chosen = (body) => this.chose(body);
      this.chose(this.viewer.body);
    } else {
      (this.viewer ?? await this.opening!).replace(runs, this.refit);
    }
    this.refit = false;
    const note = element("later");
    note.hidden = this.later === null;
    note.textContent = this.later ? `This run goes on from ${seconds(this.later[0].time)}, with what was changed then.` : "";
    button("from-start").hidden = this.later === null;
  }

  // Scenes

  /** A shipped scene by name; "": an empty one. */
  load(name: string): Promise<void> {
    list("scene").value = name;
    const path = name === "" ? "/scenes/mine.toml" : this.about.scenes[name];
    return this.openText(name === "" ? emptyScene : this.files[path], path, name);
  }

  /** The scene again, after another room had the view. */
  comeBack(): void {
    this.mine = true;
    this.refit = true;
    this.changed(0);
  }

  async openText(text: string, path: string, name: string): Promise<void> {
    list("scene").value = name;
    this.path = path;
    this.later = null;
    this.refit = true;
    this.viewer?.player.play(false);
    this.viewer?.player.seek(0);
    this.editor.open(text);
    clearTimeout(this.pending);
    button("undo").disabled = button("redo").disabled = true;
    await this.simulate();
    this.showKeys();
  }

  private async openFile(file: File): Promise<void> {
    if (file.size > 20e6) return this.say(`${file.name} has ${(file.size / 1e6).toFixed(0)} MB; a page takes files up to 20 MB`);
    const text = await file.text();
    if (/\.(csv|off)$/i.test(file.name)) {
      this.client.addFile(`/scenes/${file.name}`, text);
      this.say(`${file.name} lies beside the scene now: a track or frame times may name it`);
      return this.changed(0);
    }
    if (!/\.(toml|def)$/i.test(file.name)) return this.say(`${file.name} is no scene; a scene is a .toml or .def, what it names a .csv or .off`);
    await this.openText(text, `/scenes/${file.name}`, "");
  }

  private async link(): Promise<void> {
    const hash = await toHash({ scene: this.editor.text, path: this.path, chosen: this.methods.chosen });
    history.replaceState(null, "", hash);
    await navigator.clipboard?.writeText(location.href).catch(() => undefined);
    this.say(`The address of this page carries the scene and its methods now (${Math.ceil(hash.length / 1024)} kB)`);
  }

  private async saveTables(): Promise<void> {
    const [task] = this.tasks();
    const { tables, error } = await this.client.tables(task);
    if (error) return this.say(error.reason);
    tables.forEach((table, i) => save(new Blob([table], { type: "text/csv" }), ["trajectory.csv", "events.csv", "energy.csv"][i]));
  }

  private say(text: string): void { element("said").textContent = text; }

  // Bodies

  private get body(): string { return this.viewer ? this.viewer.runs[0].bodies[this.viewer.body].name : ""; }

  private choose(name: string): void {
    const body = this.viewer?.runs[0].bodies.findIndex((each) => each.name === name) ?? -1;
    if (body >= 0 && body !== this.viewer?.body) this.viewer?.choose(body);
  }

  private chose(body: number): void {
    const name = this.viewer?.runs[0].bodies[body]?.name ?? "";
    this.editor.show(bodyLines(this.editor.text).get(name) ?? 0);
    this.showKeys();
  }

  private showKeys(): void {
    const { text } = this.editor;
    const entity = this.viewer?.runs[0].bodies[this.viewer.body]?.entity ?? "";
    const line = bodyLines(text).get(this.body);
    if (box("keys-of-scene").checked || line === undefined) this.panel.show("", "", 0, text);
    else this.panel.show(this.body, entity, line, text);
  }

  /** Where changes act from now on, everything is where it is at the time that is shown. */
  private takeNow(): void {
    const { viewer } = this;
    if (!viewer || list("acts").value === "start" || viewer.player.time <= viewer.player.begin) return;
    const lines = bodyLines(this.editor.text);
    this.later = viewer.worlds.map((world) => new Later(Math.min(viewer.player.time, world.run.end), world.run, world.motions, lines, this.editor.text));
  }

  private take(body: number): boolean {
    const { viewer } = this;
    if (!viewer) return false;
    viewer.choose(body);
    const line = bodyLines(this.editor.text).get(this.body);
    if (line === undefined) {
      this.say(`${this.body} has no [[body]] of its own (it is one of [[many]], or of a .def): it is changed in the text`);
      return false;
    }
    this.takeNow();
    const values = valuesOf(this.editor.text, line);
    const state = viewer.worlds[0].states[body];
    const now = this.later !== null && list("acts").value === "now" && viewer.runs[0].bodies[body].moves === "free";
    const [w, x, y, z] = this.writtenTurn(values);
    this.taken = {
      name: this.body,
      position: now ? [state.px, state.py, state.pz] : numbersOf(values.get("position"), [0, 0, 0]),
      orientation: now ? new Quaternion(state.qx, state.qy, state.qz, state.qw) : new Quaternion(x, y, z, w),
      sizes: sizesOf(values),
    };
    if (list("tool").value === "size" && this.taken.sizes.size === 0) {
      this.say(`${this.body} is told by no radius, length or half extents: its size is changed in the text`);
      return false;
    }
    this.editor.separate();
    return true;
  }

  private writtenTurn(values: Map<string, string>): number[] {
    if (!values.has("axis_angle")) return numbersOf(values.get("orientation"), [1, 0, 0, 0]);
    const [x, y, z, angle] = numbersOf(values.get("axis_angle"), [0, 1, 0, 0]);
    const norm = Math.hypot(x, y, z) || 1;
    return [Math.cos(angle / 2), ...[x, y, z].map((each) => (each / norm) * Math.sin(angle / 2))];
  }

  private deed(_body: number, deed: Deed, dragged = true): void {
    const { name, position, orientation, sizes } = this.taken;
    const line = () => bodyLines(this.editor.text).get(name) ?? -1;
    const scale = this.viewer!.worlds[0].radius;
    const set = (key: string, value: string) => this.editor.change([setKey(this.editor.text, line(), key, value)], dragged);
    if (line() < 1) return;
    const tool = list("tool").value;
    const round = (x: number) => Number(tomlNumber(x, scale));
    const moved = position.map((x, k) => round(x + deed.by.getComponent(k)));
    const q = deed.turn.clone().multiply(orientation).normalize();
    if (tool === "size") {
      for (const [key, size] of sizes) {
        const values = size.map((x) => tomlNumber(x * deed.factor, scale));
        set(key, key === "half_extents" ? `[${values.join(", ")}]` : values[0]);
      }
    } else if (tool === "turn") {
      set("axis_angle", "");
      set("orientation", tomlVector([q.w, q.x, q.y, q.z]));
    } else {
      set("position", tomlVector(moved));
    }
    this.later?.forEach((each) => each.move(name, (state) => {
      if (tool === "turn") [state.qw, state.qx, state.qy, state.qz] = [q.w, q.x, q.y, q.z];
      else if (tool !== "size") [state.px, state.py, state.pz] = moved;
    }, this.editor.text, line()));
    this.changed(0);
  }

  private remove(): void {
    const line = bodyLines(this.editor.text).get(this.body);
    if (line === undefined) return;
    this.takeNow();
    this.editor.separate();
    this.editor.change([removeBody(this.editor.text, line)]);
  }

  private add(kind: string): void {
    const { viewer } = this;
    const target = viewer && !viewer.stage.following ? viewer.stage.controls.target : { x: 0, y: 1, z: 0 };
    const { name, text } = newBody(kind, new Set(bodyLines(this.editor.text).keys()), [target.x, target.y, target.z], viewer?.worlds[0].radius ?? 2);
    this.takeNow();
    this.editor.separate();
    this.editor.change([addTable(this.editor.text, text)]);
    this.say(`${name} was added`);
  }

  /** What the viewer has no key for: undo, and a chosen body by keys. */
  private key(event: KeyboardEvent): void {
    if (!this.mine) return;
    const target = event.target as HTMLElement;
    const typing = target.isContentEditable || target instanceof HTMLInputElement && target.type === "text";
    if ((event.ctrlKey || event.metaKey) && !typing && ["z", "y"].includes(event.key.toLowerCase())) {
      if (event.key.toLowerCase() === "y" || event.shiftKey) this.editor.redo();
      else this.editor.undo();
      event.preventDefault();
      return;
    }
    if (typing || target instanceof HTMLSelectElement || event.ctrlKey || event.metaKey || event.altKey || !this.viewer) return;
    if (event.key === "Delete") return this.remove();
    if (!event.shiftKey) return;
    const step = 0.02 * this.viewer.worlds[0].radius;
    const moves: Record<string, number[]> = {
      ArrowLeft: [-step, 0, 0], ArrowRight: [step, 0, 0], ArrowUp: [0, step, 0], ArrowDown: [0, -step, 0],
      PageUp: [0, 0, -step], PageDown: [0, 0, step],
    };
    const move = moves[event.key];
    if (!move || !this.take(this.viewer.body)) return;
    const deed: Deed = { by: this.viewer.stage.camera.position.clone().set(move[0], move[1], move[2]), turn: new Quaternion(), factor: 1 };
    const [dx, dy] = move;
    if (list("tool").value === "turn") deed.turn.setFromAxisAngle(deed.by.clone().set(dy === 0 ? 0 : 1, dx === 0 ? 0 : 1, move[2] === 0 ? 0 : 1), 0.1 * Math.sign(dx + dy + move[2]));
    deed.factor = Math.exp(0.1 * Math.sign(dx + dy - move[2]));
    this.deed(this.viewer.body, deed, false);
    event.preventDefault();
    event.stopImmediatePropagation();
  }

  /** The keys of the scene instead of a body's, or back. */
  refreshKeys(): void { this.showKeys(); }
}

export type { Change };
