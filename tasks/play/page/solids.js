// Balls and a dish as the stage wants its meshes: places, normals, indices.
import { LatheGeometry, PlaneGeometry, SphereGeometry, Vector2 } from "three";

function meshOf(geometry) {
  return {
    places: new Float32Array(geometry.getAttribute("position").array),
    normals: new Float32Array(geometry.getAttribute("normal").array),
    indices: new Uint32Array(geometry.index.array),
  };
}

// Frame at its centre.
export const ball = (radius) => meshOf(new SphereGeometry(radius, 48, 32));

// The inside of a ball of `radius` whose lowest point is the frame's origin, up to where it is `half` wide; z up.
export function dish(radius, half) {
  const points = Array.from({ length: 41 }, (_, i) => {
    const angle = (i / 40) * Math.asin(half / radius);
    return new Vector2(Math.max(radius * Math.sin(angle), 1e-6), radius * (1 - Math.cos(angle)));
  });
  const geometry = new LatheGeometry(points, 96);
  geometry.rotateX(Math.PI / 2);
  return meshOf(geometry);
}

export const floor = (half) => meshOf(new PlaneGeometry(2 * half, 2 * half));
