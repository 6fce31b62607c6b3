// The studio in a real browser: what a person does with a scene, by pointer and keys.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { browser, folder, kairos, open, studioPage } from "./pages.mjs";

const axe = await readFile(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
let chrome, place;
before(async () => {
  chrome = await browser();
  place = await folder();
});
after(async () => {
  await chrome?.close();
  await place?.remove();
});

/** What the driver of software rendering says of reading pixels is not the page's. */
const spoken = (said) => said.filter((line) => !line.includes("GL Driver Message"));
const ready = () => window.studio?.viewer;
const start = (hash = "", options = {}) => open(chrome, studioPage, { ready, hash, viewport: { width: 1400, height: 1000 }, ...options });
const text = (page) => page.evaluate(() => window.studio.editor.text);
/** Waits until what was changed has been run and is shown. */
async function settled(page, act) {
  const was = await page.evaluate(() => { window.before = window.studio.outcome; });
  await act();
  await page.waitForFunction(() => window.studio.outcome !== window.before && window.studio.client.busy() === 0);
  return was;
}
const load = (page, name) => settled(page, () => page.selectOption("#scene", name));
const seek = (page, t) => page.evaluate((to) => { window.studio.viewer.player.seek(to); window.studio.viewer.draw(); }, t);
/** Where a body is drawn, in pixels of the page, in view A. */
const onScreen = (page, name) => page.evaluate((which) => {
  const { viewer } = window.studio;
  viewer.draw();
  const body = viewer.runs[0].bodies.findIndex((each) => each.name === which);
  const [view] = viewer.stage.views();
  const at = viewer.stage.placeOf(body, 1, 1);
  viewer.stage.camera.aspect = view.width / view.height;
  viewer.stage.camera.updateProjectionMatrix();
  viewer.stage.camera.updateMatrixWorld();
  at.project(viewer.stage.camera);
  const box = viewer.stage.canvas.getBoundingClientRect();
  return { x: box.x + view.x + (0.5 + at.x / 2) * view.width, y: box.y + view.y + (0.5 - at.y / 2) * view.height };
}, name);
const drag = async (page, from, dx, dy) => {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(from.x + dx / 2, from.y + dy / 2, { steps: 4 });
  await page.mouse.move(from.x + dx, from.y + dy, { steps: 4 });
  await page.mouse.up();
};
const blockOf = (toml, name) => toml.split("[[body]]").find((each) => each.includes(`name = "${name}"`));
const arrayOf = (toml, name, key) => JSON.parse(new RegExp(`^${key} = (\\[[^\\]]*\\])`, "m").exec(blockOf(toml, name))[1]);
const positionOf = (toml, name) => arrayOf(toml, name, "position");
const poseAtStart = (page, name) => page.evaluate((which) => {
  const { viewer } = window.studio;
  return viewer.poses(0, viewer.player.begin)[viewer.runs[0].bodies.findIndex((body) => body.name === which)].slice(0, 3);
}, name);
const violations = async (page) => {
  await page.evaluate(axe);
  const found = await page.evaluate(() => window.axe.run());
  return found.violations.map((v) => `${v.id}: ${v.nodes[0].html}`);
};

test("every shipped scene loads, runs beside the thesis' method and is shown, silently, without a network", async () => {
  const { page, context, said, asked } = await start();
  const names = await page.evaluate(() => Object.keys(window.studio.about.scenes));
  assert.ok(names.length >= 20);
  for (const name of names) {
    await load(page, name);
    const { title, runs, errors, bodies, end } = await page.evaluate(() => {
      const { viewer, outcome } = window.studio;
      viewer.player.seek(0.3 * viewer.player.end);
      viewer.draw();
      return { title: viewer.runs[0].title, runs: viewer.runs.length, errors: outcome.errors, bodies: viewer.runs[0].bodies.length, end: viewer.player.end };
    });
    if (errors.some((error) => /friction|joints|periodic/.test(error?.reason ?? ""))) continue;  // refused by one that knows none
    assert.equal(title, name);
    assert.equal(runs, 2, name);
    assert.deepEqual(errors, [null, null], name);
    assert.ok(bodies >= 1 && end > 0, name);
  }
  assert.deepEqual(spoken(said), []);
  assert.deepEqual(asked, []);
  await context.close();
});

test("a body that is dragged is where the text says; undo brings it back, redo there again", async () => {
  const { page, context, said } = await start();
  const was = await text(page);
  await page.selectOption("#other", { label: "floor" });
  await settled(page, async () => drag(page, await onScreen(page, "ball"), 60, -40));
  await page.waitForTimeout(200);
  assert.equal(await page.locator("#other option:checked").textContent(), "floor", "what was chosen to look at stays");
  const moved = await text(page);
  const position = positionOf(moved, "ball");
  assert.notDeepEqual(position, [0, 5, 0]);
  assert.deepEqual(await poseAtStart(page, "ball"), position);
  assert.ok(position[0] > 0 && position[1] > 5, "to the right and up");
  assert.equal(moved.replace(/^position = .*$/m, ""), was.replace(/^position = .*$/m, ""), "the rest stays as it was");
  await settled(page, () => page.click("#undo"));
  assert.equal(await text(page), was, "one drag is one step");
  await settled(page, () => page.click("#redo"));
  assert.equal(await text(page), moved);
  assert.deepEqual(spoken(said), []);
  await context.close();
});

test("a body is turned and made larger by the pointer, and moved by keys", async () => {
  const { page, context } = await start();
  await load(page, "spinning-box");
  await page.selectOption("#tool", "turn");
  await settled(page, async () => drag(page, await onScreen(page, "box"), 40, 0));
  const [w] = arrayOf(await text(page), "box", "orientation");
  assert.ok(w > 0.5 && w < 1);
  await page.selectOption("#tool", "size");
  const sizes = async () => arrayOf(await text(page), "box", "half_extents");
  const before = await sizes();
  await settled(page, async () => drag(page, await onScreen(page, "box"), 40, 0));
  (await sizes()).forEach((x, k) => assert.ok(x > 1.1 * before[k]));
  await load(page, "bounce");
  await page.selectOption("#tool", "move");
  await page.focus("#canvas");
  await settled(page, () => page.keyboard.press("Shift+ArrowRight"));
  assert.ok(positionOf(await text(page), "ball")[0] > 0);
  await context.close();
});

test("the text edited by hand moves the body; what is wrong is told at its line, and the last world stays", async () => {
  const { page, context } = await start();
  await page.evaluate(() => {
    const { view } = window.studio.editor;
    const at = view.state.doc.toString().indexOf("[0.0, 5.0, 0.0]");
    view.focus();
    view.dispatch({ selection: { anchor: at, head: at + "[0.0, 5.0, 0.0]".length } });
  });
  await settled(page, () => page.keyboard.type("[1.5, 7.0, 0.0]"));
  await page.waitForTimeout(300);
  assert.deepEqual(await poseAtStart(page, "ball"), [1.5, 7, 0]);
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("Home");
  await settled(page, () => page.keyboard.type("weight = 3\n"));
  await page.waitForFunction(() => !document.getElementById("wrong").hidden);
  const line = (await text(page)).split("\n").indexOf("weight = 3") + 1;
  const told = await page.textContent("#wrong");
  assert.ok(told.startsWith(`line ${line}: body.ball.weight: unknown key`), told);
  assert.equal(await page.locator(".cm-lint-marker-error").count(), 1);
  assert.deepEqual(await poseAtStart(page, "ball"), [1.5, 7, 0]);
  // The message is the program's own.
  const file = join(place.path, "wrong.toml");
  await writeFile(file, await text(page));
  const { stderr } = await kairos("run", file).then(() => assert.fail("the program takes it"), (refused) => refused);
  assert.ok(stderr.trim().endsWith(told.slice(told.indexOf("body.ball"))), `${stderr} / ${told}`);
  await context.close();
});

test("a body is deleted during a run: the others go on from where they are", async () => {
  const { page, context, said } = await start();
  await load(page, "billiard");
  await page.selectOption("#acts", "now");
  await seek(page, 1);
  const other = () => page.evaluate(() => {
    const { viewer } = window.studio;
    return viewer.poses(0, 1)[viewer.runs[0].bodies.findIndex((body) => body.name === "ball-02")];
  });
  const before = await other();
  await page.selectOption("#body", { label: "ball-01" });
  await page.focus("#canvas");
  await settled(page, () => page.keyboard.press("Delete"));
  const names = await page.evaluate(() => window.studio.viewer.runs[0].bodies.map((body) => body.name));
  assert.ok(!names.includes("ball-01"));
  assert.doesNotMatch(await text(page), /ball-01/);
  assert.equal(await page.evaluate(() => window.studio.viewer.player.begin), 1);
  (await other()).forEach((x, k) => assert.ok(Math.abs(x - before[k]) < 1e-12));
  await settled(page, () => page.click("#from-start"));
  assert.equal(await page.evaluate(() => window.studio.viewer.player.begin), 0);
  assert.deepEqual(spoken(said), []);
  await context.close();
});

test("a body is added where one looks, and a key is set in the panel", async () => {
  const { page, context } = await start();
  await settled(page, () => page.selectOption("#add", "body"));
  assert.match(await text(page), /\[\[body\]\]\nname = "box"\nentity = "body"/);
  await page.selectOption("#body", { label: "box" });
  await settled(page, async () => {
    await page.fill("#key-restitution", "0.5");
    await page.keyboard.press("Enter");
  });
  assert.match(blockOf(await text(page), "box"), /^restitution = 0\.5$/m);
  assert.match(await page.textContent("#about-restitution"), /default 1; 0 to 1/);
  await context.close();
});

test("methods act at once; one that is refused says why where it was chosen", async () => {
  const { page, context } = await start();
  await settled(page, () => page.selectOption("#b-scheme", "substepped"));
  await page.waitForFunction(() => /substepped/.test(document.getElementById("labels").textContent));
  await settled(page, () => page.selectOption("#a-detector", "sat"));
  assert.match(await page.locator("fieldset .refused").first().textContent(), /sat/);
  assert.equal(await page.evaluate(() => window.studio.viewer.runs.length), 2, "the last good world stays");
  await settled(page, () => page.selectOption("#a-detector", "certified"));
  assert.equal(await page.locator("fieldset .refused").first().isHidden(), true);
  await settled(page, async () => {
    await page.fill("#option-frame", "1/10");
    await page.keyboard.press("Enter");
  });
  assert.ok(Math.abs((await page.evaluate(() => window.studio.viewer.runs[1].frames[1])) - 0.1) < 1e-12);
  await settled(page, () => page.uncheck("#beside"));
  assert.equal(await page.evaluate(() => window.studio.viewer.runs.length), 1);
  await context.close();
});

test("a link carries the scene and its methods to another page", async () => {
  const first = await start();
  await load(first.page, "corridor");
  await settled(first.page, () => first.page.selectOption("#b-scheme", "substepped"));
  await settled(first.page, async () => drag(first.page, await onScreen(first.page, "ball"), 30, 0));
  await first.page.waitForTimeout(200);
  await first.page.click("#link");
  await first.page.waitForFunction(() => location.hash !== "");
  const hash = await first.page.evaluate(() => location.hash);
  const wanted = await text(first.page);
  await first.context.close();
  const second = await start(hash);
  assert.equal(await text(second.page), wanted);
  assert.equal(await second.page.inputValue("#b-scheme"), "substepped");
  await second.context.close();
});

test("files: a scene is opened and saved; what is no scene is refused in words", async () => {
  const { page, context } = await start();
  const scene = `name = "mine"\nduration = 1.0\n\n[[body]]\nname = "ball"\nentity = "ball"\nradius = 0.1\nmass = 1.0\n`;
  await settled(page, () => page.setInputFiles("#file", { name: "mine.toml", mimeType: "text/plain", buffer: Buffer.from(scene) }));
  assert.equal(await page.textContent("#title"), "mine");
  const coming = page.waitForEvent("download");
  await page.click("#save");
  const saved = join(place.path, "mine.toml");
  await (await coming).saveAs(saved);
  assert.equal(await readFile(saved, "utf8"), scene);
  await page.setInputFiles("#file", { name: "picture.png", mimeType: "image/png", buffer: Buffer.from([1, 2]) });
  await page.waitForFunction(() => /picture\.png is no scene/.test(document.getElementById("said").textContent));
  assert.equal(await page.textContent("#title"), "mine");
  await context.close();
});

test("text of a scene is text, and a scene of many bodies is declined with the limit", async () => {
  const { page, context, said } = await start();
  const hostile = "</script><script>window.caught = 1</script><img src=x onerror=window.caught=2>";
  const ball = (i) => `[[body]]\nname = "b${i}"\nentity = "ball"\nradius = 0.1\nmass = 1.0\nposition = [${i}.0, 0.0, 0.0]\n`;
  const open_ = (toml) => page.setInputFiles("#file", { name: "x.toml", mimeType: "text/plain", buffer: Buffer.from(toml) });
  await settled(page, () => open_(`name = '${hostile}'\nsummary = '${hostile}'\nduration = 1\n${ball(0)}`));
  assert.equal(await page.textContent("#title"), hostile);
  await settled(page, () => open_(`name = "ok"\n'${hostile}' = 1\n${ball(0)}`));
  assert.match(await page.textContent("#wrong"), /unknown key/);
  assert.equal(await page.evaluate(() => window.caught), undefined);
  await settled(page, () => open_(`duration = 0.1\n${Array.from({ length: 100_000 }, (_, i) => ball(i)).join("\n")}`));
  assert.match(await page.textContent("#wrong"), /are 100000; a page takes up to 20000/);
  assert.deepEqual(spoken(said), []);
  await context.close();
});

for (const [what, options] of [["a wide page", {}], ["a phone in the dark", { viewport: { width: 390, height: 800 }, colorScheme: "dark", hasTouch: true }]]) {
  test(`${what}: axe finds nothing, nothing sticks out`, async () => {
    const { page, context, said } = await start("", options);
    assert.deepEqual(await violations(page), []);
    const { width, wanted } = await page.evaluate(() => ({ width: document.documentElement.clientWidth, wanted: document.documentElement.scrollWidth }));
    assert.equal(wanted, width);
    assert.deepEqual(spoken(said), []);
    await context.close();
  });
}

test("nothing blocks the page for long while a long run is computed", async () => {
  const { page, context } = await start();
  await page.evaluate(() => {
    window.longest = 0;
    let last = performance.now();
    window.ticking = setInterval(() => { const now = performance.now(); window.longest = Math.max(window.longest, now - last); last = now; }, 5);
  });
  await page.fill("#option-duration", "10000");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.studio.client.busy() > 250);
  await page.evaluate(() => { window.during = window.longest; });
  await page.fill("#option-duration", "1");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.studio.viewer.player.end === 1);
  const during = await page.evaluate(() => window.during);
  console.log(`# longest pause of the page while the worker computes: ${during.toFixed(0)} ms`);
  // 50 ms is the aim on a machine of its own. A page that waited for its worker would pause as long as that computes.
  assert.ok(during < 1000);
  await context.close();
});
