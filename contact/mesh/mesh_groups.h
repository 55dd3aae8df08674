// mesh_groups: the parts of a file that have names, each a mesh of its own.
//
// OBJ alone names parts: "o NAME" an object, "g NAME" a group. Where faces have objects, these are the parts, whatever
// groups they are in: programs group an object's faces by material. A name that comes again goes on with its part. A
// name without faces makes no part; faces without a name are the part "default" (Wavefront, "Object Files (.obj)",
// appendix B1 of the manual of the Advanced Visualizer).
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/contact/mesh_reader.h"

namespace pincer::contact {

struct MeshGroup {
  std::string name;   // as the file has it, of one word or several
  TriangleMesh mesh;  // with the vertices and normals that its triangles use; its source names file and part
};

// The parts in the order of their first faces. Throws InputError as readMesh does; also for a file of another format,
// and where no face has a name.
std::vector<MeshGroup> readMeshGroups(const std::filesystem::path& path, const ReadOptions& options = {});

// The same from memory; `name` stands for the file in messages.
std::vector<MeshGroup> parseMeshGroups(std::string_view bytes, MeshFormat format, const std::string& name,
                                       const ReadOptions& options = {});

// The mesh as parts of the same name, by the name of each triangle (as many as the mesh has), "" for none. Throws
// InputError where none has any.
std::vector<MeshGroup> splitByName(const TriangleMesh& mesh, std::span<const std::string_view> names);

}  // namespace pincer::contact
