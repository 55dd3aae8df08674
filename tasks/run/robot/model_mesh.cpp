#include "pincer/tasks/run/robot/model_mesh.h"

#include <fmt/format.h>

#include "pincer/contact/mesh_reader.h"

namespace pincer::tasks {

contact::TriangleMesh readModelMesh(const XmlElement& element, const std::string& path) {
  contact::ReadOptions options;
  options.degenerate = contact::Degenerate::keep;
  options.left_out = [](const std::string&) {};  // a mesh here is a cloud of corners, or a sum of triangles
  try {
    return contact::readMesh(path, options);
  } catch (const InputError& error) {
    element.reject(fmt::format("can't use its file: {}", error.what()));
  }
}

void scaleMesh(const Vec3& scale, contact::TriangleMesh& mesh) {
  for (Vec3& v : mesh.vertices) v = v.cwiseProduct(scale);
  if (scale.prod() < 0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  mesh.normals.clear();
  mesh.triangle_normals.clear();
}

}  // namespace pincer::tasks
