// Changes of a scene's text that leave the rest of it, comments included, as a person wrote it.

/** A change of a text: what stands from `from` up to `to` becomes `insert`. */
export interface Change { from: number; to: number; insert: string }

interface Line { from: number; to: number; text: string }

function linesOf(text: string): Line[] {
  const lines: Line[] = [];
  let from = 0;
  for (const line of text.split("\n")) {
    lines.push({ from, to: from + line.length, text: line });
    from += line.length + 1;
  }
  return lines;
}

/** Where the comment of a line begins, and how deep in brackets its end is; strings are passed over. */
function scan(text: string, depth: number): { code: number; depth: number } {
  let quote = "";
  for (let i = 0; i < text.length; ++i) {
    const c = text[i];
    if (quote !== "") {
      if (c === "\\" && quote === "\"") ++i;
      else if (c === quote) quote = "";
    } else if (c === "\"" || c === "'") quote = c;
    else if (c === "#") return { code: i, depth };
    else if (c === "[" || c === "{") ++depth;
    else if (c === "]" || c === "}") --depth;
  }
  return { code: text.length, depth };
}

const isHeader = (text: string) => /^\s*\[/.test(text);
const keyOf = (text: string) => /^\s*(?:"([^"]*)"|'([^']*)'|([A-Za-z0-9_-]+))\s*=/.exec(text);

/** An assignment: the lines it takes, and where its value stands. */
interface Entry { key: string; first: number; last: number; from: number; to: number }

/** The assignments of the table whose header is line `header` (from 0; -1: the top of the file). */
function entriesOf(lines: Line[], header: number): { entries: Entry[]; end: number } {
  const entries: Entry[] = [];
  let n = header + 1;
  for (; n < lines.length && !isHeader(lines[n].text); ++n) {
    const match = keyOf(lines[n].text);
    if (!match) continue;
    const first = n;
    let { code, depth } = scan(lines[n].text.slice(match[0].length), 0);
    code += match[0].length;
    while (depth > 0 && n + 1 < lines.length) ({ code, depth } = scan(lines[++n].text, depth));
    const begin = lines[first].text.slice(match[0].length).search(/\S/);
    const before = lines[n].text.slice(0, code).trimEnd().length;
    entries.push({
      key: match[1] ?? match[2] ?? match[3], first, last: n,
      from: lines[first].from + match[0].length + Math.max(0, begin), to: lines[n].from + before,
    });
  }
  return { entries, end: n };
}

/** Keys and values, as written, of the table whose header stands in `line` (from 1; 0: the top). */
export function valuesOf(text: string, line: number): Map<string, string> {
  const { entries } = entriesOf(linesOf(text), line - 1);
  return new Map(entries.map((entry) => [entry.key, text.slice(entry.from, entry.to)]));
}

/** Sets a key of that table, or takes it away where `value` is empty; null: nothing to do. */
export function setKey(text: string, line: number, key: string, value: string): Change | null {
  const lines = linesOf(text);
  const { entries, end } = entriesOf(lines, line - 1);
  const entry = entries.find((each) => each.key === key);
  if (entry && value !== "") return { from: entry.from, to: entry.to, insert: value };
  if (entry) {
    const last = lines[entry.last];
    return { from: lines[entry.first].from, to: Math.min(text.length, last.to + 1), insert: "" };
  }
  if (value === "") return null;
  // After the last assignment of the table: what follows may be the comment of the next.
  const after = entries.length > 0 ? entries[entries.length - 1].last : line - 1;
  if (after < 0) return { from: 0, to: 0, insert: `${key} = ${value}\n` };
  void end;
  return { from: lines[after].to, to: lines[after].to, insert: `\n${key} = ${value}` };
}

/** Takes away the body whose header stands in `line`, with the tables inside it and its own comment. */
export function removeBody(text: string, line: number): Change {
  const lines = linesOf(text);
  let end = line;
  while (end < lines.length && (!isHeader(lines[end].text) || /^\s*\[\s*body\s*\./.test(lines[end].text))) ++end;
  // Comments and empty lines before the next table are the next table's.
  let last = end - 1;
  if (end < lines.length) while (last > line - 1 && /^\s*(#.*)?$/.test(lines[last].text)) --last;
  let to = lines[last].to + 1;
  if (last + 1 < lines.length && lines[last + 1].text.trim() === "") to += lines[last + 1].text.length + 1;
  return { from: lines[line - 1].from, to: Math.min(text.length, to), insert: "" };
}

/** Adds a table at the end of the bodies: before the first force or exact solution, or at the end. */
export function addTable(text: string, table: string): Change {
  const lines = linesOf(text);
  const at = lines.findIndex((line) => /^\s*\[+\s*(force|exact)\b/.test(line.text));
  if (at < 0) return { from: text.length, to: text.length, insert: `${text.endsWith("\n") || text === "" ? "" : "\n"}\n${table}\n` };
  let before = at;
  while (before > 0 && /^\s*#/.test(lines[before - 1].text)) --before;
  return { from: lines[before].from, to: lines[before].from, insert: `${table}\n\n` };
}

/** A number as TOML has it, short: to a millionth of `scale`, or as it is where that is 0. */
export function tomlNumber(x: number, scale = 0): string {
  const digits = scale > 0 ? Math.max(0, Math.min(12, 6 - Math.floor(Math.log10(scale)))) : -1;
  const shown = digits >= 0 ? String(Number(x.toFixed(digits))) : String(x);
  const plain = shown === "-0" ? "0" : shown;
  return /^-?\d+$/.test(plain) ? `${plain}.0` : plain;
}

export const tomlVector = (x: readonly number[], scale = 0): string => `[${x.map((each) => tomlNumber(each, scale)).join(", ")}]`;

/** The line of the header of each body, by name. */
export function bodyLines(text: string): Map<string, number> {
  const found = new Map<string, number>();
  const lines = linesOf(text);
  lines.forEach((line, n) => {
    if (!/^\s*\[\[\s*body\s*\]\]/.test(line.text)) return;
    const entry = entriesOf(lines, n).entries.find((each) => each.key === "name");
    const name = entry ? textOf(text.slice(entry.from, entry.to)) : "";
    if (name !== "") found.set(name, n + 1);
  });
  return found;
}

/** The body in whose tables a line stands; "" if it stands in none. */
export function bodyAt(text: string, line: number): string {
  let name = "";
  for (const [each, at] of bodyLines(text)) if (at <= line) name = each;
  const headers = linesOf(text).slice(0, line).filter((each) => isHeader(each.text));
  const last = headers[headers.length - 1]?.text ?? "";
  return /^\s*\[+\s*body\b/.test(last) ? name : "";
}

/** A string in quotes, without them. */
export function textOf(value: string | undefined): string {
  const match = /^(?:"(.*)"|'(.*)')$/.exec(value ?? "");
  return match?.[1] ?? match?.[2] ?? "";
}

/** The numbers of an array, or `fallback` where there is none or it is another thing. */
export function numbersOf(value: string | undefined, fallback: number[]): number[] {
  if (value === undefined) return fallback;
  const numbers = value.replace(/#.*$/gm, "").replace(/[[\]\s_]/g, (c) => (c === "_" ? "" : " ")).split(",")
    .map((part) => part.trim()).filter((part) => part !== "").map(Number);
  return numbers.length === fallback.length && numbers.every(Number.isFinite) ? numbers : fallback;
}
