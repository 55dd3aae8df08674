#include "pincer/grasp/baseline/nearest_outside.h"

#include <Eigen/LU>

#include "pincer/contact/functions/invariants.h"

namespace pincer::grasp {
namespace {

constexpr double kOnPlane = 1e-12;   // [m]
constexpr double kParallel = 1e-10;  // determinant of the normals' products from which they count as independent

using PlaneSet = std::array<int, 3>;

bool isOutside(std::span<const OuterSide> planes, const Vec3& x) {
  for (const OuterSide& plane : planes) {
    if (plane.n.dot(x) < plane.b - kOnPlane) return false;
  }
  return true;
}

// With exactly the first `count` planes of `set` active; false if they depend on each other or pull.
bool solveActive(std::span<const OuterSide> planes, const PlaneSet& set, int count, const Vec3& goal,
                 NearestOutside& out) {
  Mat3 A = Mat3::Identity();
  Vec3 rhs = Vec3::Zero();
  for (int i = 0; i < count; ++i) {
    const OuterSide& p = planes[static_cast<std::size_t>(set[static_cast<std::size_t>(i)])];
    rhs[i] = p.b - p.n.dot(goal);
    for (int j = 0; j < count; ++j)
      A(i, j) = p.n.dot(planes[static_cast<std::size_t>(set[static_cast<std::size_t>(j)])].n);
  }
  if (A.determinant() < kParallel) return false;
  const Vec3 lambda = A.inverse() * rhs;
  out = {goal, {}};
  for (int i = 0; i < count; ++i) {
    if (lambda[i] < 0) return false;
    const auto k = static_cast<std::size_t>(set[static_cast<std::size_t>(i)]);
    out.lambda[k] = lambda[i];
    out.x += lambda[i] * planes[k].n;
  }
  return isOutside(planes, out.x);
}

}  // namespace

NearestOutside nearestOutside(std::span<const OuterSide> planes, const Vec3& goal) {
  PINCER_ASSERT(planes.size() <= static_cast<std::size_t>(kMostPlanes));
  PINCER_ASSERT(
      std::all_of(planes.begin(), planes.end(), [](const OuterSide& plane) { return isUnitIfFinite(plane.n); }));
  NearestOutside trial{goal, {}};
  if (isOutside(planes, goal)) return trial;
  const int n = static_cast<int>(planes.size());
  for (int i = 0; i < n; ++i) {
    if (solveActive(planes, {i, 0, 0}, 1, goal, trial))
      return trial;  // these conditions are those of the minimum: the first that fits is it
  }
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      if (solveActive(planes, {i, j, 0}, 2, goal, trial)) return trial;
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        if (solveActive(planes, {i, j, k}, 3, goal, trial)) return trial;
      }
    }
  }
  trial = {goal, {}};
  for (std::size_t i = 0; i < planes.size(); ++i) {
    trial.lambda[i] = std::max(planes[i].b - planes[i].n.dot(trial.x), 0.0);
    trial.x += trial.lambda[i] * planes[i].n;
  }
  return trial;
}

}  // namespace pincer::grasp
