// What the studio takes along of the scenes: their files, and what their README says of every key.
import { readdir, readFile } from "node:fs/promises";
import { join } from "node:path";

/** Every file that a scene is or names, by the path that it has in the page. */
export async function sceneFiles(folder, at = "/scenes") {
  const files = {};
  for (const entry of (await readdir(folder, { withFileTypes: true })).sort((a, b) => (a.name < b.name ? -1 : 1))) {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) Object.assign(files, await sceneFiles(path, `${at}/${entry.name}`));
    else if (!entry.name.endsWith(".md")) files[`${at}/${entry.name}`] = await readFile(path, "utf8");
  }
  return files;
}

/** Cells of a row of a table; `\|` is a bar inside one. */
const cells = (row) => row.replaceAll("\\|", "\0").split("|").slice(1, -1)
  .map((cell) => cell.trim().replaceAll("\0", "|").replaceAll("`", ""));

/** The tables of keys: unit, default, range and meaning of each, by the table of the scene they stand in. */
export function keysOf(readme) {
  const tables = {};
  let place = "";
  let columns = null;
  for (const line of readme.split("\n")) {
    const heading = /^##+ (.*)$/.exec(line);
    if (heading) place = { "Top level": "", "`frame`": "frame", "`[[body]]`": "body", "`[body.drive]`": "body.drive" }[heading[1]] ?? heading[1];
    if (!line.startsWith("|")) { columns = null; continue; }
    if (!columns) { columns = cells(line); continue; }
    if (/^\|[-|]+$/.test(line) || !columns.includes("key") || !columns.includes("meaning")) continue;
    const row = Object.fromEntries(cells(line).map((cell, i) => [columns[i], cell]));
    const group = row.entity ? `entity.${row.entity}` : row.force ? `force.${row.force}` : place;
    (tables[group] ??= []).push({ key: row.key, unit: row.unit ?? "", default: row.default ?? "", allowed: row.allowed ?? "", meaning: row.meaning });
  }
  return tables;
}
