#include "contact/mesh_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "contact/mesh/mesh_file.h"
#include "contact/mesh/obj_reader.h"
#include "contact/mesh/off_reader.h"
#include "contact/mesh/ply_reader.h"
#include "contact/mesh/stl_reader.h"

namespace pincer::contact {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 29;  // 512 MB of text: several times what the largest mesh needs

std::string readBytes(std::istream& in, std::size_t expected, const std::string& name) {
  std::string bytes;
  bytes.reserve(std::min(expected, kMaxBytes) + 1);
  std::string block(std::size_t{1} << 20, '\0');
  while (in) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    bytes.append(block.data(), static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > kMaxBytes) {
      throw InputError(fmt::format("{}: the file is larger than {} MB. Simplify (decimate) the mesh.", name, kMaxBytes >> 20));
    }
  }
  if (in.bad())
    throw InputError(fmt::format("{}: reading failed after {} bytes. Check the disk and copy the file again.", name, bytes.size()));
  return bytes;
}

std::string readBytes(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  const std::string name = path.string();
  if (!std::filesystem::exists(status)) throw InputError(fmt::format("{}: there is no such file. Check the path.", name));
  if (!std::filesystem::is_regular_file(status))
    throw InputError(fmt::format("{}: this is not a file. Give the path of a mesh file ({}).", name, kMeshFormats));
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: the file cannot be opened. Check that you may read it.", name));
  const auto size = std::filesystem::file_size(path, error);
  return readBytes(in, error ? 0 : size, name);
}

void requireNotEmpty(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) throw InputError(fmt::format("{}: the file is empty. Export or copy it again.", name));
}

MeshFormat formatOf(std::string_view bytes, const std::string& name) {
  const auto by_name = formatOfName(name), by_bytes = formatOfBytes(bytes);
  if (!by_name && !by_bytes) {
    throw InputError(fmt::format("{}: neither the name nor the content is that of a mesh. Give an {} file.", name, kMeshFormats));
  }
  if (by_name && by_bytes && *by_name != *by_bytes) {
    throw InputError(fmt::format("{}: by its content this is an {} file, by its name {}. Correct the ending of its name.", name,
                                 nameOf(*by_bytes), nameOf(*by_name)));
  }
  return by_bytes ? *by_bytes : *by_name;
}

}  // namespace

TriangleMesh readMesh(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string bytes = readBytes(path);
  requireNotEmpty(bytes, path.string());
  return parseMesh(bytes, formatOf(bytes, path.string()), path.string(), options);
}

TriangleMesh parseMesh(std::string_view bytes, MeshFormat format, const std::string& name, const ReadOptions& options) {
  if (!(options.metres_per_unit > 0) || !std::isfinite(options.metres_per_unit)) {
    throw InputError(
        fmt::format("{}: metres per unit = {} must be a finite number above 0: 0.001 for millimetres.", name, options.metres_per_unit));
  }
  requireNotEmpty(bytes, name);
  if (bytes.size() > kMaxBytes) {
    throw InputError(fmt::format("{}: the file is larger than {} MB. Simplify (decimate) the mesh.", name, kMaxBytes >> 20));
  }
  MeshFile file(bytes, name, options.progress);
  constexpr std::array kReaders = {readObj, readStl, readPly, readOff};
  TriangleMesh mesh = kReaders[static_cast<std::size_t>(format)](file, options);
  if (options.progress) options.progress(1);
  return mesh;
}

}  // namespace pincer::contact
