// Pages of shipped scenes, made by the program, and a Chromium to open them in.
import { execFile } from "node:child_process";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { promisify } from "node:util";
import { chromium } from "playwright-core";

const root = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
export const program = process.env.KAIROS ?? join(root, "build/release/experiments/kairos");
const run = promisify(execFile);

/** Runs kairos; rejects where it fails. */
export const kairos = (...words) => run(program, words, { maxBuffer: 1 << 28 });

/** What `./studio` builds. */
export const studioPage = process.env.KAIROS_STUDIO ?? join(root, "build/studio/studio.html");

export async function folder() {
  const path = await mkdtemp(join(tmpdir(), "kairos-studio-"));
  return { path, remove: () => rm(path, { recursive: true, force: true }) };
}

export function browser() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--headless", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--disable-quic",
           "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });
}

/** Opens a file without a network; `said` collects what a silent page does not say. */
export async function open(chrome, file, { ready = () => window.kairos !== undefined, hash = "", before = async () => {}, ...options } = {}) {
  const context = await chrome.newContext({ viewport: { width: 1280, height: 900 }, offline: true, acceptDownloads: true, ...options });
  const page = await context.newPage();
  const said = [];
  const asked = [];
  page.on("console", (message) => said.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => said.push(`error: ${error.message}`));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) asked.push(request.url());
  });
  page.setDefaultTimeout(60_000); // software rendering on a busy machine
  await before(page);
  await page.goto(pathToFileURL(file).href + hash, { timeout: 60_000 });
  await page.waitForFunction(ready, undefined, { timeout: 60_000 });
  return { page, context, said, asked };
}
