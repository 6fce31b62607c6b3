// The page's own modules, for tests that need no browser.
import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const source = resolve(dirname(fileURLToPath(import.meta.url)), "../src");

/** Bundles what is exported from the given modules into `folder` and loads it. */
export async function modules(folder, ...names) {
  const entry = names.map((name) => `export * from ${JSON.stringify(join(source, name))};`).join("\n");
  const outfile = join(folder, `${names.map((name) => name.replace(/\W/g, "-")).join("_")}.mjs`);
  await build({ stdin: { contents: entry, resolveDir: source }, outfile, bundle: true, format: "esm", logLevel: "warning" });
  await writeFile(join(folder, "package.json"), '{"type": "module"}');
  return import(pathToFileURL(outfile).href);
}

/** The runs of a page, as its script reads them. */
export async function runsOf(readPage, file) {
  const html = await readFile(file, "utf8");
  globalThis.document = {
    getElementById(id) {
      const begin = html.indexOf(`id="${id}">`);
      if (begin < 0) return null;
      const from = html.indexOf(">", begin) + 1;
      return { textContent: html.slice(from, html.indexOf("</script>", from)), remove() {} };
    },
  };
  return readPage();
}
