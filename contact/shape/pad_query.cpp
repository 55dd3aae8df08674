#include "pincer/contact/shape/pad_query.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/convex_features.h"
#include "pincer/contact/shape/core_descent.h"
#include "pincer/contact/shape/pad_contacts.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/mesh_features.h"
#include "pincer/contact/surface/surface_net.h"

namespace pincer::contact {
namespace {

constexpr double kApartOnPad = 1e-3;  // of the pad's size: two places nearer than that are one

// The straight line on a smooth mesh through a place of it, as the walls of cylinders, cones and prisms with rounded
// edges have: along edges of triangles whose two ends have one normal, across smooth edges up to the wall's rims.
class WallLine {
 public:
  // through `p`, whose triangle is `t`
  WallLine(const SurfaceNet& net, std::int32_t t, const Vec3& p, const Vec3& n) : net_(net), p_(p) {
    const int edge = straightEdge(t);
    if (edge < 0) return;
    along_ = (net.vertex(t, (edge + 1) % 3) - net.vertex(t, edge)).normalized();
    int axis = 0;
    along_.cwiseAbs().maxCoeff(&axis);
    if (along_[axis] < 0) along_ = -along_;  // one way on all triangles of a wall
    across_ = n.cross(along_).normalized();
    low_ = -follow(t, -1);
    high_ = follow(t, 1);
  }
  bool exists() const { return high_ > low_; }
  const Vec3& along() const { return along_; }  // unit
  // Its ends, from p along it [m].
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  static constexpr double kSame = 1e-6;  // difference of unit vectors

  // The only edge of the triangle along which the surface is straight and faces one way; -1 if there is none, or three
  // as on a flat face.
  int straightEdge(std::int32_t t) const {
    int found = -1;
    for (int i = 0; i < 3; ++i) {
      const Vec3 n = net_.normal(t, i), e = (net_.vertex(t, (i + 1) % 3) - net_.vertex(t, i)).normalized();
      if ((net_.normal(t, (i + 1) % 3) - n).norm() > kSame || std::abs(e.dot(n)) > kSame) continue;
      if (found >= 0) return -1;
      found = i;
    }
    return found;
  }

  Vec2 seen(const Vec3& q) const { return {along_.dot(q - p_), across_.dot(q - p_)}; }

  // How far the wall goes on that way [m]. A line along an edge is looked for just inside of its triangle.
  double follow(std::int32_t t, double sign) const {
    constexpr int kMostTriangles = 64;  // chosen: bounds the work; a wall of more ends there
    constexpr double kInside = 1e-3;    // of the triangle's width
    double low = seen(net_.vertex(t, 0)).y(), high = low;
    for (int i = 1; i < 3; ++i) {
      low = std::min(low, seen(net_.vertex(t, i)).y());
      high = std::max(high, seen(net_.vertex(t, i)).y());
    }
    const double y = std::clamp(0.0, low + kInside * (high - low), high - kInside * (high - low));
    double furthest = 0;
    int entered = -1;
    for (int n = 0; n < kMostTriangles; ++n) {
      int left = -1;
      double way = -kInfinity;
      for (int i = 0; i < 3; ++i) {
        const Vec2 from = seen(net_.vertex(t, i)), to = seen(net_.vertex(t, (i + 1) % 3));
        if (i == entered || (from.y() < y) == (to.y() < y)) continue;
        const double x = sign * (from.x() + (y - from.y()) / (to.y() - from.y()) * (to.x() - from.x()));
        if (x > way) way = x, left = i;
      }
      if (left < 0) break;
      furthest = way;
      if (net_.isSharp(t, left)) break;
      const Neighbour next = net_.neighbour(t, left);
      const int edge = straightEdge(next.triangle);
      if (edge < 0) break;
      const Vec3 e = net_.vertex(next.triangle, (edge + 1) % 3) - net_.vertex(next.triangle, edge);
      if (e.cross(along_).norm() > kSame * e.norm()) break;
      t = next.triangle;
      entered = next.edge;
    }
    return furthest;
  }

  const SurfaceNet& net_;
  const Vec3 p_;
  Vec3 along_ = Vec3::UnitZ(), across_ = Vec3::UnitX();
  double low_ = 0, high_ = 0;
};

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

  FingerContacts run() { return std::holds_alternative<Mesh>(shape_) ? onMesh() : onSolid(); }

 private:
  FingerContacts nearest() {
    const CoreDescent deepest = descend(shape_, finger_, X_BF_, margin_, tracker_.main, cache_);
    FingerContacts out;
    out.queries = deepest.queries;
    for (int i = 0; i < deepest.found.count; ++i) add(deepest.found.points[static_cast<std::size_t>(i)], out);
    return out;
  }

  static void add(const SurfaceContact& point, FingerContacts& out) {
    PINCER_ASSERT(out.count < kMaxFingerContacts);
    const auto i = static_cast<std::size_t>(out.count++);
    out.points[i] = point;
    out.p_BT[i] = point.p_BS + point.phi * point.n_B;
  }

  // The normal of a solid's last patch stays where meshes keep the followed contact.
  Vec3& lastNormal() { return tracker_.main.ball.slots[0].n_B; }

  FingerContacts onSolid() {
    PairPoints patch;
    padOnShape(pad_, X_BF_, shape_, margin_, tracker_.main.warm ? lastNormal() : Vec3(Vec3::Zero()), cache_, patch);
    if (patch.count == 0) return nearest();
    const FingerContacts found = contactsOf(patch);
    const SurfaceContact& main = found.main();
    lastNormal() = main.n_B;
    tracker_.main.c_F = X_BF_.inverse() * (main.p_BS + (main.phi + pad_.rounding) * main.n_B);
    tracker_.main.warm = true;
    return found;
  }

  // The deepest first; of more than there is room for the deepest.
  static FingerContacts contactsOf(PairPoints& patch) {
    std::sort(patch.points.begin(), patch.points.begin() + patch.count, [](const PairPoint& x, const PairPoint& y) {
      return x.phi < y.phi || (x.phi == y.phi && x.feature < y.feature);
    });
    FingerContacts found;
    found.queries = 1;
    const int count = std::min(patch.count, kMaxFingerContacts);
    for (int i = 0; i < count; ++i) {
      const PairPoint& p = patch.points[static_cast<std::size_t>(i)];
      add({p.p_W - 0.5 * p.phi * p.n_W, p.n_W, p.phi, p.feature}, found);
    }
    return found;
  }

  FingerContacts onMesh() {
    FingerContacts found = nearest();
    if (!(found.main().phi < margin_)) return found;
    if (FingerContacts line; touchesWall(found.main(), line)) return line;
    if (mayBeFlat(found.main())) {
      PairPoints patch;
      padOnShape(pad_, X_BF_, shape_, margin_, Vec3::Zero(), cache_, patch);
      if (isFlat(patch, found.main())) return contactsOf(patch);
    }
    addFurther(found);
    return found;
  }

  // The two ends of the line that a straight wall shares with the facet over it: of the wall, where it ends under the
  // facet, else of the facet. Their gaps are those of the facet's plane. False if there is no such wall.
  bool touchesWall(const SurfaceContact& main, FingerContacts& line) const {
    constexpr double kFaces = 0.1;  // [rad] between the facet and the wall under it
    const std::int32_t t = slotOf(main).triangle;
    if (t < 0) return false;
    Facet facet;
    facetOf(Convex{pad_.hull}, X_BF_.q.conjugate() * -main.n_B, facet);
    const Vec3 n_B = -(X_BF_.q * facet.n);
    if (facet.count < 3 || (n_B - main.n_B).squaredNorm() > kFaces * kFaces) return false;
    const WallLine wall(std::get<Mesh>(shape_).surface->net(), t, main.p_BS, main.n_B);
    if (!wall.exists()) return false;
    double low = wall.low(), high = wall.high();
    for (int k = 0; k < facet.count; ++k) {
      const Vec3 from = cornerOf(facet, k), inwards = n_B.cross(from - cornerOf(facet, k + 1)).normalized();
      const double inside = inwards.dot(main.p_BS - from), rate = inwards.dot(wall.along());
      if (rate > 0) low = std::max(low, -inside / rate);
      if (rate < 0) high = std::min(high, -inside / rate);
      if (rate == 0 && inside < 0) return false;
    }
    if (!(high - low > kApartOnPad * size_)) return false;
    PairPoints ends;
    for (const double s : {low, high}) {
      const Vec3 p_BS = main.p_BS + s * wall.along();
      const double phi = n_B.dot(cornerOf(facet, 0) - p_BS) - pad_.rounding;
      if (phi < margin_)
        ends.points[static_cast<std::size_t>(ends.count++)] = {p_BS + 0.5 * phi * n_B, n_B, phi,
                                                               kFirstEnd + (s == high ? 1u : 0u)};
    }
    if (ends.count == 0) return false;
    line = contactsOf(ends);
    return true;
  }

  const SurfaceSlot& slotOf(const SurfaceContact& main) const {
    return tracker_.main.ball.slots[main.feature % kMaxSurfaceContacts];
  }

  // Inside of a flat triangle the smooth surface has its normal: without that the others needn't be asked.
  bool mayBeFlat(const SurfaceContact& main) const {
    constexpr double kOnEdge = 1e-3;  // barycentric
    const SurfaceSlot& slot = slotOf(main);
    if (slot.triangle < 0 || std::min({slot.u, slot.v, 1 - slot.u - slot.v}) < kOnEdge) return true;
    const MeshFeatures& features = std::get<Mesh>(shape_).surface->features();
    return (features.triangle(slot.triangle).n - main.n_B).squaredNorm() < kSameNormal * kSameNormal;
  }

  // True if the flat triangles are the surface where the smooth one is touched: they answer with its normal in more
  // than one place, no shallower, and there and halfway between two of these the surface has their gap.
  bool isFlat(const PairPoints& patch, const SurfaceContact& main) {
    const double same_gap = 1e-6 * size_;
    const PairPoint *deepest = nullptr, *furthest = nullptr;
    const auto visitAlike = [&](const auto& visit) {
      for (int i = 0; i < patch.count; ++i) {
        const PairPoint& p = patch.points[static_cast<std::size_t>(i)];
        if ((p.n_W - main.n_B).squaredNorm() < kSameNormal * kSameNormal) visit(p);
      }
    };
    visitAlike([&](const PairPoint& p) { deepest = !deepest || p.phi < deepest->phi ? &p : deepest; });
    if (!deepest || deepest->phi > main.phi - slotOf(main).ease + same_gap) return false;
    double way = kApartOnPad * size_;
    visitAlike([&](const PairPoint& p) {
      if (const double d = (p.p_W - deepest->p_W).norm(); d > way) way = d, furthest = &p;
    });
    if (!furthest) return false;
    const auto isLevel = [&](const Vec3& p_W, double phi) {
      SurfaceTracker tracker = tracker_.main.ball;
      const Vec3 p_BC = p_W + (0.5 * phi + pad_.rounding) * main.n_B;
      return std::abs(querySphere(shape_, p_BC, pad_.rounding, 0, tracker, cache_).main().phi - phi) < same_gap;
    };
    return isLevel(deepest->p_W, deepest->phi) &&
           isLevel(0.5 * (deepest->p_W + furthest->p_W), 0.5 * (deepest->phi + furthest->phi));
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
    constexpr double kLeans = 1e-6;  // sine
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
      falls = triangle.n.dot(level) > kLeans * level.norm();
    });
    return falls;
  }

  void addEdge(const Facet& facet, int k, FingerContacts& found) {
    const FacetCorner &from = facet.corners[static_cast<std::size_t>(k)],
                      &to = facet.corners[static_cast<std::size_t>((k + 1) % facet.count)];
    CoreTracker tracker{tracker_.main.ball, Vec3::Zero(), false};
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
                       [&](const Vec3& other) { return (other - p_BT).norm() < kApartOnPad * size_; });
  }

  static constexpr double kSameNormal = 1e-4;  // [rad]
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

FingerContacts queryPad(const Shape& shape, const FingerShape& finger, const Pose& X_BF, double margin,
                        FingerTracker& tracker, PatchCache& cache) {
  return PadQuery(shape, finger, X_BF, margin, tracker, cache).run();
}

}  // namespace pincer::contact
