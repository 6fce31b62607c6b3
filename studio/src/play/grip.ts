// Who holds the bat: pointer, wheel, touch and keys become a place of the bat.
import { Plane, Vector3 } from "three";
import { box } from "../viewer";
import type { Stage } from "../stage";
import { reach, swingDirection, withinReach } from "./table";

interface Acts { serve(): void; pause(): void }

const restHeight = 0.95;
/** Of keys, m/s. */
const keySpeed = 1.6;
/** A stroke by key or button: so far (m) forward and back, in so long (s). */
const stroke = { length: 0.34, lasts: 0.3, direction: new Vector3(0, 0.34, -0.94).normalize() } as const;

const steered: Record<string, readonly [number, number, number]> = {
  arrowleft: [-1, 0, 0], arrowright: [1, 0, 0], arrowup: [0, 1, 0], arrowdown: [0, -1, 0],
  w: [0, 0, -1], s: [0, 0, 1], pageup: [0, 0, -1], pagedown: [0, 0, 1], a: [-1, 0, 0], d: [1, 0, 0],
};

export class Grip {
  /** Sideways and along the swing, m, from the middle; and how far in front of the player. */
  private x = 0;
  private along = 0;
  private swung = Infinity;
  private readonly held = new Set<string>();
  private moved = 0;

  constructor(private readonly stage: Stage, private readonly mine: () => boolean, private readonly acts: Acts) {
    const { canvas } = stage;
    canvas.addEventListener("pointermove", (event) => this.point(event));
    canvas.addEventListener("pointerdown", (event) => {
      if (!this.mine()) return;
      this.point(event);
      canvas.setPointerCapture(event.pointerId);
      if (event.pointerType !== "touch") this.acts.serve();
    });
    canvas.addEventListener("wheel", (event) => {
      if (!this.mine()) return;
      event.preventDefault();
      this.depth += 0.04 * Math.sign(event.deltaY);
    }, { passive: false });
    document.addEventListener("keydown", (event) => this.key(event, true), { capture: true });
    document.addEventListener("keyup", (event) => this.key(event, false), { capture: true });
    window.addEventListener("blur", () => this.held.clear());
  }

  get depth(): number { return Number(box("play-depth").value); }
  set depth(z: number) { box("play-depth").value = String(Math.min(reach.near, Math.max(reach.far + 0.1, z))); }

  /** Of the bat's face, rad. */
  get lift(): number { return (Number(box("play-lift").value) * Math.PI) / 180; }

  rest(): void {
    this.swung = Infinity;
    this.held.clear();
  }

  swing(): void { this.swung = 0; }

  /** When what the bat does was read, ms on the page's clock. */
  readAt(): number {
    const now = performance.now();
    return this.moved > 0 && now - this.moved < 50 ? this.moved : now;
  }

  private middle(): Vector3 { return new Vector3(0, restHeight, this.depth); }

  private point(event: PointerEvent): void {
    if (!this.mine()) return;
    this.moved = event.timeStamp;
    const ray = this.stage.ray(event.offsetX, event.offsetY).ray;
    const plane = new Plane().setFromNormalAndCoplanarPoint(new Vector3(1, 0, 0).cross(swingDirection), this.middle());
    const hit = ray.intersectPlane(plane, new Vector3());
    if (!hit) return;
    hit.sub(this.middle());
    this.x = hit.x;
    this.along = hit.dot(swingDirection);
  }

  /** Where the bat is `seconds` after the last time. */
  position(seconds: number): Vector3 {
    for (const key of this.held) {
      const [x, up, depth] = steered[key];
      this.x += x * keySpeed * seconds;
      this.along += up * keySpeed * seconds;
      this.depth += depth * 0.5 * keySpeed * seconds;
    }
    this.x = Math.min(reach.side, Math.max(-reach.side, this.x));
    this.along = Math.min(0.9, Math.max(-0.8, this.along));
    const p = this.middle().addScaledVector(swingDirection, this.along);
    p.x += this.x;
    if (this.swung < stroke.lasts) {
      this.swung += seconds;
      p.addScaledVector(stroke.direction, stroke.length * Math.sin((Math.PI * Math.min(this.swung, stroke.lasts)) / stroke.lasts) ** 2);
    }
    return withinReach(p);
  }

  private key(event: KeyboardEvent, down: boolean): void {
    const key = event.key.toLowerCase();
    if (!down) this.held.delete(key);
    const target = event.target as HTMLElement;
    if (!this.mine() || event.ctrlKey || event.metaKey || event.altKey || (target !== document.body && target.id !== "canvas")) return;
    if (key in steered) {
      if (down) this.held.add(key);
    } else if (!down) return;
    else if (key === " ") this.swing();
    else if (key === "enter") this.acts.serve();
    else if (key === "p") this.acts.pause();
    else return;
    event.preventDefault();
    event.stopImmediatePropagation();
  }
}
