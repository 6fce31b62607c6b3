// Bundles src/ into one page without references to anything outside. usage: node build.mjs [FILE]
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = resolve(process.argv[2] ?? resolve(here, "dist/viewer.html"));

const bundled = await build({
  entryPoints: [resolve(here, "src/main.ts"), resolve(here, "src/style.css")],
  outdir: "bundle",
  bundle: true,
  minify: true,
  write: false,
  format: "iife",
  target: ["es2022"],
  legalComments: "inline",
  charset: "ascii",
  logLevel: "warning",
});
const text = (ending) => bundled.outputFiles.find((file) => file.path.endsWith(ending)).text;

// A script or style ends at the first thing that looks like its end tag.
const script = text(".js").replace(/<\/(script)/gi, "<\\/$1").replace(/<!--/g, "<\\!--");
const style = text(".css").replace(/<\/(style)/gi, "<\\/$1");
const page = await readFile(resolve(here, "src/viewer.html"), "utf8");
await mkdir(dirname(out), { recursive: true });
await writeFile(out, page.replace("/*style*/", () => style).replace("/*script*/", () => script));
