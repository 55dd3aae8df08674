// mesh_writer: triangle meshes as OBJ, STL, PLY and OFF files that mesh_reader reads back.
//
// Text has as many digits (17 at most) as it takes to get the same double back; binary PLY has doubles. So with
// one metre per unit, a mesh comes back with the same bits, apart from what its format can't hold (lossesOf):
// binary STL has floats, and STL of either kind has no vertices, so that unused ones vanish and those in one
// place become one; only OBJ has smoothing groups; PLY and OFF have one normal per vertex, so that normals are
// left out where a vertex has several, or none.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pincer/contact/mesh_format.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

struct WriteOptions {
  double metres_per_unit = 1;  // of the file's coordinates, > 0 and finite
  bool ascii = false;          // STL and PLY as text instead of binary (PLY: little endian)
};

// The bytes of the file. Requires a validated mesh.
std::string formatMesh(const TriangleMesh& mesh, MeshFormat format, const WriteOptions& options = {});

// Writes the file in the format that its name ends with. Throws InputError if there is none, or if writing fails.
void writeMesh(const std::filesystem::path& path, const TriangleMesh& mesh, const WriteOptions& options = {});

// Parts of this mesh that the format can't hold, one phrase each; empty if it comes back whole.
std::vector<std::string> lossesOf(const TriangleMesh& mesh, MeshFormat format, const WriteOptions& options = {});

}  // namespace pincer::contact
