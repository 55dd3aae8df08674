// ply_header: what a PLY file says about its data.
//
//   ply / format ascii|binary_little_endian|binary_big_endian 1.0 / element NAME COUNT / property
//   [list COUNT_TYPE] TYPE NAME / end_header
//
// Types by both families of names (char or int8, ... double or float64); "comment" and "obj_info" lines have no effect.
// Source: G. Turk, "The PLY Polygon File Format", 1994.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pincer/contact/mesh/text_lines.h"

namespace pincer::contact {

enum class PlyEncoding : std::uint8_t { ascii, little_endian, big_endian };
enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::array<std::size_t, 8> kPlyBytes = {1, 1, 2, 2, 4, 4, 4, 8};  // in the order of PlyType [bytes]
constexpr std::size_t sizeOf(PlyType type) { return kPlyBytes[static_cast<std::size_t>(type)]; }
constexpr bool isInteger(PlyType type) { return type < PlyType::float32; }

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  // of a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::int32_t line = 0;  // where it is announced
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
};

// Reads up to and with "end_header". Throws InputError. Counts are compared with
// what the bytes behind the header can hold.
PlyHeader readPlyHeader(TextLines& lines, const MeshFile& file);

}  // namespace pincer::contact
