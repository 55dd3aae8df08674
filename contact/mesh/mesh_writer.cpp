#include "pincer/contact/mesh/mesh_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/contact/mesh/mesh_file.h"
#include "pincer/contact/mesh/stl_layout.h"

namespace pincer::contact {

namespace {

using Indices = std::array<std::int32_t, 3>;

template <typename Number>
void addNumber(std::string& out, Number value) {  // the shortest text that gives the same number back
  char digits[32];
  out.append(digits, std::to_chars(digits, digits + sizeof(digits), value).ptr);
}

void addVector(std::string& out, const Vec3& v) {
  addNumber(out, v.x());
  addNumber(out += ' ', v.y());
  addNumber(out += ' ', v.z());
}

template <typename Number>
void addBytes(std::string& out, Number value) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &value, sizeof(Number));
  if (std::endian::native == std::endian::big) std::reverse(raw, raw + sizeof(Number));
  out.append(raw, sizeof(Number));
}

template <typename Number>
void addVectorBytes(std::string& out, const Vec3& v) {
  for (int i = 0; i < 3; ++i) addBytes(out, static_cast<Number>(v[i]));
}

class MeshWriter {
 public:
  MeshWriter(const TriangleMesh& mesh, const WriteOptions& options) : mesh_(mesh), options_(options) {}

  std::string obj() const;
  std::string stlText() const;
  std::string stlBinary() const;
  std::string plyText() const;
  std::string plyBinary() const;
  std::string off() const;

 private:
  Vec3 inUnit(const Vec3& p) const { return p / options_.metres_per_unit; }
  std::array<Vec3, 3> corners(std::size_t t) const;
  std::string plyHeader(const char* encoding, bool normals) const;
  void addLines(std::string& out, const std::optional<std::vector<Vec3>>& normals) const;

  const TriangleMesh& mesh_;
  const WriteOptions& options_;
};

std::array<Vec3, 3> MeshWriter::corners(std::size_t t) const {
  std::array<Vec3, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = inUnit(mesh_.vertices[static_cast<std::size_t>(mesh_.triangles[t][i])]);
  return p;
}

Vec3 facetNormal(const std::array<Vec3, 3>& p) { return (p[1] - p[0]).cross(p[2] - p[0]).normalized(); }

// Per vertex, if each has exactly one.
std::optional<std::vector<Vec3>> vertexNormals(const TriangleMesh& mesh) {
  if (mesh.triangle_normals.empty()) return std::nullopt;
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t n = mesh.triangle_normals[t][i];
      if (n < 0) return std::nullopt;
      Vec3& normal = normals[static_cast<std::size_t>(mesh.triangles[t][i])];
      if (normal.isZero()) normal = mesh.normals[static_cast<std::size_t>(n)];
      if (normal != mesh.normals[static_cast<std::size_t>(n)]) return std::nullopt;
    }
  }
  if (std::any_of(normals.begin(), normals.end(), [](const Vec3& n) { return n.isZero(); })) return std::nullopt;
  return normals;
}

bool hasNormals(const Indices& corners) { return *std::min_element(corners.begin(), corners.end()) >= 0; }

std::string MeshWriter::obj() const {
  std::string out;
  for (const Vec3& p : mesh_.vertices) {
    addVector(out += "v ", inUnit(p));
    out += '\n';
  }
  for (const Vec3& n : mesh_.normals) {
    addVector(out += "vn ", n);
    out += '\n';
  }
  std::int32_t group = 0;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (!mesh_.smoothing_groups.empty() && mesh_.smoothing_groups[t] != group) {
      group = mesh_.smoothing_groups[t];
      out += group == 0 ? "s off\n" : fmt::format("s {}\n", group);
    }
    const bool normals = !mesh_.triangle_normals.empty() && hasNormals(mesh_.triangle_normals[t]);
    out += 'f';
    for (std::size_t i = 0; i < 3; ++i) {
      addNumber(out += ' ', mesh_.triangles[t][i] + 1);
      if (normals) addNumber(out += "//", mesh_.triangle_normals[t][i] + 1);
    }
    out += '\n';
  }
  return out;
}

std::string MeshWriter::stlText() const {
  std::string out = "solid pincer\n";
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const std::array<Vec3, 3> p = corners(t);
    addVector(out += "facet normal ", facetNormal(p));
    out += "\nouter loop\n";
    for (const Vec3& corner : p) {
      addVector(out += "vertex ", corner);
      out += '\n';
    }
    out += "endloop\nendfacet\n";
  }
  return out + "endsolid pincer\n";
}

std::string MeshWriter::stlBinary() const {
  std::string out = "binary STL, written by pincer";
  out.resize(kStlHeader, '\0');
  addBytes(out, static_cast<std::uint32_t>(mesh_.triangles.size()));
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const std::array<Vec3, 3> p = corners(t);
    addVectorBytes<float>(out, facetNormal(p));
    for (const Vec3& corner : p) addVectorBytes<float>(out, corner);
    addBytes(out, std::uint16_t{0});
  }
  return out;
}

std::string MeshWriter::plyHeader(const char* encoding, bool normals) const {
  std::string out = fmt::format("ply\nformat {} 1.0\ncomment written by pincer\nelement vertex {}\n", encoding,
                                mesh_.vertices.size());
  for (const char* name : {"x", "y", "z"}) out += fmt::format("property double {}\n", name);
  if (normals) out += "property double nx\nproperty double ny\nproperty double nz\n";
  return out +
         fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh_.triangles.size());
}

// Vertices and faces as PLY and OFF write them in text.
void MeshWriter::addLines(std::string& out, const std::optional<std::vector<Vec3>>& normals) const {
  for (std::size_t i = 0; i < mesh_.vertices.size(); ++i) {
    addVector(out, inUnit(mesh_.vertices[i]));
    if (normals) addVector(out += ' ', (*normals)[i]);
    out += '\n';
  }
  for (const Indices& triangle : mesh_.triangles) {
    out += '3';
    for (const std::int32_t v : triangle) addNumber(out += ' ', v);
    out += '\n';
  }
}

std::string MeshWriter::plyText() const {
  const auto normals = vertexNormals(mesh_);
  std::string out = plyHeader("ascii", normals.has_value());
  addLines(out, normals);
  return out;
}

std::string MeshWriter::plyBinary() const {
  const auto normals = vertexNormals(mesh_);
  std::string out = plyHeader("binary_little_endian", normals.has_value());
  for (std::size_t i = 0; i < mesh_.vertices.size(); ++i) {
    addVectorBytes<double>(out, inUnit(mesh_.vertices[i]));
    if (normals) addVectorBytes<double>(out, (*normals)[i]);
  }
  for (const Indices& triangle : mesh_.triangles) {
    addBytes(out, std::uint8_t{3});
    for (const std::int32_t v : triangle) addBytes(out, v);
  }
  return out;
}

std::string MeshWriter::off() const {
  const auto normals = vertexNormals(mesh_);
  std::string out =
      fmt::format("{}\n{} {} 0\n", normals ? "NOFF" : "OFF", mesh_.vertices.size(), mesh_.triangles.size());
  addLines(out, normals);
  return out;
}

bool hasPartialNormals(const TriangleMesh& mesh) {
  return std::any_of(mesh.triangle_normals.begin(), mesh.triangle_normals.end(),
                     [](const Indices& n) { return !hasNormals(n) && *std::max_element(n.begin(), n.end()) >= 0; });
}

}  // namespace

std::string formatMesh(const TriangleMesh& mesh, MeshFormat format, const WriteOptions& options) {
  if (!(options.metres_per_unit > 0) || !std::isfinite(options.metres_per_unit)) {
    throw InputError(fmt::format("metres per unit = {} must be a finite number above 0: 0.001 for millimetres.",
                                 options.metres_per_unit));
  }
  const MeshWriter writer(mesh, options);
  switch (format) {
    case MeshFormat::obj:
      return writer.obj();
    case MeshFormat::stl:
      return options.ascii ? writer.stlText() : writer.stlBinary();
    case MeshFormat::ply:
      return options.ascii ? writer.plyText() : writer.plyBinary();
    default:
      return writer.off();
  }
}

void writeMesh(const std::filesystem::path& path, const TriangleMesh& mesh, const WriteOptions& options) {
  const auto format = formatOfName(path.string());
  if (!format)
    throw InputError(fmt::format("{}: the name's ending doesn't tell the format. Let it end like an {} file's.",
                                 path.string(), kMeshFormats));
  writeAtomically(path.string(), formatMesh(mesh, *format, options));
}

std::vector<std::string> lossesOf(const TriangleMesh& mesh, MeshFormat format, const WriteOptions& options) {
  std::vector<std::string> losses;
  if (format == MeshFormat::stl) {
    if (!options.ascii) losses.emplace_back("coordinates beyond the 24 bits of a float");
    losses.emplace_back(
        "vertices' numbers, unused vertices, and which of several vertices in one place a triangle uses");
  }
  if (format != MeshFormat::obj && !mesh.smoothing_groups.empty()) losses.emplace_back("smoothing groups");
  const bool keeps_normals = format == MeshFormat::obj   ? !hasPartialNormals(mesh)
                             : format == MeshFormat::stl ? mesh.triangle_normals.empty()
                                                         : mesh.triangle_normals.empty() || vertexNormals(mesh);
  if (!keeps_normals) losses.emplace_back("normals");
  return losses;
}

}  // namespace pincer::contact
