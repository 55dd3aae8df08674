#include "pincer/contact/shape/core_descent.h"

#include <algorithm>

#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {
namespace {

constexpr double kCoreAtRest = 1e-10;  // of the finger's size: the core's deepest place moves no further
// of the rounding: the surface's shading and its shape disagree about where to go on
constexpr double kShortestStep = 0.01;
// [rad] of the way to a place: the surface there is level, and all of it the deepest
constexpr double kNoDeeper = 1e-10;
constexpr double kDescent = 1e-4;  // of |way|^2 / tau, by which a step must come deeper (Armijo)
// of the finger's size: against a plane, a step finds the support point to a hundredth
constexpr double kLongestStep = 100;

// Barzilai and Borwein's length; of the two the shorter one. A normal that doesn't turn is a plane's.
double stepLength(const Vec3& way, const Vec3& turn, double last, double longest) {
  const double along = way.dot(turn), turn2 = turn.squaredNorm();
  if (!(along > 0)) return turn2 > 0 ? 0.5 * last : longest;
  return std::min(along / turn2, longest);
}

}  // namespace

CoreDescent descend(const Shape& shape, const FingerShape& finger, const Pose& X_BF, double margin,
                    CoreTracker& tracker, PatchCache& cache) {
  const Mat3 R_BF = X_BF.q.toRotationMatrix();
  const double rho = roundingOf(finger), size = boundingRadiusOf(finger);
  CoreDescent out;
  const auto at = [&](const Vec3& c_F) {
    ++out.queries;
    return querySphere(shape, X_BF.p + R_BF * c_F, rho, margin, tracker.ball, cache);
  };
  out.c_F = tracker.warm ? tracker.c_F : nearestOnCore(finger, R_BF.transpose() * -X_BF.p, -Vec3::UnitZ());
  out.found = at(out.c_F);
  double tau = tracker.warm ? size : kLongestStep * size;  // near the place every step is short
  bool moved_on = false;                                   // the last query was of a place that wasn't taken
  while (out.queries < kMostQueries) {
    const Vec3 N_F = R_BF.transpose() * out.found.main().n_B;
    const Vec3 next = nearestOnCore(finger, out.c_F - tau * N_F, -N_F);
    const Vec3 way = next - out.c_F;
    if (way.norm() <= kCoreAtRest * size || tau < kShortestStep * rho || -N_F.dot(way) < kNoDeeper * way.norm()) break;
    const SurfaceContacts there = at(next);
    moved_on = there.main().phi > out.found.main().phi - kDescent * way.squaredNorm() / tau;
    if (moved_on) {
      tau *= 0.25;
      continue;
    }
    tau = stepLength(way, R_BF.transpose() * there.main().n_B - N_F, tau, kLongestStep * size);
    out.found = there;
    out.c_F = next;
  }
  if (moved_on) out.found = at(out.c_F);
  tracker.c_F = out.c_F;
  tracker.warm = true;
  return out;
}

}  // namespace pincer::contact
