#include "tests/support/mesh_generators.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace pincer::contact {

void writeObj(std::ostream& out, const TriangleMesh& mesh, double unit) {
  for (const Vec3& v : mesh.vertices) fmt::print(out, "v {:.17g} {:.17g} {:.17g}\n", v.x() / unit, v.y() / unit, v.z() / unit);
  for (const Vec3& n : mesh.normals) fmt::print(out, "vn {:.17g} {:.17g} {:.17g}\n", n.x(), n.y(), n.z());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    fmt::print(out, "f");
    for (std::size_t i = 0; i < 3; ++i) {
      const bool has_normal = !mesh.triangle_normals.empty() && mesh.triangle_normals[t][i] >= 0;
      fmt::print(out, " {}", mesh.triangles[t][i] + 1);
      if (has_normal) fmt::print(out, "//{}", mesh.triangle_normals[t][i] + 1);
    }
    fmt::print(out, "\n");
  }
}

}  // namespace pincer::contact
