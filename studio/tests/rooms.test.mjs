// Rooms beside the scenes: lessons say what runs say; every room by keys, without a barrier, on a phone.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { after, before, test } from "node:test";
import { browser, open, studioPage } from "./pages.mjs";

const axe = await readFile(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
let chrome;
before(async () => { chrome = await browser(); });
after(() => chrome?.close());

const half = { deviceScaleFactor: 0.5 };  // pixels cost where they are drawn in software
const spoken = (said) => said.filter((line) => !line.includes("GL Driver Message"));
const lesson = (n, options = {}) => open(chrome, studioPage, { ready: () => window.lessons?.drawn > 0, hash: `#lesson-${n}`, viewport: { width: 1250, height: 800 }, ...half, ...options });
const says = (page) => page.textContent("#lesson-says");
/** The plot's numbers: of each line by name. */
const numbers = (page) => page.evaluate(() => {
  const [head, ...rows] = [...document.querySelectorAll("#lesson-numbers tr")].map((row) => [...row.children].map((cell) => cell.textContent));
  return Object.fromEntries(head.map((name, i) => [name, rows.map((row) => row[i]).filter((x) => x !== "").map((x) => Number(x.replace("−", "-").replace(/\s/g, "")))]));
});
async function turn(page, key, value) {
  await page.evaluate(() => { window.was = window.lessons.drawn; });
  const control = page.locator(`#lesson-${key}`);
  if (await control.evaluate((it) => it.tagName === "SELECT")) await control.selectOption(value);
  else await control.fill(value);
  await page.waitForFunction(() => window.lessons.drawn > window.was);
}

test("lesson 1: the gain is that of the flight, and a better integrator has none", async () => {
  const { page, context, said, asked } = await lesson(1);
  const gained = async () => Number(/(gained|lost) ([\d.]+) J/.exec(await says(page))[2]) * ((await says(page)).includes("lost") ? -1 : 1);
  // G^2 h / 2 = 0.8003 J/s over 10 s, from the second frame on.
  assert.ok(Math.abs((await gained()) - 7.99) < 0.02, await says(page));
  await turn(page, "frame", "1/120");
  assert.ok(Math.abs((await gained()) - 4.0) < 0.02, await says(page));
  await turn(page, "integrator", "velocity-verlet");
  assert.ok(Math.abs(await gained()) < 0.5, await says(page));
  assert.deepEqual(spoken(said), []);
  assert.deepEqual(asked, []);
  await context.close();
});

test("lessons 2 to 4: what passes, as predicted; event-driven lets nothing pass", async () => {
  const { page, context, said } = await lesson(2);
  const walls = await numbers(page);
  assert.ok(walls["event-driven"].every((x) => x === 0));
  // Sixteen places resolve the share to a sixteenth.
  walls.original.forEach((x, i) => assert.ok(Math.abs(x - walls["predicted: 1 − (w + 2r)/(v h)"][i]) <= 1 / 16 + 1e-3, `${i}: ${x}`));
  await page.click("text=What does fig. 15 mend");
  await page.waitForFunction(() => document.getElementById("lesson-title").textContent.startsWith("3") && /Cut like this/.test(document.getElementById("lesson-says").textContent));
  const cut = await numbers(page);
  assert.ok(cut["substepped, fig. 15"][0] > 0.5 && cut.original[0] === 0, "slow balls are spoiled");
  await turn(page, "parts", "equal");
  assert.ok((await numbers(page))["substepped, fig. 15"].every((x) => x === 0), "equal parts mend it");
  await page.click("#lesson-next");
  await page.waitForFunction(() => document.getElementById("lesson-title").textContent.startsWith("4") && /cm a frame/.test(document.getElementById("lesson-says").textContent));
  const bats = await numbers(page);
  assert.ok(bats["event-driven"].every((x) => x === 0));
  assert.ok(Math.max(...bats.original) > 0.1);
  assert.deepEqual(spoken(said), []);
  await context.close();
});

test("lesson 5: the books of both methods balance; lesson 6: each integrator shows its order", async () => {
  const { page, context } = await lesson(5);
  const of = async () => (await says(page)).match(/[\d.]+/g).map(Number);
  // 1 kg at 5 m under 9.8 m/s^2: 49 J, whoever keeps the books; rounded as they are shown.
  assert.ok(Math.abs((await of())[0] - 49) < 0.06, await says(page));
  const method = (await of())[2];
  await turn(page, "of", "event-driven");
  const [whole, , exact] = await of();
  assert.ok(Math.abs(whole - 49) < 0.06);
  assert.ok(exact < 0.01 * method, `${exact} of ${method} J`);
  await page.click("#lesson-next");
  await page.waitForFunction(() => document.getElementById("lesson-title").textContent.startsWith("6") && /With 1\/60 s/.test(document.getElementById("lesson-says").textContent));
  const errors = await numbers(page);
  const gain = (name) => errors[name][1] / errors[name][4];
  assert.ok(gain("event-driven, velocity-verlet") > 0.5 * 4 ** 3, "second order over three halvings");
  assert.ok(gain("event-driven, rk4") > 0.5 * gain("event-driven, velocity-verlet") * 4, "and rk4 more");
  assert.ok(gain("original, thesis-euler") < 2 ** 5, "first order at most");
  await context.close();
});

for (const [what, options] of [["a wide page", {}], ["a phone in the dark", { viewport: { width: 360, height: 740 }, colorScheme: "dark", hasTouch: true, isMobile: true }]]) {
  test(`${what}: axe finds nothing in table tennis and in lessons, nothing sticks out`, async () => {
    for (const hash of ["#table-tennis", "#lesson-1", "#lesson-4"]) {
      const ready = hash === "#table-tennis" ? () => window.game?.rally?.count > 2 : () => window.lessons?.drawn > 0;
      const { page, context, said } = await open(chrome, studioPage, { ready, hash, viewport: { width: 1250, height: 800 }, ...half, ...options });
      await page.evaluate(axe);
      const found = await page.evaluate(() => window.axe.run());
      assert.deepEqual(found.violations.map((v) => `${hash} ${v.id}: ${v.nodes[0].html}`), []);
      const { width, wanted } = await page.evaluate(() => ({ width: document.documentElement.clientWidth, wanted: document.documentElement.scrollWidth }));
      assert.equal(wanted, width, hash);
      assert.deepEqual(spoken(said), []);
      await context.close();
    }
  });
}

test("by keys alone: from room to room, a serve and a swing; the focus is seen; motion is not forced on anybody", async () => {
  const { page, context } = await open(chrome, studioPage, { ready: () => window.studio?.viewer, viewport: { width: 950, height: 560 }, reducedMotion: "reduce", ...half });
  const name = () => page.evaluate(() => document.activeElement.id || document.activeElement.textContent);
  await page.evaluate(() => document.querySelector("#rooms a").focus());
  await page.keyboard.press("Tab");
  assert.equal(await name(), "Table tennis");
  const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineWidth);
  assert.equal(outline, "3px");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.game?.rally?.count > 3);
  assert.equal(await name(), "canvas");
  const before = await page.evaluate(() => window.game.rally.batNow.p.toArray());
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.game.rally.released < Infinity);
  await page.keyboard.down("ArrowRight");
  await page.waitForFunction((x) => window.game.rally.batNow.p.x > x + 0.1, before[0]);
  await page.keyboard.up("ArrowRight");
  await page.keyboard.press(" ");
  await page.waitForFunction((z) => window.game.rally.batNow.p.z < z - 0.1, before[2]);
  await page.keyboard.press("p");
  assert.equal(await page.evaluate(() => window.game.paused), true);
  await page.evaluate(() => { location.hash = "#lesson-2"; });
  await page.waitForFunction(() => window.lessons?.drawn > 0);
  assert.equal(await page.evaluate(() => window.studio.viewer.player.playing), false, "with reduced motion nothing plays by itself");
  await page.focus("#lesson-thickness");
  await page.evaluate(() => { window.was = window.lessons.drawn; });
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => window.lessons.drawn > window.was);
  await context.close();
});
