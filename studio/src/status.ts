// What is going on, in words: the last event and what is inside what.
import { eventKinds } from "./data";
import { number, seconds } from "./format";
import { after } from "./search";
import type { World } from "./world";

function eventText({ run }: World, e: number): string {
  const { events, bodies } = run;
  const name = (k: number) => bodies[events.pair[2 * e + k]].name;
  let text = `${eventKinds[events.kind[e]]} of ${name(0)} and ${name(1)} at ${seconds(events.time[e])}`;
  if (events.kind[e] === 0) {
    const v = events.vectors.subarray(9 * e + 6, 9 * e + 9);
    const impulse = Math.hypot(v[0], v[1], v[2]);
    if (events.approach[e] !== 0) text += `, closing at ${number(Math.abs(events.approach[e]), 3)} m/s`;
    if (impulse > 0) text += `, impulse ${number(impulse, 3)} N s`;
  }
  return text;
}

/** While it plays only what is inside what: a text that changes all the time is none. */
export function statusAt(worlds: World[], t: number, playing: boolean): string {
  return worlds.map((world, i) => {
    const parts: string[] = [];
    const { time } = world.run.events;
    const e = after(time, t + 1e-12 * (1 + t)) - 1;
    if (!playing && e >= 0) parts.push(`${time.length - 1 === e && t > time[e] ? "last" : `event ${e + 1} of ${time.length}`}: ${eventText(world, e)}`);
    const deepest = world.overlaps[0];
    if (deepest && !playing) {
      const { bodies } = world.run;
      const more = world.overlaps.length > 1 ? ` and ${world.overlaps.length - 1} more` : "";
      parts.push(`${bodies[deepest.a].name} is ${number(deepest.depth, 3)} m inside ${bodies[deepest.b].name}${more}`);
    }
    const text = parts.join("; ");
    return worlds.length > 1 && text !== "" ? `${"AB"[i]}: ${text}` : text;
  }).filter((text) => text !== "").join(". ");
}
