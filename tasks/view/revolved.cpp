#include "pincer/tasks/view/revolved.h"

#include <cmath>

#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {

void addArc(Profile& profile, double z, double r, double from, double to, int parts, bool inside) {
  const double sign = inside ? -1 : 1;
  for (int i = 0; i <= parts; ++i) {
    const double a = from + (to - from) * i / parts;
    profile.push_back(
        {std::max(r * math::cos(a), 0.0), z + r * math::sin(a), sign * math::cos(a), sign * math::sin(a)});
  }
}

ViewMesh revolve(const Profile& profile, int segments) {
  PINCER_ASSERT(profile.size() >= 2 && segments >= 3);
  ViewMesh mesh;
  for (const ProfilePoint& at : profile) {
    for (int k = 0; k <= segments; ++k) {
      const double a = 2 * M_PI * k / segments, c = math::cos(a), s = math::sin(a);
      mesh.vertices.push_back(
          {Vec3(at.r * c, at.r * s, at.z).cast<float>(), Vec3(at.n_r * c, at.n_r * s, at.n_z).cast<float>()});
    }
  }
  const auto columns = static_cast<std::uint32_t>(segments + 1);
  for (std::uint32_t i = 0; i + 1 < profile.size(); ++i) {
    for (std::uint32_t k = 0; k + 1 < columns; ++k) {
      const std::uint32_t a = i * columns + k, b = a + columns;
      mesh.triangles.insert(mesh.triangles.end(), {a, b, a + 1, a + 1, b, b + 1});
    }
  }
  return mesh;
}

}  // namespace pincer::tasks
