// Joints: where they are, and what they leave free.
import { Color, DynamicDrawUsage, InstancedMesh, Matrix4, MeshBasicMaterial, Quaternion, SphereGeometry, Vector3 } from "three";
import type { Joint, JointSide } from "./data";
import { FatLines } from "./fat";
import type { State } from "./motion";

const nowhere = new Quaternion();

/** A point at either side of a joint; a rod between them; the axis of a hinge or slider, long of the one that slides. */
export class Joints {
  readonly lines: FatLines;
  readonly points: InstancedMesh;
  private readonly matrix = new Matrix4();
  private readonly scale = new Vector3();

  constructor(private readonly joints: Joint[], private readonly size: number, private readonly colour: Color) {
    this.lines = new FatLines(Math.max(1, joints.length), 4, true);
    this.points = new InstancedMesh(new SphereGeometry(1, 16, 12), new MeshBasicMaterial({ color: colour, depthTest: false }), Math.max(1, 2 * joints.length));
    this.points.instanceMatrix.setUsage(DynamicDrawUsage);
    this.points.renderOrder = 15;
    this.points.frustumCulled = false;
    this.points.count = 2 * joints.length;
  }

  show(states: State[], origin: Vector3, background: Color): void {
    this.lines.clear();
    this.joints.forEach((joint, k) => {
      const [a, b] = [joint.a, joint.b].map((side) => this.place(side, states, origin));
      const radius = (joint.kind === "weld" ? 0.012 : 0.008) * this.size;
      [a.p, b.p].forEach((p, i) => this.points.setMatrixAt(2 * k + i, this.matrix.compose(p, nowhere, this.scale.setScalar(radius))));
      if (joint.kind === "rod") this.line(a.p, b.p, background);
      if (joint.kind === "hinge" || joint.kind === "slider") {
        const reach = (joint.kind === "slider" ? 0.3 : 0.05) * this.size;
        this.line(a.p.clone().addScaledVector(a.axis, -reach), a.p.clone().addScaledVector(a.axis, reach), background);
      }
    });
    this.points.instanceMatrix.needsUpdate = true;
    this.lines.commit();
  }

  private line(a: Vector3, b: Vector3, background: Color): void {
    this.lines.add(a.x, a.y, a.z, b.x, b.y, b.z, this.colour, background, 0.85);
  }

  private place(side: JointSide, states: State[], origin: Vector3): { p: Vector3; axis: Vector3 } {
    const p = new Vector3(side.point.x, side.point.y, side.point.z);
    const axis = new Vector3(side.axis.x, side.axis.y, side.axis.z);
    if (side.body >= 0) {
      const at = states[side.body];
      const q = new Quaternion(at.qx, at.qy, at.qz, at.qw);
      p.applyQuaternion(q).add(new Vector3(at.px, at.py, at.pz));
      axis.applyQuaternion(q);
    }
    return { p: p.sub(origin), axis };
  }
}
