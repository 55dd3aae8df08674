#include "contact/mesh/obj_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <span>
#include <string_view>

#include "contact/mesh/obj_lines.h"
#include "contact/mesh/polygon.h"

namespace pincer::contact {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 29;  // 512 MB of text: ten times what kMaxTriangles needs
constexpr std::size_t kMaxTriangles = 2'000'000;         // about 1 kB each once they are smooth
constexpr std::size_t kMaxCorners = 1000;                // of one polygon: ear clipping is quadratic
constexpr double kMaxCoordinate = 1000;                  // [m]
constexpr const char* kJoined = "The file is cut off or was joined by hand; export it again.";
constexpr const char* kDegenerate = "Delete degenerate faces in a mesh editor and export again.";

struct Corner {
  std::int32_t vertex = 0;   // from 0
  std::int32_t normal = -1;  // from 0, -1 for none
};

// Which of v, vt, vn the corners of a face have.
struct CornerForm {
  bool texture = false;
  bool normal = false;
  bool operator==(const CornerForm&) const = default;
};

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& name, double scale) : lines_(text, name), scale_(scale) { mesh_.source = name; }
  TriangleMesh parse();

 private:
  struct Face {  // as read
    std::size_t first_corner;
    int line;
  };
  struct Polygon {
    int line;
    int number;  // of the face in the file, from 1
    std::span<const Corner> corners;
  };

  void readLine();
  void readVertex();
  void readNormal();
  void readTexture();
  void readFace();
  Corner readCorner(std::string_view word, CornerForm& form);
  std::int32_t readIndex(std::string_view word, std::string_view what, std::int32_t count);
  void addFaces();
  void addPolygon(const Polygon& face);
  void checkPolygon(const Polygon& face) const;
  void addTriangle(const Polygon& face, const CornerTriple& triple);

  ObjLines lines_;
  double scale_;
  TriangleMesh mesh_;
  std::int32_t textures_ = 0;
  std::int32_t last_texture_ = -1;  // the highest index used, and where
  int last_texture_line_ = 0;
  std::size_t triangles_ = 0;
  bool has_normals_ = false;  // some face uses one
  std::vector<Face> faces_;
  std::vector<Corner> corners_;
};

bool isOneOf(std::string_view word, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

TriangleMesh ObjParser::parse() {
  while (lines_.next()) readLine();
  if (faces_.empty()) {
    throw InputError(fmt::format("{}: the file has {} vertices but no face (no line starts with \"f\"), so there is nothing to touch. {}",
                                 mesh_.source, mesh_.vertices.size(), "Export the mesh as polygons."));
  }
  addFaces();
  return std::move(mesh_);
}

void ObjParser::readLine() {
  const std::string_view keyword = lines_.words()[0];
  if (keyword == "v") return readVertex();
  if (keyword == "f") return readFace();
  if (keyword == "vn") return readNormal();
  if (keyword == "vt") return readTexture();
  if (isOneOf(keyword, {"g", "o", "s", "usemtl", "mtllib", "l", "p"})) return;
  if (isOneOf(keyword,
              {"vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp", "end", "con"})) {
    lines_.fail(
        fmt::format("\"{}\" belongs to a free-form curve or surface; only polygons can be read. Export the model as a mesh.", keyword));
  }
  lines_.fail(fmt::format("{} is not a keyword of an OBJ mesh (v, vn, vt, f, g, o, s, usemtl, mtllib, l, p). Is this an OBJ file?",
                          inQuotes(keyword)));
}

void ObjParser::readVertex() {
  const auto& words = lines_.words();
  const std::size_t values = words.size() - 1;
  if (values != 3 && values != 4 && values != 6 && values != 7) {
    lines_.fail(fmt::format("vertex {} has {} numbers; it needs 3 (x y z), and may have a weight and a colour (4, 6 or 7).",
                            mesh_.vertices.size() + 1, values));
  }
  constexpr std::array<std::string_view, 7> kNames = {"x", "y", "z", "value 4", "value 5", "value 6", "value 7"};
  std::array<double, 7> value{};
  for (std::size_t i = 0; i < values; ++i) value[i] = lines_.number(words[i + 1], kNames[i]);
  if ((values == 4 || values == 7) && value[3] != 1) {
    lines_.fail(fmt::format("vertex weight {} must be 1: other weights belong to free-form surfaces.", value[3]));
  }
  const Vec3 p = scale_ * Vec3(value[0], value[1], value[2]);
  if (p.cwiseAbs().maxCoeff() > kMaxCoordinate) {
    lines_.fail(fmt::format("vertex {} lies {:.3g} m from the origin along an axis; the limit is {} m. Is the unit right?",
                            mesh_.vertices.size() + 1, p.cwiseAbs().maxCoeff(), kMaxCoordinate));
  }
  mesh_.vertices.push_back(p);
}

void ObjParser::readNormal() {
  const auto& words = lines_.words();
  if (words.size() != 4) lines_.fail(fmt::format("normal {} has {} numbers; it needs 3.", mesh_.normals.size() + 1, words.size() - 1));
  const Vec3 n(lines_.number(words[1], "x"), lines_.number(words[2], "y"), lines_.number(words[3], "z"));
  const double largest = n.cwiseAbs().maxCoeff();
  if (largest == 0) {
    lines_.fail(fmt::format("normal {} is zero and has no direction. Recompute the normals, or export the mesh without them.",
                            mesh_.normals.size() + 1));
  }
  mesh_.normals.push_back((n / largest).normalized());  // of any length in the file; divided first so that no square overflows
}

void ObjParser::readTexture() {
  const auto& words = lines_.words();
  if (words.size() < 2 || words.size() > 4)
    lines_.fail(fmt::format("texture coordinate has {} numbers; it needs 1 to 3.", words.size() - 1));
  for (std::size_t i = 1; i < words.size(); ++i) lines_.number(words[i], "texture coordinate");
  ++textures_;
}

void ObjParser::readFace() {
  const auto& words = lines_.words();
  const std::size_t corners = words.size() - 1;
  if (corners < 3) lines_.fail(fmt::format("face {} has {} corners; it needs at least 3.", faces_.size() + 1, corners));
  if (corners > kMaxCorners) {
    lines_.fail(fmt::format("face {} has {} corners; the limit is {}. Triangulate the mesh before export.", faces_.size() + 1, corners,
                            kMaxCorners));
  }
  triangles_ += corners - 2;
  if (triangles_ > kMaxTriangles) {
    lines_.fail(
        fmt::format("the mesh has more than {} triangles. Simplify (decimate) it; a finger feels {} as well.", kMaxTriangles, 50'000));
  }
  faces_.push_back({corners_.size(), lines_.line()});
  CornerForm first;
  for (std::size_t i = 1; i <= corners; ++i) {
    CornerForm form;
    corners_.push_back(readCorner(words[i], form));
    if (i == 1) first = form;
    if (form != first) {
      lines_.fail(fmt::format("corner {} is written unlike the face's first corner {}: all corners of a face have the same parts.",
                              inQuotes(words[i]), inQuotes(words[1])));
    }
  }
}

Corner ObjParser::readCorner(std::string_view word, CornerForm& form) {
  std::array<std::string_view, 3> part;  // v, vt, vn
  std::size_t parts = 0;
  for (std::string_view rest = word;;) {
    const std::size_t slash = rest.find('/');
    part[parts++] = rest.substr(0, slash);
    if (slash == std::string_view::npos) break;
    rest.remove_prefix(slash + 1);
    if (parts == 3)
      lines_.fail(fmt::format("corner {} has more than three parts; it is written v, v/vt, v//vn or v/vt/vn.", inQuotes(word)));
  }
  if (parts > 1 && part[parts - 1].empty()) lines_.fail(fmt::format("corner {} ends with a slash; an index is missing.", inQuotes(word)));
  form = {parts > 1 && !part[1].empty(), parts == 3};
  Corner corner;
  corner.vertex = readIndex(part[0], "vertex", static_cast<std::int32_t>(mesh_.vertices.size()));
  if (form.normal) corner.normal = readIndex(part[2], "normal", static_cast<std::int32_t>(mesh_.normals.size()));
  if (form.texture) {
    const std::int32_t texture = readIndex(part[1], "texture coordinate", textures_);
    if (texture > last_texture_) last_texture_line_ = lines_.line();
    last_texture_ = std::max(last_texture_, texture);
  }
  return corner;
}

std::int32_t ObjParser::readIndex(std::string_view word, std::string_view what, std::int32_t count) {
  const std::int32_t index = lines_.integer(word, what);
  if (index == 0) lines_.fail(fmt::format("face {} uses {} 0; indices begin at 1 (or at -1, the last one so far).", faces_.size(), what));
  if (index < -count) lines_.fail(fmt::format("face {} uses {} {}, but there are only {} before it.", faces_.size(), what, index, count));
  return index > 0 ? index - 1 : count + index;
}

// After the last line, since a face may use a vertex that the file gives later.
void ObjParser::addFaces() {
  if (last_texture_ >= textures_) {
    lines_.failAt(last_texture_line_,
                  fmt::format("a face uses texture coordinate {}, but the file has {}. {}", last_texture_ + 1, textures_, kJoined));
  }
  has_normals_ = std::any_of(corners_.begin(), corners_.end(), [](const Corner& c) { return c.normal >= 0; });
  if (!has_normals_) mesh_.normals.clear();
  mesh_.triangles.reserve(triangles_);
  if (has_normals_) mesh_.triangle_normals.reserve(triangles_);
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const std::size_t end = i + 1 < faces_.size() ? faces_[i + 1].first_corner : corners_.size();
    addPolygon({faces_[i].line, static_cast<int>(i) + 1, {corners_.data() + faces_[i].first_corner, corners_.data() + end}});
  }
}

void ObjParser::addPolygon(const Polygon& face) {
  checkPolygon(face);
  if (face.corners.size() == 3) return addTriangle(face, {0, 1, 2});
  std::vector<Vec3> points;
  for (const Corner& c : face.corners) points.push_back(mesh_.vertices[static_cast<std::size_t>(c.vertex)]);
  const std::vector<CornerTriple> triples = triangulate(points);
  if (triples.empty()) {
    lines_.failAt(face.line, fmt::format("face {} with {} corners has no area or crosses itself. Triangulate the mesh before export.",
                                         face.number, face.corners.size()));
  }
  for (const CornerTriple& triple : triples) addTriangle(face, triple);
}

void ObjParser::checkPolygon(const Polygon& face) const {
  const auto vertices = static_cast<std::int32_t>(mesh_.vertices.size());
  const auto normals = static_cast<std::int32_t>(mesh_.normals.size());
  std::vector<std::int32_t> used;
  for (const Corner& c : face.corners) {
    if (c.vertex >= vertices) {
      lines_.failAt(face.line,
                    fmt::format("face {} uses vertex {}, but the file has {}. {}", face.number, c.vertex + 1, vertices, kJoined));
    }
    if (has_normals_ && c.normal >= normals) {
      lines_.failAt(face.line, fmt::format("face {} uses normal {}, but the file has {}. {}", face.number, c.normal + 1, normals, kJoined));
    }
    used.push_back(c.vertex);
  }
  std::sort(used.begin(), used.end());
  const auto twice = std::adjacent_find(used.begin(), used.end());
  if (twice == used.end()) return;
  lines_.failAt(face.line, fmt::format("face {} uses vertex {} twice. {}", face.number, *twice + 1, kDegenerate));
}

void ObjParser::addTriangle(const Polygon& face, const CornerTriple& triple) {
  std::array<std::int32_t, 3> v{}, n{};
  std::array<Vec3, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner& c = face.corners[static_cast<std::size_t>(triple[i])];
    v[i] = c.vertex;
    n[i] = c.normal;
    p[i] = mesh_.vertices[static_cast<std::size_t>(c.vertex)];
  }
  if (hasZeroArea(p[0], p[1], p[2])) {
    lines_.failAt(face.line, fmt::format("face {} has zero area: its vertices {}, {} and {} lie on one line. {}", face.number, v[0] + 1,
                                         v[1] + 1, v[2] + 1, kDegenerate));
  }
  mesh_.triangles.push_back(v);
  if (has_normals_) mesh_.triangle_normals.push_back(n);
}

std::string readText(std::istream& in, const std::string& name) {
  std::string text;
  std::vector<char> block(1 << 20);
  while (in) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
    if (text.size() > kMaxBytes) {
      throw InputError(fmt::format("{}: the file is larger than {} MB. Simplify (decimate) the mesh.", name, kMaxBytes >> 20));
    }
  }
  if (in.bad())
    throw InputError(fmt::format("{}: reading failed after {} bytes. Check the disk and copy the file again.", name, text.size()));
  if (text.empty()) throw InputError(fmt::format("{}: the file is empty. Export or copy it again.", name));
  return text;
}

}  // namespace

double metresPerUnit(const std::string& unit) {
  if (unit == "m") return 1;
  if (unit == "cm") return 0.01;
  if (unit == "mm") return 0.001;
  if (unit == "in") return 0.0254;
  throw InputError(fmt::format("unit {} is unknown. Use one of: m, cm, mm, in.", inQuotes(unit)));
}

TriangleMesh readObj(std::istream& in, const std::string& name, double scale) {
  if (!(scale > 0) || !std::isfinite(scale)) {
    throw InputError(
        fmt::format("{}: scale = {} must be a finite number above 0: metres per unit of the file, 0.001 for millimetres.", name, scale));
  }
  const std::string text = readText(in, name);
  return ObjParser(text, name, scale).parse();
}

TriangleMesh readObj(const std::string& path, double scale) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(fmt::format("{}: there is no such file. Check the path.", path));
  if (!std::filesystem::is_regular_file(status))
    throw InputError(fmt::format("{}: this is not a file. Give the path of an OBJ file.", path));
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: the file cannot be opened. Check that you may read it.", path));
  return readObj(in, path, scale);
}

}  // namespace pincer::contact
