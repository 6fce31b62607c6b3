// A page with as many balls, motions and frames as one likes, in the format of README.md.
import { readFile, writeFile } from "node:fs/promises";

/** Balls that bounce on a floor, each by itself, `bodies` of them for `frames` frames of 1/60 s. */
export async function syntheticPage(template, file, { bodies, frames, slowest = 3, text = "many", reason = "" }) {
  const end = frames / 60;
  const first = [0], start = [], duration = [], layout = [], c = [];
  const events = { time: [], kind: [], pair: [], gap: [], approach: [], vectors: [] };
  const shape = (kind, x, y, z) => ({ kind, x, y, z });
  const half = shape("half-space", 0, 1, 0);
  const list = { 0: { name: "floor", entity: "wall", moves: "fixed", field: false, shape: half, collides: half } };
  start.push(0); duration.push(Infinity); layout.push(0, 255, 3, 0, 255); c.push(0, 0, 0);
  first.push(1);
  const side = Math.ceil(Math.sqrt(bodies));
  const hits = [];
  for (let i = 0; i < bodies; ++i) {
    const ball = shape("sphere", 0.1, 0.1, 0.1);
    list[i + 1] = { name: i === 0 ? text : `ball ${i}`, entity: "ball", moves: "free", field: false, shape: ball, collides: ball };
    const x = i % side, z = Math.floor(i / side), speed = slowest + (i % 7) * 0.3;
    const flight = (2 * speed) / 9.8;
    for (let t = 0; t < end; t += flight) {
      start.push(t); duration.push(flight); layout.push(2, 255, 3, 0, 255);
      c.push(x, 0.1, z, 0, speed, 0, 0, -4.9, 0);
      if (t > 0) hits.push([t, i + 1, x, z, speed]);
    }
    first.push(start.length);
  }
  hits.sort((a, b) => a[0] - b[0]);
  for (const [t, i, x, z, speed] of hits) {
    events.time.push(t); events.kind.push(0); events.pair.push(0, i); events.gap.push(0); events.approach.push(-speed);
    events.vectors.push(x, 0, z, 0, 1, 0, 0, 2 * speed, 0);
  }
  const times = Array.from({ length: frames + 1 }, (_, k) => k / 60);
  const parts = [];
  const arrays = {};
  let offset = 0;
  const add = (name, type, Kind, values) => {
    const bytes = Buffer.from(Kind.from(values).buffer);
    const padded = Buffer.concat([bytes, Buffer.alloc((8 - (bytes.length % 8)) % 8)]);
    arrays[name] = { type, offset, length: values.length };
    parts.push(padded);
    offset += padded.length;
  };
  add("first", "u32", Uint32Array, first);
  add("start", "f64", Float64Array, start);
  add("duration", "f64", Float64Array, duration);
  add("layout", "u8", Uint8Array, layout);
  add("coefficients", "f64", Float64Array, c);
  add("frames", "f64", Float64Array, times);
  add("energy.kinetic", "f64", Float64Array, times.map((t) => Math.cos(t) ** 2));
  add("energy.potential", "f64", Float64Array, times.map((t) => Math.sin(t) ** 2));
  for (const [name, values] of Object.entries(events)) {
    const kinds = { kind: ["u8", Uint8Array], pair: ["u32", Uint32Array] };
    const [type, Kind] = kinds[name] ?? ["f64", Float64Array];
    add(`event.${name}`, type, Kind, values);
  }
  const run = { title: text, summary: text, method: text, note: text, reason, bodies: list, arrays };
  const json = JSON.stringify({ program: "synthetic", runs: { 0: run } }).replaceAll("<", "\\u003c");
  const data = `<script type="application/json" id="kairos-run">${json}</script>\n` +
    `<script type="text/plain" id="kairos-numbers-0">${Buffer.concat(parts).toString("base64")}</script>`;
  const page = await readFile(template, "utf8");
  await writeFile(file, page.replace("<!--kairos-data-->", () => data));
}
