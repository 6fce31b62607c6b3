// What it costs, measured in the page: start, frames, simulation. Numbers of a busy machine without a graphics
// card are printed and held to bounds that only a mistake of a magnitude exceeds.
import assert from "node:assert/strict";
import { stat } from "node:fs/promises";
import { after, before, test } from "node:test";
import { browser, open, studioPage } from "./pages.mjs";

let chrome;
before(async () => { chrome = await browser(); });
after(() => chrome?.close());

const wall = (name, position, normal) => `[[body]]\nname = "${name}"\nentity = "wall"\nshape = "half-space"\nposition = [${position}]\nnormal = [${normal}]\n`;
const gas = (count) => `name = "gas"\nduration = 2.0\nG = 0.0\n\n[[many]]\nname = "ball"\nentity = "ball"\ncount = ${count}\nradius = 0.03\nmass = 1.0
region = {min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 1.0]}\nvelocity_deviation = 1.0\n
${[["floor", "0, 0, 0", "0, 1, 0"], ["ceiling", "0, 1, 0", "0, -1, 0"], ["left", "0, 0, 0", "1, 0, 0"], ["right", "1, 0, 0", "-1, 0, 0"], ["back", "0, 0, 0", "0, 0, 1"], ["front", "0, 0, 1", "0, 0, -1"]].map((each) => wall(...each)).join("\n")}`;
const boxes = (stacks, high) => `name = "boxes"\nduration = 10.0\nG = 9.8\n\n[[body]]\nname = "floor"\nentity = "wall"\nshape = "half-space"\n
${Array.from({ length: stacks * high }, (_, i) => `[[body]]\nname = "box-${i}"\nentity = "body"\nhalf_extents = [0.25, 0.25, 0.25]\nmass = 1.0\nrestitution = 0.0\nposition = [${(i % stacks) * 1.5}, ${0.25 + 0.5 * Math.floor(i / stacks)}, 0.0]\n`).join("\n")}`;

test("the page: its size, and how long it takes to start", async () => {
  const bytes = (await stat(studioPage)).size;
  const began = performance.now();
  const { page, context } = await open(chrome, studioPage, { ready: () => window.studio?.viewer });
  const ready = await page.evaluate(() => performance.now());
  console.log(`# page ${(bytes / 1e6).toFixed(2)} MB; first run shown ${(ready / 1000).toFixed(2)} s after the page was asked for (${((performance.now() - began) / 1000).toFixed(2)} s with the browser's own)`);
  assert.ok(bytes < 5e6);
  assert.ok(ready < 20_000);
  await context.close();
});

for (const [what, scene, simulated, bodies] of [["200 balls, event-driven", gas(200), 2, 206], ["50 resting boxes, event-driven", boxes(5, 10), 10, 51]]) {
  test(`${what}: simulation and frames keep up with time`, async () => {
    const { page, context } = await open(chrome, studioPage, { ready: () => window.studio?.viewer, viewport: { width: 950, height: 700 }, deviceScaleFactor: 0.5 });
    await page.uncheck("#beside");
    await page.evaluate(() => { window.before = window.studio.outcome; });
    await page.setInputFiles("#file", { name: "scene.toml", mimeType: "text/plain", buffer: Buffer.from(scene) });
    await page.waitForFunction((n) => window.studio.outcome !== window.before && window.studio.viewer.runs[0].bodies.length === n && window.studio.client.busy() === 0, bodies);
    const told = await page.evaluate(async () => {
      const { viewer, outcome } = window.studio;
      viewer.player.seek(0);
      // What of a frame is the page's: places of all bodies, and what is asked of the graphics card.
      const costs = [];
      for (let i = 0; i < 60; ++i) {
        viewer.player.seek((viewer.player.end * i) / 60);
        const from = performance.now();
        viewer.draw();
        costs.push(performance.now() - from);
      }
      const long = [];
      new PerformanceObserver((list) => long.push(...list.getEntries().map((entry) => entry.duration))).observe({ entryTypes: ["longtask"] });
      viewer.player.seek(0);
      viewer.player.play(true);
      let frames = 0;
      const until = performance.now() + 1500;
      while (performance.now() < until) {
        await new Promise((done) => requestAnimationFrame(done));
        ++frames;
      }
      return { reason: viewer.runs[0].reason, end: viewer.player.end, computing: outcome.answers[0].milliseconds,
        draw: costs.sort((a, b) => a - b)[30], rate: frames / 1.5, long: Math.max(0, ...long), impacts: viewer.runs[0].events.time.length };
    });
    console.log(`# ${what}: ${(told.computing / simulated).toFixed(1)} ms of computing for a second (${told.impacts} events in ${told.end} s); a frame takes ${told.draw.toFixed(1)} ms of the page, ${told.rate.toFixed(0)} frames a second as drawn here; longest task ${told.long.toFixed(0)} ms`);
    assert.equal(told.reason, "");
    assert.equal(told.end, simulated);
    assert.ok(told.computing < 1000 * simulated, "faster than time");
    await context.close();
  });
}
