// Emscripten's module, which the build puts in under this name.
declare module "kairos-engine" {
  import type { CreateEngine } from "./wasm";
  const createEngine: CreateEngine;
  export default createEngine;
}
