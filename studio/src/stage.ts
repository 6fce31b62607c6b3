// The canvas: one view per run, side by side or one above the other, with one camera for all.
import { PerspectiveCamera, Raycaster, Vector2, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { newState } from "./motion";
import { pause } from "./pause";
import type { Look, World } from "./world";

export interface Rect { x: number; y: number; width: number; height: number }

export class Stage {
  readonly renderer: WebGLRenderer;
  readonly camera = new PerspectiveCamera(40, 1, 0.01, 1000);
  readonly controls: OrbitControls;
  following = false;
  private origins: Vector3[];
  private readonly state = newState();
  /** The camera moved. */
  changed: () => void = () => undefined;

  constructor(readonly canvas: HTMLCanvasElement, public worlds: World[]) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.setScissorTest(true);
    this.renderer.localClippingEnabled = true;
    this.renderer.debug.checkShaderErrors = false; // it waits for the graphics card
    this.origins = worlds.map(() => new Vector3());
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => this.changed());
    this.fit();
  }

  /** The ball around the first world's, grown for the others, but not after what escaped there. */
  private whole(): { centre: Vector3; radius: number } {
    const centre = this.worlds[0].centre.clone();
    let radius = this.worlds[0].radius;
    for (const world of this.worlds.slice(1)) {
      const away = world.centre.clone().sub(centre);
      const far = away.length();
      const grown = Math.max(world.radius, 0.5 * (radius + far + world.radius));
      if (far + world.radius <= radius || grown > 1.4 * this.worlds[0].radius) continue;
      if (far > 0) centre.addScaledVector(away, (grown - Math.min(radius, grown)) / far);
      radius = grown;
    }
    return { centre, radius };
  }

  /** Other worlds, seen as these were. */
  load(worlds: World[]): void {
    this.worlds = worlds;
    this.origins = worlds.map(() => new Vector3());
  }

  /** All of the scene, seen from `direction`. */
  fit(direction = new Vector3(0.35, 0.32, 1)): void {
    const whole = this.whole();
    const r = whole.radius;
    const centre = this.following ? new Vector3() : whole.centre;
    const [view] = this.views();
    const aspect = view ? view.width / view.height : 1;
    const half = Math.tan((this.camera.fov * Math.PI) / 360) * Math.min(1, aspect);
    this.camera.near = r * 1e-3;
    this.camera.far = r * 200;
    this.camera.position.copy(centre).addScaledVector(direction.clone().normalize(), (0.95 * r) / Math.min(half, 0.36));
    this.controls.target.copy(centre);
    this.controls.minDistance = r * 5e-3;
    this.controls.maxDistance = r * 60;
    this.controls.update();
  }

  /** From a place to another. */
  lookAt(from: Vector3, to: Vector3): void {
    const far = from.distanceTo(to);
    this.controls.minDistance = Math.min(0.01, 0.01 * far);
    this.controls.maxDistance = 1e3 * Math.max(1, far);
    this.camera.near = Math.min(0.02, 0.02 * far);
    this.camera.position.copy(from);
    this.controls.target.copy(to);
    this.controls.update();
  }

  /** Goes with a body, which becomes the middle of the picture; -1: with none. */
  follow(body: number): void {
    const distance = this.camera.position.clone().sub(this.controls.target);
    this.following = body >= 0;
    if (this.following) this.controls.target.setScalar(0);
    else this.controls.target.copy(this.whole().centre);
    this.camera.position.copy(this.controls.target).add(distance);
    this.controls.update();
  }

  /** By keys: turns (rad), moves nearer by a factor, moves sideways (shares of the distance). */
  turn(around: number, over: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const r = offset.length();
    const polar = Math.min(Math.max(Math.acos(offset.y / r) - over, 0.02), Math.PI - 0.02);
    const azimuth = Math.atan2(offset.x, offset.z) + around;
    offset.setFromSphericalCoords(r, polar, azimuth);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  zoom(factor: number): void {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
  }

  pan(right: number, up: number): void {
    const distance = this.camera.position.distanceTo(this.controls.target);
    const step = new Vector3(right * distance, up * distance, 0).applyQuaternion(this.camera.quaternion);
    this.camera.position.add(step);
    this.controls.target.add(step);
    this.controls.update();
  }

  /** Where the views are on the canvas, CSS pixels, from its upper left corner. */
  views(): Rect[] {
    const width = Math.max(1, this.canvas.clientWidth);
    const height = Math.max(1, this.canvas.clientHeight);
    const n = this.worlds.length;
    const stacked = n > 1 && width < 640;
    return this.worlds.map((_, i) =>
      stacked
        ? { x: 0, y: (i * height) / n, width, height: height / n }
        : { x: (i * width) / n, y: 0, width: width / n, height });
  }

  /** Has all that is drawn of the worlds compiled for the graphics card, where it can meanwhile. */
  async prepare(t: number, look: Look, body: number): Promise<void> {
    const meanwhile = this.renderer.getContext().getExtension("KHR_parallel_shader_compile") !== null;
    for (const world of this.worlds) {
      world.show(Math.min(t, world.run.end), new Vector3(), look, body);
      world.lookFrom(this.camera);
      if (meanwhile) await this.renderer.compileAsync(world.scene, this.camera);
      else this.renderer.compile(world.scene, this.camera);
      await pause();
    }
  }

  draw(t: number, look: Look, body: number): void {
    const width = this.canvas.clientWidth;
    const height = this.canvas.clientHeight;
    const ratio = Math.min(window.devicePixelRatio, 2);
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
    const size = this.renderer.getSize(new Vector2());
    if (size.x !== width || size.y !== height) this.renderer.setSize(width, height, false);
    this.views().forEach((view, i) => {
      const world = this.worlds[i];
      const origin = this.origins[i].setScalar(0);
      if (this.following && body >= 0 && body < world.run.bodies.length) {
        const at = world.motions.at(body, Math.min(t, world.run.end), this.state);
        origin.set(at.px, at.py, at.pz);
      }
      world.show(Math.min(t, world.run.end), origin, look, body);
      const y = height - view.y - view.height;
      this.renderer.setViewport(view.x, y, view.width, view.height);
      this.renderer.setScissor(view.x, y, view.width, view.height);
      this.camera.aspect = view.width / view.height;
      this.camera.updateProjectionMatrix();
      world.lookFrom(this.camera);
      this.renderer.render(world.scene, this.camera);
    });
  }

  /** The view under a point of the canvas; the first one where there is none. */
  viewAt(x: number, y: number): Rect {
    const views = this.views();
    return views.find((v) => x >= v.x && x < v.x + v.width && y >= v.y && y < v.y + v.height) ?? views[0];
  }

  ray(x: number, y: number): Raycaster {
    const view = this.viewAt(x, y);
    const ray = new Raycaster();
    this.camera.aspect = view.width / view.height;
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    ray.setFromCamera(new Vector2((2 * (x - view.x)) / view.width - 1, 1 - (2 * (y - view.y)) / view.height), this.camera);
    return ray;
  }

  /** The body under a point of the canvas; -1 if there is none. Fixed ones only where they are asked for. */
  pick(x: number, y: number, fixed = false): number {
    const i = this.viewIndex(x, y);
    if (i < 0) return -1;
    const { ray } = this.ray(x, y);
    return this.worlds[i].pick(ray.origin, ray.direction, this.origins[i], fixed);
  }

  private viewIndex(x: number, y: number): number {
    return this.views().findIndex((v) => x >= v.x && x < v.x + v.width && y >= v.y && y < v.y + v.height);
  }

  /** Where a body is in the view under a point of the canvas, as it is drawn. */
  placeOf(body: number, x: number, y: number): Vector3 {
    const i = Math.max(0, this.viewIndex(x, y));
    const at = this.worlds[i].states[body];
    return new Vector3(at.px, at.py, at.pz).sub(this.origins[i]);
  }
}
