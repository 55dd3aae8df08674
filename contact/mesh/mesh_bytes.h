// mesh_bytes: the content of a mesh file, bounded, and its format.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "pincer/contact/mesh_format.h"

namespace pincer::contact {

// All bytes of the file, at least one. Throws InputError: unreadable, empty, larger than a mesh may be.
std::string readMeshBytes(const std::filesystem::path& path);

// Throws InputError if there are none, or more than a mesh may have. `name` stands for the file in messages.
void requireMeshBytes(std::string_view bytes, const std::string& name);

// By the content where that tells, else by the name; throws InputError if the two contradict each other.
MeshFormat formatOf(std::string_view bytes, const std::string& name);

}  // namespace pincer::contact
