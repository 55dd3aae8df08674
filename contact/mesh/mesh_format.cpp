#include "pincer/contact/mesh_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "pincer/contact/error.h"
#include "pincer/contact/mesh/mesh_file.h"
#include "pincer/contact/mesh/obj_reader.h"
#include "pincer/contact/mesh/off_reader.h"
#include "pincer/contact/mesh/stl_layout.h"

namespace pincer::contact {

namespace {

// In the order of the enumeration, as kNames below.
constexpr std::array kFormats = {MeshFormat::obj, MeshFormat::stl, MeshFormat::ply, MeshFormat::off};

std::string lowerCase(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// The first word that isn't in a comment.
std::string_view firstWord(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n\v\f";  // as std::isspace has them
  constexpr std::size_t kFar = std::size_t{1} << 20;   // of comments; behind them the name decides
  text = text.substr(0, kFar);
  for (std::size_t begin = text.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    if (text[begin] != '#') return text.substr(begin, text.find_first_of(kBlanks, begin) - begin);
    const std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos) break;
    begin = text.find_first_not_of(kBlanks, end);
  }
  return {};
}

}  // namespace

std::string_view nameOf(MeshFormat format) {
  // In the order of MeshFormat.
  constexpr std::array<std::string_view, kFormats.size()> kNames = {"OBJ", "STL", "PLY", "OFF"};
  return kNames[static_cast<std::size_t>(format)];
}

std::optional<MeshFormat> formatOfName(std::string_view file_name) {
  const std::string name = lowerCase(file_name);
  for (const MeshFormat format : kFormats) {
    if (name.ends_with("." + lowerCase(nameOf(format)))) return format;
  }
  return std::nullopt;
}

std::optional<MeshFormat> formatOfBytes(std::string_view bytes) {
  if (isBinaryStl(bytes)) return MeshFormat::stl;
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  const std::string_view word = firstWord(bytes);
  if (word == "ply") return MeshFormat::ply;
  if (isOffHeader(word)) return MeshFormat::off;
  if (isObjKeyword(word)) return MeshFormat::obj;
  if (lowerCase(word) == "solid") return MeshFormat::stl;
  return std::nullopt;
}

bool isBinaryStl(std::string_view bytes) {
  return bytes.size() >= kStlHead &&
         bytes.size() == kStlHead + kStlFacet * static_cast<std::size_t>(readNumber<std::uint32_t>(
                                                    bytes.substr(kStlHeader), ByteOrder::little));
}

double metresPerUnit(const std::string& unit) {
  if (unit == "m") return 1;
  if (unit == "cm") return 0.01;
  if (unit == "mm") return 0.001;
  if (unit == "in") return 0.0254;
  throw InputError(fmt::format("unit {} is unknown. Use one of: m, cm, mm, in.", inQuotes(unit)));
}

}  // namespace pincer::contact
