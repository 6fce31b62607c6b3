// The page of `kairos view` in a real browser: what a person does with it, by pointer and keys.
import assert from "node:assert/strict";
import { readFile, stat } from "node:fs/promises";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { browser, folder, kairos, open, program } from "./pages.mjs";
import { syntheticPage } from "./synthetic.mjs";

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

async function view(...words) {
  const file = join(place.path, `${words.join("-").replaceAll(/[^a-z0-9-]/gi, "_")}.html`);
  await kairos("view", ...words, "--out", file);
  return file;
}
/** What the driver of software rendering says of reading pixels is not the page's. */
const spoken = (said) => said.filter((line) => !line.includes("GL Driver Message"));
const time = (page) => page.evaluate(() => window.kairos.player.time);
const drawn = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** Share of the view's pixels that are not the background. */
const inked = (page) => page.evaluate(() => {
  window.kairos.draw();
  const source = document.getElementById("canvas");
  const small = Object.assign(document.createElement("canvas"), { width: 160, height: 90 });
  const context = small.getContext("2d");
  context.drawImage(source, 0, 0, 160, 90);
  const { data } = context.getImageData(0, 0, 160, 90);
  let other = 0;
  for (let i = 0; i < data.length; i += 4) {
    if (Math.abs(data[i] - data[0]) + Math.abs(data[i + 1] - data[1]) + Math.abs(data[i + 2] - data[2]) > 12) ++other;
  }
  return other / (160 * 90);
});

for (const words of [["bounce"], ["bat", "--beside", "thesis"], ["billiard", "--duration", "1"], ["spinning-box"],
                     ["table-tennis", "--duration", "4"]]) {
  test(`${words.join(" ")}: shows something, silently, without a network, for everybody`, async () => {
    const { page, context, said, asked } = await open(chrome, await view(...words));
    await page.evaluate(() => window.kairos.player.seek(0.4 * window.kairos.player.end));
    await drawn(page);
    assert.ok((await inked(page)) > 0.01, "the view is empty");
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => window.axe.run());
    assert.deepEqual(violations.map((v) => `${v.id}: ${v.nodes[0].html}`), []);
    assert.deepEqual(spoken(said), []);
    assert.deepEqual(asked, []);
    await context.close();
  });
}

test("a ball is drawn where it is: its colour within the circle that it is seen as, the ground of the view beyond", async () => {
  const { page, context, said } = await open(chrome, await view("bounce"));
  await page.selectOption("#trail", "0");
  const { within, beyond, linked } = await page.evaluate(() => {
    const { stage, worlds, runs, body } = window.kairos;
    window.kairos.player.seek(0.5);
    window.kairos.draw();
    const small = document.createElement("canvas");
    Object.assign(small, { width: stage.canvas.width, height: stage.canvas.height });
    const context = small.getContext("2d", { willReadFrequently: true });
    context.drawImage(stage.canvas, 0, 0);
    const centre = stage.placeOf(body, 1, 1);
    const r = runs[0].bodies[body].shape.x;
    const [right, up] = [0, 1].map((k) => centre.clone().setFromMatrixColumn(stage.camera.matrixWorld, k));
    /** Pixel of a point so many radii from the centre, across the view. */
    const pixel = (x, y) => {
      const at = centre.clone().addScaledVector(right, x * r).addScaledVector(up, y * r).project(stage.camera);
      return [...context.getImageData((0.5 + at.x / 2) * small.width, (0.5 - at.y / 2) * small.height, 1, 1).data].slice(0, 3);
    };
    const ground = worlds[0].scene.background.getHexString();
    const off = (x, y) => Math.max(...pixel(x, y).map((c, k) => Math.abs(c - parseInt(ground.slice(2 * k, 2 * k + 2), 16))));
    const gl = stage.renderer.getContext();
    return {
      within: [[0, 0], [0.93, 0], [-0.93, 0], [0, 0.93], [0, -0.93], [0.6, 0.6]].map(([x, y]) => off(x, y)),
      beyond: [[1.1, 0], [-1.1, 0], [0, 1.1], [0.8, 0.8]].map(([x, y]) => off(x, y)),
      linked: stage.renderer.info.programs.every(({ program }) => gl.getProgramParameter(program, gl.LINK_STATUS)),
    };
  });
  assert.ok(linked, "the graphics card takes all programs");
  assert.ok(Math.min(...within) > 60, `within: ${within}`);
  assert.ok(Math.max(...beyond) < 20, `beyond: ${beyond}`);
  assert.deepEqual(spoken(said), []);
  await context.close();
});

test("the clock goes by keys: frames, events, start, end, play, speed", async () => {
  const { page, context, said } = await open(chrome, await view("bounce"));
  const { frames, instants } = await page.evaluate(() => ({
    frames: [...window.kairos.player.frames], instants: [...window.kairos.player.instants],
  }));
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  assert.equal(await time(page), frames[2]);
  await page.keyboard.press("ArrowLeft");
  assert.equal(await time(page), frames[1]);
  await page.keyboard.press("n");
  assert.equal(await time(page), instants[0]);
  await page.keyboard.press("n");
  await page.keyboard.press("p");
  assert.equal(await time(page), instants[0]);
  await drawn(page);
  assert.match(await page.textContent("#status"), /event 1 of \d+: impact of .*closing at .* m\/s, impulse .* N s/);
  await page.keyboard.press("End");
  assert.equal(await time(page), frames.at(-1));
  await page.keyboard.press("Home");
  assert.equal(await time(page), 0);
  await page.keyboard.press("ArrowDown");
  assert.ok((await page.evaluate(() => window.kairos.player.speed)) < 1);
  await page.keyboard.press(" ");
  await page.waitForFunction(() => window.kairos.player.time > 0.05);
  await page.keyboard.press(" ");
  assert.equal(await page.evaluate(() => window.kairos.player.playing), false);
  assert.deepEqual(spoken(said), []);
  await context.close();
});

test("every control is reached by Tab, and shows that it is", async () => {
  const { page, context } = await open(chrome, await view("bounce"));
  const wanted = await page.evaluate(() =>
    [...document.querySelectorAll("main button, main select, main input, main canvas[tabindex], summary")]
      .filter((each) => !each.disabled && each.checkVisibility()).length);
  const seen = new Set();
  for (let i = 0; i < wanted; ++i) {
    await page.keyboard.press("Tab");
    const [name, outline] = await page.evaluate(() => {
      const at = document.activeElement;
      return [at.id || at.textContent, getComputedStyle(at).outlineStyle];
    });
    assert.equal(outline, "solid", `${name} shows no focus`);
    seen.add(name);
  }
  assert.equal(seen.size, wanted);
  await context.close();
});

test("the pointer scrubs, turns the view and picks a time in a plot", async () => {
  const { page, context } = await open(chrome, await view("bounce"));
  const end = await page.evaluate(() => window.kairos.player.end);
  const scrubber = await page.locator("#scrubber").boundingBox();
  await page.mouse.click(scrubber.x + scrubber.width / 2, scrubber.y + scrubber.height / 2);
  assert.ok(Math.abs((await time(page)) - end / 2) < 0.02 * end);
  const eye = () => page.evaluate(() => window.kairos.stage.camera.position.toArray());
  const canvas = await page.locator("#canvas").boundingBox();
  const was = await eye();
  await page.mouse.move(canvas.x + 200, canvas.y + 200);
  await page.mouse.down();
  await page.mouse.move(canvas.x + 300, canvas.y + 220, { steps: 3 });
  await page.mouse.up();
  assert.notDeepEqual(await eye(), was);
  const plot = page.locator(".u-over").nth(1);
  await plot.scrollIntoViewIfNeeded();
  const over = await plot.boundingBox();
  await page.mouse.click(over.x + over.width / 4, over.y + 20);
  assert.ok(Math.abs((await time(page)) - end / 4) < 0.02 * end);
  await context.close();
});

test("two methods go in step, and a part inside another is told and shown", async () => {
  const { page, context } = await open(chrome, await view("bounce", "--beside", "thesis"));
  assert.equal(await page.locator("#labels div:not(.split)").count(), 2);
  const found = await page.evaluate(() => {
    const { player, worlds } = window.kairos;
    for (const t of player.frames) {
      player.seek(t);
      window.kairos.draw();
      if (worlds[1].overlaps.length > 0) return [t, worlds[0].overlaps.length, worlds[1].overlaps[0].depth];
    }
    return null;
  });
  assert.ok(found, "the thesis' ball never sinks in");
  assert.equal(found[1], 0);
  assert.match(await page.textContent("#status"), /B: .* m inside /);
  await context.close();
});

test("a run that stopped says why; one goes to the time and the body with a click", async () => {
  const file = join(place.path, "stopped.html");
  await syntheticPage(join(dirname(program), "../studio/viewer.html"), file,
    { bodies: 4, frames: 60, reason: "accumulation: 'floor' and 'ball 2' stay in touch" });
  const { page, context, said } = await open(chrome, file);
  assert.match(await page.textContent("#problem-text"), /stopped at 1\.?0* s: accumulation: 'floor' and 'ball 2'/);
  await page.click("#problem-show");
  assert.equal(await time(page), 1);
  assert.equal(await page.evaluate(() => window.kairos.runs[0].bodies[window.kairos.body].name), "ball 2");
  const off = await page.evaluate(() => window.kairos.stage.controls.target.distanceTo(window.kairos.stage.placeOf(window.kairos.body, 1, 1)));
  assert.ok(off < 1e-9, `looked at ${off} m beside it`);
  assert.deepEqual(spoken(said), []);
  await context.close();
});

test("a picture and a film are saved", async () => {
  const { page, context, said } = await open(chrome, await view("spinning-box"));
  const download = async (id) => {
    const coming = page.waitForEvent("download", { timeout: 180_000 });
    await page.click(id);
    const saved = join(place.path, (await coming).suggestedFilename());
    await (await coming).saveAs(saved);
    return saved;
  };
  const picture = await readFile(await download("#picture"));
  assert.equal(picture.subarray(1, 4).toString(), "PNG");
  assert.ok(picture.length > 5000);
  await page.evaluate(() => window.kairos.player.seek(window.kairos.player.end - 0.5));
  const film = await download("#film");
  assert.ok((await stat(film)).size > 1000);
  assert.deepEqual(spoken(said), []);
  await context.close();
});

test("a phone's width holds the page; a dark one is dark", async () => {
  const { page, context } = await open(chrome, await view("bounce", "--beside", "thesis"),
    { viewport: { width: 360, height: 740 }, colorScheme: "dark", hasTouch: true });
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 360);
  const background = await page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number));
  assert.ok(background.every((channel) => channel < 40));
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run());
  assert.deepEqual(violations.map((v) => `${v.id}: ${v.nodes[0].html}`), []);
  await context.close();
});

test("what a run's files hold is shown too, beside another run", async () => {
  const runs = ["one", "two"].map((name) => join(place.path, name));
  await kairos("run", "bounce", "--duration", "2", "--out", runs[0]);
  await kairos("run", "bounce", "--duration", "2", "--thesis", "--out", runs[1]);
  const { page, context, said } = await open(chrome, await view(runs[0], "--beside", runs[1]));
  assert.match(await page.textContent("#notes"), /read from files/);
  assert.equal(await page.evaluate(() => window.kairos.runs.length), 2);
  assert.deepEqual(spoken(said), []);
  await context.close();
});
