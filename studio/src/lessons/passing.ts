// Lessons 2 to 4: walls and bats that are too thin for a look once a frame.
import { newState, Motions } from "../motion";
import { judge } from "../play/verdict";
import { between, eventDriven, frames, number, original, real, seconds, type Ask, type Asked, type Lesson, type Told, type Values } from "./lesson";

const radius = 0.02;
/** Places at which the ball may be in its frame when it comes. */
const phases = 16;

const bullet = (thickness: number, speed: number, from: number) => `name = "a ball and a wall"
summary = "the ball flies at the wall; beyond it, it has passed"
duration = ${real((1.4 - from) / speed)}
frame = "1/60"
G = 0.0

[[body]]
name = "wall"
entity = "wall"
half_extents = [${real(thickness / 2)}, 0.3, 0.3]
normal = [-1.0, 0.0, 0.0]

[[body]]
name = "ball"
entity = "ball"
radius = ${radius}
mass = 1.0
position = [${real(from)}, 0.0, 0.0]
velocity = [${real(speed)}, 0.0, 0.0]
`;

const passes = ({ run }: Told) => new Motions(run).at(1, run.end, newState()).px > 0;

/** The share of balls that pass at each speed, over where in its frame the ball is. */
async function shares(ask: Ask, speeds: number[], thickness: number, h: number, settings: string): Promise<number[] | null> {
  const asked: Asked[] = speeds.flatMap((speed) =>
    Array.from({ length: phases }, (_, k) => ({ scene: bullet(thickness, speed, -0.5 - ((k + 0.5) / phases) * speed * h), settings })));
  const told = await ask(asked);
  return told && speeds.map((_, i) => told.slice(i * phases, (i + 1) * phases).filter(passes).length / phases);
}

const percent = (share: number) => `${Math.round(100 * share)} %`;

export const wall: Lesson = {
  title: "How thin may a wall be?",
  question: "A ball flies at a wall. How thick must the wall be, so that a look once a frame does not miss it?",
  text: "Make the wall thinner, the ball faster, the frame longer. The ball is where the frame happens to find it: what counts is how many of all such places let it through.",
  controls: [
    { key: "thickness", label: "Thickness of the wall", range: { least: 0.005, most: 0.3, step: 0.005, unit: "m" }, start: 0.05 },
    { key: "speed", label: "Speed of the ball", range: { least: 2, most: 40, step: 1, unit: "m/s" }, start: 12 },
    frames(),
  ],
  seen: (values) => [eventDriven, original].map((method) => ({
    scene: bullet(number(values, "thickness"), number(values, "speed"), -1), settings: method(`\nframe=${values.frame}`),
  })),
  plot: async (values, _, ask) => {
    const [w, h] = [number(values, "thickness"), seconds(String(values.frame))];
    const speeds = between(2, 40, 20);
    const [stepped, exact] = [await shares(ask, speeds, w, h, original(`\nframe=${values.frame}`)), await shares(ask, speeds, w, h, eventDriven(`\nframe=${values.frame}`))];
    if (!stepped || !exact) return null;
    const law = (v: number) => Math.max(0, 1 - (w + 2 * radius) / (v * h));
    return { title: "Balls that pass the wall", x: "speed (m/s)", y: "share", lines: [
      { label: "event-driven", x: speeds, y: exact }, { label: "original", x: speeds, y: stepped, points: true },
      { label: "predicted: 1 − (w + 2r)/(v h)", x: speeds, y: speeds.map(law), dashed: true },
    ], says: `At ${values.speed} m/s a frame is ${(100 * number(values, "speed") * h).toFixed(0)} cm of flight; ${percent(law(number(values, "speed")))} of the balls should pass.` };
  },
  answer: "A frame misses the wall when the ball is before it in one picture and behind it in the next. The ball touches it over w + 2r of its way, and moves v h a frame: while v h is less than that, no ball passes; beyond it, a share of 1 − (w + 2r)/(v h) does. At 60 frames a second and 20 m/s that is a third of a metre. No thickness is safe for all speeds. Event-driven asks when the ball touches, not whether it does.",
};

export const figure15: Lesson = {
  title: "What does fig. 15 mend, and what does it spoil?",
  question: "The thesis proposes to cut a frame where something would move too far. Is every ball caught then?",
  text: "The frame is cut into parts in which nothing moves more than the threshold. Taken literally, the last part of a frame is what is left over, and can be short. Look at slow balls, too.",
  controls: [
    { key: "threshold", label: "Largest movement", range: { least: 0.01, most: 0.12, step: 0.005, unit: "m" }, start: 0.03 },
    { key: "parts", label: "Parts of a frame", start: "literal", choices: [{ value: "literal", text: "as fig. 15 says" }, { value: "equal", text: "equal ones (the mend)" }] },
    { key: "speed", label: "Speed of the ball", range: { least: 2, most: 40, step: 0.5, unit: "m/s" }, start: 2 },
  ],
  seen: (values) => [cut(values), original()].map((settings) => ({ scene: bullet(0.02, number(values, "speed"), -1), settings })),
  plot: async (values, _, ask) => {
    const speeds = [2, 2.5, 3, 4, 5, 6, 8, 10, 12, 15, 18, 20, 22, 25, 30, 35, 40];
    const [mended, stepped] = [await shares(ask, speeds, 0.02, 1 / 60, cut(values)), await shares(ask, speeds, 0.02, 1 / 60, original())];
    if (!mended || !stepped) return null;
    const mean = mended.reduce((sum, each) => sum + each, 0) / mended.length;
    const slow = mended.filter((share, i) => share > stepped[i]).length;
    return { title: "Balls that pass a wall of 2 cm", x: "speed (m/s)", y: "share", lines: [
      { label: "substepped, fig. 15", x: speeds, y: mended, points: true }, { label: "original", x: speeds, y: stepped, points: true },
    ], says: `Cut like this, ${percent(mean)} pass on the mean over these speeds; at ${slow} of ${speeds.length} speeds more than without the cut.` };
  },
  answer: "Fast balls are caught: no part moves one past the wall. But a ball that is inside the wall at the end of a short last part is turned back by the reflection, which asks neither for the side nor for the direction, and so it may be sent on through the wall by the next: at 2 m/s most pass, where the plain scheme lets none. Equal parts mend that. The threshold must stay below w + 2r, and the work grows as 1/threshold.",
};

const cut = (values: Values) => original(`\nscheme=substepped\nthreshold=${real(number(values, "threshold"))}${values.parts === "equal" ? "\nequal_substeps=true" : ""}`).replace("scheme=original\n", "");

const swing = (frequency: number, place: number, nudge: number) => `name = "a bat and a ball"
summary = "the bat swings once, and the ball waits in its path"
duration = ${real(0.5 / frequency)}
frame = "1/60"
G = 0.0

[[body]]
name = "bat"
entity = "bat"
half_extents = [0.075, 0.08, 0.0075]
mass = 0.18
nudge = ${real(nudge)}

[body.drive]
amplitude = [0.0, 0.0, 0.4]
frequency = ${real(frequency)}
phase = ${-Math.PI / 2}

[[body]]
name = "ball"
entity = "ball"
radius = ${radius}
mass = 0.0027
position = [0.0, 0.0, ${real(place)}]
`;

export const bat: Lesson = {
  title: "The bat",
  question: "A bat swings at a ball that waits. Why does it go through?",
  text: "A bat is 1.5 cm thick and the ball 4 cm; a stroke of 5 m/s is 8 cm a frame. Swing faster, and try the thesis' nudge, which moves a struck ball out of the bat's way.",
  controls: [
    { key: "frequency", label: "Swings a second", range: { least: 0.5, most: 8, step: 0.25, unit: "Hz" }, start: 3 },
    { key: "nudge", label: "Nudge (13.9)", start: "0.0025", choices: [{ value: "0", text: "none" }, { value: "0.0025", text: "0.0025 s" }, { value: "0.01", text: "0.01 s" }] },
    frames(),
  ],
  seen: (values) => [
    { scene: swing(number(values, "frequency"), 0.05, 0), settings: eventDriven(`\nframe=${values.frame}`) },
    { scene: swing(number(values, "frequency"), 0.05, number(values, "nudge")), settings: original(`\nframe=${values.frame}`) },
  ],
  plot: async (values, _, ask) => {
    const rates = between(0.5, 8, 11);
    const places = between(-0.1, 0.1, 12);
    const told = [];
    for (const [method, nudge] of [[eventDriven, 0], [original, number(values, "nudge")]] as const) {
      const answers = await ask(rates.flatMap((f) => places.map((at) => ({ scene: swing(f, at, nudge), settings: method(`\nframe=${values.frame}`) }))));
      if (!answers) return null;
      told.push(rates.map((_, i) => answers.slice(i * places.length, (i + 1) * places.length).filter(({ run }) => judge(run, -1).outcome === "passed").length / places.length));
    }
    const speeds = rates.map((f) => 2 * Math.PI * f * 0.4);
    return { title: "Balls that the bat passes through", x: "largest speed of the bat (m/s)", y: "share", lines: [
      { label: "event-driven", x: speeds, y: told[0] }, { label: "original", x: speeds, y: told[1], points: true },
    ], says: `At ${values.frequency} Hz the bat moves up to ${(100 * 2 * Math.PI * number(values, "frequency") * 0.4 * seconds(String(values.frame))).toFixed(0)} cm a frame; bat and ball are 5.5 cm.` };
  },
  answer: "It is the wall again, and now the wall moves. Between two frames the bat jumps over the ball. The nudge helps a ball that was seen: it cannot help one that no frame saw inside the bat. Play it yourself in the room Table tennis: both methods get your own strokes there.",
};
