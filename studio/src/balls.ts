// Balls without triangles: each is two of them, and what is seen of the ball there is found for every pixel.
import { Color, HemisphereLight, InstancedMesh, PlaneGeometry, ShaderMaterial, Vector3 } from "three";

const vertex = `
flat varying vec3 centre;
flat varying float radius;
flat varying mat3 toBody;
varying vec3 seen;
varying vec3 tone;
void main() {
  mat4 place = modelMatrix * instanceMatrix;
  radius = length(place[0].xyz);
  centre = (viewMatrix * place[3]).xyz;
  toBody = transpose(mat3(place)) * transpose(mat3(viewMatrix)) / radius;
  tone = instanceColor;
  // The square around the circle in which a ray from the eye touches the ball.
  float far2 = dot(centre, centre);
  float rim = 1.0 - radius * radius / far2;
  vec3 away = centre * inversesqrt(far2);
  vec3 side = normalize(cross(abs(away.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), away));
  seen = centre * rim + radius * sqrt(max(rim, 0.0)) * 1.05 * (position.x * side + position.y * cross(side, away));
  gl_Position = rim > 0.0 ? projectionMatrix * vec4(seen, 1.0) : vec4(0.0, 0.0, 2.0, 1.0); // the eye is inside
}`;

const fragment = `
uniform mat4 projectionMatrix;
uniform vec3 sky, ground, ambient, sun, sunColour;
flat varying vec3 centre;
flat varying float radius;
flat varying mat3 toBody;
varying vec3 seen;
varying vec3 tone;
void main() {
  vec3 ray = normalize(seen);
  float along = dot(ray, centre);
  vec3 miss = centre - along * ray;
  float inside = radius * radius - dot(miss, miss);
  float cover = clamp(inside / max(fwidth(inside), 1e-30) + 0.5, 0.0, 1.0);
  if (cover <= 0.0) discard;
  vec3 at = (along - sqrt(max(inside, 0.0))) * ray;
  vec3 normal = normalize(at - centre);
  vec3 body = toBody * normal;
  float dark = body.x * body.y * body.z > 0.0 ? 0.72 : 1.0; // octants, so that turning is seen
  vec3 up = (viewMatrix * vec4(0.0, 1.0, 0.0, 0.0)).xyz;
  vec3 light = ambient + mix(ground, sky, 0.5 + 0.5 * dot(normal, up))
    + sunColour * max(dot(normal, (viewMatrix * vec4(sun, 0.0)).xyz), 0.0);
  gl_FragColor = vec4(tone * dark * light * 0.3183098861837907, cover);
  vec4 clip = projectionMatrix * vec4(at, 1.0);
  gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;
  #include <colorspace_fragment>
}`;

/** How what is opaque is lit. */
export interface Lights { hemisphere: HemisphereLight; ambient: Color; sun: Vector3; sunColour: Color }

/** `count` balls of radius 1, to be placed by their matrices and coloured one by one. */
export function balls(count: number, { hemisphere, ambient, sun, sunColour }: Lights): InstancedMesh {
  const material = new ShaderMaterial({
    vertexShader: vertex, fragmentShader: fragment, alphaToCoverage: true,
    uniforms: {
      sky: { value: hemisphere.color.clone().multiplyScalar(hemisphere.intensity) },
      ground: { value: hemisphere.groundColor.clone().multiplyScalar(hemisphere.intensity) },
      ambient: { value: ambient }, sun: { value: sun.clone().normalize() }, sunColour: { value: sunColour },
    },
  });
  return new InstancedMesh(new PlaneGeometry(2, 2), material, count);
}
