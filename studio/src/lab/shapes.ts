// New bodies: what a person adds with one choice, and changes afterwards.
import { tomlNumber, tomlVector } from "./toml_edit";

const kinds: Record<string, { name: string; lines: (size: (share: number) => string) => string[] }> = {
  ball: { name: "ball", lines: (s) => [`entity = "ball"`, `radius = ${s(0.08)}`, "mass = 1.0"] },
  body: { name: "box", lines: (s) => [`entity = "body"`, `half_extents = [${s(0.08)}, ${s(0.08)}, ${s(0.08)}]`, "mass = 1.0"] },
  wall: { name: "wall", lines: (s) => [`entity = "wall"`, `half_extents = [${s(0.3)}, ${s(0.03)}, ${s(0.3)}]`] },
  floor: { name: "floor", lines: () => [`entity = "wall"`, `shape = "half-space"`] },
  conveyor: { name: "conveyor", lines: (s) => [`entity = "conveyor"`, `half_extents = [${s(0.4)}, ${s(0.03)}, ${s(0.2)}]`] },
  pad: { name: "pad", lines: (s) => [`entity = "anti-gravity-pad"`, `half_extents = [${s(0.2)}, ${s(0.2)}, ${s(0.2)}]`] },
  balloon: { name: "balloon", lines: (s) => [`entity = "balloon"`, `radius = ${s(0.08)}`, "mass = 1.0"] },
};

/** The text of a new body of that kind, with a name that is free, where one looks. */
export function newBody(kind: string, taken: Set<string>, at: number[], radius: number): { name: string; text: string } {
  const { name: stem, lines } = kinds[kind];
  let name = stem;
  for (let n = 2; taken.has(name); ++n) name = `${stem}-${n}`;
  const place = kind === "floor" ? [at[0], at[1] - radius, at[2]] : at;
  const size = (share: number) => tomlNumber(share * radius, radius);
  return { name, text: ["[[body]]", `name = "${name}"`, ...lines(size), `position = ${tomlVector(place, radius)}`].join("\n") };
}
