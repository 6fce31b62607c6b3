// Lessons 1 and 5: energy that comes from nowhere, and where each joule goes.
import type { Run } from "../data";
import { eventDriven, frames, number, real, seconds, type Lesson, type Line } from "./lesson";

const words = (name: string) => name.replaceAll("_", " ");
const line = (run: Run, name: string) => run.energy.find((each) => words(each.name) === name)?.values ?? new Float64Array(run.frames.length);
const mechanical = (run: Run) => Array.from(line(run, "kinetic"), (kinetic, i) => kinetic + line(run, "potential")[i]);
const every = (n: number) => Math.max(1, Math.ceil(n / 500));
const thinned = <T>(values: ArrayLike<T>) => Array.from(values).filter((_, i) => i % every(values.length) === 0);

const drop = (restitution: number, density: number) => `name = "a ball on a floor"
summary = "it is let go of 5 m above, and nothing pushes it"
duration = 10.0
frame = "1/60"
G = 9.8

[[body]]
name = "floor"
entity = "wall"
shape = "half-space"

[[body]]
name = "ball"
entity = "ball"
radius = 0.5
mass = 1.0
position = [0.0, 5.0, 0.0]
restitution = ${real(restitution)}
${density > 0 ? `\n[[force]]\nkind = "quadratic-drag"\ndensity = ${real(density)}\n` : ""}`;

export const gain: Lesson = {
  title: "Why do balls gain energy?",
  question: "A ball is let go of once, and nothing pushes it. Why does it rise higher with every bounce?",
  text: "On the right the thesis' stepping, on the left the exact run. Change how long a frame lasts, and what moves the ball between frames. Does the gain come from the bounces, or from the flight?",
  controls: [frames(), {
    key: "integrator", label: "Between frames it moves by", start: "thesis-euler",
    choices: ["thesis-euler", "explicit-euler", "symplectic-euler", "velocity-verlet", "rk4"].map((value) => ({ value, text: value })),
  }],
  seen: (values) => [
    { scene: drop(1, 0), settings: eventDriven(`\nframe=${values.frame}`) },
    { scene: drop(1, 0), settings: `scheme=original\nintegrator=${values.integrator}\ndetector=sat\nimpact=thesis\nframe=${values.frame}` },
  ],
  plot: async (values, seen) => {
    const h = seconds(String(values.frame));
    const [exact, stepped] = seen.map(({ run }) => ({ x: thinned(run.frames), y: thinned(mechanical(run)) }));
    const lines: Line[] = [
      { label: "event-driven", ...exact }, { label: `original, ${values.integrator}`, ...stepped },
    ];
    if (values.integrator === "thesis-euler") {
      lines.push({ label: "predicted: G²h²/2 more a frame", dashed: true, x: stepped.x, y: stepped.x.map((t) => exact.y[0] + Math.max(0, t / h - 1) * 0.5 * 9.8 ** 2 * h ** 2) });
    }
    const gained = stepped.y[stepped.y.length - 1] - stepped.y[0];
    return { title: "Energy of the ball", x: "time (s)", y: "energy (J)", lines,
      says: `After ${stepped.x[stepped.x.length - 1].toFixed(1)} s the stepped ball has ${gained >= 0 ? "gained" : "lost"} ${Math.abs(gained).toFixed(2)} J of ${exact.y[0].toFixed(1)} J.` };
  },
  answer: "It is the flight. The thesis' step moves a ball with the acceleration of the frame before, and gains exactly G²h²/2 (for 1 kg) in every frame that gravity acts, whether or not the ball bounces. Half the frame time gives a quarter a frame, and half a second. velocity-verlet and rk4 are exact in free flight: their energy does not grow steadily. What is left there are late bounces, and those are of the contact.",
};

export const ledger: Lesson = {
  title: "Where do the joules go?",
  question: "A ball bounces lower and lower. Which of its joules did the world take, and which did the method lose?",
  text: "Every line of the ledger has a formula of its own, and none is the remainder. Choose a restitution and a gas, and whose ledger is shown.",
  controls: [
    { key: "restitution", label: "Restitution", range: { least: 0.3, most: 1, step: 0.05, unit: "" }, start: 0.8 },
    { key: "density", label: "Density of the gas", range: { least: 0, most: 3, step: 0.1, unit: "kg/m³" }, start: 1.2 },
    { key: "of", label: "Ledger of", start: "original", choices: [{ value: "original", text: "original" }, { value: "event-driven", text: "event-driven" }] },
  ],
  seen: (values) => {
    const scene = drop(number(values, "restitution"), number(values, "density"));
    return [
      { scene, settings: "scheme=event-driven\nintegrator=auto\ndetector=certified\nimpact=newton\nduration=4" },
      { scene, settings: "scheme=original\nintegrator=thesis-euler\ndetector=sat\nimpact=newton\nduration=4" },
    ];
  },
  plot: async (values, seen) => {
    const { run } = seen[values.of === "original" ? 1 : 0];
    const x = thinned(run.frames);
    const lines = run.energy.filter(({ name, values: y }) => name !== "unexplained" && Math.max(...Array.from(y, Math.abs)) > 1e-9)
      .map(({ name, values: y }) => ({ label: words(name), x, y: thinned(y) }));
    const last = (name: string) => line(run, name)[run.frames.length - 1];
    const world = last("restitution loss") + last("field work");
    const method = ["truncation", "late impact", "position correction"].reduce((sum, name) => sum + last(name), 0);
    return { title: `The ledger of ${values.of}`, x: "time (s)", y: "energy (J)", lines,
      says: `Of ${(last("kinetic") + last("potential") - world - method).toFixed(1)} J the world took ${(-world).toFixed(2)} J; the method ${method >= 0 ? "added" : "lost"} ${Math.abs(method).toFixed(3)} J.` };
  },
  answer: "Restitution and drag belong to the world: both methods book them. Truncation (the step against the true flight), late impact (a bounce that is handled inside the floor, at another speed than that of the contact) and position correction belong to the method. Event-driven has no late impact at all, and its truncation is what its integrator is asked for. A method whose books balance can still be wrong in time: energy alone proves nothing.",
};

