// generated_meshes: triangle meshes of surfaces with a closed form, to measure what contact with them
// is worth (`pincer bench contact`, tests).
//
// SI units, frame B, around its origin unless said otherwise; triangles counter-clockwise seen from outside; vertices
// exactly on the surface to round-off; without file normals. All are closed and manifold.
#pragma once
#include <cstdint>

#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

// 20 * 4^level triangles of nearly equal size.
TriangleMesh icosphere(double radius, int level);

// The same surface with 20 n^2 triangles, each side of an icosahedron cut into n >= 1 parts.
TriangleMesh geodesicSphere(double radius, int n);

// Along parallels and meridians: `rings` >= 2 bands, the first and last of them fans around the poles (0, 0, +-radius),
// `segments` >= 3. Needles at the poles, vertices there of as many triangles as there are segments.
TriangleMesh uvSphere(double radius, int rings, int segments);

// Half axes `half` [m]: (x/a)^2 + (y/b)^2 + (z/c)^2 = 1. Triangles as geodesicSphere's.
TriangleMesh ellipsoid(const Vec3& half, int n);

// |x| = radius (1 + amplitude f(x / |x|)),  f(d) = sin(waves d_x) sin(waves d_y + 1) sin(waves d_z + 2):
// hills and hollows without a symmetry.
//   amplitude  [-], 0 <= amplitude < 1
// Triangles as geodesicSphere's.
TriangleMesh bumpySphere(double radius, double amplitude, double waves, int n);

// About the z axis, centre at the origin, `segments` on the round part and `rows` along z; the part beyond x =
// flat_distance is cut off (the flat's normal is +x). Edges of caps and flat are sharp.
TriangleMesh cylinderWithFlat(double radius, double half_length, double flat_distance, int segments, int rows);
TriangleMesh cylinder(double radius, double half_length, int segments, int rows);

// About the z axis, tube radius `minor` around a circle of radius `major`.
TriangleMesh torus(double major, double minor, int major_segments, int minor_segments);

// A cube of half edge length `half`, edges and corners rounded to `rounding` < half with `segments` per quarter turn.
TriangleMesh roundedCube(double half, double rounding, int segments);

// Edges sharp. 12 triangles, or each face a grid of `cells` x `cells` quads.
TriangleMesh box(const Vec3& half);
TriangleMesh gridBox(const Vec3& half, int cells);

// A block with a V-shaped groove along y in its top: half the opening's angle `half_angle` [rad], from the vertical;
// the groove's bottom is the y axis, z = 0, its edges at z = depth. The block ends at x = +-half_width, y =
// +-half_length, z = -depth. All edges sharp.
TriangleMesh grooveBlock(double half_angle, double depth, double half_width, double half_length);

// Every vertex moved by a pseudo-random vector uniform in the cube of half edge
// `amplitude` [m]: what a scanner's noise does.
TriangleMesh noisy(TriangleMesh mesh, double amplitude, std::uint64_t seed);

// Coordinates times `factor`, then a rigid displacement; normals turn with it.
TriangleMesh transformed(TriangleMesh mesh, const Pose& X, double factor = 1);

}  // namespace pincer::contact
