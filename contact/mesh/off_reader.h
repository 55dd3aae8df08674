// off_reader: the Object File Format of Geomview, as text.
//
// Read: OFF, and with any of the letters C (colours), N (vertex normals) and ST (texture coordinates) before it; "#"
// comments; the counts on the header's line or the next; a vertex is x y z, then its normal, its colour (3 or 4
// numbers) and its texture coordinate (2), as the letters say; a face is its number of corners, their indices from 0,
// and a colour of 0, 1, 3 or 4 numbers. Colours and texture have no effect, nor has the number of edges. Refused by
// name: 4OFF and nOFF (other dimensions), OFF BINARY. Source: Geomview manual, "OFF Files". Departures: each vertex and
// face has a line of its own; the header is required.
#pragma once
#include <string_view>

#include "pincer/contact/mesh/mesh_file.h"
#include "pincer/contact/mesh_reader.h"

namespace pincer::contact {

// True if a file's first word is the header of an OFF file, of any kind.
bool isOffHeader(std::string_view word);

TriangleMesh readOff(MeshFile& file, const ReadOptions& options);

}  // namespace pincer::contact
