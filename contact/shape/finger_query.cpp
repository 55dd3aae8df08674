#include "pincer/contact/finger_query.h"

#include <type_traits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/smooth_mesh.h"

namespace pincer::contact {
namespace {

SurfaceContacts contactAt(const NearestPoint& s, double r) {
  SurfaceContacts found;
  PINCER_ASSERT(isUnitIfFinite(s.n_B));
  found.points[0] = {s.p_BS, s.n_B, s.distance - r, 0};
  found.count = 1;
  return found;
}

}  // namespace

SurfaceContacts querySphere(const Shape& shape, const Vec3& p_BC, double r, double margin, SurfaceTracker& tracker, PatchCache& cache) {
  PINCER_ASSERT(r > 0 && !(margin < 0));
  return std::visit(
      [&](const auto& solid) -> SurfaceContacts {
        if constexpr (std::is_same_v<decltype(solid), const Mesh&>) {
          return solid.surface->querySphere(p_BC, r, margin, tracker, cache);
        } else {
          return contactAt(nearestPoint(solid, p_BC), r);
        }
      },
      shape);
}

namespace {

constexpr int kMostFingerQueries = 24;
constexpr double kCoreAtRest = 1e-10;   // of the finger's size: the core's deepest place moves no further
constexpr double kShortestStep = 0.01;  // of the rounding: the surface's shading and its shape disagree about where to go on
constexpr double kDescent = 1e-4;       // of |way|^2 / tau, by which a step must come deeper (Armijo)
constexpr double kLongestStep = 100;    // of the finger's size: against a plane, a step finds the support point to a hundredth

// One finger in front of one shape.
class FingerDescent {
 public:
  FingerDescent(const Shape& shape, const FingerShape& finger, const Pose& X_BF, double margin, FingerTracker& tracker, PatchCache& cache)
      : shape_(shape),
        finger_(finger),
        R_BF_(X_BF.q.toRotationMatrix()),
        p_BF_(X_BF.p),
        rho_(roundingOf(finger)),
        size_(boundingRadiusOf(finger)),
        margin_(margin),
        tracker_(tracker),
        cache_(cache) {}

  FingerContacts run() {
    Vec3 c = tracker_.warm ? tracker_.c_F : nearestOnCore(finger_, R_BF_.transpose() * -p_BF_, -Vec3::UnitZ());
    SurfaceContacts found = at(c, 0);
    double tau = kLongestStep * size_;
    bool moved_on = false;  // the last query was of a place that wasn't taken
    while (out_.queries < kMostFingerQueries) {
      const Vec3 N_F = R_BF_.transpose() * found.main().n_B;
      const Vec3 next = nearestOnCore(finger_, c - tau * N_F, -N_F);
      const Vec3 way = next - c;
      if (way.norm() <= kCoreAtRest * size_ || tau < kShortestStep * rho_) break;
      const SurfaceContacts there = at(next, 0);
      moved_on = there.main().phi > found.main().phi - kDescent * way.squaredNorm() / tau;
      if (moved_on) {
        tau *= 0.25;
        continue;
      }
      tau = stepLength(way, R_BF_.transpose() * there.main().n_B - N_F, tau);
      found = there;
      c = next;
    }
    if (moved_on) found = at(c, 0);
    tracker_.c_F = c;
    tracker_.warm = true;
    for (int i = 0; i < found.count; ++i) add(found.points[static_cast<std::size_t>(i)], 0);
    if (const auto* capsule = std::get_if<CapsuleTip>(&finger_)) addEnds(*capsule, c);
    return out_;
  }

 private:
  SurfaceContacts at(const Vec3& c_F, std::size_t ball) {
    ++out_.queries;
    return querySphere(shape_, p_BF_ + R_BF_ * c_F, rho_, margin_, tracker_.balls[ball], cache_);
  }

  // Of the two lengths the shorter one; a normal that doesn't turn is a plane's.
  double stepLength(const Vec3& way, const Vec3& turn, double last) const {
    const double along = way.dot(turn), turn2 = turn.squaredNorm();
    if (!(along > 0)) return turn2 > 0 ? 0.5 * last : kLongestStep * size_;
    return std::min(along / turn2, kLongestStep * size_);
  }

  void add(const SurfaceContact& point, std::uint32_t ball) {
    PINCER_ASSERT(out_.count < kMaxFingerContacts);
    const auto i = static_cast<std::size_t>(out_.count++);
    out_.points[i] = point;
    out_.points[i].feature = ball * kMaxSurfaceContacts + point.feature;
    out_.p_BT[i] = point.p_BS + point.phi * point.n_B;
  }

  // Ends that come within the margin, where they aren't the deepest place themselves.
  void addEnds(const CapsuleTip& capsule, const Vec3& c) {
    constexpr double kApart = 1e-3;  // of the capsule's half length
    for (const int end : {1, 2}) {
      const Vec3 c_end = (end == 1 ? -1.0 : 1.0) * capsule.half_F;
      if ((c_end - c).norm() < kApart * capsule.half_F.norm()) continue;
      const SurfaceContact point = at(c_end, static_cast<std::size_t>(end)).main();
      if (point.phi < margin_) add(point, static_cast<std::uint32_t>(end));
    }
  }

  const Shape& shape_;
  const FingerShape& finger_;
  const Mat3 R_BF_;
  const Vec3 p_BF_;
  const double rho_, size_, margin_;
  FingerTracker& tracker_;
  PatchCache& cache_;
  FingerContacts out_;
};

}  // namespace

FingerContacts queryFinger(const Shape& shape, const FingerShape& finger, const Pose& X_BF, double margin, FingerTracker& tracker,
                           PatchCache& cache) {
  PINCER_ASSERT(isUnitIfFinite(X_BF.q));
  return FingerDescent(shape, finger, X_BF, margin, tracker, cache).run();
}

double lowerBoundOfGap(const Shape& shape, const Vec3& p_BC, double r) {
  if (const auto* half_space = std::get_if<HalfSpace>(&shape)) return nearestPoint(*half_space, p_BC).distance - r;
  if (const auto* dish = std::get_if<Dish>(&shape)) return nearestPoint(*dish, p_BC).distance - r;
  return p_BC.norm() - boundingRadius(shape) - r;
}

}  // namespace pincer::contact
