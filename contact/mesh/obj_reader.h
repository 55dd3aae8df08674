// obj_reader: a strict reader of Wavefront OBJ.
//
// Read: v (with an optional weight of 1 or a colour), vn, vt, f with corners v, v/vt, v//vn, v/vt/vn, indices from 1 or, negative, back from
// the last; polygons are triangulated (polygon.h). Accepted without effect: g, o, s, usemtl, mtllib (names and looks), l and p (lines and
// points have no surface). Refused by name: free-form curves and surfaces, and every keyword that isn't OBJ's.
//
// Bounded in time and memory by the file's size. Nothing is repaired silently: every defect throws InputError naming file, line, value and remedy.
// Vertices and faces keep the file's order; vertices that no face uses stay in the mesh (mesh_report counts them).
#pragma once
#include <istream>
#include <string>

#include "contact/error.h"
#include "contact/mesh/triangle_mesh.h"

namespace pincer::contact {

// Metres per unit of a length unit's name: "m", "cm", "mm", "in". Throws InputError on any other, listing these.
double metresPerUnit(const std::string& unit);

// Reads the file at `path`, scaling coordinates by `scale` [m per file unit], > 0. Throws InputError.
TriangleMesh readObj(const std::string& path, double scale);
// The same from a stream; `name` stands for the file in messages.
TriangleMesh readObj(std::istream& in, const std::string& name, double scale);

}  // namespace pincer::contact
