// obj_reader: Wavefront OBJ.
//
// Read: v (with an optional weight of 1 or a colour), vn, vt, s, f with corners v, v/vt, v//vn, v/vt/vn, indices from 1
// or, negative, back from the last; o and g where named parts are asked for (mesh_groups.h). Accepted without effect:
// usemtl, mtllib (looks), l and p (lines and points have no surface). Refused by name: free-form curves and surfaces,
// and every keyword that isn't OBJ's. Source: Wavefront, "Object Files (.obj)", appendix B1 of the manual of the
// Advanced Visualizer. A file whose only groups are "s off" has none: programs write it by default, and taken at its
// word every facet would be felt.
#pragma once
#include <string_view>

#include "pincer/contact/mesh/mesh_file.h"
#include "pincer/contact/mesh/mesh_groups.h"
#include "pincer/contact/mesh_reader.h"

namespace pincer::contact {

// True if a line of a polygon mesh may begin with this word.
bool isObjKeyword(std::string_view word);

TriangleMesh readObj(MeshFile& file, const ReadOptions& options);
std::vector<MeshGroup> readObjGroups(MeshFile& file, const ReadOptions& options);

}  // namespace pincer::contact
