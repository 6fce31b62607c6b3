// A player for tests: where the bat has to be in the next frame to meet a ball at a given speed.
const g = 9.8;
const frame = 1 / 60;

/** `ball`: position and velocity; `middle` and `along`: a point of the bat's plane, and its direction up;
 *  `speed` of the stroke, m/s; `lag`: frames until the bat is there. Returns x and the distance along that
 *  direction, m; null where the ball does not come. */
export function aim(ball, middle, along, speed, lag = 1, low = -0.35) {
  const [c, s] = [along[1], -along[2]];
  const at = (t) => ball.p.map((x, k) => x + ball.v[k] * t - (k === 1 ? 0.5 * g * t * t : 0));
  // Distance to the plane, which holds x and `along`.
  const off = (p) => (p[1] - middle[1]) * s + (p[2] - middle[2]) * c;
  let t = 0;
  while (t < 1.5 && off(at(t)) < 0) t += 1 / 2000;
  if (t === 0 || t >= 1.5) return null;
  const p = at(t);
  const meets = (p[1] - middle[1]) * along[1] + (p[2] - middle[2]) * along[2];
  const early = t - lag * frame;
  return { x: p[0], along: Math.max(low, meets - speed * Math.max(early, -0.1)), t };
}
