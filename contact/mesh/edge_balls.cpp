#include "pincer/contact/mesh/edge_balls.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>

#include "pincer/contact/error.h"
#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/mesh/mesh_findings.h"
#include "pincer/contact/mesh/union_find.h"

namespace pincer::contact {

namespace {

constexpr double kSameFace = 1e-4;    // sine of an angle between normals below which there is nothing to round [-]
constexpr double kAllTouched = 1e-3;  // how far, in radii, a face of a corner may miss the ball: 1.5 um at 1.5 mm
constexpr double kFlattest = 1e-6;    // determinant of three normals that still make a corner

class EdgeBallFinder {
 public:
  EdgeBallFinder(const TriangleMesh& mesh, const Neighbours& neighbours, const CornerNormals& corners)
      : mesh_(mesh), neighbours_(neighbours), corners_(corners) {}

  EdgeBalls find() {
    findFans();
    balls_.at_vertex.resize(mesh_.vertices.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (corners_.sharp[t][i]) addCrease(t, i);
      }
    }
    for (std::size_t v = 0; v < balls_.at_vertex.size(); ++v) {
      if (!balls_.at_vertex[v].creases.empty()) place(static_cast<std::int32_t>(v), balls_.at_vertex[v]);
    }
    return std::move(balls_);
  }

 private:
  const Vec3& corner(std::size_t t, std::size_t i) const {
    return mesh_.vertices[static_cast<std::size_t>(mesh_.triangles[t][i % 3])];
  }
  const Vec3& normal(Fan fan) const {
    return corners_.normals[static_cast<std::size_t>(fan) / 3][static_cast<std::size_t>(fan) % 3];
  }

  void findFans() {
    UnionFind sets(3 * mesh_.triangles.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (corners_.sharp[t][i]) continue;
        const auto [other, edge] = neighbours_[t][i];
        sets.join(static_cast<std::int32_t>(3 * t + i), 3 * other + (edge + 1) % 3);
        sets.join(static_cast<std::int32_t>(3 * t + (i + 1) % 3), 3 * other + edge);
      }
    }
    for (std::size_t c = 0; c < 3 * mesh_.triangles.size(); ++c)
      balls_.fan_of.push_back(sets.find(static_cast<std::int32_t>(c)));
  }

  void addCrease(std::size_t t, std::size_t i) {
    const auto [other, edge] = neighbours_[t][i];
    PINCER_ASSERT(other >= 0);  // the mesh is closed
    const Fan left = balls_.fan_of[3 * t + i];
    const Fan right = balls_.fan_of[static_cast<std::size_t>(3 * other + (edge + 1) % 3)];
    const Vec3 facet = (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
    const Vec3& beyond = corner(static_cast<std::size_t>(other), static_cast<std::size_t>(edge + 2));
    const bool convex = facet.dot(beyond - corner(t, i)) < 0;
    balls_.at_vertex[static_cast<std::size_t>(mesh_.triangles[t][i])].creases.push_back(
        {static_cast<std::int32_t>(t), static_cast<std::int8_t>(i), left, right, convex});
    const Vec3 &a = normal(left), &b = normal(right);
    balls_.widest_turn = std::max(balls_.widest_turn, math::atan2(a.cross(b).norm(), a.dot(b)));
  }

  void place(std::int32_t vertex, EdgeBall& ball) const {
    const std::size_t n = ball.creases.size();
    const Vec3 &a = normal(ball.creases[0].left), &b = normal(ball.creases[0].right);
    ball.vanishes = n == 1 || (n == 2 && a.dot(b) > 0 && a.cross(b).norm() < kSameFace);
    if (ball.vanishes) return;
    const auto same_turn = [&](const CreaseEnd& crease) { return crease.convex == ball.creases[0].convex; };
    if (!std::all_of(ball.creases.begin(), ball.creases.end(), same_turn))
      refuse(vertex, "convex and concave edges meet");
    ball.s = ball.creases[0].convex ? 1 : -1;
    if (n == 2 && 1 + a.dot(b) < kFlattest) refuse(vertex, "the two faces lie back to back");
    ball.x = n == 2 ? (a + b) / (1 + a.dot(b)) : centreOfCorner(vertex, ball);
  }

  // Least squares of n_i . x = 1; with three faces the solution is exact.
  Vec3 centreOfCorner(std::int32_t vertex, const EdgeBall& ball) const {
    Mat3 A = Mat3::Zero();
    Vec3 sum = Vec3::Zero();
    for (const CreaseEnd& crease : ball.creases) {
      const Vec3& n = normal(crease.left);
      A += n * n.transpose();
      sum += n;
    }
    if (A.determinant() < kFlattest) refuse(vertex, "three creases meet whose faces make no corner");
    const Vec3 x = A.inverse() * sum;
    for (const CreaseEnd& crease : ball.creases) {
      if (std::abs(normal(crease.left).dot(x) - 1) > kAllTouched) {
        refuse(vertex, fmt::format("{} faces meet that no ball touches all at once", ball.creases.size()));
      }
    }
    return x;
  }

  [[noreturn]] void refuse(std::int32_t vertex, const std::string& why) const {
    throw InputError(
        fmt::format("{}: at {} {}: such a corner can't be rounded. Round it in a mesh editor, or let the crease angle "
                    "leave one of its edges smooth "
                    "(--crease-angle).",
                    mesh_.source, vertexPlace(mesh_, vertex), why));
  }

  const TriangleMesh& mesh_;
  const Neighbours& neighbours_;
  const CornerNormals& corners_;
  EdgeBalls balls_;
};

}  // namespace

EdgeBalls findEdgeBalls(const TriangleMesh& mesh, const Neighbours& neighbours, const CornerNormals& corners) {
  return EdgeBallFinder(mesh, neighbours, corners).find();
}

}  // namespace pincer::contact
