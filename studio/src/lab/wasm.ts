// The engine: the library compiled to WebAssembly, as typed calls.
import type { About, Complaint, EngineRun, RunAnswer, Task } from "./protocol";

/** What Emscripten makes. */
export interface EngineModule {
  HEAPU8: Uint8Array;
  FS: { mkdirTree(path: string): void; writeFile(path: string, text: string): void };
  UTF8ToString(at: number): string;
  allocateUTF8(text: string): number;
  _kairos_about(): number;
  _kairos_run(scene: number, path: number, settings: number, start: number, seconds: number, tables: number): number;
  _kairos_json(answer: number): number;
  _kairos_numbers(answer: number): number;
  _kairos_size(answer: number): number;
  _kairos_table(answer: number, which: number): number;
  _kairos_free(answer: number): void;
  _free(at: number): void;
}

export type CreateEngine = (options: { wasmBinary: ArrayBuffer }) => Promise<EngineModule>;

export class Engine {
  private constructor(private readonly module: EngineModule) {}

  static async load(create: CreateEngine, wasm: ArrayBuffer, files: Record<string, string>): Promise<Engine> {
    const engine = new Engine(await create({ wasmBinary: wasm }));
    for (const [path, text] of Object.entries(files)) engine.write(path, text);
    return engine;
  }

  /** A file that scenes may name: a track, a model. */
  write(path: string, text: string): void {
    this.module.FS.mkdirTree(path.slice(0, path.lastIndexOf("/")) || "/");
    this.module.FS.writeFile(path, text);
  }

  about(): About {
    return this.read(this.module._kairos_about(), (answer) => this.json<About>(answer));
  }

  run(task: Task): RunAnswer {
    const began = performance.now();
    return this.ask(task, false, (answer) => {
      const at = this.module._kairos_numbers(answer);
      const numbers = this.module.HEAPU8.slice(at, at + this.module._kairos_size(answer)).buffer as ArrayBuffer;
      return { text: this.json<EngineRun>(answer), numbers, milliseconds: performance.now() - began };
    });
  }

  /** Trajectory, events and energy as CSV, the bytes of `kairos run --out`. */
  tables(task: Task): { tables: string[]; error: Complaint | null } {
    return this.ask(task, true, (answer) => ({
      tables: [0, 1, 2].map((which) => this.module.UTF8ToString(this.module._kairos_table(answer, which))),
      error: this.json<{ error?: Complaint }>(answer).error ?? null,
    }));
  }

  private json<T>(answer: number): T {
    return JSON.parse(this.module.UTF8ToString(this.module._kairos_json(answer))) as T;
  }

  private ask<T>(task: Task, tables: boolean, take: (answer: number) => T): T {
    const texts = [task.scene, task.path, task.settings, task.start].map((text) => this.module.allocateUTF8(text));
    try {
      const [scene, path, settings, start] = texts;
      return this.read(this.module._kairos_run(scene, path, settings, start, task.seconds, Number(tables)), take);
    } finally {
      texts.forEach((text) => this.module._free(text));
    }
  }

  private read<T>(answer: number, take: (answer: number) => T): T {
    try {
      return take(answer);
    } finally {
      this.module._kairos_free(answer);
    }
  }
}
