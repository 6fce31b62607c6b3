// The table, the player's bat and the machine's hand: places and sizes, m, y up, the player at +z.
// A table's size and height are those of the game; the bat is that of the shipped scene.
import { Quaternion, Vector3 } from "three";

export const table = { half: [0.7625, 0.0125, 1.37], top: 0.76 } as const;
export const net = { height: 0.1525, half: [0.7625, 0.07625, 0.003] } as const;
export const ball = { radius: 0.02, mass: 0.0027 } as const;
export const bat = { half: [0.075, 0.08, 0.0075], mass: 0.18 } as const;
export const gravity = 9.8;

/** Where the hand keeps the ball: the player's own before a serve, the machine's before a return. */
export const places = {
  serve: new Vector3(0, 0.95, 1.62),
  return: new Vector3(0, 1.0, -1.55),
} as const;
export type Kind = keyof typeof places;

/** Beyond it, and above the floor, the machine takes the ball. */
export const machineTakes = -1.75;

/** How far in front of the player the bat is, and how far it may go; it never reaches over the table. */
export const reach = { near: 2.3, far: 1.46, low: 0.35, high: 1.9, side: 1.1 } as const;

/** Up on the screen is up and forward in the world: a flick is a swing. rad from the vertical. */
export const swingTilt = 0.95;
export const swingDirection = new Vector3(0, Math.cos(swingTilt), -Math.sin(swingTilt));

/** The face of a bat at x looks to the far half of the table, and up by `lift` (rad). */
export function faceAt(x: number, lift: number): Quaternion {
  const yaw = new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), 0.55 * Math.atan2(x, 2.2));
  return yaw.multiply(new Quaternion().setFromAxisAngle(new Vector3(1, 0, 0), lift));
}

/** Whether a ball that was let go of is on its last way to the bat: a thrown one when it has met the table, one
 *  that was tossed up when it falls. */
export function comes(kind: Kind, ball: { pz: number; vz: number; vy: number }): boolean {
  return kind === "serve" ? ball.vy < 0 : ball.vz > 0 && ball.pz > 1.25 && ball.vy > 0;
}

export function withinReach(p: Vector3): Vector3 {
  p.x = Math.min(reach.side, Math.max(-reach.side, p.x));
  p.y = Math.min(reach.high, Math.max(reach.low, p.y));
  p.z = Math.min(reach.near, Math.max(reach.far, p.z));
  return p;
}

/** The velocity with which a ball that a hand moves from `from` for `swing` s, and then lets go of, meets the
 *  table at `to`, `flight` s later. */
export function throwTo(from: Vector3, to: { x: number; z: number }, swing: number, flight: number): Vector3 {
  const falls = 0.5 * gravity * flight ** 2;
  return new Vector3(to.x - from.x, table.top + ball.radius - from.y + falls, to.z - from.z).divideScalar(swing + flight);
}
