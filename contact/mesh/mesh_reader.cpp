#include "pincer/contact/mesh_reader.h"

#include <array>

#include "pincer/contact/mesh/mesh_bytes.h"
#include "pincer/contact/mesh/mesh_file.h"
#include "pincer/contact/mesh/obj_reader.h"
#include "pincer/contact/mesh/off_reader.h"
#include "pincer/contact/mesh/ply_reader.h"
#include "pincer/contact/mesh/stl_reader.h"

namespace pincer::contact {

TriangleMesh readMesh(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string bytes = readMeshBytes(path);
  return parseMesh(bytes, formatOf(bytes, path.string()), path.string(), options);
}

TriangleMesh parseMesh(std::string_view bytes, MeshFormat format, const std::string& name, const ReadOptions& options) {
  requireMeshBytes(bytes, name);
  MeshFile file(bytes, name, options.progress);
  constexpr std::array kReaders = {readObj, readStl, readPly, readOff};  // in the order of MeshFormat
  TriangleMesh mesh = kReaders[static_cast<std::size_t>(format)](file, options);
  if (options.progress) options.progress(1);
  return mesh;
}

}  // namespace pincer::contact
