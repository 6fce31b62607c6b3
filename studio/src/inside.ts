// The part of one body that is inside another, hatched and seen through everything.
import {
  BoxGeometry, Color, Group, Mesh, PlaneGeometry, Quaternion, ShaderMaterial, SphereGeometry, Vector3, Vector4,
  DoubleSide,
} from "three";
import type { Shape } from "./data";
import { boundingRadius, normalOf } from "./gap";
import type { State } from "./motion";

const vertex = `
varying vec3 world;
void main() {
  vec4 p = modelMatrix * vec4(position, 1.0);
  world = p.xyz;
  gl_Position = projectionMatrix * viewMatrix * p;
}`;

/** kind 0: sphere, 1: box, 2: half-space. Stripes tell it from a colour alone. */
const fragment = `
uniform int kind;
uniform vec3 centre;
uniform vec3 extent;
uniform vec4 turn;
uniform vec3 colour;
varying vec3 world;
void main() {
  vec3 p = world - centre;
  p += 2.0 * cross(-turn.xyz, cross(-turn.xyz, p) + turn.w * p);
  bool inside = kind == 0 ? length(p) <= extent.x * 1.0001
              : kind == 1 ? all(lessThanEqual(abs(p), extent * 1.0001 + 1e-6))
              : dot(p, extent) <= 1e-6;
  if (!inside) discard;
  float stripe = step(0.5, fract((gl_FragCoord.x + gl_FragCoord.y) / 9.0));
  gl_FragColor = vec4(mix(colour, vec3(1.0), 0.55 * stripe), 0.92);
}`;

const kinds = { sphere: 0, box: 1, "half-space": 2 };
const sphere = new SphereGeometry(1, 48, 32);
const box = new BoxGeometry(2, 2, 2);
const plane = new PlaneGeometry(2, 2);
const up = new Vector3(0, 0, 1);

/** Of one pair: the surface of each inside the other. */
export class Insides {
  readonly object = new Group();
  private readonly meshes: Mesh<SphereGeometry | BoxGeometry | PlaneGeometry, ShaderMaterial>[] = [];
  private used = 0;
  private readonly normal = new Float64Array(3);

  constructor(private readonly most: number) {}

  clear(): void {
    this.used = 0;
  }

  add(a: Shape, sa: State, b: Shape, sb: State, origin: Vector3, colour: Color): void {
    if (this.used + 2 > 2 * this.most) return;
    this.place(a, sa, b, sb, origin, colour);
    this.place(b, sb, a, sa, origin, colour);
  }

  commit(): void {
    this.meshes.forEach((mesh, i) => { mesh.visible = i < this.used; });
  }

  private place(shape: Shape, at: State, other: Shape, where: State, origin: Vector3, colour: Color): void {
    const mesh = this.next();
    mesh.quaternion.set(at.qx, at.qy, at.qz, at.qw);
    mesh.position.set(at.px, at.py, at.pz).sub(origin);
    if (shape.kind === "half-space") {
      const n = normalOf(shape, at, this.normal);
      const height = n[0] * (where.px - at.px) + n[1] * (where.py - at.py) + n[2] * (where.pz - at.pz);
      mesh.geometry = plane;
      mesh.scale.setScalar(1.05 * boundingRadius(other));
      mesh.position.set(where.px - height * n[0], where.py - height * n[1], where.pz - height * n[2]).sub(origin);
      mesh.quaternion.setFromUnitVectors(up, new Vector3(n[0], n[1], n[2]));
    } else {
      mesh.geometry = shape.kind === "sphere" ? sphere : box;
      mesh.scale.set(shape.x, shape.y, shape.z);
    }
    const u = mesh.material.uniforms;
    u.kind.value = kinds[other.kind];
    (u.centre.value as Vector3).set(where.px, where.py, where.pz).sub(origin);
    (u.extent.value as Vector3).set(other.x, other.y, other.z);
    (u.turn.value as Vector4).set(where.qx, where.qy, where.qz, where.qw);
    (u.colour.value as Color).copy(colour);
  }

  private next(): Mesh<SphereGeometry | BoxGeometry | PlaneGeometry, ShaderMaterial> {
    let mesh = this.meshes[this.used];
    if (!mesh) {
      const material = new ShaderMaterial({
        vertexShader: vertex, fragmentShader: fragment, transparent: true, depthTest: false, depthWrite: false,
        side: DoubleSide,
        uniforms: {
          kind: { value: 0 }, centre: { value: new Vector3() }, extent: { value: new Vector3() },
          turn: { value: new Vector4(0, 0, 0, 1) }, colour: { value: new Color() },
        },
      });
      mesh = new Mesh<SphereGeometry | BoxGeometry | PlaneGeometry, ShaderMaterial>(sphere, material);
      mesh.renderOrder = 10;
      mesh.frustumCulled = false;
      mesh.quaternion.copy(new Quaternion());
      this.meshes.push(mesh);
      this.object.add(mesh);
    }
    ++this.used;
    return mesh;
  }
}
