// Bundles a page without references to anything outside.
// usage: node build.mjs [FILE]                          the viewer, that `kairos view` fills
//        node build.mjs --studio FILE ENGINE SCENES     the studio: ENGINE holds engine.js and engine.wasm
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { keysOf, sceneFiles } from "./scenes.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const source = (name) => resolve(here, "src", name);

/** A script and a style sheet, bundled. */
async function bundle(entries, options = {}) {
  const bundled = await build({
    entryPoints: entries.map(source), outdir: "bundle", bundle: true, minify: true, write: false, format: "iife",
    target: ["es2022"], legalComments: "inline", charset: "ascii", logLevel: "warning", ...options,
  });
  const text = (ending) => bundled.outputFiles.find((file) => file.path.endsWith(ending))?.text ?? "";
  return { script: text(".js"), style: text(".css") };
}

/** The editor is a script of its own: a page parses and starts a script without a pause, and for both that takes too long. */
const editorAside = {
  name: "editor-aside",
  setup(made) {
    made.onResolve({ filter: /^\.\/editor$/ }, () => ({ path: "editor", namespace: "aside" }));
    made.onLoad({ filter: /./, namespace: "aside" }, () => ({ contents: "module.exports = globalThis.kairosEditor" }));
  },
};

// A script or style ends at the first thing that looks like its end tag.
const asScript = (text) => text.replace(/<\/(script)/gi, "<\\/$1").replace(/<!--/g, "<\\!--");
const asStyle = (text) => text.replace(/<\/(style)/gi, "<\\/$1");
const asData = (id, value) => `<script type="application/json" id="${id}">${JSON.stringify(value).replaceAll("<", "\\u003c")}</script>\n`;

async function write(file, page) {
  await mkdir(dirname(file), { recursive: true });
  await writeFile(file, page);
}

async function viewer(out) {
  const { script, style } = await bundle(["main.ts", "style.css"]);
  const page = await readFile(source("viewer.html"), "utf8");
  await write(out, page.replace("/*style*/", () => asStyle(style)).replace("/*script*/", () => asScript(script)));
}

async function studio(out, engine, scenes) {
  const { script, style } = await bundle(["lab/main.ts", "studio.css"], { plugins: [editorAside] });
  const editor = await bundle(["lab/editor.ts"], { globalName: "kairosEditor" });
  const worker = await bundle(["lab/worker.ts"], {
    alias: { "kairos-engine": resolve(engine, "engine.js") }, external: ["fs", "path", "crypto"],
  });
  const frame = await readFile(source("viewer.html"), "utf8");
  const main = frame.slice(frame.indexOf("<main>"), frame.indexOf("</main>") + "</main>".length);
  const wasm = gzipSync(await readFile(resolve(engine, "engine.wasm")), { level: 9 }).toString("base64");
  const data = [
    asData("studio-files", await sceneFiles(scenes)),
    asData("studio-keys", keysOf(await readFile(resolve(scenes, "README.md"), "utf8"))),
    `<script type="text/plain" id="studio-engine">${wasm}</script>\n`,
    `<script type="text/plain" id="studio-worker">${asScript(worker.script)}</script>\n`,
  ].join("");
  const page = (await readFile(source("studio.html"), "utf8"))
    .replace("<!--viewer-->", () => main).replace("<!--studio-data-->", () => data)
    .replace("/*style*/", () => asStyle(style)).replace("/*editor*/", () => asScript(editor.script))
    .replace("/*script*/", () => asScript(script));
  await write(out, page);
}

const words = process.argv.slice(2);
if (words[0] === "--studio") {
  const [, file, engine, scenes] = words;
  if (!scenes) throw new Error("usage: node build.mjs --studio FILE ENGINE SCENES");
  await studio(resolve(file), resolve(engine), resolve(scenes));
} else {
  await viewer(resolve(words[0] ?? resolve(here, "dist/viewer.html")));
}
