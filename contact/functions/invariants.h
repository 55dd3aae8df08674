// invariants: what asserts ask of numbers, vectors, frames and lists
// (contact/assert.h). For sources: no public header needs it.
#pragma once
#include <cmath>
#include <cstddef>
#include <functional>

#include "pincer/contact/assert.h"
#include "pincer/contact/math.h"

namespace pincer {

// |v|^2 of a normalised vector misses 1 by some 4e-16, and by as much again per rotation; chains
// of a thousand rotations lie within this.
constexpr double kUnitRoundOff = 1e-12;

inline bool isUnit(const Vec3& v) { return std::abs(v.squaredNorm() - 1) <= kUnitRoundOff; }
inline bool isUnit(const Quat& q) { return std::abs(q.squaredNorm() - 1) <= kUnitRoundOff; }
// For what a tick goes through: it hands on what isn't finite, and says so in its status (engine/world/step.h).
template <class Vector>
bool isUnitIfFinite(const Vector& v) {
  return isUnit(v) || !std::isfinite(v.squaredNorm());
}

// True if the columns are orthonormal and right-handed.
inline bool isRotation(const Mat3& R) {
  return (R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() <= kUnitRoundOff && R.determinant() > 0;
}
inline bool isRotationIfFinite(const Mat3& R) { return isRotation(R) || !R.allFinite(); }
// True if A differs from its transpose by round-off only.
inline bool isSymmetric(const Mat3& A) {
  return (A - A.transpose()).cwiseAbs().maxCoeff() <= kUnitRoundOff * A.cwiseAbs().maxCoeff();
}

inline bool isFiniteAndPositive(double x) { return x > 0 && x < kInfinity; }
inline bool isFiniteAndNotNegative(double x) { return x >= 0 && x < kInfinity; }

// True if `i` is an index of something that has `size` entries.
inline bool isIndex(std::ptrdiff_t i, std::size_t size) { return i >= 0 && static_cast<std::size_t>(i) < size; }

// True if key(x) rises strictly from entry to entry.
template <class Range, class Key>
bool isAscending(const Range& range, Key key) {
  for (std::size_t i = 1; i < range.size(); ++i) {
    if (!(std::invoke(key, range[i - 1]) < std::invoke(key, range[i]))) return false;
  }
  return true;
}

}  // namespace pincer
