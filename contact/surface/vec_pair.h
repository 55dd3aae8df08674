// vec_pair: two vectors side by side, a component of both in one register. What is written once for Vec3 and this gives
// the same bits with both: sums are taken in Eigen's order.
#pragma once
#include <array>
#include <cmath>

#include "pincer/contact/math.h"

namespace pincer::contact {

using Two = double __attribute__((vector_size(16)));  // one instruction for both

inline Two squareRoots(Two a) { return Two{std::sqrt(a[0]), std::sqrt(a[1])}; }
inline double squareRoots(double a) { return std::sqrt(a); }

struct VecPair {
  Two x, y, z;

  VecPair(Two x_, Two y_, Two z_) : x(x_), y(y_), z(z_) {}
  VecPair(const Vec3& a, const Vec3& b) : x{a.x(), b.x()}, y{a.y(), b.y()}, z{a.z(), b.z()} {}
  Vec3 first() const { return {x[0], y[0], z[0]}; }
  Vec3 second() const { return {x[1], y[1], z[1]}; }

  Two dot(const VecPair& b) const { return x * b.x + y * b.y + z * b.z; }
  Two squaredNorm() const { return dot(*this); }
};

inline VecPair operator+(const VecPair& a, const VecPair& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline VecPair operator-(const VecPair& a, const VecPair& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline VecPair operator*(Two s, const VecPair& a) { return {s * a.x, s * a.y, s * a.z}; }
inline VecPair operator*(double s, const VecPair& a) { return {s * a.x, s * a.y, s * a.z}; }

}  // namespace pincer::contact
