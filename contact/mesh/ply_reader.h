// ply_reader: the PLY polygon format, ascii, binary little endian and binary big endian.
//
// Read: element "vertex" with x, y, z and, where all three are there, nx, ny, nz, of any type; element "face" with
// the list vertex_indices (or vertex_index), counts and indices of any type of whole numbers, indices from 0.
// Elements and properties may stand in any order; all others are skipped. Element "tristrips" holds triangle strips,
// as Stanford's scans do: lists of the same name, -1 between strips. Departure from Turk's text: in an ascii file
// each entry has a line of its own. Source: ply_header.h.
#pragma once
#include "pincer/contact/mesh/mesh_file.h"
#include "pincer/contact/mesh_reader.h"

namespace pincer::contact {

TriangleMesh readPly(MeshFile& file, const ReadOptions& options);

}  // namespace pincer::contact
