// pairs: one query of a pair of bodies, and what tests ask of its answer.
#pragma once
#include <cstdint>
#include <limits>
#include <set>

#include "pincer/contact/pair_query.h"
#include "pincer/contact/shape/separation.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/random_poses.h"

namespace pincer::tests {

constexpr double kEverything = 1;  // [m] a margin that holds any gap

inline contact::PairPoints collide(const contact::Shape& a, const Pose& X_WA, const contact::Shape& b, const Pose& X_WB,
                                   double margin = kEverything) {
  contact::PatchCache cache(64);
  contact::PairPoints out;
  contact::collideShapes(a, X_WA, b, X_WB, margin, cache, out);
  return out;
}

inline double leastGap(const contact::PairPoints& p) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < p.count; ++i) least = std::min(least, p.points[static_cast<std::size_t>(i)].phi);
  return least;
}

inline std::set<std::uint32_t> featuresOf(const contact::PairPoints& p) {
  std::set<std::uint32_t> features;
  for (int i = 0; i < p.count; ++i) features.insert(p.points[static_cast<std::size_t>(i)].feature);
  return features;
}

// b at the origin, a turned by `q` in that direction from it, about `gap` [m] from it (negative: it overlaps).
inline Pose besideAt(const Quat& q, const Vec3& direction, const contact::Shape& a, const contact::Shape& b,
                     double gap) {
  Pose X_BA{q, 0.1 * direction};
  for (int i = 0; i < 8; ++i) {
    const contact::PosedSolid A{a, X_BA.q.toRotationMatrix(), X_BA.p}, B{b, Mat3::Identity(), Vec3::Zero()};
    const contact::Separation s = contact::separate(A, B, 0.03);
    X_BA.p += (gap - s.gap + contact::roundingOf(a) + contact::roundingOf(b)) * s.n;
  }
  return X_BA;
}

// The same of any pose.
inline Pose around(RandomNumbers& random, const contact::Shape& a, const contact::Shape& b, double gap) {
  const Quat q = rotation(random);
  return besideAt(q, direction(random), a, b, gap);
}

}  // namespace pincer::tests
