// The page's side of the worker: the last question counts; one that is out of date is not waited for.
import { readRun, type Run } from "../data";
import type { About, Answer, Complaint, Request, RunAnswer, Task } from "./protocol";

export interface Outcome {
  /** Empty where something is wrong with one of them. */
  runs: Run[];
  answers: RunAnswer[];
  errors: (Complaint | null)[];
}

/** After so long a question that is out of date is given up, ms: a new worker takes 0.1 s to start. */
const patience = 400;

export class EngineClient {
  about: About | null = null;
  private worker!: Worker;
  private id = 0;
  private asked = 0;
  private running: { id: number; since: number; done: (outcome: Outcome | null) => void } | null = null;
  private next: { tasks: Task[]; done: (outcome: Outcome | null) => void } | null = null;
  private waiting = new Map<number, (answer: { tables: string[]; error: Complaint | null }) => void>();
  private readonly files = new Map<string, string>();
  private ready: Promise<About>;
  private told: (about: About) => void = () => undefined;
  private refused: (error: Error) => void = () => undefined;

  constructor(private readonly script: string, private readonly wasm: ArrayBuffer, files: Record<string, string>) {
    Object.entries(files).forEach(([path, text]) => this.files.set(path, text));
    this.ready = this.start();
  }

  loaded(): Promise<About> { return this.ready; }

  /** Milliseconds for which the question that is out has been worked on; 0: none is out. */
  busy(): number { return this.running ? performance.now() - this.running.since : 0; }

  addFile(path: string, text: string): void {
    this.files.set(path, text);
    this.post({ kind: "file", path, text });
  }

  /** All tasks, or null where a later question came before the answer. */
  run(tasks: Task[]): Promise<Outcome | null> {
    return new Promise((done) => {
      this.next?.done(null);
      this.next = { tasks, done };
      if (this.running && performance.now() - this.running.since > patience) this.restart();
      this.pump();
    });
  }

  async tables(task: Task): Promise<{ tables: string[]; error: Complaint | null }> {
    await this.ready;
    const id = ++this.id;
    const answer = new Promise<{ tables: string[]; error: Complaint | null }>((done) => this.waiting.set(id, done));
    this.post({ kind: "tables", id, task });
    return answer;
  }

  /** Gives up what is being computed. */
  stop(): void {
    this.next?.done(null);
    this.next = null;
    if (this.running) this.restart();
  }

  private post(request: Request): void { this.worker.postMessage(request); }

  private start(): Promise<About> {
    const url = URL.createObjectURL(new Blob([this.script], { type: "text/javascript" }));
    this.worker = new Worker(url);
    URL.revokeObjectURL(url);
    this.worker.onmessage = (message: MessageEvent<Answer>) => this.take(message.data);
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.refused(new Error(event.message || "the worker stopped"));
    };
    const ready = new Promise<About>((done, failed) => { this.told = done; this.refused = failed; });
    this.post({ kind: "begin", wasm: this.wasm, files: Object.fromEntries(this.files) });
    return ready;
  }

  private restart(): void {
    this.worker.terminate();
    this.running?.done(null);
    this.running = null;
    this.waiting.forEach((done) => done({ tables: [], error: { file: "", line: 0, key: "", reason: "was given up" } }));
    this.waiting.clear();
    this.ready = this.start();
    void this.ready.then(() => this.pump());
  }

  private pump(): void {
    if (this.running || !this.next || !this.about) return;
    const { tasks, done } = this.next;
    this.next = null;
    const id = (this.asked = ++this.id);
    this.running = { id, since: performance.now(), done };
    this.post({ kind: "run", id, tasks });
  }

  private take(answer: Answer): void {
    switch (answer.kind) {
      case "ready":
        this.about = answer.about;
        this.told(answer.about);
        this.pump();
        return;
      case "run": {
        if (answer.id !== this.asked || !this.running) return;
        const { done } = this.running;
        this.running = null;
        done(outcome(answer.answers));
        this.pump();
        return;
      }
      case "tables":
        this.waiting.get(answer.id)?.(answer);
        this.waiting.delete(answer.id);
        return;
      case "failed": {
        const error = { file: "", line: 0, key: "", reason: `the engine stopped: ${answer.reason}` };
        const running = this.running;
        this.running = null;
        if (!running) this.refused(new Error(error.reason));
        else running.done({ runs: [], answers: [], errors: [error] });
        this.restart();
      }
    }
  }
}

function outcome(answers: RunAnswer[]): Outcome {
  const errors = answers.map((answer) => answer.text.error ?? null);
  const runs = errors.every((error) => error === null) ? answers.map((answer) => readRun(answer.text, answer.numbers)) : [];
  return { runs, answers, errors };
}
