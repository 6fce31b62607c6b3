// What the page computes: poses as the program wrote them, text as text, work that does not grow.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { browser, folder, kairos, open, program } from "./pages.mjs";
import { modules, runsOf } from "./modules.mjs";
import { syntheticPage } from "./synthetic.mjs";

const template = join(dirname(program), "../studio/viewer.html");
let chrome, place;
before(async () => {
  chrome = await browser();
  place = await folder();
});
after(async () => {
  await chrome?.close();
  await place?.remove();
});

/** trajectory.csv as [time, poses by body]. */
async function drawnFrames(path) {
  const [head, ...lines] = (await readFile(path, "utf8")).trim().split("\n");
  const columns = head.split(",");
  const frames = [];
  for (const line of lines) {
    const fields = line.split(",");
    const t = Number(fields[0]);
    if (frames.at(-1)?.[0] !== t) frames.push([t, []]);
    frames.at(-1)[1].push(["px", "py", "pz", "qw", "qx", "qy", "qz"].map((name) => Number(fields[columns.indexOf(name)])));
  }
  return frames;
}

/** The largest difference of any coordinate (m), or component of a quaternion up to its sign. */
function largest(a, b) {
  const sign = a.slice(3).reduce((sum, x, k) => sum + x * b[3 + k], 0) < 0 ? -1 : 1;
  return Math.max(...a.map((x, k) => Math.abs(x - (k < 3 ? 1 : sign) * b[k])));
}

/** 1e-9: coordinates are metres of order one; roundoff and the merging of motions stay far below. */
function compare(frames, posesAt, where) {
  let worst = [0, "nowhere"];
  for (const [t, bodies] of frames) {
    const poses = posesAt(t);
    bodies.forEach((body, i) => {
      const off = largest(body, poses[i]);
      if (!(off <= worst[0])) worst = [off, `body ${i} at ${t} s`];
    });
  }
  assert.ok(frames.length > 1);
  assert.ok(worst[0] <= 1e-9, `${where}: off by ${worst[0]}: ${worst[1]}`);
}

const short = ["--duration", "3"];
const cases = [
  ["bounce", ...short], ["bounce", ...short, "--thesis"], ["bat"], ["bat", "--thesis"], ["billiard", ...short],
  ["spinning-box"], ["spinning-box", "--integrator", "dopri5"], ["table-tennis", "--duration", "5"],
  ["table-tennis", "--duration", "5", "--thesis"], ["flipping-box", ...short], ["conveyor", ...short], ["pad", ...short],
  ["balloon", ...short], ["spring", ...short], ["piston", ...short], ["stroke"], ["stroke", "--thesis"],
  ["bounce", ...short, "--scheme", "bisected"], ["bounce", ...short, "--scheme", "substepped"],
];
const fileOf = ([scene, ...method]) => join(place.path, [scene, ...method].join("_"));

test("the page's modules put bodies where trajectory.csv has them at the times of frames", async (t) => {
  const { readPage, Motions, newState } = await modules(place.path, "data.ts", "motion.ts");
  const state = newState();
  for (const words of cases) {
    await t.test(words.join(" "), async () => {
      const out = fileOf(words);
      await kairos("run", ...words, "--out", out).catch((stopped) => assert.equal(stopped.code, 1));
      const frames = await drawnFrames(join(out, "trajectory.csv"));
      for (const source of [words, [out]]) {
        await kairos("view", ...source, "--out", `${out}.html`);
        const [run] = await runsOf(readPage, `${out}.html`);
        const motions = new Motions(run);
        const posesAt = (time) => run.bodies.map((_, i) => {
          const at = motions.at(i, time, state);
          return [at.px, at.py, at.pz, at.qw, at.qx, at.qy, at.qz];
        });
        compare(frames, posesAt, source.join(" "));
        compare(frames.slice().reverse(), posesAt, `${source.join(" ")}, backwards`);
      }
    });
  }
});

test("a body between frames is where the motion has it: a ball in free fall, at any time", async () => {
  const { readPage, Motions, newState } = await modules(place.path, "data.ts", "motion.ts");
  const file = join(place.path, "fall.html");
  await kairos("view", "bounce", "--duration", "0.3", "--out", file);
  const [run] = await runsOf(readPage, file);
  const ball = run.bodies.findIndex((body) => body.moves === "free");
  const motions = new Motions(run);
  const { py: y0 } = motions.at(ball, 0, newState());
  for (const t of [0.001234, 0.1, 0.2718281]) {
    const { py, vy } = motions.at(ball, t, newState());
    assert.ok(Math.abs(py - (y0 - 4.9 * t * t)) < 1e-12 && Math.abs(vy + 9.8 * t) < 1e-12);
  }
});

for (const words of [["bounce", ...short, "--thesis"], ["table-tennis", "--duration", "5"]]) {
  test(`${words.join(" ")}: poses evaluated in the browser are those of trajectory.csv`, async () => {
    const out = fileOf(words);
    await kairos("run", ...words, "--out", out);
    await kairos("view", ...words, "--out", `${out}.html`);
    const frames = await drawnFrames(join(out, "trajectory.csv"));
    const { page, context } = await open(chrome, `${out}.html`);
    const poses = await page.evaluate((times) => times.map((t) => window.kairos.poses(0, t)), frames.map(([t]) => t));
    const index = new Map(frames.map(([t], n) => [t, n]));
    compare(frames, (t) => poses[index.get(t)], words.join(" "));
    await context.close();
  });
}

test("text of a scene is text, whatever it holds", async () => {
  const file = join(place.path, "hostile.html");
  const hostile = '</script><script>window.caught = 1</script><img src=x onerror="window.caught = 2"><!--';
  await syntheticPage(template, file, { bodies: 2, frames: 60, text: hostile });
  const { page, context, said } = await open(chrome, file);
  assert.equal(await page.evaluate(() => window.caught), undefined);
  assert.equal(await page.textContent("#title"), hostile);
  assert.equal(await page.locator("main img").count(), 0);
  assert.deepEqual(said.filter((line) => !line.includes("GL Driver Message")), []);
  await context.close();
});

test("a name of a scene reaches the page of the program as text", async () => {
  const file = join(place.path, "named.html");
  const scene = join(place.path, "named.toml");
  const hostile = "</script><script>window.caught = 1</script><!--";
  await writeFile(scene, `name = "x"\nsummary = '${hostile}'\nduration = 0.5\nframe = "1/60"\nG = 9.8\n
[[body]]\nname = "ball"\nentity = "ball"\nradius = 0.1\nmass = 1.0\nposition = [0.0, 1.0, 0.0]\n`);
  await kairos("view", scene, "--out", file);
  const { page, context } = await open(chrome, file);
  assert.equal(await page.evaluate(() => window.caught), undefined);
  assert.equal(await page.textContent("#summary"), hostile);
  await context.close();
});

test("a thousand bodies and a hundred thousand frames: a body's pose costs a search in its own motions", async () => {
  const file = join(place.path, "many.html");
  await syntheticPage(template, file, { bodies: 1000, frames: 2000 });
  const long = join(place.path, "long.html");
  await syntheticPage(template, long, { bodies: 2, frames: 100_000 });
  for (const [page_, bodies] of [[file, 1001], [long, 3]]) {
    const { page, context, said } = await open(chrome, page_);
    const { reads, milliseconds, motions } = await page.evaluate(() => {
      const { worlds: [world], player } = window.kairos;
      const looks = 40;
      const began = performance.now();
      for (let k = 0; k < looks; ++k) {
        const t = (player.end * ((k * 17) % looks)) / looks;
        world.states.forEach((state, i) => world.motions.at(i, t, state));
        world.contacts.overlaps(world.states);
      }
      const milliseconds = (performance.now() - began) / looks;
      let count = 0;
      const { run } = world.motions;
      world.motions.run = { ...run, start: new Proxy(run.start, { get: (of, key) => { ++count; return of[key]; } }) };
      for (let k = 0; k < looks; ++k) {
        world.states.forEach((state, i) => world.motions.at(i, (player.end * ((k * 17) % looks)) / looks, state));
      }
      return { reads: count / looks / world.states.length, milliseconds, motions: run.start.length };
    });
    console.log(`# ${bodies} bodies, ${motions} motions: ${milliseconds.toFixed(2)} ms for poses and overlaps of a picture`);
    // A binary search in one body's motions, and the tries before it.
    assert.ok(reads < 2 * Math.log2(motions) + 8, `${reads} reads a body`);
    assert.deepEqual(said.filter((line) => !line.includes("GL Driver Message")), []);
    await context.close();
  }
});

test("events are called what events.csv calls them", async () => {
  const { readPage, eventKinds } = await modules(place.path, "data.ts");
  for (const scene of ["belt", "rolling", "table-tennis"]) {
    const out = join(place.path, `${scene}-events`);
    await kairos("run", scene, "--duration", "4", "--out", out);
    await kairos("view", scene, "--duration", "4", "--out", `${out}.html`);
    const [run] = await runsOf(readPage, `${out}.html`);
    const [head, ...lines] = (await readFile(join(out, "events.csv"), "utf8")).trim().split("\n").map((line) => line.split(","));
    assert.deepEqual(Array.from(run.events.kind, (kind) => eventKinds[kind]), lines.map((line) => line[head.indexOf("kind")].replace("-", " ")));
  }
});

test("gaps of shapes are those of geometry", async () => {
  const { gap, newState } = await modules(place.path, "gap.ts", "motion.ts");
  const at = (px, py, pz, axis = [0, 0, 1], angle = 0) => {
    const norm = Math.hypot(...axis);
    const [qx, qy, qz] = axis.map((x) => (x / norm) * Math.sin(angle / 2));
    return { ...newState(), px, py, pz, qw: Math.cos(angle / 2), qx, qy, qz };
  };
  const capsule = { kind: "capsule", x: 0.1, y: 0.6, z: 0.1, radius: 0.1, length: 1 };
  const cylinder = { kind: "cylinder", x: 0.2, y: 0.5, z: 0.2, radius: 0.2, length: 1 };
  const cone = { kind: "cone", x: 0.3, y: 0.75, z: 0.3, radius: 0.3, length: 1 };
  const box = { kind: "box", x: 0.1, y: 0.2, z: 0.3 };
  const hull = { kind: "hull", x: 0.1, y: 0.2, z: 0.3, rounding: 0, points: [-0.1, 0.1].flatMap((x) => [-0.2, 0.2].flatMap((y) => [-0.3, 0.3].flatMap((z) => [x, y, z]))) };
  const ball = { kind: "sphere", x: 0.05, y: 0.05, z: 0.05 };
  const floor = { kind: "half-space", x: 0, y: 1, z: 0 };
  const cases = [
    ["capsules side by side", capsule, at(0, 0, 0), capsule, at(1, 0.3, 0), 0.8],
    ["crossed capsules", capsule, at(0, 0, 0), capsule, at(0.5, 0, 0, [1, 0, 0], Math.PI / 2), 0.3],
    ["capsules that overlap by their margins", capsule, at(0, 0, 0), capsule, at(0.15, 0, 0), -0.05],
    ["cylinders, rim to rim", cylinder, at(0, 0, 0), cylinder, at(1, 1.3, 0), Math.hypot(0.6, 0.3)],
    ["a cone's apex to a face of a cylinder", cone, at(0, -1, 0), cylinder, at(0, 0.5, 0), 0.25],
    ["a cone beside a capsule", cone, at(0, 0, 0), capsule, at(1, 0.25, 0), 0.6],
    ["a lying cylinder on the floor", cylinder, at(0, 0.2, 0, [0, 0, 1], Math.PI / 2), floor, at(0, 0, 0), 0],
    ["a cone on its base", cone, at(0, 0.5, 0), floor, at(0, 0, 0), 0.25],
    ["a rounded hull in the floor", { ...hull, rounding: 0.05 }, at(0, 0.2, 0), floor, at(0, 0, 0), -0.05],
    ["a dumbbell on its side and a ball", { kind: "compound", x: 1, y: 1, z: 1, parts: [-1, 1].map((x) => (
      { shape: { kind: "box", x: 0.2, y: 0.2, z: 0.2 }, place: { x, y: 0, z: 0 }, turn: { w: 1, x: 0, y: 0, z: 0 } })) },
      at(0, 0, 0, [0, 0, 1], Math.PI / 2), ball, at(0.5, 1, 0), 0.25],
    ["a hull inside a hull", hull, at(0, 0, 0), hull, at(0.15, 0, 0), -0.05],
  ];
  for (const [what, a, sa, b, sb, wanted] of cases) {
    assert.ok(Math.abs(gap(a, sa, b, sb) - wanted) < 1e-9, `${what}: ${gap(a, sa, b, sb)}, not ${wanted}`);
    assert.ok(Math.abs(gap(b, sb, a, sa) - wanted) < 1e-9, `${what}, the other way round`);
  }
  // A box told by its corners, anywhere around a ball: as the box's own formula has it.
  for (let k = 0; k < 500; ++k) {
    const turn = at(0, 0, 0, [Math.sin(k), Math.cos(3 * k), Math.sin(2 * k + 1)], k);
    const there = at(0.5 * Math.sin(7 * k), 0.6 * Math.cos(5 * k), 0.7 * Math.sin(11 * k + 2));
    const wanted = gap(box, turn, ball, there);
    if (wanted > -0.05) assert.ok(Math.abs(gap(hull, turn, ball, there) - wanted) < 1e-9, `${k}: ${gap(hull, turn, ball, there)}, not ${wanted}`);
  }
});

test("shapes of a run: apart at every picture, in touch at every impact, as the program says", async () => {
  const { readPage, Motions, Contacts, newState } = await modules(place.path, "data.ts", "motion.ts", "contacts.ts");
  const file = join(place.path, "shapes.html");
  await kairos("view", "shapes", "--out", file);
  const [run] = await runsOf(readPage, file);
  assert.deepEqual(run.bodies.map((body) => body.shape.kind), ["half-space", "capsule", "cylinder", "cone", "hull", "hull"]);
  const motions = new Motions(run), contacts = new Contacts(run);
  const states = run.bodies.map(newState);
  for (let k = 0; k <= 2000; ++k) {
    states.forEach((state, i) => motions.at(i, (run.end * k) / 2000, state));
    assert.deepEqual(contacts.overlaps(states), []);
  }
  assert.ok(run.events.time.length > 10);
  run.events.time.forEach((t, e) => {
    const [a, b] = [run.events.pair[2 * e], run.events.pair[2 * e + 1]];
    const gap = contacts.gapAt(motions, a === 0 ? b : a, t, a === 0 ? a : b);
    assert.ok(Math.abs(gap - run.events.gap[e]) < 1e-8, `event ${e}: ${gap}, not ${run.events.gap[e]}`);
  });
});

test("meshes are there as triangles, and nothing is said of gaps that are not known", async () => {
  const { readPage, Motions, Contacts, newState } = await modules(place.path, "data.ts", "motion.ts", "contacts.ts");
  const file = join(place.path, "meshes.html");
  await kairos("view", "meshes", "--duration", "0.5", "--out", file);
  const [run] = await runsOf(readPage, file);
  assert.deepEqual(run.bodies.map((body) => body.shape.kind), ["mesh", "mesh", "mesh", "sphere", "box"]);
  for (const { shape } of run.bodies.slice(0, 3)) {
    assert.ok(shape.triangles.length >= 12 && shape.triangles.length % 3 === 0);
    assert.ok(shape.triangles.every((k) => k < shape.points.length / 3));
    const reach = Math.max(...shape.points.filter((_, k) => k % 3 === 0).map(Math.abs));
    assert.ok(Math.abs(reach - shape.x) <= 1e-9 * shape.x, "the box is that around the points");
  }
  const motions = new Motions(run), contacts = new Contacts(run);
  const states = run.bodies.map(newState);
  for (let k = 0; k <= 100; ++k) {
    states.forEach((state, i) => motions.at(i, (run.end * k) / 100, state));
    assert.deepEqual(contacts.overlaps(states), []);
  }
});

test("joints: both sides are at one place all the time; what they hold is not told as an overlap", async () => {
  const { readPage, Motions, Contacts, newState } = await modules(place.path, "data.ts", "motion.ts", "contacts.ts");
  for (const [scene, kinds] of [["slider-crank", ["hinge", "hinge", "hinge", "slider"]], ["double-pendulum", ["rod", "rod"]]]) {
    const file = join(place.path, `${scene}.html`);
    await kairos("view", scene, "--out", file);
    const [run] = await runsOf(readPage, file);
    assert.deepEqual(run.joints.map((joint) => joint.kind), kinds);
    const motions = new Motions(run), contacts = new Contacts(run);
    const states = run.bodies.map(newState);
    const placeOf = ({ body, point: { x, y, z } }) => {
      if (body < 0) return [x, y, z];
      const { px, py, pz, qw, qx, qy, qz } = states[body];
      const [tx, ty, tz] = [2 * (qy * z - qz * y), 2 * (qz * x - qx * z), 2 * (qx * y - qy * x)];
      return [px + x + qw * tx + qy * tz - qz * ty, py + y + qw * ty + qz * tx - qx * tz, pz + z + qw * tz + qx * ty - qy * tx];
    };
    for (let k = 0; k <= 500; ++k) {
      states.forEach((state, i) => motions.at(i, (run.end * k) / 500, state));
      assert.deepEqual(contacts.overlaps(states), [], scene);
      for (const { kind, a, b } of run.joints) {
        const apart = Math.hypot(...placeOf(a).map((x, i) => x - placeOf(b)[i]));
        if (kind === "slider") assert.ok(apart < 1);
        else assert.ok(Math.abs(apart - (kind === "rod" ? 1 : 0)) < 1e-5, `${scene}, ${kind}: ${apart}`);
      }
    }
  }
});
