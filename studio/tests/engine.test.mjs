// The engine of the page against the program: the same files of a run, byte for byte.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { after, before, test } from "node:test";
import { folder, kairos } from "./pages.mjs";
import { modules } from "./modules.mjs";
import { keysOf, sceneFiles } from "../scenes.mjs";

const root = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
const built = process.env.KAIROS_ENGINE ?? join(root, "build/engine");
const thesis = "scheme=original\nintegrator=thesis-euler\ndetector=sat\nimpact=thesis";
const tables = ["trajectory", "events", "energy"];
let place, engine, files, page;
before(async () => {
  place = await folder();
  files = await sceneFiles(join(root, "scenes"));
  page = await modules(place.path, "lab/wasm.ts", "data.ts", "motion.ts");
  const create = createRequire(import.meta.url)(join(built, "engine.js"));
  engine = await page.Engine.load(create, await readFile(join(built, "engine.wasm")), files);
});
after(() => place?.remove());

const task = (path, settings) => ({ scene: files[path], path, settings, start: "", seconds: 0 });

/** Of two texts, the number and both versions of the first line that is not the same. */
function firstDifference(one, other) {
  const [a, b] = [one, other].map((text) => text.split("\n"));
  const line = a.findIndex((each, i) => each !== b[i]);
  return `${line + 1}: ${a[line]} | ${b[line]}`;
}

test("every shipped scene: the bytes of the program's files", async (t) => {
  for (const [name, path] of Object.entries(engine.about().scenes)) {
    for (const [method, settings, words] of [["event-driven", "", []], ["the thesis' own", thesis, ["--thesis"]]]) {
      await t.test(`${name}, ${method}`, async () => {
        const out = join(place.path, `${name}-${words.length}`);
        let code = 0;
        await kairos("run", name, ...words, "--out", out).catch((ended) => (code = ended.code));
        const { tables: mine, error } = engine.tables(task(path, settings));
        if (code === 2) {  // refused, as friction or joints by a scheme that knows none: here as there
          assert.match(error.reason, /friction|joints|periodic/);
          return;
        }
        assert.ok(code <= 1);
        assert.equal(error, null);
        for (const [i, table] of tables.entries()) {
          const theirs = await readFile(join(out, `${table}.csv`), "utf8");
          assert.ok(mine[i] === theirs, `${table}.csv differs first in line ${firstDifference(mine[i], theirs)}`);
        }
      });
    }
  }
});

test("what is wrong is told in the program's words, with line and key", () => {
  const scene = "duration = 1.0\n[[body]]\nname = \"ball\"\nentity = \"ball\"\nradius = -1.0\nmass = 1.0\n";
  const { text } = engine.run({ scene, path: "a.toml", settings: "", start: "", seconds: 0 });
  assert.deepEqual(text.error, { file: "a.toml", line: 5, key: "body.ball.radius", reason: "is -1; allowed: a number from 1e-15 to 1e+12 (m)" });
  for (const settings of ["scheme=orignal", "frame_jitter=2", "nonsense"]) {
    const { text: refused } = engine.run({ ...task("/scenes/bounce.toml", settings) });
    assert.ok(refused.error && refused.error.line === 0 && refused.error.reason !== "", settings);
  }
});

test("a run that takes too long ends with what there is, and says so", () => {
  const { text } = engine.run({ ...task("/scenes/billiard.toml", "duration=1e6"), seconds: 0.5 });
  assert.equal(text.error, undefined);
  assert.match(text.reason, /took longer than 0\.5 s; shown up to t = /);
  assert.ok(text.arrays.frames.length > 1);
});

test("a run that goes on from a later moment is the rest of the first", async () => {
  const { readRun, Motions, newState } = page;
  const at = (run, name, t) => {
    const { px, py, pz, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz } = new Motions(run).at(run.bodies.findIndex((body) => body.name === name), t, newState());
    return [px, py, pz, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz];
  };
  for (const [path, name, moment, later] of [["/scenes/bounce.toml", "ball", 0.4, 1.7], ["/scenes/table.toml", "ball", 0.11, 0.31]]) {
    const whole = engine.run(task(path, ""));
    const first = readRun(whole.text, whole.numbers);
    const start = `${moment}\n${name}\t${at(first, name, moment).join(" ")}\n`;
    const rest = engine.run({ ...task(path, "duration=2"), start });
    assert.equal(rest.text.error, undefined);
    const second = readRun(rest.text, rest.numbers);
    at(second, name, later - moment).forEach((x, k) => assert.ok(Math.abs(x - at(first, name, later)[k]) < 1e-9, `${path}: ${k}`));
  }
});

test("the page documents every key that reading takes", async () => {
  const keys = keysOf(await readFile(join(root, "scenes/README.md"), "utf8"));
  for (const name of Object.keys(engine.about().keys)) {
    const [table, key] = name.includes(".") ? [name.slice(0, name.lastIndexOf(".")), name.slice(name.lastIndexOf(".") + 1)] : ["", name];
    if (!["", "body", "body.drive", "frame"].includes(table)) continue;
    assert.ok(keys[table].some((info) => info.key === key), name);
  }
  for (const [entity, { keys: own }] of Object.entries(engine.about().entities)) {
    for (const key of Object.keys(own)) assert.ok(keys[`entity.${entity}`].some((info) => info.key === key), `${entity}.${key}`);
  }
});
