// The surfaces of shapes as triangles, in two tones, so that one sees them turn.
import { BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, ConeGeometry, CylinderGeometry, IcosahedronGeometry, SphereGeometry, Matrix4, Quaternion, Vector3 } from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import { ConvexGeometry } from "three/addons/geometries/ConvexGeometry.js";
import type { Part, Shape } from "./data";

/** Pieces of a turn: of many each is small, and coarser. */
const around = (many: number) => (many <= 40 ? 32 : many <= 400 ? 20 : 12);

/** Darker where `dark` says; vertices of one triangle may differ. */
function toned(geometry: BufferGeometry, dark: (x: number, y: number, z: number) => boolean): BufferGeometry {
  const position = geometry.getAttribute("position");
  const tones = new Float32Array(3 * position.count);
  for (let i = 0; i < position.count; ++i) {
    tones.fill(dark(position.getX(i), position.getY(i), position.getZ(i)) ? 0.72 : 1, 3 * i, 3 * i + 3);
  }
  geometry.setAttribute("color", new BufferAttribute(tones, 3));
  return geometry;
}

const octants = (x: number, y: number, z: number) => x * y * z > 1e-6;
const quarters = (x: number, _y: number, z: number) => x * z > 1e-9;

/** All points within `rounding` of the hull of some points: each of them as a small ball. */
export function hullGeometry(shape: Shape): BufferGeometry {
  const { points = [], rounding = 0 } = shape;
  const corners: Vector3[] = [];
  const ball = new IcosahedronGeometry(1, 2).getAttribute("position");
  for (let k = 0; k < points.length; k += 3) {
    const corner = new Vector3(points[k], points[k + 1], points[k + 2]);
    if (!(rounding > 0)) corners.push(corner);
    else for (let i = 0; i < ball.count; ++i) corners.push(new Vector3().fromBufferAttribute(ball, i).multiplyScalar(rounding).add(corner));
  }
  const geometry = new ConvexGeometry(corners);
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(3 * geometry.getAttribute("position").count).fill(1), 3));
  return geometry;
}

const plain = (geometry: BufferGeometry): BufferGeometry => {
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(3 * geometry.getAttribute("position").count).fill(1), 3));
  return geometry;
};

/** The triangles of a mesh as they are. */
function meshGeometry({ points = [], triangles = [] }: Shape): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(triangles.flatMap((k) => points.slice(3 * k, 3 * k + 3))), 3));
  geometry.computeVertexNormals();
  return plain(geometry);
}

/** The parts of a compound where they are. */
function compoundGeometry(parts: Part[]): BufferGeometry {
  const one = new Vector3(1, 1, 1);
  return mergeGeometries(parts.map(({ shape, place, turn }) => {
    const made = solidGeometry(shape, 1);
    const geometry = (made.index ? made.toNonIndexed() : made).scale(...stretch(shape, new Vector3()).toArray());
    geometry.applyMatrix4(new Matrix4().compose(new Vector3(place.x, place.y, place.z), new Quaternion(turn.x, turn.y, turn.z, turn.w), one));
    geometry.deleteAttribute("uv");
    return geometry.hasAttribute("color") ? geometry : plain(geometry);
  }));
}

/** What has the same key is drawn with the same triangles, `stretch` times as large along each axis. */
export function solidKey(shape: Shape): string {
  if (shape.kind === "capsule") return `capsule ${(shape.length! / shape.radius!).toPrecision(6)}`;
  if (shape.kind === "hull") return `hull ${shape.rounding} ${shape.points!.join(" ")}`;
  if (shape.kind === "mesh" || shape.kind === "compound") return `${shape.kind} ${JSON.stringify(shape)}`;
  return shape.kind;
}

/** Triangles of a body that is one of `many` like it. */
export function solidGeometry(shape: Shape, many: number): BufferGeometry {
  const n = around(many);
  switch (shape.kind) {
    case "sphere": return toned(new SphereGeometry(1, n, (3 * n) / 4), octants);
    case "capsule": return toned(new CapsuleGeometry(1, shape.length! / shape.radius!, n / 4, n), quarters);
    case "cylinder": return toned(new CylinderGeometry(1, 1, 2, n), quarters);
    case "cone": return toned(new ConeGeometry(1, 1, n).translate(0, 0.25, 0), quarters);
    case "hull": return hullGeometry(shape);
    case "mesh": return meshGeometry(shape);
    case "compound": return compoundGeometry(shape.parts!);
    default: return new BoxGeometry(2, 2, 2);
  }
}

export function stretch(shape: Shape, out: Vector3): Vector3 {
  const { radius = 1, length = 1 } = shape;
  switch (shape.kind) {
    case "capsule": return out.setScalar(radius);
    case "cylinder": return out.set(radius, length / 2, radius);
    case "cone": return out.set(radius, length, radius);
    case "hull": case "mesh": case "compound": return out.setScalar(1);
    default: return out.set(shape.x, shape.y, shape.z);
  }
}
