#include "pincer/contact/mesh_reader.h"

#include <fmt/format.h>

#include <cmath>

#include "pincer/contact/io/input_file.h"
#include "pincer/contact/mesh/mesh_file.h"
#include "pincer/contact/mesh/obj_reader.h"
#include "pincer/contact/mesh/off_reader.h"
#include "pincer/contact/mesh/ply_reader.h"
#include "pincer/contact/mesh/stl_reader.h"

namespace pincer::contact {

namespace {

// As text STL, the longest of the formats, the 2 million triangles that a mesh may have (mesh_builder.h) take some 500
// MB. Memory while it is read: the file, and at most 1 GB more for 6 million vertices and normals.
constexpr std::size_t kMaxMeshBytes = 512 * kMegabyte;
constexpr InputKind kMeshFile = {"a mesh (OBJ, STL, PLY or OFF)", kMaxMeshBytes, false,
                                 "Simplify (decimate) the mesh."};

void requireNotEmpty(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) throw InputError(fmt::format("{}: the file is empty. Export or copy it again.", name));
}

MeshFormat formatOf(std::string_view bytes, const std::string& name) {
  const auto by_name = formatOfName(name), by_bytes = formatOfBytes(bytes);
  if (!by_name && !by_bytes) {
    throw InputError(
        fmt::format("{}: neither the name nor the content is that of a mesh. Give an {} file.", name, kMeshFormats));
  }
  if (by_name && by_bytes && *by_name != *by_bytes) {
    throw InputError(
        fmt::format("{}: by its content this is an {} file, by its name {}. Correct the ending of its name.", name,
                    nameOf(*by_bytes), nameOf(*by_name)));
  }
  return by_bytes ? *by_bytes : *by_name;
}

}  // namespace

TriangleMesh readMesh(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string bytes = readInputFile(path.string(), kMeshFile);
  requireNotEmpty(bytes, path.string());
  return parseMesh(bytes, formatOf(bytes, path.string()), path.string(), options);
}

TriangleMesh parseMesh(std::string_view bytes, MeshFormat format, const std::string& name, const ReadOptions& options) {
  if (!(options.metres_per_unit > 0) || !std::isfinite(options.metres_per_unit)) {
    throw InputError(fmt::format("{}: metres per unit = {} must be a finite number above 0: 0.001 for millimetres.",
                                 name, options.metres_per_unit));
  }
  requireNotEmpty(bytes, name);
  if (bytes.size() > kMaxMeshBytes) {
    throw InputError(fmt::format("{}: the file is larger than {} MB. Simplify (decimate) the mesh.", name,
                                 kMaxMeshBytes / kMegabyte));
  }
  MeshFile file(bytes, name, options.progress);
  constexpr std::array kReaders = {readObj, readStl, readPly, readOff};  // in the order of MeshFormat
  TriangleMesh mesh = kReaders[static_cast<std::size_t>(format)](file, options);
  if (options.progress) options.progress(1);
  return mesh;
}

}  // namespace pincer::contact
