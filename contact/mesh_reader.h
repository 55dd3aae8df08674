// mesh_reader: strict readers of OBJ, STL (ascii and binary), PLY (ascii, binary little and big endian) and OFF.
//
// Nothing is repaired silently: every defect throws InputError with file, line or byte, the offending value,
// its range and a remedy. Time and memory are bounded by the file's size: a count in a header is believed only
// as far as the bytes behind it can hold it.
//
// Common to all formats: polygons are triangulated (polygon.h); vertices and faces keep the file's order; vertices that
// no face uses, and several at one place, stay in the mesh (mesh_report counts them). What a format says about features
// becomes data: vertex normals (OBJ per corner; PLY nx ny nz and NOFF per vertex) and OBJ's smoothing groups. What each
// format allows is in its reader's header.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "pincer/contact/error.h"
#include "pincer/contact/mesh_format.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

// Treatment of triangles of zero area: an error, or kept for a repair to see. A kept one may use a vertex twice.
enum class Degenerate : std::uint8_t { reject, keep };

struct ReadOptions {
  double metres_per_unit = 1;  // of the file's coordinates, > 0 and finite
  Degenerate degenerate = Degenerate::reject;
  // Told of each polygon that can't be used: its index is out of range, it has fewer than three corners, or no
  // triangles. It is then left out and the rest is read. Empty: the first such polygon throws.
  std::function<void(const std::string& what)> left_out = {};
  // of the bytes read, 0 .. 1; called about once a megabyte; may throw to cancel
  std::function<void(double fraction)> progress = {};
};

// The format is told from the content where that can be, else from the name; throws
// InputError if the two contradict each other.
TriangleMesh readMesh(const std::filesystem::path& path, const ReadOptions& options = {});

// The same from memory; `name` stands for the file in messages.
TriangleMesh parseMesh(std::string_view bytes, MeshFormat format, const std::string& name,
                       const ReadOptions& options = {});

}  // namespace pincer::contact
