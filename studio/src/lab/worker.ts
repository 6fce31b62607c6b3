// Simulates beside the page, so that nothing in it waits.
import createEngine from "kairos-engine";
import type { Answer, Request } from "./protocol";
import { Engine } from "./wasm";

/** Questions that come while it loads wait for it. */
let loading: Promise<Engine> | null = null;
const say = (answer: Answer, given: Transferable[] = []) => self.postMessage(answer, { transfer: given });

async function serve(request: Request): Promise<void> {
  if (request.kind === "begin") {
    loading = Engine.load(createEngine, request.wasm, request.files);
    say({ kind: "ready", about: (await loading).about() });
    return;
  }
  if (!loading) throw new Error("the engine is not there");
  const engine = await loading;
  switch (request.kind) {
    case "file": engine.write(request.path, request.text); return;
    case "run": {
      const answers = request.tasks.map((task) => engine.run(task));
      say({ kind: "run", id: request.id, answers }, answers.map((answer) => answer.numbers));
      return;
    }
    case "tables": say({ kind: "tables", id: request.id, ...engine.tables(request.task) });
  }
}

self.onmessage = (message: MessageEvent<Request>) => {
  serve(message.data).catch((error: unknown) => say({ kind: "failed", reason: error instanceof Error ? error.message : String(error) }));
};
