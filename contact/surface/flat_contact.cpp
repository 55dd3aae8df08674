#include "pincer/contact/surface/flat_contact.h"

#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/surface/flat_minimum.h"
#include "pincer/contact/surface/shell_edge.h"

namespace pincer::contact {

namespace {

constexpr int kMaxFacets = 200;      // that one query walks over
constexpr double kOnFeature = 1e-8;  // of the mesh's size: nearer to a border's point than this, direction is lost

class FlatWalk {
 public:
  FlatWalk(const SurfaceNet& net, const Vec3& C, const Foot& start) : net_(net), C_(C), start_(start) {
    moveTo(start.triangle);
  }

  ShellContact run() {
    while (crossings_ < kMaxFacets) {
      if (!descend()) return contact();
      ++crossings_;
    }
    return {start_, {0, 0, 1}, 0, false, {0, crossings_}};
  }

 private:
  // Where the nearest point lies on its triangle: the only corner (vertex), the edge, or neither.
  int corner() const;
  int edge() const;
  void moveTo(std::int32_t triangle);
  bool descend();
  ShellContact contact() const;
  ShellContact onEdge(int edge) const;
  ShellContact onVertex(int corner) const;
  ShellContact on(std::int32_t triangle, const Vec3& n) const;
  ShellContact rolledOver(const Vec3& outward) const;

  const SurfaceNet& net_;
  const Vec3 C_;
  const Foot start_;
  std::int32_t triangle_ = 0;
  FlatPoint nearest_{};
  int crossings_ = 0;
};

int FlatWalk::corner() const {
  for (int i = 0; i < 3; ++i) {
    if (nearest_.b[static_cast<std::size_t>(i)] == 1) return i;
  }
  return -1;
}

int FlatWalk::edge() const {
  for (int i = 0; i < 3; ++i) {
    if (nearest_.b[static_cast<std::size_t>(i)] == 0) return (i + 1) % 3;
  }
  return -1;
}

void FlatWalk::moveTo(std::int32_t triangle) {
  triangle_ = triangle;
  nearest_ = closestOnFacet(net_, triangle, C_);
}

// To a neighbour that is strictly nearer: no walk goes in circles.
bool FlatWalk::descend() {
  std::int32_t nearer = -1;
  double least = nearest_.distance2;
  const auto consider = [&](std::int32_t triangle) {
    const double distance2 = closestOnFacet(net_, triangle, C_).distance2;
    if (!(distance2 < least)) return;
    least = distance2;
    nearer = triangle;
  };
  if (const int at = corner(); at >= 0) {
    net_.visitCorners({triangle_, at}, [&](const CellCorner& c) { consider(c.triangle); });
  } else if (const int over = edge(); over >= 0) {
    const Neighbour other = net_.neighbour(triangle_, over);
    if (other.triangle >= 0) consider(other.triangle);
  }
  if (nearer < 0) return false;
  moveTo(nearer);
  return true;
}

ShellContact FlatWalk::on(std::int32_t triangle, const Vec3& n) const {
  const FlatPoint foot = triangle == triangle_ ? nearest_ : closestOnFacet(net_, triangle, C_);
  const double h = (C_ - net_.vertex(triangle, 0)).dot(n);
  const bool has_answer = std::isfinite(h) && !n.isZero(0);  // not on a triangle without area
  return {{triangle, foot.b}, n, h, has_answer, {1, crossings_}};
}

ShellContact FlatWalk::rolledOver(const Vec3& outward) const {
  const Vec3 p = nearest_.b[0] * net_.vertex(triangle_, 0) + nearest_.b[1] * net_.vertex(triangle_, 1) +
                 nearest_.b[2] * net_.vertex(triangle_, 2);
  const FeatureContact contact = contactWithPoint(C_, p, outward, true, kOnFeature * net_.length());
  return {{triangle_, nearest_.b}, contact.n, contact.h, true, {1, crossings_}};
}

ShellContact FlatWalk::contact() const {
  if (const int at = corner(); at >= 0) return onVertex(at);
  if (const int over = edge(); over >= 0) return onEdge(over);
  return on(triangle_, net_.facetNormal(triangle_));
}

ShellContact FlatWalk::onEdge(int edge) const {
  const Neighbour other = net_.neighbour(triangle_, edge);
  const Vec3 n = net_.facetNormal(triangle_);
  if (other.triangle < 0) return rolledOver(n);
  const Vec3 n_other = net_.facetNormal(other.triangle), R = C_ - net_.vertex(triangle_, edge);
  const double sign = R.dot(n + n_other) < 0 ? -1 : 1;
  return sign * R.dot(n_other) > sign * R.dot(n) ? on(other.triangle, n_other) : on(triangle_, n);
}

ShellContact FlatWalk::onVertex(int corner) const {
  const Vec3 R = C_ - net_.vertex(triangle_, corner);
  Vec3 outward = Vec3::Zero();  // facets' normals weighted by their angles: tells inside from outside at any vertex
  const bool has_border = net_.visitCorners({triangle_, corner}, [&](const CellCorner& c) {
    const Vec3& p = net_.vertex(c.triangle, c.corner);
    const Vec3 e = net_.vertex(c.triangle, (c.corner + 1) % 3) - p, f = net_.vertex(c.triangle, (c.corner + 2) % 3) - p;
    outward += math::atan2(e.cross(f).norm(), e.dot(f)) * net_.facetNormal(c.triangle);
  });
  if (has_border) return rolledOver(outward);
  const double sign = R.dot(outward) < 0 ? -1 : 1;
  std::int32_t best = triangle_;
  double highest = sign * R.dot(net_.facetNormal(triangle_));
  net_.visitCorners({triangle_, corner}, [&](const CellCorner& c) {
    const double height = sign * R.dot(net_.facetNormal(c.triangle));
    if (!(height > highest)) return;
    highest = height;
    best = c.triangle;
  });
  return on(best, net_.facetNormal(best));
}

}  // namespace

ShellContact followFlat(const SurfaceNet& net, const Vec3& C, const Foot& start) {
  return FlatWalk(net, C, start).run();
}

void shadeForce(const SurfaceNet& net, const SurfaceTracker& tracker, SurfaceContacts& contacts) {
  constexpr double kSame = 1e-9;  // 1 - cosine to the facet's normal, which a rolled-over border has lost
  for (int i = 0; i < contacts.count; ++i) {
    SurfaceContact& contact = contacts.points[static_cast<std::size_t>(i)];
    PINCER_ASSERT(contact.feature < tracker.slots.size());
    const SurfaceSlot& slot = tracker.slots[contact.feature];
    PINCER_ASSERT(slot.triangle >= 0);
    if (contact.n_B.dot(net.facetNormal(slot.triangle)) < 1 - kSame) continue;
    const auto n = [&](int corner) -> const Vec3& { return net.shadingNormal(slot.triangle, corner); };
    contact.n_B = ((1 - slot.u - slot.v) * n(0) + slot.u * n(1) + slot.v * n(2)).normalized();
  }
}

}  // namespace pincer::contact
