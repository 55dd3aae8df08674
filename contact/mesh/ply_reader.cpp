#include "pincer/contact/mesh/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/io/printable.h"
#include "pincer/contact/mesh/mesh_builder.h"
#include "pincer/contact/mesh/ply_header.h"

namespace pincer::contact {

namespace {

// The remedy for a file that ends too early.
constexpr const char* kCutOff = "The file is cut off; export or copy it again.";

// Where an element's next value stands and how it is written: words of a line, or bytes. Both have the same members.
class AsciiValues {
 public:
  AsciiValues(MeshFile&, TextLines& lines, PlyEncoding) : lines_(lines) {}

  std::int32_t place() const { return lines_.line(); }
  void begin(const PlyElement& element, std::size_t number) {
    next_ = 0;
    if (!lines_.next())
      lines_.fail(
          fmt::format("entry {} of {} {} is missing. {}", number, element.count, inQuotes(element.name), kCutOff));
  }
  double scalar(const PlyProperty& p) { return lines_.number(word(p), p.name); }
  std::int64_t index(const PlyProperty& p) { return lines_.integer(word(p), p.name); }
  std::int64_t count(const PlyProperty& p) { return lines_.integer(word(p), p.name); }
  void skip(const PlyProperty& p, std::size_t values) {
    if (values > lines_.words().size() - next_) fail(p);
    next_ += values;
  }
  void end(const PlyElement& element) const {
    const std::size_t words = lines_.words().size();
    if (next_ != words) {
      lines_.fail(fmt::format("the line has {} values, but a {} has only {} here. Export the mesh again.", words,
                              inQuotes(element.name), next_));
    }
  }
  void requireEnd() const {
    if (lines_.next())
      lines_.fail(fmt::format("{} follows after the last entry. {}", inQuotes(lines_.words()[0]), kCutOffOrJoined));
  }

 private:
  std::string_view word(const PlyProperty& p) {
    if (next_ == lines_.words().size()) fail(p);
    return lines_.words()[next_++];
  }
  [[noreturn]] void fail(const PlyProperty& p) const {
    lines_.fail(fmt::format("the line has {} values, which aren't enough for {}. {}", lines_.words().size(),
                            inQuotes(p.name), kCutOffOrJoined));
  }

  TextLines& lines_;
  std::size_t next_ = 0;
};

class BinaryValues {
 public:
  BinaryValues(MeshFile& file, const TextLines& lines, PlyEncoding encoding)
      : file_(file),
        at_(lines.position()),
        order_(encoding == PlyEncoding::little_endian ? ByteOrder::little : ByteOrder::big) {
    file.countPlacesIn(Places::bytes);
  }

  std::int32_t place() const { return static_cast<std::int32_t>(at_); }
  void begin(const PlyElement&, std::size_t) { file_.reached(at_); }
  double scalar(const PlyProperty& p) {
    const std::string_view bytes = take(sizeOf(p.type), p);
    const double value = p.type == PlyType::float64   ? readNumber<double>(bytes, order_)
                         : p.type == PlyType::float32 ? static_cast<double>(readNumber<float>(bytes, order_))
                                                      : static_cast<double>(integer(bytes, p.type));
    if (!std::isfinite(value)) {
      file_.failAt(place() - static_cast<std::int32_t>(bytes.size()),
                   fmt::format("{} = {} must be finite. Export the mesh again; its program had no valid value here.",
                               printable(p.name), value));
    }
    return value;
  }
  std::int64_t index(const PlyProperty& p) { return integer(take(sizeOf(p.type), p), p.type); }
  std::int64_t count(const PlyProperty& p) { return integer(take(sizeOf(p.count_type), p), p.count_type); }
  void skip(const PlyProperty& p, std::size_t values) {
    if (values > (file_.bytes().size() - at_) / sizeOf(p.type)) fail(p);
    at_ += values * sizeOf(p.type);
  }
  void end(const PlyElement&) const {}
  void requireEnd() const {
    if (at_ == file_.bytes().size()) return;
    file_.failAt(place(),
                 fmt::format("{} bytes follow after the last entry. {}", file_.bytes().size() - at_, kCutOffOrJoined));
  }

 private:
  std::string_view take(std::size_t bytes, const PlyProperty& p) {
    if (bytes > file_.bytes().size() - at_) fail(p);
    at_ += bytes;
    return file_.bytes().substr(at_ - bytes, bytes);
  }
  [[noreturn]] void fail(const PlyProperty& p) const {
    file_.failAt(place(), fmt::format("the file ends within {}. {}", inQuotes(p.name), kCutOff));
  }
  std::int64_t integer(std::string_view bytes, PlyType type) const {
    switch (type) {
      case PlyType::int8:
        return readNumber<std::int8_t>(bytes, order_);
      case PlyType::uint8:
        return readNumber<std::uint8_t>(bytes, order_);
      case PlyType::int16:
        return readNumber<std::int16_t>(bytes, order_);
      case PlyType::uint16:
        return readNumber<std::uint16_t>(bytes, order_);
      case PlyType::int32:
        return readNumber<std::int32_t>(bytes, order_);
      default:
        return readNumber<std::uint32_t>(bytes, order_);
    }
  }

  MeshFile& file_;
  std::size_t at_;
  ByteOrder order_;
};

// Which of a vertex' properties are its place (0, 1, 2) and its normal (3, 4, 5).
struct VertexLayout {
  std::vector<int> role;  // per property, -1 for others
  bool has_normals = false;
};

VertexLayout layoutOf(const PlyElement& element, const MeshFile& file) {
  // Of the properties that are read.
  constexpr std::array<std::string_view, 6> kNames = {"x", "y", "z", "nx", "ny", "nz"};
  VertexLayout layout;
  std::array<bool, 6> found{};
  for (const PlyProperty& p : element.properties) {
    const auto name = static_cast<std::size_t>(std::find(kNames.begin(), kNames.end(), p.name) - kNames.begin());
    const bool used = name < kNames.size() && !p.is_list;
    layout.role.push_back(used ? static_cast<int>(name) : -1);
    if (used) found[name] = true;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!found[i])
      file.failAt(
          element.line,
          fmt::format("element \"vertex\" has no property \"{}\". Export the mesh with vertex positions.", kNames[i]));
  }
  layout.has_normals = found[3] && found[4] && found[5];
  if (!layout.has_normals && (found[3] || found[4] || found[5])) {
    file.failAt(element.line,
                "element \"vertex\" has only some of nx, ny and nz. Export the normals whole, or not at all.");
  }
  if (!layout.has_normals)
    std::replace_if(
        layout.role.begin(), layout.role.end(), [](int role) { return role > 2; }, -1);
  return layout;
}

// Which property of a face or strip lists its vertices.
std::size_t vertexListOf(const PlyElement& element, const MeshFile& file) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& p = element.properties[i];
    if (p.name != "vertex_indices" && p.name != "vertex_index") continue;
    if (!p.is_list || !isInteger(p.type)) {
      file.failAt(element.line,
                  fmt::format("property \"{}\" must be a list of whole numbers. Export the mesh again.", p.name));
    }
    return i;
  }
  file.failAt(element.line,
              fmt::format("element \"{}\" has no list \"vertex_indices\". Export the mesh as polygons.", element.name));
}

template <typename Values>
class PlyParser {
 public:
  PlyParser(MeshFile& file, const ReadOptions& options, TextLines& lines, const PlyHeader& header)
      : file_(file), header_(header), values_(file, lines, header.encoding), builder_(file, options, 0) {}

  TriangleMesh parse() {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") layout_ = layoutOf(element, file_);
    }
    for (const PlyElement& element : header_.elements) readElement(element);
    values_.requireEnd();
    return builder_.build();
  }

 private:
  void readElement(const PlyElement& element) {
    if (element.name == "vertex") return readVertices(element);
    if (element.name == "face") return readFaces(element);
    if (element.name == "tristrips") return readStrips(element);
    for (std::size_t i = 0; i < element.count; ++i) {
      values_.begin(element, i);
      for (const PlyProperty& p : element.properties) skip(p);
      values_.end(element);
    }
  }

  void readVertices(const PlyElement& element) {
    builder_.reserveVertices(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      values_.begin(element, i);
      const std::int32_t place = values_.place();
      std::array<double, 6> value{};
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const int role = layout_.role[k];
        role < 0 ? skip(element.properties[k])
                 : void(value[static_cast<std::size_t>(role)] = values_.scalar(element.properties[k]));
      }
      values_.end(element);
      builder_.addVertex({value[0], value[1], value[2]}, place);
      if (layout_.has_normals) builder_.addNormal({value[3], value[4], value[5]}, place);
    }
  }

  void readFaces(const PlyElement& element) {
    const std::size_t list = element.count > 0 ? vertexListOf(element, file_) : 0;
    builder_.reserveFaces(element.count, values_.place());
    for (std::size_t i = 0; i < element.count; ++i) {
      values_.begin(element, i);
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        k == list ? readFace(element.properties[k]) : skip(element.properties[k]);
      }
      values_.end(element);
    }
  }

  void readStrips(const PlyElement& element) {
    const std::size_t list = element.count > 0 ? vertexListOf(element, file_) : 0;
    for (std::size_t i = 0; i < element.count; ++i) {
      values_.begin(element, i);
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        k == list ? readStrip(element.properties[k]) : skip(element.properties[k]);
      }
      values_.end(element);
    }
  }

  // Each vertex makes a triangle with the two before it, every second one turned round. -1 ends a strip; another begins
  // in the same list. Strips are joined by triangles that name a vertex twice: these aren't part of the surface.
  void readStrip(const PlyProperty& p) {
    constexpr std::int64_t kEnd = -1;  // in place of a vertex: ends a strip
    const std::int32_t place = values_.place();
    const std::int64_t items = values_.count(p);
    requireNotNegative(items, p, place);
    std::array<std::int64_t, 3> latest{};
    std::int64_t length = 0;
    for (std::int64_t i = 0; i < items; ++i) {
      const std::int32_t here = values_.place();
      const std::int64_t vertex = values_.index(p);
      if (vertex == kEnd) {
        length = 0;
        continue;
      }
      latest = {latest[1], latest[2], vertex};
      if (++length >= 3) addStripTriangle(latest, length % 2 == 0, here);
    }
  }

  void addStripTriangle(const std::array<std::int64_t, 3>& v, bool is_turned, std::int32_t place) {
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) return;
    builder_.beginFace(3, place);
    for (const std::size_t i : is_turned ? std::array<std::size_t, 3>{1, 0, 2} : std::array<std::size_t, 3>{0, 1, 2}) {
      builder_.addCorner(v[i], layout_.has_normals ? v[i] : -1);
    }
  }

  void readFace(const PlyProperty& p) {
    const std::int32_t place = values_.place();
    const std::int64_t corners = values_.count(p);
    builder_.beginFace(corners, place);
    for (std::int64_t i = 0; i < corners; ++i) {
      const std::int64_t vertex = values_.index(p);
      builder_.addCorner(vertex, layout_.has_normals ? vertex : -1);
    }
  }

  void skip(const PlyProperty& p) {
    if (!p.is_list) return values_.skip(p, 1);
    const std::int32_t place = values_.place();
    const std::int64_t items = values_.count(p);
    requireNotNegative(items, p, place);
    values_.skip(p, static_cast<std::size_t>(items));
  }

  void requireNotNegative(std::int64_t items, const PlyProperty& p, std::int32_t place) const {
    if (items >= 0) return;
    file_.failAt(place, fmt::format("list {} has the count {}, which can't be negative. Export the mesh again.",
                                    inQuotes(p.name), items));
  }

  MeshFile& file_;
  const PlyHeader& header_;
  Values values_;
  MeshBuilder builder_;
  VertexLayout layout_;
};

}  // namespace

TriangleMesh readPly(MeshFile& file, const ReadOptions& options) {
  TextLines lines(file, {});
  const PlyHeader header = readPlyHeader(lines, file);
  if (header.encoding == PlyEncoding::ascii) return PlyParser<AsciiValues>(file, options, lines, header).parse();
  return PlyParser<BinaryValues>(file, options, lines, header).parse();
}

}  // namespace pincer::contact
