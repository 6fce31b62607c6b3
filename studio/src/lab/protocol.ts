// What the page and its worker say to each other, and what the engine says of itself.
import type { RunText } from "../data";

export interface Complaint { file: string; line: number; key: string; reason: string }

export interface OptionInfo {
  kind: "name" | "number" | "count" | "flag" | "duration" | "frames";
  help: string;
  default: string;
  unit: string;
  allowed: string;
}

export type Choice = "scheme" | "integrator" | "detector" | "impact";

/** The plug-ins, options, entities and keys of this build. */
export interface About {
  version: string;
  names: Record<Choice, Record<string, string>>;
  options: Record<string, OptionInfo>;
  entities: Record<string, { moves: "fixed" | "driven" | "free"; keys: Record<string, string> }>;
  keys: Record<string, string>;
  scenes: Record<string, string>;
}

/** A run as the engine tells it; or what is wrong. */
export interface EngineRun extends RunText {
  error?: Complaint;
  /** Where each body was written, from 1. */
  lines: Record<string, number>;
  cost?: Record<string, number>;
}

/** One method on the scene. */
export interface Task {
  scene: string;
  path: string;
  /** Lines `option=value`. */
  settings: string;
  /** See `Request` of the engine: empty, or where everything is at a later start. */
  start: string;
  /** Of computing; the run is stopped there. */
  seconds: number;
}

export interface Begin { kind: "begin"; wasm: ArrayBuffer; files: Record<string, string> }
export interface RunRequest { kind: "run"; id: number; tasks: Task[] }
export interface TableRequest { kind: "tables"; id: number; task: Task }
export interface FileRequest { kind: "file"; path: string; text: string }
export type Request = Begin | RunRequest | TableRequest | FileRequest;

export interface RunAnswer { text: EngineRun; numbers: ArrayBuffer; milliseconds: number }
export type Answer =
  | { kind: "ready"; about: About }
  | { kind: "run"; id: number; answers: RunAnswer[] }
  | { kind: "tables"; id: number; tables: string[]; error: Complaint | null }
  | { kind: "failed"; reason: string };
