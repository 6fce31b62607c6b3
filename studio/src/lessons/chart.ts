// The plot of a lesson, and its numbers as a table.
import uPlot from "uplot";
import { number } from "../format";
import { palette } from "../palette";
import type { Chart } from "./lesson";

/** All x of all lines in order, and each line's values there, or null. */
function aligned(chart: Chart): uPlot.AlignedData {
  const times = [...new Set(chart.lines.flatMap((line) => line.x))].sort((a, b) => a - b);
  const at = new Map(times.map((x, i) => [x, i]));
  return [times, ...chart.lines.map((line) => {
    const values: (number | null)[] = times.map(() => null);
    line.x.forEach((x, i) => { values[at.get(x)!] = line.y[i]; });
    return values;
  })] as uPlot.AlignedData;
}

export function draw(place: HTMLElement, chart: Chart): uPlot {
  const colour = palette(matchMedia("(prefers-color-scheme: dark)").matches);
  const font = "12px system-ui, sans-serif";
  const axis = { stroke: colour.text, font, labelFont: font, grid: { stroke: colour.dark ? "#ffffff1a" : "#0000001a", width: 1 },
    ticks: { stroke: colour.dark ? "#ffffff33" : "#00000033", width: 1 } };
  const scale = chart.log ? { distr: 3 as const } : {};
  place.replaceChildren();
  place.setAttribute("aria-label", `${chart.title}: ${chart.y} over ${chart.x}. ${chart.says}`);
  return new uPlot({
    width: Math.max(220, place.clientWidth), height: 250, legend: { show: false }, cursor: { show: false },
    scales: { x: { time: false, ...scale }, y: chart.log ? scale : { range: (_, low, high) => (low === high ? [low - 1, high + 1] : uPlot.rangeNum(Math.min(0, low), high, 0.08, true)) } },
    axes: [
      { ...axis, size: 32, label: chart.x, labelSize: 18, values: (_, ticks) => ticks.map((x) => (x === null ? "" : number(x, 4))) },
      { ...axis, size: 62, label: chart.y, labelSize: 18, values: (_, ticks) => ticks.map((y) => (y === null ? "" : chart.log ? y.toExponential(0) : number(y))) },
    ],
    series: [{}, ...chart.lines.map((line, i) => ({
      label: line.label, stroke: colour.lines[i % colour.lines.length], width: 2, spanGaps: true,
      ...(line.dashed ? { dash: [6, 4] } : {}), points: { show: line.points ?? false, size: 7 },
    }))],
  }, aligned(chart), place);
}

export function legend(chart: Chart): HTMLLIElement[] {
  const colour = palette(matchMedia("(prefers-color-scheme: dark)").matches);
  return chart.lines.map((line, i) => {
    const item = document.createElement("li");
    const mark = document.createElement("span");
    mark.className = line.dashed ? "mark dashed" : "mark";
    mark.style.borderColor = colour.lines[i % colour.lines.length];
    item.append(mark, ` ${line.label}`);
    return item;
  });
}

/** At most 25 rows: enough to read what is plotted. */
export function table(chart: Chart): HTMLTableElement {
  const [xs, ...columns] = aligned(chart) as (number | null)[][];
  const made = document.createElement("table");
  const row = (cells: string[], tag: "th" | "td") => {
    const tr = document.createElement("tr");
    tr.append(...cells.map((text) => Object.assign(document.createElement(tag), { textContent: text, ...(tag === "th" ? { scope: "col" } : {}) })));
    return tr;
  };
  made.createTHead().append(row([chart.x, ...chart.lines.map((line) => line.label)], "th"));
  const stride = Math.max(1, Math.ceil(xs.length / 25));
  made.createTBody().append(...xs.flatMap((x, i) => (i % stride === 0
    ? [row([x, ...columns.map((column) => column[i])].map((value) => (value === null ? "" : chart.log ? value.toExponential(2) : number(value))), "td")] : [])));
  return made;
}
