// Lines wider than a pixel, in a buffer that is filled again and again.
import { Color } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

export class FatLines {
  readonly object: LineSegments2;
  private readonly geometry = new LineSegmentsGeometry();
  private readonly positions: Float32Array;
  private readonly colours: Float32Array;
  private count = 0;
  private readonly colour = new Color();

  constructor(private readonly capacity: number, width: number, onTop = false) {
    this.positions = new Float32Array(6 * capacity);
    this.colours = new Float32Array(6 * capacity);
    this.geometry.setPositions(this.positions);
    this.geometry.setColors(this.colours);
    this.geometry.instanceCount = 0;
    const material = new LineMaterial({ linewidth: width, vertexColors: true, depthTest: !onTop });
    this.object = new LineSegments2(this.geometry, material);
    this.object.frustumCulled = false;
    if (onTop) this.object.renderOrder = 20;
  }

  clear(): void {
    this.count = 0;
  }

  /** A segment; `share` of the colour, the rest is the background. */
  add(ax: number, ay: number, az: number, bx: number, by: number, bz: number,
      colour: Color, background: Color, share = 1, shareEnd = share): void {
    if (this.count >= this.capacity) return;
    const k = 6 * this.count++;
    this.positions.set([ax, ay, az, bx, by, bz], k);
    this.colour.copy(background).lerp(colour, share).toArray(this.colours, k);
    this.colour.copy(background).lerp(colour, shareEnd).toArray(this.colours, k + 3);
  }

  commit(): void {
    for (const [name, values] of [
      ["instanceStart", this.positions],
      ["instanceColorStart", this.colours],
    ] as const) {
      const attribute = this.geometry.getAttribute(name) as unknown as {
        data: { array: Float32Array; needsUpdate: boolean };
      };
      attribute.data.array.set(values.subarray(0, 6 * this.count));
      attribute.data.needsUpdate = true;
    }
    this.geometry.instanceCount = this.count;
    this.object.visible = this.count > 0;
  }
}
