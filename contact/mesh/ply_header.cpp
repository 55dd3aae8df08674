#include "pincer/contact/mesh/ply_header.h"

#include <fmt/format.h>

#include <algorithm>

namespace pincer::contact {

namespace {

constexpr std::size_t kMaxLines = 1000;  // of elements and properties: real files have some ten

PlyType typeOf(std::string_view word, const TextLines& lines) {
  // Both spellings of each type, in the order of PlyType.
  constexpr std::array<std::string_view, 8> kC = {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
  constexpr std::array<std::string_view, 8> kSized = {"int8",  "uint8",  "int16",   "uint16",
                                                      "int32", "uint32", "float32", "float64"};
  for (std::size_t i = 0; i < kC.size(); ++i) {
    if (word == kC[i] || word == kSized[i]) return static_cast<PlyType>(i);
  }
  lines.fail(fmt::format("type {} is unknown. A PLY type is one of {}, or {}.", inQuotes(word), fmt::join(kC, ", "),
                         fmt::join(kSized, ", ")));
}

void readFormat(TextLines& lines, PlyHeader& header) {
  // All that the format has.
  constexpr std::array<std::string_view, 3> kNames = {"ascii", "binary_little_endian", "binary_big_endian"};
  const auto& words = lines.words();
  if (words.size() != 3 || words[0] != "format") {
    lines.fail(
        fmt::format("the line after \"ply\" must be \"format\" with {} and 1.0. The file is damaged; export it again.",
                    fmt::join(kNames, " or ")));
  }
  const auto* const name = std::find(kNames.begin(), kNames.end(), words[1]);
  if (name == kNames.end() || words[2] != "1.0") {
    lines.fail(fmt::format("format {} {} is unknown; it is one of {}, version 1.0. Export the mesh again.",
                           inQuotes(words[1]), inQuotes(words[2]), fmt::join(kNames, ", ")));
  }
  header.encoding = static_cast<PlyEncoding>(name - kNames.begin());
}

void addElement(const TextLines& lines, PlyHeader& header) {
  const auto& words = lines.words();
  if (words.size() != 3) lines.fail("an element is written \"element\", its name and its count.");
  const std::int64_t count = lines.integer(words[2], "element count");
  if (count < 0)
    lines.fail(fmt::format("element {} has the count {}, which can't be negative. Export the mesh again.",
                           inQuotes(words[1]), count));
  const bool twice = std::any_of(header.elements.begin(), header.elements.end(),
                                 [&](const PlyElement& e) { return e.name == words[1]; });
  if (twice) lines.fail(fmt::format("element {} is announced twice. Export the mesh again.", inQuotes(words[1])));
  header.elements.push_back({std::string(words[1]), static_cast<std::size_t>(count), lines.line(), {}});
}

void addProperty(const TextLines& lines, PlyHeader& header) {
  const auto& words = lines.words();
  if (header.elements.empty()) lines.fail("a property stands before the first element. Export the mesh again.");
  PlyProperty property;
  property.is_list = words.size() > 1 && words[1] == "list";
  if (words.size() != (property.is_list ? 5u : 3u)) {
    lines.fail(
        "a property is written \"property\", its type and its name, or \"property list\", the count's type, the items' "
        "and its name.");
  }
  if (property.is_list) property.count_type = typeOf(words[2], lines);
  if (property.is_list && !isInteger(property.count_type)) {
    lines.fail(
        fmt::format("a list's count can't be of type {}; it must be a type of whole numbers.", inQuotes(words[2])));
  }
  property.type = typeOf(words[property.is_list ? 3 : 1], lines);
  property.name = words.back();
  auto& all = header.elements.back().properties;
  const bool twice = std::any_of(all.begin(), all.end(), [&](const PlyProperty& p) { return p.name == property.name; });
  if (twice)
    lines.fail(fmt::format("property {} of {} is announced twice. Export the mesh again.", inQuotes(property.name),
                           inQuotes(header.elements.back().name)));
  all.push_back(std::move(property));
}

std::size_t shortest(const PlyElement& element, PlyEncoding encoding) {  // [bytes] that one takes
  if (encoding == PlyEncoding::ascii) return 2 * element.properties.size();
  std::size_t bytes = 0;
  for (const PlyProperty& p : element.properties) bytes += sizeOf(p.is_list ? p.count_type : p.type);
  return bytes;
}

void requireRoom(const TextLines& lines, const PlyHeader& header, const MeshFile& file) {
  // a last line may lack its end
  std::size_t room = lines.bytesLeft() + (header.encoding == PlyEncoding::ascii ? 1 : 0);
  for (const PlyElement& element : header.elements) {
    const std::size_t each = shortest(element, header.encoding);
    if (each == 0 && element.count > 0) {
      file.failAt(element.line, fmt::format("element {} has no property, so it can't have {} entries.",
                                            inQuotes(element.name), element.count));
    }
    if (each > 0 && element.count > room / each) {
      file.failAt(
          element.line,
          fmt::format("{} of {} need more than the {} bytes that follow. The file is cut off or its header is damaged; "
                      "export or copy it again.",
                      element.count, inQuotes(element.name), lines.bytesLeft()));
    }
    room -= each * element.count;
  }
}

}  // namespace

PlyHeader readPlyHeader(TextLines& lines, const MeshFile& file) {
  PlyHeader header;
  const auto next = [&] {
    if (!lines.next())
      lines.fail("the header has no end (\"end_header\"): the file is cut off. Export or copy it again.");
  };
  if (!lines.next() || lines.words().size() != 1 || lines.words()[0] != "ply") {
    lines.fail("the first line must be \"ply\". Is this a PLY file?");
  }
  const auto isComment = [&] { return lines.words()[0] == "comment" || lines.words()[0] == "obj_info"; };
  do next();
  while (isComment());
  readFormat(lines, header);
  for (std::size_t count = 0;;) {
    next();
    const std::string_view keyword = lines.words()[0];
    if (isComment()) continue;
    if (keyword == "end_header") break;
    if (++count > kMaxLines)
      lines.fail(fmt::format("the header has more than {} elements and properties. Export only the mesh.", kMaxLines));
    if (keyword == "element")
      addElement(lines, header);
    else if (keyword == "property")
      addProperty(lines, header);
    else
      lines.fail(fmt::format("{} is not a keyword of a PLY header (element, property, comment, obj_info, end_header).",
                             inQuotes(keyword)));
  }
  requireRoom(lines, header, file);
  return header;
}

}  // namespace pincer::contact
