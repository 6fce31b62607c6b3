// Table tennis: many strokes through the engine without a browser, and twenty by a real pointer in one.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { after, before, test } from "node:test";
import { Vector3 } from "three";
import { browser, folder, kairos, open, studioPage } from "./pages.mjs";
import { modules } from "./modules.mjs";
import { aim } from "./player.mjs";

const root = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
const built = process.env.KAIROS_ENGINE ?? join(root, "build/engine");
const settings = [
  "scheme=event-driven\nintegrator=auto\ndetector=certified\nimpact=newton",
  "scheme=original\nintegrator=thesis-euler\ndetector=sat\nimpact=thesis",
];
let place, page, engine, chrome;
before(async () => {
  place = await folder();
  page = await modules(place.path, "lab/wasm.ts", "data.ts", "motion.ts", "play/rally.ts", "play/verdict.ts", "play/table.ts");
  const create = createRequire(import.meta.url)(join(built, "engine.js"));
  engine = await page.Engine.load(create, await readFile(join(built, "engine.wasm")), {});
  chrome = await browser();
});
after(async () => {
  await chrome?.close();
  await place?.remove();
});

const speedOf = (stroke) => 1 + 0.6 * (stroke % 8);
const middle = [0, 0.95, 1.85];
const nudge = 0.0025;
const lift = -0.05;

function ask(files, name, method) {
  for (const which of ["bat", "hand", "frames"]) engine.write(`/scenes/${name}-${which}.csv`, files[which]);
  const answer = engine.run({ scene: files.scene, path: `/scenes/${name}.toml`, settings: settings[method], start: "", seconds: 0 });
  assert.equal(answer.text.error, undefined, JSON.stringify(answer.text.error));
  return page.readRun(answer.text, answer.numbers);
}

function ballOf(run, t) {
  const s = new page.Motions(run).at(run.bodies.findIndex((body) => body.name === "ball"), t, page.newState());
  return { p: [s.px, s.py, s.pz], v: [s.vx, s.vy, s.vz] };
}

/** What a ball does that nothing meets, `t` s later. */
const flown = ({ p, v }, t) => ({ p: p.map((x, k) => x + v[k] * t - (k === 1 ? 4.9 * t * t : 0)), v: v.map((x, k) => x - (k === 1 ? 9.8 * t : 0)) });

/** So many balls that the machine throws, each struck as fast as `speedOf` says: the verdicts on both methods. */
function play(balls) {
  const along = page.swingDirection.toArray();
  const put = ({ x, along: s }) => page.withinReach(new Vector3(x, middle[1] + s * along[1], middle[2] + s * along[2]));
  const rest = { x: 0, along: -0.35 };
  const rally = new page.Rally({ threshold: 0.01, scale: 1, nudge }, { p: put(rest), q: page.faceAt(0, lift) });
  const verdicts = [];
  for (let ball = 0; ball < balls; ++ball) {
    rally.point("return");
    while (rally.time < rally.met + 0.75) {
      if (rally.met === Infinity && rally.time > rally.released + 0.5) {
        const run = ask(rally.pointFiles("point", 0), "point", 0);
        const { p, v } = ballOf(run, run.end);
        if (page.comes("return", { pz: p[2], vy: v[1], vz: v[2] })) rally.meet(rally.last = { p, v });
      }
      const now = rally.met < Infinity ? aim(flown(rally.last, rally.time - rally.met), middle, along, speedOf(ball)) : null;
      const at = put(now ?? rest);
      rally.sample(1 / 60, at, page.faceAt(at.x, lift));
    }
    const whole = ask(rally.pointFiles("point", 0), "point", 0);
    const stroke = ask(rally.strokeFiles("stroke", nudge), "stroke", 1);
    verdicts.push([page.judge(whole, rally.met - rally.began), page.judge(stroke, 0)]);
  }
  return { rally, verdicts };
}

test("a hundred strokes of the same player: event-driven lets none through, original some", async () => {
  const { rally, verdicts } = play(100);
  const count = (i, what) => verdicts.filter((each) => each[i].outcome === what).length;
  console.log(`# 100 strokes: event-driven met ${100 - count(0, "missed")}, passed ${count(0, "passed")}; original met ${100 - count(1, "missed")}, passed ${count(1, "passed")}`);
  assert.equal(count(0, "passed"), 0);
  assert.ok(verdicts.every(([each]) => each.crossings === 0), "nor half through");
  assert.ok(count(0, "hit") >= 90);
  assert.ok(count(1, "passed") >= 5);
  // What is saved is the same rally in the program.
  const files = rally.allFiles("rally", 0);
  await writeFile(join(place.path, "rally.toml"), files.scene);
  for (const which of ["bat", "hand", "frames"]) await writeFile(join(place.path, `rally-${which}.csv`), files[which]);
  const out = join(place.path, "rally");
  await kairos("run", join(place.path, "rally.toml"), "--out", out);
  const events = (await readFile(join(out, "events.csv"), "utf8")).split("\n").map((line) => line.split(","));
  const hits = events.filter(([, , kind, a, b]) => kind === "impact" && [a, b].includes("bat") && [a, b].includes("ball")).length;
  assert.ok(hits >= count(0, "hit"), `${hits} impacts of ${count(0, "hit")} strokes`);
  await kairos("run", join(place.path, "rally.toml"), "--thesis", "--set", `body.bat.nudge=${nudge}`, "--out", join(place.path, "thesis"));
});

test("a stroke is judged by where bat and ball were", () => {
  // A bat at rest and a ball along its normal: through it, beside it, away from it.
  const motion = (z0, v, x) => [x, 0, z0, 0, 0, v];
  const run = (z0, v, x) => ({
    bodies: [{ name: "bat", shape: { x: 0.075, y: 0.08, z: 0.0075 } }, { name: "ball", shape: { x: 0.02 } }],
    first: Uint32Array.from([0, 1, 2]), start: Float64Array.from([0, 0]), duration: Float64Array.from([1, 1]),
    layout: Uint8Array.from([0, 255, 3, 0, 255, 1, 255, 3, 0, 255]),
    coefficients: Float64Array.from([0, 0, 0, ...motion(z0, v, x)]), frames: Float64Array.from([0, 0.5, 1]),
    events: { time: new Float64Array(), kind: new Uint8Array(), pair: new Uint32Array() }, begin: 0, end: 1,
  });
  const through = page.judge(run(-1, 2, 0), 0);
  assert.equal(through.outcome, "passed");
  assert.equal(through.speed, 2);
  assert.ok(Math.abs(through.time - 0.5) < 0.05);
  assert.equal(through.crossings, 1);
  assert.equal(page.judge(run(-1, 2, 0.08), 0).outcome, "missed");
  assert.equal(page.judge(run(-1, -2, 0), 0).outcome, "missed");
  assert.equal(page.judge(run(-1, 2, 0), 0.6).outcome, "missed", "what was before the release does not count");
});

/** What the script needs to see, and where a place of the bat is on the screen. */
const see = (p) => p.evaluate(() => {
  const { rally, strokes, grip, host } = window.game;
  const { viewer } = host;
  const [world] = viewer.worlds;
  const i = world.run.bodies.findIndex((body) => body.name === "ball");
  const s = world.motions.at(i, world.run.end, { px: 0, py: 0, pz: 0, qw: 1, qx: 0, qy: 0, qz: 0, vx: 0, vy: 0, vz: 0, wx: 0, wy: 0, wz: 0 });
  return { count: rally.count, time: rally.time, kind: rally.kind, flies: rally.released < rally.time, strokes: strokes.length,
    depth: grip.depth, ball: { p: [s.px, s.py, s.pz], v: [s.vx, s.vy, s.vz] } };
});
const pixel = (p, at) => p.evaluate((place) => {
  const { stage } = window.game.host.viewer;
  const [view] = stage.views();
  stage.camera.aspect = view.width / view.height;
  stage.camera.updateProjectionMatrix();
  stage.camera.updateMatrixWorld();
  const v = stage.camera.position.clone().set(...place).project(stage.camera);
  const box = stage.canvas.getBoundingClientRect();
  return { x: box.x + view.x + (0.5 + v.x / 2) * view.width, y: box.y + view.y + (0.5 - v.y / 2) * view.height };
}, at);

/** What a page saves, by name, once there are `count` files. */
async function downloads(p, count, act) {
  const coming = [];
  const all = new Promise((done) => p.on("download", (each) => { if (coming.push(each) === count) done(); }));
  await act();
  await all;
  p.removeAllListeners("download");
  const files = {};
  for (const each of coming) {
    files[each.suggestedFilename()] = join(place.path, each.suggestedFilename());
    await each.saveAs(files[each.suggestedFilename()]);
  }
  return files;
}

test("a rally of 20 strokes by the pointer: event-driven passes 0, original some; each is seen again, the track is saved", async () => {
  const { page: p, context, said, asked } = await open(chrome, studioPage, {
    ready: () => window.game?.rally, hash: "#table-tennis", viewport: { width: 950, height: 520 },
    deviceScaleFactor: 0.5,  // a quarter of the pixels, for a driver that renders in software
  });
  const along = page.swingDirection.toArray();
  const began = Date.now();
  await p.keyboard.press("Enter");
  for (let last = -1, now = await see(p); now.strokes < 20; ) {
    assert.ok(now.time < 120, "20 strokes take less than two minutes of the world");
    if (now.count !== last) {
      last = now.count;
      const m = [0, 0.95, now.depth];
      const target = (now.flies && (now.kind === "serve" || (now.ball.v[2] > 0 && now.ball.p[2] > 0.9)) && aim(now.ball, m, along, speedOf(now.strokes), 2))
        || { x: 0, along: -0.3 };
      const { x, y } = await pixel(p, [target.x, m[1] + target.along * along[1], m[2] + target.along * along[2]]);
      await p.mouse.move(x, y);
    }
    now = await see(p);
  }
  const counts = await p.evaluate(() => window.game.counts());
  const frames = await p.evaluate(() => window.game.rally.count);
  console.log(`# 20 strokes by the pointer: ${JSON.stringify(counts)}; ${frames} frames in ${((Date.now() - began) / 1000).toFixed(0)} s; ${await p.textContent("#play-latency")}`);
  assert.equal(counts["event-driven"].passed, 0);
  assert.ok(counts["event-driven"].met >= 10);
  assert.ok(counts.original.passed >= 1);
  assert.equal(await p.textContent("#play-passed-1"), String(counts.original.passed));
  // Nothing is shown beyond what is known.
  const { shown, known } = await p.evaluate(() => ({ shown: window.game.host.viewer.player.time, known: window.game.rally.time - window.game.rally.began }));
  assert.ok(shown <= known + 1e-12);
  // A passage again, slowly.
  await p.locator("#play-replays button").first().click();
  assert.equal(await p.isVisible("#play-back"), true);
  assert.equal(await p.evaluate(() => window.game.host.viewer.player.speed), 0.05);
  assert.match(await p.textContent("#play-said"), /let the ball through at/);
  await p.click("#play-back");
  await p.waitForFunction((were) => window.game.rally.count > were, frames);
  // The rally is saved, the pointer's track with it, and run by the program.
  await p.click("#play-pause");
  const saved = await downloads(p, 4, () => p.click("#play-save"));
  const scene = Object.values(saved).find((file) => file.endsWith(".toml"));
  const out = join(place.path, "pointer");
  await kairos("run", scene, "--out", out);
  const events = (await readFile(join(out, "events.csv"), "utf8")).split("\n").map((line) => line.split(","));
  const hits = events.filter(([, , kind, a, b]) => kind === "impact" && [a, b].includes("bat") && [a, b].includes("ball")).length;
  assert.ok(hits >= counts["event-driven"].met, `${hits} impacts of ${counts["event-driven"].met} strokes`);
  // The rally as a scene: the page's engine makes of it what the program makes of the saved files.
  await p.click("#play-open");
  await p.waitForFunction(() => window.studio.viewer.runs[0].title === "Table tennis" && window.studio.viewer.runs[0].end > 5 && window.studio.client.busy() === 0);
  assert.deepEqual(await p.evaluate(() => window.studio.outcome.errors), [null, null]);
  const tables = await downloads(p, 3, () => p.click("#tables"));
  for (const [name, file] of Object.entries(tables)) {
    assert.ok((await readFile(file, "utf8")) === (await readFile(join(out, name), "utf8")), `${name} of the page is not the program's`);
  }
  assert.deepEqual(said.filter((line) => !line.includes("GL Driver Message")), []);
  assert.deepEqual(asked, []);
  await context.close();
});
