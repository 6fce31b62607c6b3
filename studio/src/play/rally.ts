// A rally as samples: the tracks of bat and hand, frame by frame, and the scene that they make. What a
// page shows of a point is a run of that scene, and what is saved is the same scene with all points.
import { Quaternion, Vector3 } from "three";
import { ball, bat, gravity, net, places, table, throwTo, type Kind } from "./table";

/** Times are multiples of 2^-20 s: sums and differences of them are exact, here and in the program. */
const tick = 2 ** -20;
export const ticks = (seconds: number) => Math.max(tick, Math.round(seconds / tick) * tick);

/** Of the files of a rally; what a page shows while it is played has a title of its own. */
const title = "Table tennis";

interface BatSample { t: number; p: Vector3; q: Quaternion }
interface HandSample { t: number; p: Vector3; closed: boolean }
/** A ball on its way to the bat. */
export interface Coming { p: readonly number[]; v: readonly number[] }

export interface Files { scene: string; bat: string; hand: string; frames: string }
export interface Bat13 { threshold: number; scale: number; nudge: number }

/** How long the machine keeps a ball before it throws, and the hand moves with it before it lets go, s. */
const pause = 0.3;
const swing = 0.0625;

/** Where the hand goes when the ball has left it: out of its way. */
const aside = { serve: new Vector3(0.3, -0.5, 0.3), return: new Vector3(0, 0.4, -0.35) } as const;

const hand = (name: string) => `[[body]]
name = "hand"
entity = "hand"
half_extents = [0.04, 0.015, 0.04]
mass = 0.4
holds = "ball"

[body.drive]
track = "${name}-hand.csv"

`;

/** The same places for the same seed. */
function* randoms(seed: number): Generator<number, never> {
  for (let state = seed >>> 0; ; ) {
    state = (state + 0x6d2b79f5) >>> 0; // mulberry32
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    yield ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  }
}

export class Rally {
  time = 0;
  /** When the point began, whose it is, and when the ball was let go of; infinite: it is held. */
  began = 0;
  kind: Kind = "serve";
  released = Infinity;
  /** When the stroke began: from here on both methods have the same ball. Infinite: not yet. */
  met = Infinity;
  private coming: Coming = { p: [0, 0, 0], v: [0, 0, 0] };
  private firstOfStroke = 0;
  private readonly batSamples: BatSample[] = [];
  private readonly hand: HandSample[] = [];
  private readonly frames: number[] = [];
  private firstBat = 0;
  private firstHand = 0;
  private readonly random: Generator<number, never>;

  constructor(readonly options: Bat13, at: { p: Vector3; q: Quaternion }, seed = 1999) {
    this.random = randoms(seed);
    this.batSamples.push({ t: 0, p: at.p.clone(), q: at.q.clone() });
    this.point("serve");
  }

  /** The fist closes about the ball, wherever it is: another point begins. */
  point(kind: Kind): void {
    this.kind = kind;
    this.began = this.time;
    this.released = Infinity;
    this.met = Infinity;
    // What was planned of the hand for later is not done.
    while (this.hand.length > 0 && this.hand[this.hand.length - 1].t >= this.time) this.hand.pop();
    const last = this.hand[this.hand.length - 1];
    const leaves = this.time - 2 ** -10;
    if (last && last.t < leaves) this.hand.push({ ...last, t: leaves });
    this.hand.push({ t: this.time, p: places[kind].clone(), closed: true });
    this.firstHand = this.hand.length - 1;
    this.firstBat = this.batSamples.length - 1;
    if (kind === "return") this.letGo(this.time + pause);
  }

  /** The player's own hand tosses the ball up. */
  serve(): void {
    if (this.kind === "serve" && this.released === Infinity) this.letGo(this.time);
  }

  private letGo(at: number): void {
    const from = places[this.kind];
    const side = 2 * this.random.next().value - 1;
    const depth = this.random.next().value;
    const velocity = this.kind === "serve"
      ? new Vector3(0, 2.4, 0.03)
      : throwTo(from, { x: 0.3 * side, z: 0.75 + 0.25 * depth }, swing, 0.5);
    // The place from which it flies is where the hand is then: a short way along.
    const along = (s: number) => from.clone().addScaledVector(velocity, s);
    this.released = ticks(at + swing);
    if (at > this.hand[this.hand.length - 1].t) this.hand.push({ t: at, p: from.clone(), closed: true });
    this.hand.push({ t: this.released, p: along(swing), closed: false });
    this.hand.push({ t: ticks(this.released + 0.03), p: along(swing + 0.03), closed: false });
    this.hand.push({ t: ticks(this.released + 0.3), p: from.clone().add(aside[this.kind]), closed: false });
  }

  /** The ball comes to the bat, and is here now: the stroke begins. */
  meet(coming: Coming): void {
    this.met = this.time;
    this.coming = coming;
    this.firstOfStroke = this.batSamples.length - 1;
  }

  /** Another frame: where the bat is `seconds` later. */
  sample(seconds: number, p: Vector3, q: Quaternion): void {
    const dt = ticks(seconds);
    this.time += dt;
    this.frames.push(dt);
    this.batSamples.push({ t: this.time, p: p.clone(), q: q.clone() });
  }

  get count(): number { return this.frames.length; }
  get batNow(): BatSample { return this.batSamples[this.batSamples.length - 1]; }

  /** The scene of this point up to now, on a clock that starts with it. Only what looks once a frame has a nudge. */
  pointFiles(name: string, nudge: number): Files {
    return this.files(name, nudge, this.batSamples.slice(this.firstBat), this.hand.slice(this.firstHand), this.frames.slice(this.firstBat), this.began);
  }

  /** The scene of this stroke up to now: a ball on its way, and a bat. */
  strokeFiles(name: string, nudge: number): Files {
    return this.files(name, nudge, this.batSamples.slice(this.firstOfStroke), [], this.frames.slice(this.firstOfStroke), this.met);
  }

  /** The scene of all points. */
  allFiles(name: string, nudge: number): Files { return this.files(name, nudge, this.batSamples, this.hand, this.frames, 0); }

  private files(name: string, nudge: number, bats: BatSample[], hands: HandSample[], frames: number[], from: number): Files {
    const row = (t: number, p: Vector3) => `${t - from},${p.x},${p.y},${p.z}`;
    return {
      scene: this.scene(name, nudge, Math.max(tick, this.time - from), hands),
      bat: `t,x,y,z,qw,qx,qy,qz\n${bats.map(({ t, p, q }) => `${row(t, p)},${q.w},${q.x},${q.y},${q.z}\n`).join("")}`,
      hand: `t,x,y,z,gesture\n${hands.map(({ t, p, closed }) => `${row(t, p)},${Number(closed)}\n`).join("")}`,
      frames: `# s, of each frame\n${frames.length > 0 ? frames.join("\n") : String(tick)}\n`,
    };
  }

  private scene(name: string, nudge: number, duration: number, hands: HandSample[]): string {
    const list = (x: readonly number[]) => `[${x.map((each) => (Number.isInteger(each) ? `${each}.0` : String(each))).join(", ")}]`;
    const real = (x: number) => (Number.isInteger(x) ? `${x}.0` : String(x));
    return `# Table tennis played with the pointer: the bat follows its recording.

name = "${title}"
summary = "a rally played with the pointer"
duration = ${real(duration)}
frame = { csv = "${name}-frames.csv" }   # as they were
G = ${gravity}

[[body]]
name = "table"
entity = "wall"
half_extents = ${list(table.half)}
position = ${list([0, table.top - table.half[1], 0])}

[[body]]
name = "net"
entity = "wall"
half_extents = ${list(net.half)}
position = ${list([0, table.top + net.half[1], 0])}
normal = [0.0, 0.0, 1.0]

[[body]]
name = "floor"
entity = "wall"
shape = "half-space"

[[body]]
name = "bat"
entity = "bat"
half_extents = ${list(bat.half)}
mass = ${bat.mass}
velocity_threshold = ${real(this.options.threshold)}   # m, 13.8
velocity_scale = ${real(this.options.scale)}   # 7.3
nudge = ${real(nudge)}   # s, 13.9; only looked at once a frame: --set body.bat.nudge=${this.options.nudge} --thesis

[body.drive]
track = "${name}-bat.csv"

${hands.length > 0 ? hand(name) : ""}[[body]]
name = "ball"
entity = "ball"
radius = ${ball.radius}
mass = ${ball.mass}
${hands.length > 0 ? `position = ${list([hands[0].p.x, hands[0].p.y + 0.25, hands[0].p.z])}   # until the fist closes`
    : `position = ${list(this.coming.p)}\nvelocity = ${list(this.coming.v)}`}
`;
  }
}
