// Bodies by pointer and keys: moved, turned and made larger where they are seen.
import { Plane, Quaternion, Raycaster, Vector2, Vector3 } from "three";
import type { Stage } from "../stage";

export type Tool = "view" | "move" | "turn" | "size";

/** What is done to a body, from where it was when it was taken. */
export interface Deed {
  by: Vector3;
  turn: Quaternion;
  factor: number;
}

export interface Handler {
  tool(): Tool;
  /** The body is taken; false: it cannot be. */
  take(body: number): boolean;
  deed(body: number, deed: Deed): void;
  done(body: number): void;
}

export class Drag {
  private body = -1;
  private pointer = -1;
  private readonly from = new Vector2();
  private readonly grip = new Vector3();
  private began = false;

  constructor(private readonly stage: Stage, private readonly handler: Handler) {
    const { canvas } = stage;
    // Before OrbitControls, which would turn the view.
    canvas.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event), { capture: true });
    for (const end of ["pointerup", "pointercancel"] as const) {
      canvas.addEventListener(end, (event) => this.up(event), { capture: true });
    }
  }

  private down(event: PointerEvent): void {
    if (this.handler.tool() === "view" || event.button !== 0 || !event.isPrimary) return;
    const body = this.stage.pick(event.offsetX, event.offsetY, true);
    if (body < 0) return;
    this.body = body;
    this.pointer = event.pointerId;
    this.began = false;
    this.from.set(event.offsetX, event.offsetY);
    this.grip.copy(this.stage.placeOf(body, event.offsetX, event.offsetY));
    this.stage.controls.enabled = false;
    this.stage.canvas.setPointerCapture(event.pointerId);
  }

  private move(event: PointerEvent): void {
    if (event.pointerId !== this.pointer || this.body < 0) return;
    const dx = event.offsetX - this.from.x;
    const dy = event.offsetY - this.from.y;
    if (!this.began) {
      if (Math.hypot(dx, dy) < 4) return;
      if (!this.handler.take(this.body)) return this.drop();
      this.began = true;
    }
    this.handler.deed(this.body, this.deed(event, dx, dy));
    event.stopImmediatePropagation();
  }

  private deed(event: PointerEvent, dx: number, dy: number): Deed {
    const { camera } = this.stage;
    const deed: Deed = { by: new Vector3(), turn: new Quaternion(), factor: 1 };
    switch (this.handler.tool()) {
      case "turn": {
        const right = new Vector3(1, 0, 0).applyQuaternion(camera.quaternion);
        const up = new Vector3(0, 1, 0);
        deed.turn.setFromAxisAngle(up, 0.01 * dx).multiply(new Quaternion().setFromAxisAngle(right, 0.01 * dy));
        break;
      }
      case "size":
        deed.factor = Math.exp(0.006 * (dx - dy));
        break;
      default: {
        // In the plane of the picture; on level ground with Shift held.
        const normal = event.shiftKey ? new Vector3(0, 1, 0) : camera.getWorldDirection(new Vector3());
        const plane = new Plane().setFromNormalAndCoplanarPoint(normal, this.grip);
        const hit = this.ray(event.offsetX, event.offsetY).ray.intersectPlane(plane, new Vector3());
        if (hit) deed.by.subVectors(hit, this.grip);
      }
    }
    return deed;
  }

  private ray(x: number, y: number): Raycaster {
    const view = this.stage.viewAt(this.from.x, this.from.y);
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2((2 * (x - view.x)) / view.width - 1, 1 - (2 * (y - view.y)) / view.height), this.stage.camera);
    return ray;
  }

  private up(event: PointerEvent): void {
    if (event.pointerId !== this.pointer) return;
    if (this.began) {
      this.handler.done(this.body);
      event.stopImmediatePropagation();
    }
    this.drop();
  }

  private drop(): void {
    this.body = -1;
    this.pointer = -1;
    this.stage.controls.enabled = true;
  }
}
