// Joined bodies as contacts see them: the factor F of their inverse mass.
#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/tree/loop_basis.h"
#include "pincer/engine/world/joints.h"

namespace pincer::engine {
namespace {

// Orthonormal vectors of dimension `size`, first those of the hard rows, then what is free.
class Basis {
 public:
  Basis(double* memory, int size) : v_(memory), size_(size) {}

  // Takes the part of v that is new; false if nothing is.
  bool add(const double* v) {
    if (count_ == size_) return false;  // it spans all, so that nothing is new
    double* const w = v_ + static_cast<std::ptrdiff_t>(count_) * size_;
    std::copy(v, v + size_, w);
    const double before = std::sqrt(dot(w, w));
    for (int twice = 0; twice < 2; ++twice) {
      for (int q = 0; q < count_; ++q) subtract(w, vector(q));
    }
    const double after = std::sqrt(dot(w, w));
    if (!(after > kNothingNew * before)) return false;
    for (int i = 0; i < size_; ++i) w[i] /= after;
    ++count_;
    return true;
  }

  // Adds the unit vector that the basis covers least.
  bool addFreest() {
    int freest = 0;
    double least = 2;
    for (int i = 0; i < size_; ++i) {
      double covered = 0;
      for (int q = 0; q < count_; ++q) covered += vector(q)[i] * vector(q)[i];
      if (covered >= least - 1e-12) continue;
      least = covered;
      freest = i;
    }
    double unit[kMostGroupFreedoms] = {};
    unit[freest] = 1;
    return add(unit);
  }

  const double* vector(int q) const { return v_ + static_cast<std::ptrdiff_t>(q) * size_; }
  int count() const { return count_; }

 private:
  double dot(const double* a, const double* b) const {
    double sum = 0;
    for (int i = 0; i < size_; ++i) sum += a[i] * b[i];
    return sum;
  }
  void subtract(double* w, const double* q) const {
    const double along = dot(w, q);
    for (int i = 0; i < size_; ++i) w[i] -= along * q[i];
  }

  double* v_;
  int size_, count_ = 0;
};

// S of one body: its columns are those of sqrt(1/m) and of R diag(1 / sqrt(I_k)).
struct RootOfMass {
  double linear;
  Mat3 angular;
};

RootOfMass rootOfMass(const BodyModel& body, const Quat& q_WI) {
  RootOfMass S{std::sqrt(body.inverse_mass), q_WI.toRotationMatrix()};
  for (int k = 0; k < 3; ++k) S.angular.col(k) *= std::sqrt(body.rotation.inverse_moments[k]);
  return S;
}

int placeInGroup(const JointGroup& g, int body) {
  const auto place = std::lower_bound(g.bodies.begin(), g.bodies.end(), body);
  PINCER_ASSERT(place != g.bodies.end() && *place == body);
  return static_cast<int>(place - g.bodies.begin());
}

// The row's S^T g, in the order of the group's bodies.
void scaledRow(const WorldModel& model, const WorldScratch& scratch, const JointGroup& g, const JointRow& row,
               double* out) {
  std::fill(out, out + 6 * g.bodies.size(), 0.0);
  for (int side = 0; side < 2; ++side) {
    const int body = side == 0 ? row.a : row.b;
    if (body < 0 || !model.bodies[body].dynamic) continue;
    const double sign = side == 0 ? 1 : -1;
    const RootOfMass S = rootOfMass(model.bodies[body], scratch.bodies[body].X_WI_mid.q);
    double* const to = out + std::ptrdiff_t{6} * placeInGroup(g, body);
    const Vec3 lin = sign * S.linear * row.n_W,
               ang = sign * (S.angular.transpose() * (side == 0 ? row.ang_a_W : row.ang_b_W));
    for (int i = 0; i < 3; ++i) {
      to[i] += lin[i];
      to[3 + i] += ang[i];
    }
  }
}

// L L^T of 1 + sum d d^T / R, in place of N: its columns divided by L^T from the right.
void applyDampers(const WorldModel& model, const WorldScratch& scratch, const JointGroup& g,
                  const JointGroupScratch& group, int size, int free, double* N) {
  double mass[kMoverFreedoms][kMoverFreedoms] = {};
  for (int i = 0; i < free; ++i) mass[i][i] = 1;
  for (const JointRow& row : group.rows) {
    if (!(row.softness > 0)) continue;
    double g_hat[kMostGroupFreedoms], d[kMoverFreedoms];
    scaledRow(model, scratch, g, row, g_hat);
    for (int i = 0; i < free; ++i) {
      d[i] = 0;
      for (int k = 0; k < size; ++k) d[i] += N[i * size + k] * g_hat[k];
    }
    for (int i = 0; i < free; ++i) {
      for (int j = 0; j <= i; ++j) mass[i][j] += d[i] * d[j] / row.softness;
    }
  }
  for (int i = 0; i < free; ++i) {  // Cholesky, and N L^-T column by column
    for (int j = 0; j <= i; ++j) {
      for (int k = 0; k < j; ++k) mass[i][j] -= mass[i][k] * mass[j][k];
      PINCER_ASSERT(i != j || !(mass[i][i] <= 0));
      mass[i][j] = i == j ? std::sqrt(mass[i][i]) : mass[i][j] / mass[j][j];
    }
    for (int k = 0; k < size; ++k) {
      for (int j = 0; j < i; ++j) N[i * size + k] -= mass[i][j] * N[j * size + k];
      N[i * size + k] /= mass[i][i];
    }
  }
}

}  // namespace

void factoriseInverseMass(const WorldModel& model, const WorldScratch& scratch, const JointGroup& g,
                          JointGroupScratch& group) {
  const int size = 6 * static_cast<int>(g.bodies.size());
  std::fill(group.factor.begin(), group.factor.end(), 0.0);
  if (size > kMostGroupFreedoms) return;
  Basis basis(group.basis.data(), size);
  double row_hat[kMostGroupFreedoms];
  bool damped = false;
  for (const JointRow& row : group.rows) {
    damped = damped || row.softness > 0;
    if (row.softness > 0) continue;
    scaledRow(model, scratch, g, row, row_hat);
    basis.add(row_hat);
  }
  const int hard = basis.count(), free = size - hard;
  if (free > kMoverFreedoms) return;
  while (basis.count() < size && basis.addFreest()) {
  }
  double* const N = group.basis.data() + static_cast<std::ptrdiff_t>(hard) * size;
  if (damped) applyDampers(model, scratch, g, group, size, free, N);
  for (int b = 0; b < static_cast<int>(g.bodies.size()); ++b) {
    const RootOfMass S = rootOfMass(model.bodies[g.bodies[b]], scratch.bodies[g.bodies[b]].X_WI_mid.q);
    for (int j = 0; j < free; ++j) {
      const double* const from = N + static_cast<std::ptrdiff_t>(j) * size + std::ptrdiff_t{6} * b;
      double* const to = group.factor.data() + std::ptrdiff_t{6} * (b * kMoverFreedoms + j);
      const Vec3 ang = S.angular * Vec3(from[3], from[4], from[5]);
      for (int i = 0; i < 3; ++i) {
        to[i] = S.linear * from[i];
        to[3 + i] = ang[i];
      }
    }
  }
}

void addJointedSide(const WorldModel& model, const WorldScratch& scratch, const Contact& c, int rows, double sign,
                    int body, const Vec3& arm_W, ContactSide& out) {
  const int n = model.bodies[body].joint_group;
  const JointGroupScratch& group = scratch.joint_groups[n];
  const double* const F =
      group.factor.data() + std::ptrdiff_t{6} * kMoverFreedoms * placeInGroup(model.joint_groups[n], body);
  for (int k = 0; k < rows; ++k) {
    const Vec3 lin = k < 3 ? Vec3(c.R_WC.col(k)) : Vec3::Zero();
    const Vec3 ang = k < 3 ? Vec3(arm_W.cross(lin)) : Vec3(radiusOf(c, k) * axisOf(c, k));
    for (int j = 0; j < kMoverFreedoms; ++j) {
      const double* const column = F + std::ptrdiff_t{6} * j;
      double sum = 0;
      for (int l = 0; l < 3; ++l) sum += lin[l] * column[l] + ang[l] * column[3 + l];
      out.A[k][j] += sign * sum;
    }
  }
}

}  // namespace pincer::engine
