// stl_reader: STL, ascii and binary.
//
// STL lists triangles by their corners' positions and has no vertices of its own: positions that are exactly equal are
// one vertex here, numbered as they first appear. That is the format's meaning; nothing is welded within a tolerance.
// Facet normals and attribute bytes are not looked at: a facet normal says nothing that the corners' order doesn't,
// and nothing about the smooth shape. An ascii file may hold several solids; they are read as one mesh. A binary
// file's header may say anything, "solid" too: its size decides (mesh_format.h). Source: 3D Systems,
// "Stereolithography Interface Specification", 1989.
#pragma once
#include "pincer/contact/mesh/mesh_file.h"
#include "pincer/contact/mesh_reader.h"

namespace pincer::contact {

TriangleMesh readStl(MeshFile& file, const ReadOptions& options);

}  // namespace pincer::contact
