// mesh_generators: closed triangle meshes of known solids, and their OBJ text. SI units; triangles counter-clockwise seen from outside.
#pragma once
#include <ostream>

#include "contact/mesh/triangle_mesh.h"

namespace pincer::contact {

// 20 * 4^level triangles, vertices on the sphere about the origin. Without file normals.
TriangleMesh icosphere(double radius, int level);

// About the z axis, centre at the origin, `segments` on the round part and `rows` along z; the part beyond x = flat_distance is cut off
// (the flat's normal is +x). Edges of caps and flat are sharp. Without file normals.
TriangleMesh cylinderWithFlat(double radius, double half_length, double flat_distance, int segments, int rows);
TriangleMesh cylinder(double radius, double half_length, int segments, int rows);

// About the z axis, tube radius `minor` around a circle of radius `major`.
TriangleMesh torus(double major, double minor, int major_segments, int minor_segments);

// A cube of half edge length `half`, edges and corners rounded to `rounding` < half with `segments` per quarter turn.
TriangleMesh roundedCube(double half, double rounding, int segments);

// 12 triangles, edges sharp.
TriangleMesh box(const Vec3& half);

// Writes vertices, normals (if any) and faces with 17 digits, so that a reader gets back the same bits. `unit` [m]: 0.001 for millimetres.
void writeObj(std::ostream& out, const TriangleMesh& mesh, double unit = 1);

}  // namespace pincer::contact
