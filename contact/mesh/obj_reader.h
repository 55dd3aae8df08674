// obj_reader: a strict reader of Wavefront OBJ (v, vn, vt, f, g, o, s, usemtl, mtllib; polygons are triangulated).
//
// Bounded in time and memory by the file's size. Nothing is repaired silently: every defect throws InputError naming file, line, value and remedy.
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
