#include "pincer/contact/shape/pad_query.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/convex_features.h"
#include "pincer/contact/shape/core_descent.h"
#include "pincer/contact/shape/pad_contacts.h"
#include "pincer/contact/shape/tolerances.h"
#include "pincer/contact/shape/wall_line.h"
#include "pincer/contact/shape/wander.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/mesh_features.h"
#include "pincer/contact/surface/surface_net.h"

namespace pincer::contact {
namespace {

void add(const SurfaceContact& point, FingerContacts& out) {
  PINCER_ASSERT(out.count < kMaxFingerContacts);
  const auto i = static_cast<std::size_t>(out.count++);
  out.points[i] = point;
  out.p_BT[i] = point.p_BS + point.phi * point.n_B;
}

bool isBefore(const PairPoint& x, const PairPoint& y) {
  return x.phi < y.phi || (x.phi == y.phi && x.feature < y.feature);
}
// The deepest first; of more than there is room for the deepest. In place of what `found` holds.
void takePatch(const PairPoints& patch, FingerContacts& found) {
  std::array<const PairPoint*, kMaxPairPoints> order;
  int sorted = 0;
  for (; sorted < patch.count; ++sorted) {
    const PairPoint* const p = &patch.points[static_cast<std::size_t>(sorted)];
    auto at = static_cast<std::size_t>(sorted);
    for (; at > 0 && isBefore(*p, *order[at - 1]); --at) order[at] = order[at - 1];
    order[at] = p;
  }
  found.queries = 1;
  found.count = std::min(patch.count, kMaxFingerContacts);
  for (std::size_t i = 0; i < static_cast<std::size_t>(found.count); ++i) {
    const PairPoint& p = *order[i];
    SurfaceContact& point = found.points[i];  // where it belongs at once
    point.p_BS = p.p_W - 0.5 * p.phi * p.n_W;
    point.n_B = p.n_W;
    point.phi = p.phi;
    point.feature = p.feature;
    found.p_BT[i] = point.p_BS + point.phi * point.n_B;
  }
}

class PadQuery {
 public:
  PadQuery(const Shape& shape, const FingerShape& finger, const Pose& X_BF, double margin, FingerTracker& tracker,
           PatchCache& cache)
      : shape_(shape),
        pad_(std::get<PadTip>(finger)),
        finger_(finger),
        X_BF_(X_BF),
        margin_(margin),
        size_(boundingRadiusOf(finger)),
        tracker_(tracker),
        cache_(cache) {}

  // `found` is empty.
  void run(FingerContacts& found) {
    if (std::holds_alternative<Mesh>(shape_)) return onMesh(found);
    if (!touchOnFacets(shape_, finger_, X_BF_, margin_, tracker_, cache_, found)) addNearest(found);
  }

 private:
  void addNearest(FingerContacts& found) {
    const CoreDescent deepest = descend(shape_, finger_, X_BF_, margin_, tracker_.main, cache_);
    found.queries = deepest.queries;
    for (int i = 0; i < deepest.found.count; ++i) add(deepest.found.points[static_cast<std::size_t>(i)], found);
  }

  void onMesh(FingerContacts& found) {
    addNearest(found);
    if (!(found.main().phi < margin_)) return;
    PairPoints ends;
    if (touchesWall(found.main(), ends)) return takePatch(ends, found);
    if (mayBeFlat(found.main())) {
      PairPoints patch;
      padOnShape(pad_, X_BF_, shape_, margin_, Vec3::Zero(), cache_, patch);
      if (isFlat(patch, found.main())) return takePatch(patch, found);
    }
    const SurfaceContact main = found.main();
    addFurther(found);
    if (isInsideFacet(main))
      found.wander_B = wanderAt(shape_, main, pad_.rounding, kOnePoint * size_, triedBall(), cache_);
  }

  // From an edge or a corner of the pad the place doesn't wander.
  bool isInsideFacet(const SurfaceContact& main) const {
    Facet facet;
    facetOf(Convex{pad_.hull}, X_BF_.q.conjugate() * -main.n_B, facet);
    const Vec3 n_B = -(X_BF_.q * facet.n);
    for (int k = 0; k < facet.count; ++k) {
      const Vec3 from = cornerOf(facet, k), inwards = n_B.cross(from - cornerOf(facet, k + 1)).normalized();
      if (!(inwards.dot(main.p_BS - from) > kOnePoint * size_)) return false;
    }
    return facet.count > 2;
  }

  // The two ends of the line that a straight wall shares with the facet over it: of the wall, where it ends under the
  // facet, else of the facet. Their gaps are those of the facet's plane. False if there is no such wall.
  bool touchesWall(const SurfaceContact& main, PairPoints& ends) const {
    const std::int32_t t = slotOf(main).triangle;
    if (t < 0) return false;
    Facet facet;
    facetOf(Convex{pad_.hull}, X_BF_.q.conjugate() * -main.n_B, facet);
    const Vec3 n_B = -(X_BF_.q * facet.n);
    if (facet.count < 3 || !faces(n_B, main.n_B)) return false;
    const WallLine wall = wallAt(main, n_B);
    if (!wall.exists() || !faces(n_B, wall.normal())) return false;
    double low = wall.low(), high = wall.high();
    for (int k = 0; k < facet.count; ++k) {
      const Vec3 from = cornerOf(facet, k), inwards = n_B.cross(from - cornerOf(facet, k + 1)).normalized();
      const double inside = inwards.dot(main.p_BS - from), rate = inwards.dot(wall.along());
      if (rate > 0) low = std::max(low, -inside / rate);
      if (rate < 0) high = std::min(high, -inside / rate);
      if (rate == 0 && inside < 0) return false;
    }
    if (!(high - low > kOnePoint * size_)) return false;
    for (const double s : {low, high}) {
      const Vec3 p_BS = main.p_BS + s * wall.along();
      const double phi = n_B.dot(cornerOf(facet, 0) - p_BS) - pad_.rounding;
      if (phi < margin_)
        ends.points[static_cast<std::size_t>(ends.count++)] = {p_BS + 0.5 * phi * n_B, n_B, phi,
                                                               kFirstEnd + (s == high ? 1u : 0u)};
    }
    return ends.count > 0;
  }

  static bool faces(const Vec3& facet_n_B, const Vec3& n_B) {
    constexpr double kFaces = 0.1;  // [rad] between the facet and the wall under it
    return (facet_n_B - n_B).squaredNorm() <= kFaces * kFaces;
  }

  // The wall at the main contact: on a rim that may be the triangle's, or that on the other side.
  WallLine wallAt(const SurfaceContact& main, const Vec3& facet_n_B) const {
    const SurfaceNet& net = std::get<Mesh>(shape_).surface->net();
    const SurfaceSlot& slot = slotOf(main);
    const WallLine wall(net, slot.triangle, main.p_BS);
    if (wall.exists() && faces(facet_n_B, wall.normal())) return wall;
    const std::array<double, 3> corners = {1 - slot.u - slot.v, slot.u, slot.v};
    for (int i = 0; i < 3; ++i) {
      if (corners[static_cast<std::size_t>((i + 2) % 3)] > kOnEdge || !net.isSharp(slot.triangle, i)) continue;
      const Neighbour other = net.neighbour(slot.triangle, i);
      if (other.triangle >= 0) return {net, other.triangle, main.p_BS};
    }
    return wall;
  }

  const SurfaceSlot& slotOf(const SurfaceContact& main) const {
    return tracker_.main.ball.slots[main.feature % kMaxSurfaceContacts];
  }

  // Inside of a flat triangle the smooth surface has its normal: without that the others needn't be asked.
  bool mayBeFlat(const SurfaceContact& main) const {
    const SurfaceSlot& slot = slotOf(main);
    if (slot.triangle < 0 || std::min({slot.u, slot.v, 1 - slot.u - slot.v}) < kOnEdge) return true;
    const MeshFeatures& features = std::get<Mesh>(shape_).surface->features();
    return (features.triangle(slot.triangle).n - main.n_B).squaredNorm() < kSameNormal * kSameNormal;
  }

  // True if the flat triangles are the surface where the smooth one is touched: they answer with a normal like its own
  // in more than one place, no shallower, and there and halfway between two of these the surface has their gap. Of two
  // faces with a gap between them, as of a gear's teeth, only the points stay that have it.
  bool isFlat(PairPoints& patch, const SurfaceContact& main) {
    PairPoint *const first = patch.points.data(), *const end = first + patch.count;
    const PairPoint *deepest = nullptr, *furthest = nullptr;
    for (const PairPoint* p = first; p != end; ++p) {
      if (faces(p->n_W, main.n_B) && (!deepest || p->phi < deepest->phi)) deepest = p;
    }
    if (!deepest || deepest->phi > main.phi - slotOf(main).ease + sameGap()) return false;
    const auto wayTo = [&](const PairPoint& p) { return (p.p_W - deepest->p_W).norm(); };
    const auto isApart = [&](const PairPoint& p) { return faces(p.n_W, main.n_B) && wayTo(p) > kOnePoint * size_; };
    for (const PairPoint* p = first; p != end; ++p) {
      if (isApart(*p) && (!furthest || wayTo(*p) > wayTo(*furthest))) furthest = p;
    }
    if (!furthest || !isLevel(*deepest)) return false;
    if (isLevelBetween(*deepest, *furthest)) return true;
    const auto isPartner = [&](const PairPoint& p) {
      return &p != furthest && isApart(p) && isLevelBetween(*deepest, p);
    };
    if (std::none_of(first, end, isPartner)) return false;
    const auto isOff = [&](const PairPoint& p) { return !isLevel(p); };
    patch.count = static_cast<int>(std::remove_if(first, end, isOff) - first);
    return true;
  }

  double sameGap() const { return 1e-6 * size_; }
  bool isLevelBetween(const PairPoint& a, const PairPoint& b) {
    return isLevel({0.5 * (a.p_W + b.p_W), (a.n_W + b.n_W).normalized(), 0.5 * (a.phi + b.phi), 0});
  }

  // True if the surface has the point's gap: that of a plane, seen along its own normal, where that isn't the point's.
  // A pad leans on a corner of the mesh with the normal of its own face.
  bool isLevel(const PairPoint& point) {
    SurfaceTracker tracker = triedBall();
    const double height = point.phi + pad_.rounding;
    const Vec3 p_BC = point.p_W + (0.5 * point.phi + pad_.rounding) * point.n_W;
    const SurfaceContact found = querySphere(shape_, p_BC, pad_.rounding, 0, tracker, cache_).main();
    return std::abs(found.phi + pad_.rounding - height * found.n_B.dot(point.n_W)) < sameGap();
  }

  // From where the main contact is, with a memory that isn't the main one's.
  SurfaceTracker triedBall() const {
    SurfaceTracker ball = tracker_.main.ball;
    ball.memory += FingerTracker::kMemories - 1;
    return ball;
  }

  // Of the facet that faces the surface: along its edges, each a capsule that searches from where the main contact is,
  // and from its corners downhill. Neither finds a place where the mesh only falls away from the main one.
  void addFurther(FingerContacts& found) {
    Facet facet;
    facetOf(Convex{pad_.hull}, X_BF_.q.conjugate() * -found.main().n_B, facet);
    for (int k = 0; k < facet.count; ++k) {
      if (mayReachEdge(facet, k)) addEdge(facet, k, found);
    }
    if (onlyFallsAway(facet, found.main())) return;
    for (std::size_t k = 0; k < tracker_.feet.size() && static_cast<int>(k) < facet.count; ++k)
      addDownhill(facet, k, found);
  }

  const MeshFeatures& features() const { return std::get<Mesh>(shape_).surface->features(); }
  // How far from the core flat triangles may be that the surface touches.
  double reach() const { return pad_.rounding + margin_ + std::get<Mesh>(shape_).surface->bulge(); }
  Vec3 cornerOf(const Facet& facet, int k) const {
    return X_BF_ * facet.corners[static_cast<std::size_t>(k % facet.count)].p;
  }

  bool mayReachEdge(const Facet& facet, int k) const {
    const Vec3 from = cornerOf(facet, k), to = cornerOf(facet, k + 1), around = Vec3::Constant(reach());
    const Vec3 low = from.cwiseMin(to) - around, high = from.cwiseMax(to) + around;
    bool may = false;
    features().visitBox(low, high, [&](std::int32_t t) { may = may || features().meetsBox(t, low, high); });
    return may;
  }

  // True if every triangle that the facet may touch leans away from the main contact: then the gap grows along each way
  // from there, and has no other minimum. Another rim or bump would have a side that faces it. What is level along a
  // way, as a cylinder, isn't known by that.
  bool onlyFallsAway(const Facet& facet, const SurfaceContact& main) const {
    const Vec3 ahead = X_BF_.q * facet.n, around = Vec3::Constant(reach());
    Vec3 low = Vec3::Constant(kInfinity), high = -low;
    for (int k = 0; k < facet.count; ++k) {
      low = low.cwiseMin(cornerOf(facet, k));
      high = high.cwiseMax(cornerOf(facet, k));
    }
    const Vec3 from = cornerOf(facet, 0);
    bool falls = facet.count > 2;
    features().visitBox(low - around, high + around, [&](std::int32_t t) {
      if (!falls) return;
      const auto triangle = features().triangle(t);
      const auto heightOf = [&](int i) { return ahead.dot(triangle.corner(i) - from); };
      if (std::min({heightOf(0), heightOf(1), heightOf(2)}) > reach()) return;
      const Vec3 way = (triangle.corner(0) + triangle.corner(1) + triangle.corner(2)) / 3 - main.p_BS;
      const Vec3 level = way - ahead.dot(way) * ahead;
      falls = triangle.n.dot(level) > kNoAngle * level.norm();
    });
    return falls;
  }

  void addEdge(const Facet& facet, int k, FingerContacts& found) {
    const FacetCorner &from = facet.corners[static_cast<std::size_t>(k)],
                      &to = facet.corners[static_cast<std::size_t>((k + 1) % facet.count)];
    CoreTracker tracker{triedBall(), Vec3::Zero(), false};
    const FingerShape edge = CapsuleTip{pad_.rounding, 0.5 * (to.p - from.p)};
    const Pose X_BE{X_BF_.q, X_BF_ * (0.5 * (from.p + to.p))};
    addIfNew(descend(shape_, edge, X_BE, 0, tracker, cache_), kFirstEdge + from.edge, found);
  }

  // Of as many corners as there are trackers, evenly around: a place of its own where the
  // surface is hollow between it and the deepest.
  void addDownhill(const Facet& facet, std::size_t k, FingerContacts& found) {
    const std::size_t corner = k * static_cast<std::size_t>(facet.count) /
                               std::min<std::size_t>(tracker_.feet.size(), static_cast<std::size_t>(facet.count));
    CoreTracker& foot = tracker_.feet[k];
    foot.c_F = facet.corners[corner].p;
    foot.warm = true;
    addIfNew(descend(shape_, finger_, X_BF_, 0, foot, cache_), kFirstFoot + static_cast<std::uint32_t>(k), found);
  }

  void addIfNew(const CoreDescent& there, std::uint32_t feature, FingerContacts& found) const {
    found.queries += there.queries;
    SurfaceContact point = there.found.main();
    if (found.count == kMaxFingerContacts || !(point.phi < margin_) || isKnown(found, point)) return;
    point.feature = feature;
    add(point, found);
  }

  bool isKnown(const FingerContacts& found, const SurfaceContact& point) const {
    const Vec3 p_BT = point.p_BS + point.phi * point.n_B;
    return std::any_of(found.p_BT.begin(), found.p_BT.begin() + found.count,
                       [&](const Vec3& other) { return (other - p_BT).norm() < kOnePoint * size_; });
  }

  static constexpr double kSameNormal = 1e-4;  // [rad]
  static constexpr double kOnEdge = 1e-3;      // barycentric
  // features: above those of the deepest place's ball
  static constexpr std::uint32_t kFirstFoot = 16, kFirstEdge = 32, kFirstEnd = 1024;

  const Shape& shape_;
  const PadTip& pad_;
  const FingerShape& finger_;
  const Pose& X_BF_;
  const double margin_, size_;
  FingerTracker& tracker_;
  PatchCache& cache_;
};

}  // namespace

bool touchOnFacets(const Shape& solid, const FingerShape& finger, const Pose& X_BF, double margin,
                   FingerTracker& tracker, PatchCache& cache, FingerContacts& found) {
  // The normal of a solid's last patch stays where meshes keep the followed contact.
  Vec3& last_n_B = tracker.main.ball.slots[0].n_B;
  const Vec3 from_n_B = tracker.main.warm ? last_n_B : Vec3(Vec3::Zero());
  PairPoints patch;
  if (const auto* capsule = std::get_if<CapsuleTip>(&finger))
    capsuleOnShape(*capsule, X_BF, solid, margin, from_n_B, patch);
  else
    padOnShape(std::get<PadTip>(finger), X_BF, solid, margin, from_n_B, cache, patch);
  if (patch.count == 0) return false;
  takePatch(patch, found);
  const SurfaceContact& main = found.main();
  last_n_B = main.n_B;
  tracker.main.c_F = X_BF.inverse() * (main.p_BS + (main.phi + roundingOf(finger)) * main.n_B);
  tracker.main.warm = true;
  return true;
}

FingerContacts queryPad(const Shape& shape, const FingerShape& finger, const Pose& X_BF, double margin,
                        FingerTracker& tracker, PatchCache& cache) {
  FingerContacts found;
  PadQuery(shape, finger, X_BF, margin, tracker, cache).run(found);
  return found;
}

}  // namespace pincer::contact
