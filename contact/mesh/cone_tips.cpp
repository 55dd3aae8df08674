#include "pincer/contact/mesh/cone_tips.h"

#include <Eigen/Dense>

namespace pincer::contact {

std::optional<ConeTip> findConeTip(const TriangleMesh& mesh, const CornerNormals& corners,
                                   const std::vector<std::int32_t>& corners_at, double least_lean) {
  constexpr double kStraight = 0.02;  // n . g of a ruling's far end
  constexpr double kRound = 1e-3;     // how evenly the rulings lie about the axis
  if (corners_at.empty()) return {};
  std::vector<Vec3> rulings;
  Mat3 A = Mat3::Zero();
  Vec3 sum = Vec3::Zero();
  for (const std::int32_t c : corners_at) {
    const auto t = static_cast<std::size_t>(c / 3), i = static_cast<std::size_t>(c % 3), j = (i + 1) % 3;
    const auto at = [&](std::size_t k) -> const Vec3& {
      return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
    };
    const Vec3 g = (at(j) - at(i)).normalized();
    if (std::abs(corners.normals[t][j].dot(g)) > kStraight) return {};
    rulings.push_back(g);
    A += g * g.transpose();
    sum += g;
  }
  if (!(A.determinant() > 1e-9)) return {};  // in a plane: no tip at all
  const Vec3 y = -(A.inverse() * sum);
  for (const Vec3& g : rulings) {
    if (std::abs(g.dot(y) + 1) > kRound) return {};
  }
  const double cos = 1 / y.norm();
  if (!(cos > math::sin(least_lean) && cos < 1)) return {};
  const Vec3& n =
      corners.normals[static_cast<std::size_t>(corners_at[0] / 3)][static_cast<std::size_t>(corners_at[0] % 3)];
  return ConeTip{y.normalized(), std::sqrt(1 - cos * cos), cos, n.dot(y) > 0 ? 1.0 : -1.0};
}

}  // namespace pincer::contact
