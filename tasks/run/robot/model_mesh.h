// model_mesh: the meshes that a robot's file names.
#pragma once
#include <string>

#include "pincer/contact/triangle_mesh.h"
#include "pincer/tasks/run/robot/xml_tree.h"

namespace pincer::tasks {

// The mesh of a file at `path`, in metres. Throws InputError at the element that names it.
contact::TriangleMesh readModelMesh(const XmlElement& element, const std::string& path);

// Scales along the mesh's axes, by no factor of 0; a mirrored one keeps its outside outside.
void scaleMesh(const Vec3& scale, contact::TriangleMesh& mesh);

}  // namespace pincer::tasks
