#include "pincer/contact/mesh/off_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "pincer/contact/mesh/mesh_builder.h"
#include "pincer/contact/mesh/text_lines.h"

namespace pincer::contact {

namespace {

// Meaning of the letters before "OFF".
struct OffKind {
  bool texture = false, colour = false, normal = false, other_dimension = false, known = false;
};

OffKind kindOf(std::string_view word) {
  OffKind kind;
  for (;;) {
    if (word == "OFF") {
      kind.known = true;
      return kind;
    }
    const auto take = [&](std::string_view letters, bool& flag) {
      if (flag || !word.starts_with(letters)) return false;
      word.remove_prefix(letters.size());
      return flag = true;
    };
    if (!take("ST", kind.texture) && !take("C", kind.colour) && !take("N", kind.normal) &&
        !take("4", kind.other_dimension) && !take("n", kind.other_dimension)) {
      return kind;
    }
  }
}

class OffParser {
 public:
  OffParser(MeshFile& file, const ReadOptions& options)
      : lines_(file, {.comments = true}), builder_(file, options, 0) {}
  TriangleMesh parse();

 private:
  void readHeader();
  void readCounts(std::size_t first_word);
  void readVertex();
  void readFace();
  void nextLine(std::string_view of, std::size_t number, std::size_t count);

  TextLines lines_;
  MeshBuilder builder_;
  OffKind kind_;
  std::size_t vertices_ = 0, faces_ = 0;
};

TriangleMesh OffParser::parse() {
  readHeader();
  for (std::size_t i = 0; i < vertices_; ++i) {
    nextLine("vertex", i, vertices_);
    readVertex();
  }
  for (std::size_t i = 0; i < faces_; ++i) {
    nextLine("face", i, faces_);
    readFace();
  }
  if (lines_.next()) {
    lines_.fail(fmt::format("{} follows after the last of the {} faces that the header announces. {}",
                            inQuotes(lines_.words()[0]), faces_, kCutOffOrJoined));
  }
  return builder_.build();
}

void OffParser::readHeader() {
  if (!lines_.next()) lines_.fail("the file has no header \"OFF\". Export it again.");
  const auto& words = lines_.words();
  kind_ = kindOf(words[0]);
  if (!kind_.known)
    lines_.fail(fmt::format("{} is not the header of an OFF file (OFF, COFF, NOFF, ...). Is this an OFF file?",
                            inQuotes(words[0])));
  if (kind_.other_dimension) {
    lines_.fail(
        fmt::format("{} has vertices in other than three dimensions. Export the mesh as OFF.", inQuotes(words[0])));
  }
  if (words.size() > 1 && words[1] == "BINARY")
    lines_.fail("binary OFF can't be read. Export the mesh as ascii OFF or as PLY.");
  if (words.size() > 1) return readCounts(1);
  if (!lines_.next())
    lines_.fail("the numbers of vertices, faces and edges are missing. The file is cut off; export it again.");
  readCounts(0);
}

void OffParser::readCounts(std::size_t first_word) {
  const auto& words = lines_.words();
  if (words.size() != first_word + 3) {
    lines_.fail(fmt::format("the header has {} counts; it needs 3: vertices, faces and edges (0 if unknown).",
                            words.size() - first_word));
  }
  // For messages, in the order of the file.
  constexpr std::array<std::string_view, 3> kNames = {"number of vertices", "number of faces", "number of edges"};
  std::array<std::size_t, 3> count{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t value = lines_.integer(words[first_word + i], kNames[i]);
    if (value < 0)
      lines_.fail(fmt::format("{} = {} can't be negative. The file is damaged; export it again.", kNames[i], value));
    count[i] = static_cast<std::size_t>(value);
  }
  vertices_ = count[0];
  faces_ = count[1];
  constexpr std::size_t kShortestVertex = 6, kShortestFace = 8;  // "0 0 0\n", "3 0 1 2\n"
  const std::size_t room = lines_.bytesLeft() + 1;               // the last line may lack its end
  if (vertices_ > room / kShortestVertex || faces_ > room / kShortestFace) {
    lines_.fail(fmt::format("{} vertices and {} faces need more than the {} bytes that follow. {}", vertices_, faces_,
                            lines_.bytesLeft(), kCutOffOrJoined));
  }
  builder_.reserveVertices(vertices_);
  builder_.reserveFaces(faces_, lines_.line());
}

void OffParser::nextLine(std::string_view of, std::size_t number, std::size_t count) {
  if (!lines_.next()) {
    lines_.fail(
        fmt::format("{} {} is missing: the header announces {} (from 0). The file is cut off; export or copy it again.",
                    of, number, count));
  }
}

void OffParser::readVertex() {
  const auto& words = lines_.words();
  const std::size_t place = kind_.normal ? 6 : 3, extra = kind_.texture ? 2 : 0,
                    colour = words.size() - std::min(words.size(), place + extra);
  const bool fits = words.size() >= place + extra && (kind_.colour ? colour == 3 || colour == 4 : colour == 0);
  if (!fits) {
    lines_.fail(fmt::format("vertex {} has {} numbers; by the header it needs {}{}.", builder_.nextVertex(),
                            words.size(), place + extra, kind_.colour ? " and 3 or 4 for its colour" : ""));
  }
  builder_.addVertex({lines_.number(words[0], "x"), lines_.number(words[1], "y"), lines_.number(words[2], "z")},
                     lines_.line());
  if (kind_.normal) {
    builder_.addNormal(
        {lines_.number(words[3], "normal x"), lines_.number(words[4], "normal y"), lines_.number(words[5], "normal z")},
        lines_.line());
  }
}

void OffParser::readFace() {
  const auto& words = lines_.words();
  const std::int64_t corners = lines_.integer(words[0], "number of corners");
  if (corners < 0)
    lines_.fail(fmt::format("face {} has {} corners; it needs at least 3.", builder_.nextFace(), corners));
  builder_.beginFace(corners, lines_.line());
  const std::size_t used = static_cast<std::size_t>(corners) + 1;
  const std::size_t colour = words.size() - std::min(words.size(), used);
  if (words.size() < used || colour == 2 || colour > 4) {
    lines_.fail(
        fmt::format("face {} has {} numbers after its first; it needs {} corners and a colour of 0, 1, 3 or 4 numbers.",
                    builder_.nextFace() - 1, words.size() - 1, corners));
  }
  builder_.readCorners([&] {
    for (std::size_t i = 1; i < used; ++i) {
      const std::int64_t vertex = lines_.integer(words[i], "vertex");
      builder_.addCorner(vertex, kind_.normal ? vertex : -1);
    }
  });
}

}  // namespace

bool isOffHeader(std::string_view word) { return kindOf(word).known; }

TriangleMesh readOff(MeshFile& file, const ReadOptions& options) { return OffParser(file, options).parse(); }

}  // namespace pincer::contact
