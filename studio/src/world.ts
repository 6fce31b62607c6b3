// One run as a three.js scene: bodies, their boxes, what is inside what, trails, impacts.
import {
  AmbientLight, BufferAttribute, BufferGeometry, Color, ConeGeometry, DirectionalLight, DoubleSide, EdgesGeometry,
  DynamicDrawUsage, FrontSide, GridHelper, Group, HemisphereLight, InstancedMesh, LineBasicMaterial, LineSegments, Material,
  Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, Plane, PlaneGeometry, Quaternion, Scene,
  Vector3, type Camera,
} from "three";
import { balls, type Lights } from "./balls";
import { Belts } from "./belts";
import { Contacts, type Overlap } from "./contacts";
import type { Body, Run, Shape } from "./data";
import { FatLines } from "./fat";
import { boundingRadius } from "./gap";
import { Insides } from "./inside";
import { Joints } from "./joints";
import { Motions, newState, type State } from "./motion";
import type { Palette } from "./palette";
import { after, before } from "./search";
import { solidGeometry, solidKey, stretch } from "./solids";

export interface Look {
  boxes: boolean;
  fields: boolean;
  inside: boolean;
  impacts: boolean;
  /** Seconds of trail behind moving bodies; 0: none. */
  trail: number;
}

const trailPoints = 96;
const mostTrails = 48;
const mostArrows = 24;

/** The bodies that one instanced mesh draws. */
interface Batch {
  mesh: InstancedMesh;
  bodies: number[];
}

const corners = [-1, 1].flatMap((x) => [-1, 1].flatMap((y) => [-1, 1].map((z) => new Vector3(x, y, z))));
const edges = corners.flatMap((a, i) =>
  corners.flatMap((b, j) => (j > i && a.clone().sub(b).lengthSq() === 4 ? [a, b] : [])));

/** Ends of the edges of a shape, body frame; of a round one none. */
function edgesOf(shape: Shape): Vector3[] {
  if (shape.kind === "box") return edges.map((corner) => corner.clone().multiply(new Vector3(shape.x, shape.y, shape.z)));
  const sharp = shape.kind === "compound" || shape.kind === "cylinder" || shape.kind === "cone" || (shape.kind === "hull" && !(shape.rounding! > 0));
  if (!sharp) return [];
  const position = new EdgesGeometry(solidGeometry(shape, 1), shape.kind === "hull" ? 1 : 40).getAttribute("position");
  const scale = stretch(shape, new Vector3());
  return Array.from({ length: position.count }, (_, k) => new Vector3().fromBufferAttribute(position, k).multiply(scale));
}

export class World {
  readonly scene = new Scene();
  motions: Motions;
  contacts: Contacts;
  readonly states: State[];
  readonly centre = new Vector3();
  radius = 1;
  overlaps: Overlap[] = [];
  private readonly batches: Batch[] = [];
  private readonly planes: { body: number; group: Group; grid: GridHelper; clip: Plane }[] = [];
  private readonly edged: { body: number; ends: Vector3[] }[];
  private readonly joints: Joints;
  private readonly belts: Belts;
  private readonly wires: LineSegments<BufferGeometry, LineBasicMaterial>;
  private readonly insides = new Insides(16);
  private readonly trails = new FatLines(mostTrails * trailPoints, 2.5);
  private readonly shafts = new FatLines(2 * mostArrows, 3, true);
  private readonly heads: InstancedMesh;
  private largestImpulse = 0;
  private readonly matrix = new Matrix4();
  private readonly p = new Vector3();
  private readonly q = new Quaternion();
  private readonly s = new Vector3();
  private readonly colours: Record<"background" | "inside" | "normal" | "impulse" | "edge", Color>;
  private readonly movers: number[];
  private lights!: Lights;

  constructor(public run: Run, private readonly colour: Palette) {
    this.motions = new Motions(run);
    this.contacts = new Contacts(run);
    this.states = run.bodies.map(newState);
    this.movers = run.bodies.map((_, i) => i).filter((i) => run.bodies[i].moves !== "fixed");
    const named = (name: "background" | "inside" | "normal" | "impulse" | "edge") => new Color(colour[name]);
    this.colours = {
      background: named("background"), inside: named("inside"), normal: named("normal"),
      impulse: named("impulse"), edge: named("edge"),
    };
    this.measure();
    this.light();
    this.makeBodies();
    this.edged = run.bodies.map(({ collides }, body) => ({ body, ends: edgesOf(collides) })).filter(({ ends }) => ends.length > 0);
    this.joints = new Joints(run.joints, this.radius, new Color(colour.joint));
    this.belts = new Belts(run.bodies, this.radius, new Color(colour.driven));
    this.wires = this.makeWires();
    this.heads = new InstancedMesh(new ConeGeometry(1, 2.6, 16), new MeshBasicMaterial({ depthTest: false }), 2 * mostArrows);
    this.heads.renderOrder = 20;
    this.heads.frustumCulled = false;
    this.heads.count = 0;
    this.scene.add(this.insides.object, this.trails.object, this.shafts.object, this.heads);
    this.scene.add(this.joints.lines.object, this.joints.points, this.belts.lines.object);
    this.measureImpulses();
  }

  /** Another run of the same bodies: what was built for them stays. */
  renew(run: Run): void {
    this.run = run;
    this.motions = new Motions(run);
    this.contacts = new Contacts(run);
    this.measureImpulses();
  }

  private measureImpulses(): void {
    const v = this.run.events.vectors;
    this.largestImpulse = 0;
    for (let e = 0; e < this.run.events.time.length; ++e) {
      this.largestImpulse = Math.max(this.largestImpulse, Math.hypot(v[9 * e + 6], v[9 * e + 7], v[9 * e + 8]));
    }
  }

  /** The ball around what moves, and around what is fixed nearby; around the room, where there is one. */
  private measure(): void {
    const { run } = this;
    const low = new Vector3(Infinity, Infinity, Infinity);
    const high = low.clone().negate();
    const state = newState();
    const include = (i: number, t: number, reach: number) => {
      this.motions.at(i, t, state);
      this.p.set(state.px, state.py, state.pz);
      low.min(this.s.copy(this.p).subScalar(reach));
      high.max(this.s.copy(this.p).addScalar(reach));
    };
    const moving = this.movers.filter((i) => Number.isFinite(boundingRadius(run.bodies[i].shape)));
    const looks = Math.max(2, Math.min(200, Math.floor(40000 / Math.max(1, moving.length))));
    const samples = (bodies: number[], take: (i: number, t: number) => void) => {
      for (const i of bodies) for (let k = 0; k <= looks; ++k) take(i, run.begin + ((run.end - run.begin) * k) / looks);
    };
    const kept = this.stayers(samples);
    samples(moving, (i, t) => { if (kept(i, t)) include(i, t, boundingRadius(run.bodies[i].shape)); });
    const reach = moving.length > 0 ? high.distanceTo(low) : Infinity;
    run.bodies.forEach((body, i) => {
      const r = boundingRadius(body.shape);
      if (body.moves === "fixed" && r < 2 * reach) include(i, run.begin, 0.8 * r);
    });
    if (!(low.x <= high.x)) { low.setScalar(-1); high.setScalar(1); }
    this.centre.addVectors(low, high).multiplyScalar(0.5);
    this.radius = Math.max(0.5 * high.distanceTo(low), 1e-6);
  }

  /** Which moments count for what is seen: the start, and those near the room that fixed and driven bodies
   *  make, where there is one. A ball that was hit out of it is not followed. */
  private stayers(samples: (bodies: number[], take: (i: number, t: number) => void) => void): (i: number, t: number) => boolean {
    const { run } = this;
    const { bodies } = run;
    const room = bodies.map((_, i) => i)
      .filter((i) => bodies[i].moves !== "free" && Number.isFinite(boundingRadius(bodies[i].shape)));
    const low = new Vector3(Infinity, Infinity, Infinity);
    const high = low.clone().negate();
    const state = newState();
    samples(room, (i, t) => {
      const r = boundingRadius(bodies[i].shape);
      this.motions.at(i, t, state);
      low.min(this.s.set(state.px, state.py, state.pz).subScalar(r));
      high.max(this.s.set(state.px, state.py, state.pz).addScalar(r));
    });
    if (room.length === 0) return () => true;
    const centre = low.clone().add(high).multiplyScalar(0.5);
    const limit = 0.6 * high.distanceTo(low);
    return (i, t) => {
      this.motions.at(i, t, state);
      return t === run.begin || this.s.set(state.px, state.py, state.pz).distanceTo(centre) <= limit;
    };
  }

  private light(): void {
    this.scene.background = this.colours.background;
    const sun = new DirectionalLight(0xffffff, 1.6);
    sun.position.set(0.5, 1, 0.8);
    const ambient = new AmbientLight(0xffffff, 0.35);
    const hemisphere = new HemisphereLight(0xffffff, 0x8a8f96, this.colour.dark ? 1.5 : 1.9);
    this.scene.add(hemisphere, ambient, sun);
    const bright = (light: AmbientLight | DirectionalLight) => light.color.clone().multiplyScalar(light.intensity);
    this.lights = { hemisphere, ambient: bright(ambient), sun: sun.position, sunColour: bright(sun) };
  }

  private tone(body: Body, i: number): Color {
    if (body.field) return new Color(this.colour.field);
    if (body.moves === "fixed") return new Color(this.colour.fixed);
    return new Color(body.moves === "driven" ? this.colour.driven : this.colour.free[i % 2]);
  }

  private makeBodies(): void {
    const { run } = this;
    const kinds = new Map<string, number[]>();
    run.bodies.forEach((body, i) => {
      if (body.shape.kind === "half-space") return this.makePlane(body, i);
      const key = `${solidKey(body.shape)} ${body.field ? "field" : body.moves === "fixed" ? "fixed" : "moving"}`;
      kinds.set(key, [...(kinds.get(key) ?? []), i]);
    });
    for (const [key, bodies] of kinds) {
      const { shape } = run.bodies[bodies[0]];
      const round = shape.kind === "sphere";
      const field = key.endsWith("field");
      const seeThrough = field || (key.endsWith("fixed") && !round);
      const mesh = round && !field ? balls(bodies.length, this.lights) : this.solids(shape, bodies.length, field, seeThrough);
      mesh.instanceMatrix.setUsage(DynamicDrawUsage);
      mesh.frustumCulled = false;
      mesh.userData.field = field;
      mesh.renderOrder = field ? 5 : seeThrough ? 1 : 0;
      bodies.forEach((i, k) => mesh.setColorAt(k, this.tone(run.bodies[i], i)));
      this.batches.push({ mesh, bodies });
      this.scene.add(mesh);
    }
  }

  private solids(shape: Shape, count: number, field: boolean, seeThrough: boolean): InstancedMesh {
    const geometry = solidGeometry(shape, count);
    const material = new MeshLambertMaterial({
      vertexColors: geometry.hasAttribute("color"), transparent: seeThrough, opacity: field ? 0.25 : seeThrough ? 0.62 : 1,
      depthWrite: !field, flatShading: shape.kind === "hull" || shape.kind === "mesh", side: shape.kind === "mesh" ? DoubleSide : FrontSide,
    });
    return new InstancedMesh(geometry, material, count);
  }

  /** A half-space: a piece of its face with a grid, seen from outside only. */
  private makePlane(body: Body, i: number): void {
    const size = 3 * this.radius;
    const step = 10 ** Math.floor(Math.log10(this.radius)) * 0.5;
    const group = new Group();
    const face = new Mesh(
      new PlaneGeometry(2 * size, 2 * size),
      new MeshBasicMaterial({
        color: this.tone(body, i), transparent: true, opacity: this.colour.dark ? 0.3 : 0.35,
        side: body.field ? DoubleSide : FrontSide, depthWrite: false,
      }),
    );
    face.rotation.x = -Math.PI / 2;
    const grid = new GridHelper(2 * Math.ceil(size / step) * step, 2 * Math.ceil(size / step), this.colours.edge, this.colours.edge);
    grid.material.transparent = true;
    grid.material.opacity = 0.13;
    group.add(face, grid);
    group.userData.field = body.field;
    this.planes.push({ body: i, group, grid, clip: new Plane() });
    this.scene.add(group);
  }

  private makeWires(): LineSegments<BufferGeometry, LineBasicMaterial> {
    const geometry = new BufferGeometry();
    const positions = new BufferAttribute(new Float32Array(3 * this.edged.reduce((sum, { ends }) => sum + ends.length, 0)), 3);
    positions.setUsage(DynamicDrawUsage);
    geometry.setAttribute("position", positions);
    const wires = new LineSegments(geometry, new LineBasicMaterial({ color: this.colours.edge }));
    wires.frustumCulled = false;
    this.scene.add(wires);
    return wires;
  }

  /** Frees what the graphics card holds. */
  dispose(): void {
    this.scene.traverse((object) => {
      const { geometry, material } = object as Partial<Mesh<BufferGeometry, Material | Material[]>>;
      geometry?.dispose();
      for (const each of material === undefined ? [] : [material].flat()) each.dispose();
      if (object instanceof InstancedMesh) object.dispose();
    });
  }

  /** Poses of all bodies at t, m from `origin`. */
  show(t: number, origin: Vector3, look: Look, highlighted: number): void {
    this.run.bodies.forEach((_, i) => this.motions.at(i, t, this.states[i]));
    this.overlaps = look.inside ? this.contacts.overlaps(this.states) : [];
    this.placeBodies(origin, look);
    this.placeWires(origin, look);
    this.insides.clear();
    for (const { a, b } of this.overlaps) {
      const { bodies } = this.run;
      this.insides.add(bodies[a].collides, this.states[a], bodies[b].collides, this.states[b], origin, this.colours.inside);
    }
    this.insides.commit();
    this.joints.show(this.states, origin, this.colours.background);
    this.belts.show(t, this.states, this.centre, origin, this.colours.background);
    this.drawTrails(t, origin, look, highlighted);
    this.drawImpacts(t, origin, look);
  }

  private placeBodies(origin: Vector3, look: Look): void {
    for (const { mesh, bodies } of this.batches) {
      bodies.forEach((i, k) => {
        const at = this.states[i];
        const shape: Shape = this.run.bodies[i].shape;
        this.p.set(at.px - origin.x, at.py - origin.y, at.pz - origin.z);
        this.q.set(at.qx, at.qy, at.qz, at.qw);
        stretch(shape, this.s);
        mesh.setMatrixAt(k, this.matrix.compose(this.p, this.q, this.s));
      });
      mesh.instanceMatrix.needsUpdate = true;
      mesh.visible = look.fields || !mesh.userData.field;
    }
    for (const { body, group, clip } of this.planes) {
      const at = this.states[body];
      const n = this.run.bodies[body].shape;
      this.q.set(at.qx, at.qy, at.qz, at.qw);
      this.s.set(n.x, n.y, n.z).applyQuaternion(this.q);
      group.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), this.s);
      // The piece below the middle of the scene.
      this.p.set(at.px, at.py, at.pz);
      const height = this.p.sub(this.centre).dot(this.s);
      group.position.copy(this.centre).addScaledVector(this.s, height).sub(origin);
      group.visible = look.fields || !group.userData.field;
      clip.setFromNormalAndCoplanarPoint(this.s, this.p.copy(group.position).addScaledVector(this.s, -1e-4 * this.radius));
    }
  }

  /** Faces end where they meet others, and one sees no grid from behind. */
  lookFrom(camera: Camera): void {
    for (const { group, grid, clip } of this.planes) {
      grid.visible = group.userData.field || clip.distanceToPoint(camera.position) > 0;
      const others = group.userData.field ? [] : this.planes.filter((plane) => plane.clip !== clip && !plane.group.userData.field);
      for (const part of group.children) (part as Mesh<BufferGeometry, Material>).material.clippingPlanes = others.map((plane) => plane.clip);
    }
  }

  private placeWires(origin: Vector3, look: Look): void {
    this.wires.visible = look.boxes;
    if (!look.boxes) return;
    const positions = this.wires.geometry.getAttribute("position") as BufferAttribute;
    let k = 0;
    for (const { body, ends } of this.edged) {
      const at = this.states[body];
      const hidden = this.run.bodies[body].field && !look.fields;
      this.q.set(at.qx, at.qy, at.qz, at.qw);
      for (const end of ends) {
        this.p.copy(end).applyQuaternion(this.q);
        if (hidden) this.p.setScalar(0);
        positions.setXYZ(k++, this.p.x + at.px - origin.x, this.p.y + at.py - origin.y, this.p.z + at.pz - origin.z);
      }
    }
    positions.needsUpdate = true;
  }

  private drawTrails(t: number, origin: Vector3, look: Look, highlighted: number): void {
    this.trails.clear();
    const { run, colours } = this;
    if (look.trail > 0) {
      const all = this.movers.filter((i) => !run.bodies[i].field);
      const of = all.length <= mostTrails ? all : all.filter((i) => i === highlighted);
      const state = newState();
      for (const i of of) {
        const colour = this.tone(run.bodies[i], i);
        const from = Math.max(this.run.begin, t - look.trail);
        let x = 0, y = 0, z = 0;
        for (let k = 0; k <= trailPoints; ++k) {
          this.motions.at(i, from + ((t - from) * k) / trailPoints, state);
          const [nx, ny, nz] = [state.px - origin.x, state.py - origin.y, state.pz - origin.z];
          if (k > 0) this.trails.add(x, y, z, nx, ny, nz, colour, colours.background, (0.9 * k) / trailPoints);
          x = nx; y = ny; z = nz;
        }
      }
    }
    this.trails.commit();
  }

  /** Normals and impulses of impacts of the last moments. */
  private drawImpacts(t: number, origin: Vector3, look: Look): void {
    this.shafts.clear();
    let heads = 0;
    const { events } = this.run;
    const last = look.impacts ? after(events.time, t + 1e-12 * (1 + t)) - 1 : -1;
    const since = t - 0.25;
    let drawn = 0;
    for (let e = last; e >= 0 && drawn < mostArrows && events.time[e] >= since; --e) {
      if (events.kind[e] !== 0) continue;
      ++drawn;
      const v = events.vectors.subarray(9 * e, 9 * e + 9);
      const known = v[0] !== 0 || v[1] !== 0 || v[2] !== 0 || v[3] !== 0 || v[4] !== 0 || v[5] !== 0;
      const fade = 1 - (t - events.time[e]) / 0.5;
      if (known) {
        this.p.set(v[0], v[1], v[2]);
      } else { // a law without contact points: at the first body that moves
        const i = this.run.bodies[events.pair[2 * e]].moves === "free" ? events.pair[2 * e] : events.pair[2 * e + 1];
        const state = this.motions.at(i, events.time[e], newState());
        this.p.set(state.px, state.py, state.pz);
      }
      this.p.sub(origin);
      const impulse = Math.hypot(v[6], v[7], v[8]);
      const arrow = (x: number, y: number, z: number, length: number, colour: Color) => {
        const norm = Math.hypot(x, y, z);
        if (!(norm > 0) || !(length > 0)) return;
        const head = 0.022 * this.radius;
        const d = new Vector3(x, y, z).divideScalar(norm);
        const tip = this.p.clone().addScaledVector(d, length);
        this.shafts.add(this.p.x, this.p.y, this.p.z, tip.x, tip.y, tip.z, colour, this.colours.background, fade);
        this.q.setFromUnitVectors(new Vector3(0, 1, 0), d);
        this.heads.setMatrixAt(heads, this.matrix.compose(tip, this.q, this.s.setScalar(head)));
        this.heads.setColorAt(heads++, new Color().copy(this.colours.background).lerp(colour, fade));
      };
      arrow(v[3], v[4], v[5], 0.2 * this.radius, this.colours.normal);
      if (this.largestImpulse > 0) {
        const length = this.radius * (0.1 + 0.35 * (impulse / this.largestImpulse));
        if (impulse > 0) arrow(v[6], v[7], v[8], length, this.colours.impulse);
      }
    }
    this.heads.count = heads;
    this.heads.instanceMatrix.needsUpdate = true;
    if (this.heads.instanceColor) this.heads.instanceColor.needsUpdate = true;
    this.shafts.commit();
  }

  /** The nearest body on a ray; else the nearest of those that move and are nearly on it; -1: none. */
  pick(from: Vector3, direction: Vector3, origin: Vector3, fixed: boolean): number {
    let best = -1;
    let nearest = Infinity;
    const candidates = fixed ? this.run.bodies.map((_, i) => i) : this.movers;
    for (const i of candidates) {
      const along = this.meets(i, from, direction, origin);
      if (along < nearest) { nearest = along; best = i; }
    }
    if (best >= 0) return best;
    for (const i of this.movers) {
      const at = this.states[i];
      this.p.set(at.px, at.py, at.pz).sub(origin).sub(from);
      const along = this.p.dot(direction);
      const miss = Math.sqrt(Math.max(0, this.p.lengthSq() - along * along));
      if (along > 0 && along < nearest && miss < Math.max(boundingRadius(this.run.bodies[i].shape), 0.012 * along)) {
        nearest = along;
        best = i;
      }
    }
    return best;
  }

  /** How far along a ray it meets the body; infinite: not, or a half-space. */
  private meets(i: number, from: Vector3, direction: Vector3, origin: Vector3): number {
    const { shape } = this.run.bodies[i];
    const at = this.states[i];
    if (shape.kind === "half-space") return Infinity;
    this.p.set(at.px, at.py, at.pz).sub(origin).sub(from);
    if (shape.kind === "sphere") {
      const along = this.p.dot(direction);
      const inside = shape.x * shape.x - (this.p.lengthSq() - along * along);
      return inside >= 0 && along > 0 ? along - Math.sqrt(inside) : Infinity;
    }
    // A box: the ray in its frame, between its three pairs of faces.
    this.q.set(at.qx, at.qy, at.qz, at.qw).invert();
    const p = this.p.applyQuaternion(this.q);
    const d = this.s.copy(direction).applyQuaternion(this.q);
    let enter = -Infinity, leave = Infinity;
    for (const [x, v, h] of [[p.x, d.x, shape.x], [p.y, d.y, shape.y], [p.z, d.z, shape.z]]) {
      const [one, other] = [(x - h) / v, (x + h) / v];
      enter = Math.max(enter, Math.min(one, other));
      leave = Math.min(leave, Math.max(one, other));
    }
    return leave > Math.max(enter, 0) ? Math.max(enter, 0) : Infinity;
  }

  /** The frame that was drawn last at t. */
  frameAt(t: number): number {
    return Math.max(0, before(this.run.frames, t + 1e-9 * (1 + Math.abs(t))));
  }
}
