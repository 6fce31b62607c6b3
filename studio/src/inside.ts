// The part of one body that is inside another, hatched and seen through everything.
import {
  type BufferGeometry, Color, Group, Mesh, PlaneGeometry, Quaternion, ShaderMaterial, Vector3, Vector4, DoubleSide,
} from "three";
import type { Shape } from "./data";
import { boundingRadius, normalOf } from "./gap";
import type { State } from "./motion";
import { solidGeometry, solidKey, stretch } from "./solids";

const vertex = `
varying vec3 world;
void main() {
  vec4 p = modelMatrix * vec4(position, 1.0);
  world = p.xyz;
  gl_Position = projectionMatrix * viewMatrix * p;
}`;

/** kind 0: sphere, 1: box, 2: half-space, 3: capsule, 4: cylinder, 5: cone (extent: radius, length), 6: hull (its
 *  planes). Stripes tell it from a colour alone. */
const fragment = `
uniform int kind;
uniform vec3 centre;
uniform vec3 extent;
uniform vec4 turn;
uniform vec3 colour;
uniform vec4 planes[PLANES];
uniform int sides;
varying vec3 world;
void main() {
  vec3 p = world - centre;
  p += 2.0 * cross(-turn.xyz, cross(-turn.xyz, p) + turn.w * p);
  bool inside = kind == 0 ? length(p) <= extent.x * 1.0001
              : kind == 1 ? all(lessThanEqual(abs(p), extent * 1.0001 + 1e-6))
              : kind == 2 ? dot(p, extent) <= 1e-6
              : kind == 3 ? length(vec3(p.x, p.y - clamp(p.y, -0.5 * extent.y, 0.5 * extent.y), p.z)) <= extent.x * 1.0001
              : kind == 4 ? length(p.xz) <= extent.x * 1.0001 && abs(p.y) <= 0.50005 * extent.y
              : kind == 5 ? p.y >= -0.25001 * extent.y && length(p.xz) <= extent.x * (0.7501 - p.y / extent.y)
              : sides > 0;
  if (kind == 6) for (int k = 0; k < PLANES; ++k) if (k < sides && dot(planes[k].xyz, p) > planes[k].w * 1.0001 + 1e-6) inside = false;
  if (!inside) discard;
  float stripe = step(0.5, fract((gl_FragCoord.x + gl_FragCoord.y) / 9.0));
  gl_FragColor = vec4(mix(colour, vec3(1.0), 0.55 * stripe), 0.92);
}`;

const kinds: Record<string, number> = { sphere: 0, box: 1, "half-space": 2, capsule: 3, cylinder: 4, cone: 5, hull: 6 };
/** Whether the shader knows the inside of a shape. */
const told = (shape: Shape) => shape.kind in kinds;
/** Of a hull, faces that a shader is told; one of more is not hatched. */
const mostPlanes = 48;
const noPlanes = Array.from({ length: mostPlanes }, () => new Vector4());
const plane = new PlaneGeometry(2, 2);
const up = new Vector3(0, 0, 1);

const solids = new Map<string, BufferGeometry>();
function solid(shape: Shape): BufferGeometry {
  const key = solidKey(shape);
  const known = solids.get(key);
  if (known) return known;
  const made = solidGeometry(shape, 1);
  solids.set(key, made);
  return made;
}

/** Outward normals of a hull's faces, and how far out they are. */
const planesOf = new WeakMap<number[], Vector4[]>();
function planes(shape: Shape): Vector4[] {
  const known = planesOf.get(shape.points!);
  if (known) return known;
  const position = solid({ ...shape, rounding: 0 }).getAttribute("position");
  const found: Vector4[] = [];
  const [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];
  for (let k = 0; k + 2 < position.count; k += 3) {
    [a, b, c].forEach((corner, i) => corner.fromBufferAttribute(position, k + i));
    const n = b.sub(a).cross(c.sub(a)).normalize();
    const plane = new Vector4(n.x, n.y, n.z, n.dot(a) + shape.rounding!);
    if (!found.some((each) => each.clone().sub(plane).lengthSq() < 1e-10)) found.push(plane);
  }
  planesOf.set(shape.points!, found);
  return found;
}

/** Of one pair: the surface of each inside the other. */
export class Insides {
  readonly object = new Group();
  private readonly meshes: Mesh<BufferGeometry, ShaderMaterial>[] = [];
  private used = 0;
  private readonly normal = new Float64Array(3);

  constructor(private readonly most: number) {}

  clear(): void {
    this.used = 0;
  }

  add(a: Shape, sa: State, b: Shape, sb: State, origin: Vector3, colour: Color): void {
    if (this.used + 2 > 2 * this.most || !told(a) || !told(b)) return;
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
      mesh.geometry = solid(shape);
      stretch(shape, mesh.scale);
    }
    const u = mesh.material.uniforms;
    u.kind.value = kinds[other.kind];
    (u.centre.value as Vector3).set(where.px, where.py, where.pz).sub(origin);
    if (other.radius !== undefined) (u.extent.value as Vector3).set(other.radius, other.length!, 0);
    else (u.extent.value as Vector3).set(other.x, other.y, other.z);
    const faces = other.kind === "hull" ? planes(other) : noPlanes;
    u.sides.value = faces.length <= mostPlanes && other.kind === "hull" ? faces.length : 0;
    u.planes.value = noPlanes.map((none, k) => faces[k] ?? none);
    (u.turn.value as Vector4).set(where.qx, where.qy, where.qz, where.qw);
    (u.colour.value as Color).copy(colour);
  }

  private next(): Mesh<BufferGeometry, ShaderMaterial> {
    let mesh = this.meshes[this.used];
    if (!mesh) {
      const material = new ShaderMaterial({
        vertexShader: vertex, fragmentShader: fragment, transparent: true, depthTest: false, depthWrite: false,
        side: DoubleSide,
        defines: { PLANES: mostPlanes },
        uniforms: {
          planes: { value: noPlanes }, sides: { value: 0 },
          kind: { value: 0 }, centre: { value: new Vector3() }, extent: { value: new Vector3() },
          turn: { value: new Vector4(0, 0, 0, 1) }, colour: { value: new Color() },
        },
      });
      mesh = new Mesh<BufferGeometry, ShaderMaterial>(plane, material);
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
