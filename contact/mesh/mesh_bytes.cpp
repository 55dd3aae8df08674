#include "pincer/contact/mesh/mesh_bytes.h"

#include <fmt/format.h>

#include "pincer/contact/error.h"
#include "pincer/contact/io/input_file.h"

namespace pincer::contact {

namespace {

// As text STL, the longest of the formats, the 2 million triangles that a mesh may have (mesh_builder.h) take some 500
// MB. Memory while it is read: the file, and at most 1 GB more for 6 million vertices and normals.
constexpr std::size_t kMaxMeshBytes = 512 * kMegabyte;
constexpr InputKind kMeshFile = {"a mesh (OBJ, STL, PLY or OFF)", kMaxMeshBytes, false,
                                 "Simplify (decimate) the mesh."};

}  // namespace

std::string readMeshBytes(const std::filesystem::path& path) {
  std::string bytes = readInputFile(path.string(), kMeshFile);
  requireMeshBytes(bytes, path.string());
  return bytes;
}

void requireMeshBytes(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) throw InputError(fmt::format("{}: the file is empty. Export or copy it again.", name));
  if (bytes.size() <= kMaxMeshBytes) return;
  throw InputError(
      fmt::format("{}: the file is larger than {} MB. Simplify (decimate) the mesh.", name, kMaxMeshBytes / kMegabyte));
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

}  // namespace pincer::contact
