// Lesson 6: what an accurate answer costs.
import { Motions, newState } from "../motion";
import { real, type Asked, type Lesson, type Told, type Values, number } from "./lesson";

const drop = (density: number) => `name = "a ball falls through air"
summary = "1 m through a gas, onto a floor, and up again"
duration = 1.0
frame = "1/60"
G = 9.81

[[body]]
name = "floor"
entity = "wall"
shape = "half-space"

[[body]]
name = "ball"
entity = "ball"
radius = 0.02
mass = 0.0027
position = [0.0, 1.02, 0.0]
restitution = 0.9

[[force]]
kind = "quadratic-drag"
density = ${real(density)}
`;

const steps = [15, 30, 60, 120, 240, 480];
const located = (integrator: string, frame: string) => `scheme=event-driven\nintegrator=${integrator}\ndetector=certified\nimpact=newton\nframe=${frame}`;
const stepped = (frame: string) => `scheme=original\nintegrator=thesis-euler\ndetector=sat\nimpact=newton\nframe=${frame}`;
const families: [string, (frame: string) => string][] = [
  ["original, thesis-euler", stepped],
  ["event-driven, symplectic-euler", (frame) => located("symplectic-euler", frame)],
  ["event-driven, velocity-verlet", (frame) => located("velocity-verlet", frame)],
  ["event-driven, rk4", (frame) => located("rk4", frame)],
];
const height = ({ run }: Told) => new Motions(run).at(1, run.end, newState()).py;

export const accuracy: Lesson = {
  title: "Speed against accuracy",
  question: "Shorter steps cost more work. Which method buys the most digits for it?",
  text: "Each point is a run with another frame time, from 1/15 to 1/480 s; its error is that of the height after a second, against a run with steps of 1/4000 s. Make the gas thinner or thicker.",
  controls: [
    { key: "density", label: "Density of the gas", range: { least: 0.1, most: 5, step: 0.1, unit: "kg/m³" }, start: 1.2 },
    { key: "integrator", label: "Seen: event-driven with", start: "rk4", choices: ["symplectic-euler", "velocity-verlet", "rk4"].map((value) => ({ value, text: value })) },
  ],
  seen: (values: Values) => {
    const scene = drop(number(values, "density"));
    return [{ scene, settings: located(String(values.integrator), "1/60") }, { scene, settings: stepped("1/60") }];
  },
  plot: async (values, _, ask) => {
    const scene = drop(number(values, "density"));
    const asked: Asked[] = families.flatMap(([, settings]) => steps.map((n) => ({ scene, settings: settings(`1/${n}`) })));
    const told = await ask([...asked, { scene, settings: located("rk4", "1/4000") }]);
    if (!told) return null;
    const truth = height(told[told.length - 1]);
    const lines = families.map(([label], i) => {
      const of = told.slice(i * steps.length, (i + 1) * steps.length);
      return { label, points: true, x: of.map(({ answer }) => answer.text.cost?.right_hand_sides ?? 0),
        y: of.map((each) => Math.max(Math.abs(height(each) - truth), 1e-15)) };
    });
    return { title: "Error of the height after 1 s", x: "evaluations of the acceleration", y: "error (m)", log: true, lines,
      says: `With 1/60 s: ${lines.map((line) => `${line.label} ${line.y[2].toExponential(0)} m`).join("; ")}.` };
  },
  answer: "A method that looks once a frame is of first order, whatever moves the ball: the bounce comes late by up to a frame, and half the step only halves the error. Where the impact is located, an integrator shows its own order: twice the work gives 4 times less error with velocity-verlet, and 16 times less with rk4. Beyond a few digits the higher order is cheaper, and no frame rate makes up for a late bounce.",
};
