#include "pincer/contact/mesh/obj_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "pincer/contact/mesh/mesh_builder.h"
#include "pincer/contact/mesh/text_lines.h"

namespace pincer::contact {

namespace {

// Which of v, vt, vn the corners of a face have.
struct CornerForm {
  bool texture = false;
  bool normal = false;
  bool operator==(const CornerForm&) const = default;
};

class ObjParser {
 public:
  ObjParser(MeshFile& file, const ReadOptions& options)
      : file_(file), lines_(file, {.comments = true, .continued = true}), builder_(file, options, 1) {}
  TriangleMesh parse();
  // The parts of the mesh that was parsed.
  std::vector<MeshGroup> groupsOf(const TriangleMesh& mesh) const;

 private:
  // Names that are in force, in the file's bytes; empty: none.
  struct Names {
    std::string_view object, group;
    std::size_t first_face = 0;
  };

  void readLine();
  void readVertex();
  void readNormal();
  void readTexture();
  void readSmoothingGroup();
  void readNames();
  void readFace();
  void readCorners(const std::vector<std::string_view>& words);
  CornerForm readCorner(std::string_view word);
  std::int64_t readIndex(std::string_view word, std::string_view what, std::size_t count) const;

  MeshFile& file_;
  TextLines lines_;
  MeshBuilder builder_;
  std::size_t textures_ = 0;
  std::int64_t last_texture_ = -1;  // the highest index used, and where
  std::int32_t last_texture_line_ = 0;
  std::vector<Names> names_ = {{}};  // by MeshBuilder's parts
};

bool isOneOf(std::string_view word, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

TriangleMesh ObjParser::parse() {
  while (lines_.next()) readLine();
  if (last_texture_ >= static_cast<std::int64_t>(textures_)) {
    file_.failAt(last_texture_line_, fmt::format("a face uses texture coordinate {}, but the file has {}. {}",
                                                 last_texture_ + 1, textures_, kCutOffOrJoined));
  }
  return builder_.build();
}

void ObjParser::readLine() {
  const std::string_view keyword = lines_.words()[0];
  if (keyword == "v") return readVertex();
  if (keyword == "f") return readFace();
  if (keyword == "vn") return readNormal();
  if (keyword == "vt") return readTexture();
  if (keyword == "s") return readSmoothingGroup();
  if (keyword == "o" || keyword == "g") return readNames();
  if (isObjKeyword(keyword)) return;
  if (isOneOf(keyword, {"vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv",
                        "sp", "end", "con"})) {
    lines_.fail(fmt::format(
        "\"{}\" belongs to a free-form curve or surface; only polygons can be read. Export the model as a mesh.",
        keyword));
  }
  lines_.fail(fmt::format(
      "{} is not a keyword of an OBJ mesh (v, vn, vt, f, g, o, s, usemtl, mtllib, l, p). Is this an OBJ file?",
      inQuotes(keyword)));
}

void ObjParser::readVertex() {
  const auto& words = lines_.words();
  const std::size_t values = words.size() - 1;
  if (values != 3 && values != 4 && values != 6 && values != 7) {
    lines_.fail(
        fmt::format("vertex {} has {} numbers; it needs 3 (x y z), and may have a weight and a colour (4, 6 or 7).",
                    builder_.nextVertex(), values));
  }
  // For messages: a vertex may have up to four values more, of weight or colour.
  constexpr std::array<std::string_view, 7> kNames = {"x", "y", "z", "value 4", "value 5", "value 6", "value 7"};
  std::array<double, 7> value{};
  for (std::size_t i = 0; i < values; ++i) value[i] = lines_.number(words[i + 1], kNames[i]);
  if ((values == 4 || values == 7) && value[3] != 1) {
    lines_.fail(fmt::format("vertex weight {} must be 1: other weights belong to free-form surfaces.", value[3]));
  }
  builder_.addVertex({value[0], value[1], value[2]}, lines_.line());
}

void ObjParser::readNormal() {
  const auto& words = lines_.words();
  if (words.size() != 4)
    lines_.fail(fmt::format("normal {} has {} numbers; it needs 3.", builder_.nextNormal(), words.size() - 1));
  builder_.addNormal({lines_.number(words[1], "x"), lines_.number(words[2], "y"), lines_.number(words[3], "z")},
                     lines_.line());
}

void ObjParser::readTexture() {
  const auto& words = lines_.words();
  if (words.size() < 2 || words.size() > 4)
    lines_.fail(fmt::format("texture coordinate has {} numbers; it needs 1 to 3.", words.size() - 1));
  for (std::size_t i = 1; i < words.size(); ++i) lines_.number(words[i], "texture coordinate");
  ++textures_;
}

void ObjParser::readSmoothingGroup() {
  const auto& words = lines_.words();
  if (words.size() != 2) lines_.fail("a smoothing group is written \"s\" and its number, or \"s off\".");
  constexpr std::int64_t kLast = 0x7fffffff;  // that a 32-bit number holds
  const std::int64_t group = words[1] == "off" ? 0 : lines_.integer(words[1], "smoothing group");
  if (group < 0 || group > kLast)
    lines_.fail(fmt::format("smoothing group {} is out of range 1 .. {} (0 or \"off\": none).", group, kLast));
  builder_.setSmoothingGroup(static_cast<std::int32_t>(group));
}

// Several words are one name. Names that no face stood under are forgotten.
void ObjParser::readNames() {
  const auto& words = lines_.words();
  const std::string_view first = words.size() > 1 ? words[1] : "", last = words.back();
  const auto length = static_cast<std::size_t>(last.data() + last.size() - first.data());
  const std::string_view name = first.empty() ? first : std::string_view(first.data(), length);
  Names names = names_.back();
  if (names.first_face == builder_.faces()) names_.pop_back();
  (words[0] == "o" ? names.object : names.group) = name;
  names.first_face = builder_.faces();
  builder_.setPart(static_cast<std::int32_t>(names_.size()));
  names_.push_back(names);
}

// By their objects' names if a face has one, else by their groups'.
std::vector<MeshGroup> ObjParser::groupsOf(const TriangleMesh& mesh) const {
  const auto namesOf = [&](std::int32_t part) -> const Names& { return names_[static_cast<std::size_t>(part)]; };
  const std::vector<std::int32_t>& parts = builder_.parts();
  const bool has_objects = std::any_of(parts.begin(), parts.end(), [&](auto p) { return !namesOf(p).object.empty(); });
  std::vector<std::string_view> name_of_triangle;
  for (const std::int32_t part : parts)
    name_of_triangle.push_back(has_objects ? namesOf(part).object : namesOf(part).group);
  return splitByName(mesh, name_of_triangle);
}

void ObjParser::readFace() {
  const auto& words = lines_.words();
  builder_.beginFace(std::max<std::int64_t>(static_cast<std::int64_t>(words.size()) - 1, 3), lines_.line());
  builder_.readCorners([&] { readCorners(words); });
}

void ObjParser::readCorners(const std::vector<std::string_view>& words) {
  if (words.size() < 4)
    lines_.fail(fmt::format("face {} has {} corners; it needs at least 3.", builder_.nextFace() - 1, words.size() - 1));
  const CornerForm first = readCorner(words[1]);
  for (std::size_t i = 2; i < words.size(); ++i) {
    if (readCorner(words[i]) == first) continue;
    lines_.fail(fmt::format(
        "corner {} is written unlike the face's first corner {}: all corners of a face have the same parts.",
        inQuotes(words[i]), inQuotes(words[1])));
  }
}

CornerForm ObjParser::readCorner(std::string_view word) {
  std::array<std::string_view, 3> part;  // v, vt, vn
  std::size_t parts = 0;
  for (std::string_view rest = word;;) {
    const std::size_t slash = rest.find('/');
    part[parts++] = rest.substr(0, slash);
    if (slash == std::string_view::npos) break;
    rest.remove_prefix(slash + 1);
    if (parts == 3)
      lines_.fail(
          fmt::format("corner {} has more than three parts; it is written v, v/vt, v//vn or v/vt/vn.", inQuotes(word)));
  }
  if (parts > 1 && part[parts - 1].empty())
    lines_.fail(fmt::format("corner {} ends with a slash; an index is missing.", inQuotes(word)));
  const CornerForm form = {parts > 1 && !part[1].empty(), parts == 3};
  builder_.addCorner(readIndex(part[0], "vertex", builder_.vertices()),
                     form.normal ? readIndex(part[2], "normal", builder_.normals()) : -1);
  if (form.texture) {
    const std::int64_t texture = readIndex(part[1], "texture coordinate", textures_);
    if (texture > last_texture_) last_texture_line_ = lines_.line();
    last_texture_ = std::max(last_texture_, texture);
  }
  return form;
}

std::int64_t ObjParser::readIndex(std::string_view word, std::string_view what, std::size_t count) const {
  const std::int64_t index = lines_.integer(word, what);
  if (index > 0) return index - 1;
  const std::size_t face = builder_.nextFace() - 1;
  if (index == 0)
    lines_.fail(fmt::format("face {} uses {} 0; indices begin at 1 (or at -1, the last one so far).", face, what));
  const auto before = static_cast<std::int64_t>(count);
  if (index < -before)
    lines_.fail(fmt::format("face {} uses {} {}, but there are only {} before it.", face, what, index, before));
  return before + index;
}

}  // namespace

bool isObjKeyword(std::string_view word) {
  return isOneOf(word, {"v", "f", "vn", "vt", "s", "g", "o", "usemtl", "mtllib", "l", "p"});
}

TriangleMesh readObj(MeshFile& file, const ReadOptions& options) { return ObjParser(file, options).parse(); }

std::vector<MeshGroup> readObjGroups(MeshFile& file, const ReadOptions& options) {
  ObjParser parser(file, options);
  const TriangleMesh mesh = parser.parse();
  return parser.groupsOf(mesh);
}

}  // namespace pincer::contact
