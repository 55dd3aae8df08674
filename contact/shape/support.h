// support: the two static surfaces on which solids rest, seen from the solid's frame A.
//
//   plane  gap(p) = n . p - d                         n_A unit normal out of the support, d [m]
//   bowl   gap(p) = R - |p - m|,  n = (m - p)/|m - p|  m_A centre of curvature [m], R radius [m]
//
// Both gaps are concave and fall by at most 1 m per m: a convex solid is nearest to either at one of its extreme points
// (vertices, rims, ends), and no nearer than gap(origin) - bounding radius.
//   sieve(g)    bowl: false only of points whose gap isn't below g, so that a scan over many needs no roots
//   steepest()  the direction in A's xy-plane in which the gap falls fastest, times that rate (at the
//               solid's axis; bowl: seen from m) [-]; of a circle about A's z axis the point in that
//               direction is the deepest, exactly, for both
#pragma once
#include "pincer/contact/math.h"
#include "pincer/contact/shape.h"
#include "pincer/contact/shape/direction.h"

namespace pincer::contact {

// Frame A with the rotation as a matrix: it turns more than two vectors per pair, where
// a matrix is cheaper than the quaternion.
struct SolidFrame {
  Mat3 R_WA;
  Vec3 p_WA;

  explicit SolidFrame(const Pose& X_WA) : R_WA(X_WA.q.toRotationMatrix()), p_WA(X_WA.p) {}
  // Written out by columns: Eigen's 3x3 product is a call of its own here and cost a resting box 15 ns of 95.
  Vec3 toWorld(const Vec3& v_A) const { return v_A.x() * R_WA.col(0) + v_A.y() * R_WA.col(1) + v_A.z() * R_WA.col(2); }
  Vec3 fromWorld(const Vec3& v_W) const { return {R_WA.col(0).dot(v_W), R_WA.col(1).dot(v_W), R_WA.col(2).dot(v_W)}; }
};

class PlaneSupport {
 public:
  PlaneSupport(const HalfSpace&, const Pose& X_WB, const SolidFrame& A)
      : n_W_(X_WB.q * Vec3::UnitZ()), n_A_(A.fromWorld(n_W_)), d_(n_W_.dot(X_WB.p - A.p_WA)) {}
  double gap(const Vec3& p_A) const { return n_A_.dot(p_A) - d_; }
  Vec3 normal(const Vec3&) const { return n_A_; }
  Vec3 normalInWorld(const Vec3&, const SolidFrame&) const { return n_W_; }
  Vec2 steepest() const { return -n_A_.head<2>(); }

 private:
  Vec3 n_W_;
  Vec3 n_A_;
  double d_;
};

class BowlSupport {
 public:
  BowlSupport(const Dish& dish, const Pose& X_WB, const SolidFrame& A)
      : m_A_(A.fromWorld(X_WB * Vec3(0, 0, dish.radius) - A.p_WA)), radius_(dish.radius) {}
  double gap(const Vec3& p_A) const { return radius_ - (p_A - m_A_).norm(); }
  auto sieve(double gap) const {
    constexpr double kRounded = 1 - 1e-12;  // more than round-off changes
    const double reach = kRounded * (radius_ - gap), reach2 = reach > 0 ? reach * reach : -1;
    return [reach2, m_A = m_A_](const Vec3& p_A) { return (p_A - m_A).squaredNorm() > reach2; };
  }
  Vec3 normal(const Vec3& p_A) const { return directionOf<Vec3>(m_A_ - p_A, Vec3::UnitZ()).n; }
  Vec3 normalInWorld(const Vec3& p_A, const SolidFrame& A) const { return A.toWorld(normal(p_A)); }
  Vec2 steepest() const { return -m_A_.head<2>() / radius_; }

 private:
  Vec3 m_A_;
  double radius_;
};

}  // namespace pincer::contact
