#include "pincer/contact/finger_query.h"

#include <algorithm>
#include <type_traits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/shape/convex_features.h"
#include "pincer/contact/shape/pad_contacts.h"
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
  PINCER_ASSERT(r >= 0 && !(margin < 0));
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

// A pad's patch, see pad_contacts.h; where it touches nothing yet its nearest place, and of a curved surface also the nearest of each edge of
// the facet that faces it.
class PadQuery {
 public:
  PadQuery(const Shape& shape, const PadTip& pad, const FingerShape& finger, const Pose& X_BF, double margin, FingerTracker& tracker,
           PatchCache& cache)
      : shape_(shape), pad_(pad), finger_(finger), X_BF_(X_BF), margin_(margin), tracker_(tracker), cache_(cache) {}

  FingerContacts run() { return std::holds_alternative<Mesh>(shape_) ? onMesh() : onSolid(); }

 private:
  // Meshes keep the followed contact there; a solid's pad the normal of its last patch.
  Vec3& lastNormal() { return tracker_.balls[0].slots[0].n_B; }

  FingerContacts nearest() { return FingerDescent(shape_, finger_, X_BF_, margin_, tracker_, cache_).run(); }

  FingerContacts onSolid() {
    PairPoints patch;
    padOnShape(pad_, X_BF_, shape_, margin_, tracker_.warm ? lastNormal() : Vec3(Vec3::Zero()), cache_, patch);
    if (patch.count == 0) return nearest();
    const FingerContacts found = contactsOf(patch);
    const SurfaceContact& main = found.main();
    lastNormal() = main.n_B;
    tracker_.c_F = X_BF_.inverse() * (main.p_BS + (main.phi + pad_.rounding) * main.n_B);
    tracker_.warm = true;
    return found;
  }

  FingerContacts onMesh() {
    FingerContacts found = nearest();
    if (!(found.main().phi < margin_)) return found;
    PairPoints patch;
    padOnShape(pad_, X_BF_, shape_, margin_, Vec3::Zero(), cache_, patch);
    if (isFlat(patch, found.main())) return contactsOf(patch);
    addEdges(found);
    return found;
  }

  // Whether the flat triangles are the surface where the smooth one is touched: they answer with the same gap and normal, in more than one place.
  bool isFlat(const PairPoints& patch, const SurfaceContact& main) const {
    constexpr double kSameGap = 1e-6;     // of the pad's size
    constexpr double kSameNormal = 1e-4;  // [rad]
    int alike = 0;
    double least = kInfinity;
    for (int i = 0; i < patch.count; ++i) {
      const PairPoint& p = patch.points[static_cast<std::size_t>(i)];
      least = std::min(least, p.phi);
      alike += (p.n_W - main.n_B).squaredNorm() < kSameNormal * kSameNormal;
    }
    const double eased = tracker_.balls[0].slots[main.feature % kMaxSurfaceContacts].ease;
    return alike > 1 && std::abs(least - (main.phi - eased)) < kSameGap * boundingRadiusOf(finger_);
  }

  // The deepest first; of more than there is room for the deepest.
  FingerContacts contactsOf(PairPoints& patch) const {
    std::sort(patch.points.begin(), patch.points.begin() + patch.count,
              [](const PairPoint& x, const PairPoint& y) { return x.phi < y.phi || (x.phi == y.phi && x.feature < y.feature); });
    FingerContacts found;
    found.queries = 1;
    found.count = std::min(patch.count, kMaxFingerContacts);
    for (int i = 0; i < found.count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const PairPoint& p = patch.points[at];
      found.points[at] = {p.p_W - 0.5 * p.phi * p.n_W, p.n_W, p.phi, p.feature};
      found.p_BT[at] = p.p_W + 0.5 * p.phi * p.n_W;
    }
    return found;
  }

  // Along the facet's edges, each a capsule that searches from where the main contact is.
  void addEdges(FingerContacts& found) {
    constexpr std::uint32_t kFirstEdge = 16;  // feature: above those of balls
    Facet facet;
    facetOf(Convex{pad_.hull}, X_BF_.q.conjugate() * -found.main().n_B, facet);
    for (int k = 0; k < facet.count && found.count < kMaxFingerContacts; ++k) {
      const FacetCorner &from = facet.corners[static_cast<std::size_t>(k)],
                        &to = facet.corners[static_cast<std::size_t>((k + 1) % facet.count)];
      FingerTracker tracker;
      tracker.balls[0] = tracker_.balls[0];
      const FingerShape edge = CapsuleTip{pad_.rounding, 0.5 * (to.p - from.p)};
      const Pose X_BE{X_BF_.q, X_BF_ * (0.5 * (from.p + to.p))};
      FingerContacts there = FingerDescent(shape_, edge, X_BE, 0, tracker, cache_).run();
      found.queries += there.queries;
      if (!(there.main().phi < margin_) || isKnown(found, there.p_BT[0])) continue;
      const auto i = static_cast<std::size_t>(found.count++);
      found.points[i] = there.main();
      found.points[i].feature = kFirstEdge + from.edge;
      found.p_BT[i] = there.p_BT[0];
    }
  }

  bool isKnown(const FingerContacts& found, const Vec3& p_BT) const {
    constexpr double kApart = 1e-3;  // of the pad's size
    for (int i = 0; i < found.count; ++i) {
      if ((found.p_BT[static_cast<std::size_t>(i)] - p_BT).norm() < kApart * boundingRadiusOf(finger_)) return true;
    }
    return false;
  }

  const Shape& shape_;
  const PadTip& pad_;
  const FingerShape& finger_;
  const Pose& X_BF_;
  const double margin_;
  FingerTracker& tracker_;
  PatchCache& cache_;
};

}  // namespace

FingerContacts queryFinger(const Shape& shape, const FingerShape& finger, const Pose& X_BF, double margin, FingerTracker& tracker,
                           PatchCache& cache) {
  PINCER_ASSERT(isUnitIfFinite(X_BF.q));
  if (const auto* pad = std::get_if<PadTip>(&finger)) return PadQuery(shape, *pad, finger, X_BF, margin, tracker, cache).run();
  return FingerDescent(shape, finger, X_BF, margin, tracker, cache).run();
}

double lowerBoundOfGap(const Shape& shape, const Vec3& p_BC, double r) {
  if (const auto* half_space = std::get_if<HalfSpace>(&shape)) return nearestPoint(*half_space, p_BC).distance - r;
  if (const auto* dish = std::get_if<Dish>(&shape)) return nearestPoint(*dish, p_BC).distance - r;
  return p_BC.norm() - boundingRadius(shape) - r;
}

}  // namespace pincer::contact
