#include "pincer/contact/mesh/stl_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "pincer/contact/mesh/mesh_builder.h"
#include "pincer/contact/mesh/stl_layout.h"
#include "pincer/contact/mesh/text_lines.h"

namespace pincer::contact {

namespace {

std::uint64_t mixed(std::uint64_t z) {  // SplitMix64's finaliser
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

// Numbers positions as they first appear. Open addressing: at most half of the slots are taken.
class Positions {
 public:
  explicit Positions(std::size_t expected) : slots_(std::bit_ceil(4 * expected + 16), -1) {}

  // The number of `p`; `is_new` says whether this is its first appearance.
  std::int32_t numberOf(const Vec3& p, bool& is_new) {
    if (2 * points_.size() >= slots_.size()) grow();
    std::int32_t& slot = slotOf(p);
    is_new = slot < 0;
    if (is_new) {
      slot = static_cast<std::int32_t>(points_.size());
      points_.push_back(p);
    }
    return slot;
  }

 private:
  std::int32_t& slotOf(const Vec3& p) {
    std::uint64_t hash = 0;
    // -0 is 0
    for (int i = 0; i < 3; ++i) hash = mixed(hash + 0x9e3779b97f4a7c15u + std::bit_cast<std::uint64_t>(p[i] + 0.0));
    for (std::size_t i = hash;; ++i) {
      std::int32_t& slot = slots_[i & (slots_.size() - 1)];
      if (slot < 0 || points_[static_cast<std::size_t>(slot)] == p) return slot;
    }
  }
  void grow() {
    slots_.assign(2 * slots_.size(), -1);
    for (std::size_t i = 0; i < points_.size(); ++i) slotOf(points_[i]) = static_cast<std::int32_t>(i);
  }

  std::vector<std::int32_t> slots_;
  std::vector<Vec3> points_;  // in the file's unit
};

class StlParser {
 public:
  StlParser(MeshFile& file, const ReadOptions& options) : file_(file), builder_(file, options, 1), positions_(0) {}
  TriangleMesh parseBinary();
  TriangleMesh parseAscii();

 private:
  std::size_t readCount() const;
  void readBinaryCorner(std::size_t at);
  void readFacet(TextLines& lines);
  void readAsciiCorner(TextLines& lines);
  void expect(TextLines& lines, std::initializer_list<std::string_view> keywords, std::size_t words);
  void addCorner(const Vec3& p, std::int32_t place);

  MeshFile& file_;
  MeshBuilder builder_;
  Positions positions_;
};

bool isKeyword(std::string_view word, std::string_view keyword) {  // in upper or lower case: both are in use
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](unsigned char a, unsigned char b) { return std::tolower(a) == b; });
}

void StlParser::addCorner(const Vec3& p, std::int32_t place) {
  bool is_new = false;
  const std::int32_t number = positions_.numberOf(p, is_new);
  if (is_new) builder_.addVertex(p, place);
  builder_.addCorner(number);
}

TriangleMesh StlParser::parseBinary() {
  file_.countPlacesIn(Places::bytes);
  const std::size_t count = readCount();
  builder_.reserveFaces(count, kStlHeader);
  positions_ = Positions(count / 2);  // a closed surface has half as many vertices as triangles
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = kStlHead + kStlFacet * i;
    file_.reached(begin);
    builder_.beginFace(3, static_cast<std::int32_t>(begin));
    for (std::size_t corner = 0; corner < 3; ++corner) readBinaryCorner(begin + 12 + 12 * corner);
  }
  return builder_.build();
}

std::size_t StlParser::readCount() const {
  const std::size_t size = file_.bytes().size();
  if (size < kStlHead) {
    file_.fail(
        fmt::format("the file has {} bytes; a binary STL file has at least {}, and an ascii one begins with \"solid\". "
                    "It is cut off or isn't STL; export it again.",
                    size, kStlHead));
  }
  const auto count =
      static_cast<std::size_t>(readNumber<std::uint32_t>(file_.bytes().substr(kStlHeader), ByteOrder::little));
  const std::size_t expected = kStlHead + kStlFacet * count;
  if (size == expected) return count;
  file_.fail(fmt::format(
      "the header announces {} triangles, which take {} bytes, but the file has {}. {}", count, expected, size,
      size < expected ? "It is cut off or isn't STL; export or copy it again."
                      : "Something follows after the last triangle: the file is damaged; export it again."));
}

void StlParser::readBinaryCorner(std::size_t at) {
  constexpr std::array<char, 3> kNames = {'x', 'y', 'z'};  // for messages
  Vec3 p;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = readNumber<float>(file_.bytes().substr(at + 4 * i), ByteOrder::little);
    if (!std::isfinite(value)) {
      file_.failAt(static_cast<std::int32_t>(at + 4 * i),
                   fmt::format("{} of a corner of triangle {} = {} must be finite. Export the mesh again; its program "
                               "had no valid value here.",
                               kNames[i], builder_.nextFace() - 1, value));
    }
    p[static_cast<Eigen::Index>(i)] = value;
  }
  addCorner(p, static_cast<std::int32_t>(at));
}

TriangleMesh StlParser::parseAscii() {
  TextLines lines(file_, {});
  while (lines.next()) {
    if (!isKeyword(lines.words()[0], "solid")) {
      lines.fail(fmt::format("{} stands where a solid should begin. The file is damaged or isn't STL; export it again.",
                             inQuotes(lines.words()[0])));
    }
    for (;;) {
      if (!lines.next())
        lines.fail("the solid has no end (\"endsolid\"): the file is cut off. Export or copy it again.");
      if (isKeyword(lines.words()[0], "endsolid")) break;
      readFacet(lines);
    }
  }
  return builder_.build();
}

void StlParser::readFacet(TextLines& lines) {
  expect(lines, {"facet", "normal"}, 5);
  builder_.beginFace(3, lines.line());
  const auto next = [&] {
    if (!lines.next()) lines.fail("the facet has no end (\"endfacet\"): the file is cut off. Export or copy it again.");
  };
  next();
  expect(lines, {"outer", "loop"}, 2);
  for (int corner = 0; corner < 3; ++corner) {
    next();
    readAsciiCorner(lines);
  }
  next();
  expect(lines, {"endloop"}, 1);
  next();
  expect(lines, {"endfacet"}, 1);
}

void StlParser::readAsciiCorner(TextLines& lines) {
  expect(lines, {"vertex"}, 4);
  const auto& words = lines.words();
  addCorner({lines.number(words[1], "x"), lines.number(words[2], "y"), lines.number(words[3], "z")}, lines.line());
}

void StlParser::expect(TextLines& lines, std::initializer_list<std::string_view> keywords, std::size_t count) {
  const auto& words = lines.words();
  const bool fits =
      words.size() == count && std::equal(keywords.begin(), keywords.end(), words.begin(),
                                          [](std::string_view k, std::string_view word) { return isKeyword(word, k); });
  if (fits) return;
  lines.fail(
      fmt::format("{} and {} more words stand where \"{}\"{} should. The file is damaged, or a facet isn't a triangle; "
                  "export it again.",
                  inQuotes(words[0]), words.size() - 1, fmt::join(keywords, " "),
                  count > keywords.size() ? fmt::format(" and {} numbers", count - keywords.size()) : ""));
}

// A binary header may begin with "solid", but no text has a zero byte among its first ones.
bool looksLikeText(std::string_view bytes) {
  constexpr std::size_t kSolid = 5;  // letters of "solid"
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  return isKeyword(bytes.substr(0, kSolid), "solid") &&
         bytes.substr(0, 2 * kStlHead).find('\0') == std::string_view::npos;
}

}  // namespace

TriangleMesh readStl(MeshFile& file, const ReadOptions& options) {
  StlParser parser(file, options);
  return !isBinaryStl(file.bytes()) && looksLikeText(file.bytes()) ? parser.parseAscii() : parser.parseBinary();
}

}  // namespace pincer::contact
