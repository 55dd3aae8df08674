// mesh_format: the mesh files that can be read and written, how to tell them apart,
// and the length units of their coordinates.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace pincer::contact {

enum class MeshFormat : std::uint8_t { obj, stl, ply, off };

constexpr std::string_view kMeshFormats = "OBJ, STL, PLY or OFF";  // for messages

// "OBJ", "STL", "PLY", "OFF".
std::string_view nameOf(MeshFormat format);

// By the ending of a file's name, in upper or lower case; none if it isn't one of ".obj", ".stl", ".ply", ".off".
std::optional<MeshFormat> formatOfName(std::string_view file_name);

// By the first bytes (binary STL: by the size that its count asks for); none if they could be anything.
std::optional<MeshFormat> formatOfBytes(std::string_view bytes);

// True if the bytes are a whole binary STL file: 84 bytes and 50 for each of its triangles.
// No text of less than 7 GB passes for one.
bool isBinaryStl(std::string_view bytes);

// Metres per unit of a length unit's name: "m", "cm", "mm", "in". Throws InputError on any other, listing these.
double metresPerUnit(const std::string& unit);

}  // namespace pincer::contact
