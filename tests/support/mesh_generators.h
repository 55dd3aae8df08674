// mesh_generators: the product's generated meshes (contact/mesh/generated_meshes.h) and their OBJ text.
#pragma once
#include <ostream>

#include "contact/mesh/generated_meshes.h"

namespace pincer::contact {

// Writes vertices, normals (if any) and faces with 17 digits, so that a reader gets back the same bits. `unit` [m]: 0.001 for millimetres.
void writeObj(std::ostream& out, const TriangleMesh& mesh, double unit = 1);

}  // namespace pincer::contact
