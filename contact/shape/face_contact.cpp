#include "pincer/contact/shape/face_contact.h"

#include <algorithm>
#include <array>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/facet_overlap.h"
#include "pincer/contact/shape/point_choice.h"
#include "pincer/contact/shape/tolerances.h"
#include "pincer/contact/surface/vec_pair.h"

namespace pincer::contact {
namespace {

// One solid over the face `base` of the other: what of it faces that, seen in the base's frame.
class OverFace {
 public:
  OverFace(const PosedSolid& base_solid, const Facet& base, const PosedSolid& over_solid)
      : base_solid_(base_solid), over_solid_(over_solid), base_(base), n_(base_solid.outwards(base.n)) {
    PINCER_ASSERT(base.count > 2);
    const Vec3 ahead = over_solid.inwards(-n_);
    facetOf(over_solid.shape, ahead, over_);
    const double plane = base.n.dot(base.corners[0].p);
    double lowest_corner = kInfinity;
    for (int i = 0; i < over_.count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      places_[at] = over_solid.place(over_.corners[at].p);
      seen_[at] = seen(places_[at]);
      heights_[at] = base.n.dot(seen_[at]) - plane;
      highest_ = std::max(highest_, heights_[at]);
      lowest_corner = std::min(lowest_corner, heights_[at]);
    }
    // A face with all of its corners holds its lowest point.
    const bool is_whole = over_.count > 2 && over_.count <= kMaxChosen && !(over_.rim_radius > 0);
    lowest_ = is_whole ? lowest_corner : base.n.dot(seen(over_solid.place(supportOf(over_solid.shape, ahead)))) - plane;
    noteInside();
  }

  // A lowest point lies over the base; or would, if the two facets share a place.
  bool isNearest(double size) const { return isLowest(lowest_inside_, size); }
  bool isFlush(double size) const { return isLowest(highest_, size); }
  bool isWithin() const { return all_inside_ && over_.count > 2 && over_.count <= kMaxChosen; }
  const Vec3& normal() const { return n_; }  // out of the base
  double lowest() const { return lowest_; }  // over the base [m]

  // The corners nearer than the margin, of a polygon within the base.
  void takeCorners(bool are_of_a, double margin, PairPoints& out) const {
    const double rounding = roundingOf(over_solid_), base_rounding = roundingOf(base_solid_);
    const double sign = are_of_a ? 1 : -1;
    const std::array<std::size_t, kMaxChosen> order = cornersByName();
    for (int k = 0; k < over_.count; ++k) {
      const std::size_t i = order[static_cast<std::size_t>(k)];
      const double height = heights_[i], phi = height - rounding - base_rounding;
      if (!(phi < margin)) continue;
      PairPoint& point = out.points[static_cast<std::size_t>(out.count++)];
      point.p_W = places_[i] - 0.5 * (height + rounding - base_rounding) * n_;
      point.n_W = sign * n_;
      point.phi = phi;
      point.feature = featureOfCorner(are_of_a, over_.corners[i].vertex);
    }
  }

 private:
  // Which sorts their features, too.
  std::array<std::size_t, kMaxChosen> cornersByName() const {
    std::array<std::size_t, kMaxChosen> order;
    for (std::size_t i = 0; i < static_cast<std::size_t>(over_.count); ++i) {
      std::size_t at = i;
      for (; at > 0 && over_.corners[i].vertex < over_.corners[order[at - 1]].vertex; --at) order[at] = order[at - 1];
      order[at] = i;
    }
    return order;
  }

  bool isLowest(double height, double size) const { return lowest_ > 0 && height - lowest_ <= kGapRounding * size; }

  // In the base's frame.
  Vec3 seen(const Vec3& p) const { return base_solid_.inwards(p - base_solid_.p); }

  // Of the base's outline, both in its frame.
  struct Edge {
    Vec3 from, inwards;
  };
  void listEdges(std::array<Edge, Facet::kMost>& edges) const {
    const Vec3& n = base_.n;
    const Vec3* from = &base_.corners[static_cast<std::size_t>(base_.count - 1)].p;
    for (int k = 0; k < base_.count; ++k) {
      const Vec3& to = base_.corners[static_cast<std::size_t>(k)].p;
      const double x = to.x() - from->x(), y = to.y() - from->y(), z = to.z() - from->z();
      Vec3& inwards = edges[static_cast<std::size_t>(k)].inwards;
      inwards[0] = n.y() * z - n.z() * y;
      inwards[1] = n.z() * x - n.x() * z;
      inwards[2] = n.x() * y - n.y() * x;
      edges[static_cast<std::size_t>(k)].from = *from;
      from = &to;
    }
  }

  // Which corners are over the base: two at a time, an eighth of a pad's look is two corners and one edge.
  void noteInside() {
    std::array<Edge, Facet::kMost> edges;
    listEdges(edges);
    const std::size_t count = static_cast<std::size_t>(over_.count);
    for (std::size_t i = 0; i < count; i += 2) {
      const std::size_t second = std::min(i + 1, count - 1);
      const Vec3 &a = seen_[i], &b = seen_[second];
      const Two x{a.x(), b.x()}, y{a.y(), b.y()}, z{a.z(), b.z()};
      auto inside = x == x;
      for (int k = 0; k < base_.count; ++k) {
        const Vec3 &from = edges[static_cast<std::size_t>(k)].from, &in = edges[static_cast<std::size_t>(k)].inwards;
        inside &= (in[0] * (x - from[0]) + in[1] * (y - from[1])) + in[2] * (z - from[2]) >= 0;
      }
      note(inside[0] != 0, heights_[i]);
      if (second > i) note(inside[1] != 0, heights_[second]);
    }
  }
  void note(bool is_inside, double height) {
    if (is_inside) lowest_inside_ = std::min(lowest_inside_, height);
    all_inside_ = all_inside_ && is_inside;
  }

  const PosedSolid& base_solid_;
  const PosedSolid& over_solid_;
  const Facet& base_;
  const Vec3 n_;
  Facet over_;
  std::array<Vec3, Facet::kMost> places_, seen_;  // of its corners, and in the base's frame
  std::array<double, Facet::kMost> heights_;      // over the base's plane [m]
  double lowest_ = kInfinity, lowest_inside_ = kInfinity, highest_ = -kInfinity;
  bool all_inside_ = true;
};

}  // namespace

bool touchOnFaces(const PosedSolid& a, const PosedSolid& b, const LastPoints& last, double size, double margin,
                  PairPoints& out) {
  PINCER_ASSERT(isUnitIfFinite(last.n_W) && size > 0);
  for (const bool is_base_a : {false, true}) {
    out.count = 0;
    const PosedSolid& base_solid = is_base_a ? a : b;
    Facet base;
    facetOf(base_solid.shape, base_solid.inwards(is_base_a ? Vec3(-last.n_W) : last.n_W), base);
    if (base.count < 3) continue;
    const OverFace over(base_solid, base, is_base_a ? b : a);
    const bool is_nearest = over.isNearest(size);
    if (!is_nearest && !over.isFlush(size)) continue;
    if (is_nearest && over.isWithin()) {
      over.takeCorners(!is_base_a, margin, out);
      return true;
    }
    const Vec3 n = is_base_a ? Vec3(-over.normal()) : over.normal();
    if (overlapFacets(a, b, {n, over.lowest()}, size, margin, last, out)) return true;
  }
  return false;
}

}  // namespace pincer::contact
