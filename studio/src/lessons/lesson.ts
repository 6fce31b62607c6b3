// What a lesson is: a scene with a few controls, a question, and the plot that answers it.
import type { Run } from "../data";
import type { RunAnswer } from "../lab/protocol";

export type Values = Record<string, number | string>;

export interface Control {
  key: string;
  label: string;
  /** Choices, or a range with its unit. */
  choices?: { value: string; text: string }[];
  range?: { least: number; most: number; step: number; unit: string };
  start: number | string;
}

/** A method on a scene: lines `option=value`, as the program's. */
export interface Asked { scene: string; settings: string }
export interface Told { run: Run; answer: RunAnswer }
/** All of them; null where a later question came. */
export type Ask = (asked: Asked[]) => Promise<Told[] | null>;

export interface Line { label: string; x: number[]; y: (number | null)[]; dashed?: boolean; points?: boolean }
export interface Chart {
  title: string;
  x: string;
  y: string;
  log?: boolean;
  lines: Line[];
  /** What it says at these values, in a sentence. */
  says: string;
}

export interface Lesson {
  title: string;
  question: string;
  /** What to do, and what it is good for. */
  text: string;
  controls: Control[];
  /** What is seen: two methods beside each other. */
  seen(values: Values): Asked[];
  plot(values: Values, seen: Told[], ask: Ask): Promise<Chart | null>;
  answer: string;
}

export const eventDriven = (more = "") => `scheme=event-driven\nintegrator=auto\ndetector=certified\nimpact=newton${more}`;
export const original = (more = "") => `scheme=original\nintegrator=thesis-euler\ndetector=sat\nimpact=thesis${more}`;
export const number = (values: Values, key: string) => Number(values[key]);

/** A number that TOML takes for one with a fraction. */
export const real = (x: number) => (Number.isInteger(x) ? `${x}.0` : String(x));
export const frames = (start = "1/60"): Control => ({
  key: "frame", label: "A frame lasts", start,
  choices: ["1/30", "1/60", "1/120", "1/240"].map((value) => ({ value, text: `${value} s` })),
});
export const seconds = (fraction: string): number => {
  const [a, b] = fraction.split("/").map(Number);
  return a / b;
};
/** n numbers from a to b. */
export const between = (a: number, b: number, n: number) => Array.from({ length: n }, (_, i) => a + ((b - a) * i) / (n - 1));
