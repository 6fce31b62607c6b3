// What `kairos view` puts into the page, see README.md.
import { inSlices } from "./pause";

export type ShapeKind = "sphere" | "box" | "half-space" | "capsule" | "cylinder" | "cone" | "hull" | "mesh" | "compound";

/** Body frame, m. */
export interface Shape {
  kind: ShapeKind;
  /** Half extents of the box around the origin that contains it, or the outward normal of a half-space. */
  x: number;
  y: number;
  z: number;
  /** Of what is round about y, and its extent along y: of a capsule between the centres of its caps. */
  radius?: number;
  length?: number;
  /** Of a hull: how far its surface is from that of its points; coordinates, three a point. */
  rounding?: number;
  points?: number[];
  /** Of a mesh: three of its points each. */
  triangles?: number[];
  /** Of a compound. */
  parts?: Part[];
}

/** A convex part, and where it is in its body. */
export interface Part {
  shape: Shape;
  place: Vector;
  turn: Vector & { w: number };
}

export interface Vector {
  x: number;
  y: number;
  z: number;
}

export const jointKinds = ["ball", "hinge", "slider", "rod", "weld"] as const;

/** A body (-1: the world), and in its frame where the joint is and its axis. */
export interface JointSide {
  body: number;
  point: Vector;
  axis: Vector;
}

export interface Joint {
  kind: (typeof jointKinds)[number];
  name: string;
  /** Whether the two also meet as solids. */
  collide: boolean;
  a: JointSide;
  b: JointSide;
}

export interface Body {
  name: string;
  entity: string;
  moves: "fixed" | "driven" | "free";
  field: boolean;
  shape: Shape;
  collides: Shape;
  /** How its surface runs, body frame, m/s. */
  belt?: Vector;
}

export const eventKinds = [
  "impact",
  "contact begins",
  "contact ends",
  "field entered",
  "field left",
  "grasped",
  "released",
  "slip begins",
  "stick begins",
  "roll begins",
] as const;

/** A run: SI units, world frame, y up. */
export interface Run {
  title: string;
  summary: string;
  method: string;
  note: string;
  reason: string;
  bodies: Body[];
  joints: Joint[];
  /** Motions of body i are those from first[i] to first[i + 1] - 1. */
  first: Uint32Array;
  start: Float64Array;
  duration: Float64Array;
  layout: Uint8Array;
  coefficients: Float64Array;
  frames: Float64Array;
  energy: { name: string; values: Float64Array }[];
  events: Events;
  begin: number;
  end: number;
}

export interface Events {
  time: Float64Array;
  kind: Uint8Array;
  pair: Uint32Array;
  gap: Float64Array;
  approach: Float64Array;
  /** Of each event: contact point, normal from a to b, impulse on b. */
  vectors: Float64Array;
}

interface Entry {
  type: "f64" | "u32" | "u8";
  offset: number;
  length: number;
}

export interface RunText {
  title: string;
  summary: string;
  method: string;
  note: string;
  reason: string;
  bodies: Record<string, Body>;
  joints?: Record<string, Joint>;
  arrays: Record<string, Entry>;
}

const digits = new Uint8Array(128);
[..."ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"].forEach((c, i) => {
  digits[c.charCodeAt(0)] = i;
});

/** RFC 4648, some 100 kB a piece; `atob` would make a text of it first. */
export function* fromBase64(text: string): Generator<void, ArrayBuffer> {
  const padding = text.endsWith("==") ? 2 : text.endsWith("=") ? 1 : 0;
  const bytes = new Uint8Array((text.length / 4) * 3 - padding);
  let out = 0;
  for (let i = 0; i < text.length; i += 4) {
    if (i % 131072 === 131068) yield;
    const group =
      (digits[text.charCodeAt(i)] << 18) |
      (digits[text.charCodeAt(i + 1)] << 12) |
      (digits[text.charCodeAt(i + 2) & 127] << 6) |
      digits[text.charCodeAt(i + 3) & 127];
    bytes[out++] = group >> 16;
    if (out < bytes.length) bytes[out++] = (group >> 8) & 255;
    if (out < bytes.length) bytes[out++] = group & 255;
  }
  return bytes.buffer;
}

/** Lists are written as members 0, 1, 2, ... */
const withPoints = (shape: Shape): Shape => ({
  ...shape,
  ...(shape.points && { points: Object.values(shape.points) }),
  ...(shape.triangles && { triangles: Object.values(shape.triangles) }),
  ...(shape.parts && { parts: Object.values(shape.parts).map((part) => ({ ...part, shape: withPoints(part.shape) })) }),
});

/** A run from its names and texts, and the block of its numbers. */
export function readRun(text: RunText, buffer: ArrayBuffer): Run {
  const find = (name: string): Entry => {
    const entry = text.arrays[name];
    if (!entry) throw new Error(`the page holds no ${name}`);
    return entry;
  };
  const f64 = (name: string) => new Float64Array(buffer, find(name).offset, find(name).length);
  const u32 = (name: string) => new Uint32Array(buffer, find(name).offset, find(name).length);
  const u8 = (name: string) => new Uint8Array(buffer, find(name).offset, find(name).length);
  const frames = f64("frames");
  return {
    title: text.title,
    summary: text.summary,
    method: text.method,
    note: text.note,
    reason: text.reason,
    bodies: Object.values(text.bodies).map((body) => ({ ...body, shape: withPoints(body.shape), collides: withPoints(body.collides) })),
    joints: Object.values(text.joints ?? {}),
    first: u32("first"),
    start: f64("start"),
    duration: f64("duration"),
    layout: u8("layout"),
    coefficients: f64("coefficients"),
    frames,
    energy: Object.keys(text.arrays)
      .filter((name) => name.startsWith("energy."))
      .map((name) => ({ name: name.slice("energy.".length).replace(/[-_]/g, " "), values: f64(name) })),
    events: {
      time: f64("event.time"),
      kind: u8("event.kind"),
      pair: u32("event.pair"),
      gap: f64("event.gap"),
      approach: f64("event.approach"),
      vectors: f64("event.vectors"),
    },
    begin: frames[0] ?? 0,
    end: frames.length > 0 ? frames[frames.length - 1] : 0,
  };
}

/** The runs of this page. */
export async function readPage(): Promise<Run[]> {
  const json = document.getElementById("kairos-run")?.textContent;
  if (!json) throw new Error("this page holds no run: `kairos view` makes one that does");
  const page = JSON.parse(json) as { runs: Record<string, RunText> };
  const runs: Run[] = [];
  for (const [i, text] of Object.values(page.runs).entries()) {
    const block = document.getElementById(`kairos-numbers-${i}`);
    runs.push(readRun(text, await inSlices(fromBase64(block?.textContent ?? ""))));
    block?.remove();
  }
  return runs;
}
