// convex_gap: how far two convex solids are apart, or how deep they overlap, by
// trying every direction that may be the best.
//
//   gap(n) = min over a of n . p - max over b of n . p [m],   n out of b towards a
//   phi = max over unit n of gap(n)
//
// gap has kinks at the normals of flat faces, and along the circle of directions across each straight edge; it is
// smooth elsewhere. Every maximum is therefore one of four kinds, and each is tried: the faces' normals; the cross
// products of two edges; a maximum along one edge's circle (sampled, then narrowed by halves); one on the open sphere
// (sampled, then climbed from the best samples by shrinking steps). The solids are described again, by corners and
// discs: nothing is shared with contact/shape but the shapes' own numbers. It takes milliseconds, and serves tests and
// measurements. Error: gap 1e-14 of the size, and the direction 1e-7 rad, where one of the first two kinds wins exact.
// A maximum that no sample comes near (basins narrower than 0.05 rad, of deep overlap) is missed: it is a lower bound.
#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/math.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/shape.h"

namespace pincer::tasks {

// A convex solid in W: the hull of its corners and discs, rounded.
struct PlainSolid {
  struct Disc {
    Vec3 centre, axis;  // unit axis
    double radius;
    // unit vector in the disc's plane beyond whose multiple `cut` nothing is; zero: a whole disc
    Vec3 flat = Vec3::Zero();
    double cut = 0;
  };
  std::vector<Vec3> corners;
  std::vector<Disc> discs;
  std::vector<Vec3> normals, edges;  // unit
  double rounding = 0;               // [m]

  // Furthest point along the unit vector `d`, without the rounding.
  Vec3 furthest(const Vec3& d) const {
    double most = -kInfinity;
    Vec3 best = Vec3::Zero();
    const auto offer = [&](const Vec3& p) {
      if (d.dot(p) > most) most = d.dot(p), best = p;
    };
    for (const Vec3& p : corners) offer(p);
    for (const Disc& disc : discs) {
      Vec3 across = d - disc.axis.dot(d) * disc.axis;
      // twice: of nearly nothing the first leaves round-off along the axis
      across -= disc.axis.dot(across) * disc.axis;
      const double length = across.norm();
      const Vec3 rim = length > 1e-12 ? Vec3(disc.radius / length * across) : Vec3(Vec3::Zero());
      if (disc.flat == Vec3::Zero() || disc.flat.dot(rim) <= disc.cut) offer(disc.centre + rim);
    }
    return best;
  }
};

namespace convex_gap {

inline void add(const contact::Box& s, PlainSolid& out) {
  for (int i = 0; i < 8; ++i)
    out.corners.emplace_back(i & 1 ? s.half.x() : -s.half.x(), i & 2 ? s.half.y() : -s.half.y(),
                             i & 4 ? s.half.z() : -s.half.z());
  for (int i = 0; i < 3; ++i) {
    out.edges.push_back(Vec3::Unit(i));
    for (const double sign : {-1.0, 1.0}) out.normals.push_back(sign * Vec3::Unit(i));
  }
}
inline void add(const contact::Sphere& s, PlainSolid& out) {
  out.corners.push_back(Vec3::Zero());
  out.rounding = s.radius;
}
inline void add(const contact::Capsule& s, PlainSolid& out) {
  for (const double sign : {-1.0, 1.0}) out.corners.push_back(sign * s.half_length * Vec3::UnitZ());
  out.edges.push_back(Vec3::UnitZ());
  out.rounding = s.radius;
}
inline void add(const contact::Cylinder& s, PlainSolid& out) {
  for (const double sign : {-1.0, 1.0}) {
    out.discs.push_back({sign * s.half_length * Vec3::UnitZ(), Vec3::UnitZ(), s.radius});
    out.normals.push_back(sign * Vec3::UnitZ());
  }
  out.edges.push_back(Vec3::UnitZ());
}
inline void add(const contact::CylinderWithFlat& s, PlainSolid& out) {
  add(contact::Cylinder{s.radius, s.half_length}, out);
  const double w = std::sqrt(s.radius * s.radius - s.flat_distance * s.flat_distance);
  for (PlainSolid::Disc& disc : out.discs) {
    disc.flat = Vec3::UnitX();
    disc.cut = s.flat_distance;
    for (const double y : {-w, w}) out.corners.emplace_back(s.flat_distance, y, disc.centre.z());
  }
  out.normals.push_back(Vec3::UnitX());
  out.edges.push_back(Vec3::UnitY());
}
inline void add(const contact::Convex& s, PlainSolid& out) {
  out.corners = s.hull->vertices();
  for (const auto& face : s.hull->faces()) out.normals.push_back(face.n);
  const auto at = [&](int i) -> const Vec3& { return s.hull->vertices()[static_cast<std::size_t>(i)]; };
  for (const auto& edge : s.hull->edges()) out.edges.push_back((at(edge.to) - at(edge.from)).normalized());
}
template <class Other>
void add(const Other&, PlainSolid&) {}  // half-space, dish, mesh: not one of these

struct Best {
  Vec3 n = Vec3::UnitZ();
  double gap = -kInfinity;
};

class Search {
 public:
  Search(const PlainSolid& a, const PlainSolid& b) : a_(a), b_(b), slope_(2 * spread()) {}

  double gapAlong(const Vec3& n) const {
    return n.dot(a_.furthest(-n)) - n.dot(b_.furthest(n)) - a_.rounding - b_.rounding;
  }

  Best find() {
    for (const Vec3& m : a_.normals) offer(-m);
    for (const Vec3& m : b_.normals) offer(m);
    for (const Vec3& e : a_.edges) {
      for (const Vec3& f : b_.edges) {
        const Vec3 n = e.cross(f);
        if (n.norm() > 1e-9) offer(n.normalized()), offer(-n.normalized());
      }
    }
    for (const PlainSolid* s : {&a_, &b_}) {
      for (const Vec3& e : s->edges) tryCircle(e);
    }
    trySphere();
    return best_;
  }

 private:
  void offer(const Vec3& n) {
    const double gap = gapAlong(n);
    if (gap > best_.gap) best_ = {n, gap};
  }

  void tryCircle(const Vec3& e) {
    constexpr int kSamples = 96;  // of the circle: 3.75 degrees apart, between which a maximum is searched; chosen
    const Mat3 F = frameFromNormal(e);
    const auto at = [&](double t) -> Vec3 { return math::cos(t) * F.col(0) + math::sin(t) * F.col(1); };
    const double step = 2 * M_PI / kSamples;
    std::array<double, kSamples> gaps;
    for (int i = 0; i < kSamples; ++i) gaps[static_cast<std::size_t>(i)] = gapAlong(at(i * step));
    for (int i = 0; i < kSamples; ++i) {
      const double here = gaps[static_cast<std::size_t>(i)];
      if (here + slope_ * step < best_.gap) continue;
      if (here < gaps[static_cast<std::size_t>((i + 1) % kSamples)] ||
          here < gaps[static_cast<std::size_t>((i + kSamples - 1) % kSamples)])
        continue;
      double lo = (i - 1) * step, hi = (i + 1) * step;  // one maximum between the two: thirds until round-off
      for (int k = 0; k < 80 && hi - lo > 1e-12; ++k) {
        const double l = lo + (hi - lo) / 3, r = hi - (hi - lo) / 3;
        const bool right = gapAlong(at(l)) < gapAlong(at(r));
        (right ? lo : hi) = right ? l : r;
      }
      offer(at(0.5 * (lo + hi)));
    }
  }

  void trySphere() {
    // Directions of the sphere; the best of them that are climbed from; chosen.
    constexpr int kSamples = 1000, kClimbed = 6;
    std::vector<Best> samples;
    for (int i = 0; i < kSamples; ++i) {  // Fibonacci's spiral: 0.11 rad between neighbours
      const double z = 1 - (2 * i + 1.0) / kSamples, t = 2.399963229728653 * i, s = std::sqrt(1 - z * z);
      const Vec3 n(s * math::cos(t), s * math::sin(t), z);
      samples.push_back({n, gapAlong(n)});
    }
    std::sort(samples.begin(), samples.end(), [](const Best& x, const Best& y) { return x.gap > y.gap; });
    std::vector<Vec3> starts = {best_.n};
    for (const Best& s : samples) {
      const bool is_near =
          std::any_of(starts.begin(), starts.end(), [&](const Vec3& n) { return (n - s.n).norm() < 0.15; });
      if (!is_near) starts.push_back(s.n);
      if (starts.size() > kClimbed || s.gap + 0.1 * slope_ < best_.gap) break;
    }
    for (const Vec3& n : starts) climb(n);
  }

  void climb(Vec3 n) {
    double gap = gapAlong(n);
    constexpr int kMostSteps = 120;  // along a kink it would creep for ever; those are tried above
    double reach = 0.08;
    for (int step = 0; step < kMostSteps && reach > 1e-10; ++step) {
      const Mat3 F = frameFromNormal(n);
      bool better = false;
      for (int k = 0; k < 12; ++k) {
        const double t = k * M_PI / 6;
        const Vec3 next = (n + reach * (math::cos(t) * F.col(0) + math::sin(t) * F.col(1))).normalized();
        const double next_gap = gapAlong(next);
        if (next_gap > gap) gap = next_gap, n = next, better = true;
      }
      if (!better) reach *= 0.5;
    }
    offer(n);
  }

  // Of all points of a from all of b: half of what gap can rise by per radian, and more.
  double spread() const {
    double most = 0;
    for (int i = 0; i < 3; ++i) {
      for (const double sign : {-1.0, 1.0}) most += 0.5 * std::abs(gapAlong(sign * Vec3::Unit(i)));
    }
    return most;
  }

  const PlainSolid& a_;
  const PlainSolid& b_;
  double slope_;  // [m/rad]
  Best best_;
};

}  // namespace convex_gap

// `shape`: a sphere, box, capsule, cylinder (with a flat) or hull.
inline PlainSolid plainSolid(const contact::Shape& shape, const Pose& X_WS) {
  PlainSolid s;
  std::visit([&](const auto& solid) { convex_gap::add(solid, s); }, shape);
  for (Vec3& p : s.corners) p = X_WS * p;
  for (PlainSolid::Disc& disc : s.discs) {
    disc.centre = X_WS * disc.centre;
    disc.axis = X_WS.q * disc.axis;
    disc.flat = X_WS.q * disc.flat;
    if (disc.flat != Vec3::Zero()) disc.flat.normalize();
  }
  for (std::vector<Vec3>* all : {&s.normals, &s.edges}) {
    for (Vec3& v : *all) v = (X_WS.q * v).normalized();
  }
  return s;
}

using ConvexGap = convex_gap::Best;

inline ConvexGap convexGap(const contact::Shape& a, const Pose& X_WA, const contact::Shape& b, const Pose& X_WB) {
  const PlainSolid sa = plainSolid(a, X_WA), sb = plainSolid(b, X_WB);
  return convex_gap::Search(sa, sb).find();
}

// Along the unit vector `n`.
inline double convexGapAlong(const contact::Shape& a, const Pose& X_WA, const contact::Shape& b, const Pose& X_WB,
                             const Vec3& n) {
  PINCER_ASSERT(isUnit(n));
  const PlainSolid sa = plainSolid(a, X_WA), sb = plainSolid(b, X_WB);
  return convex_gap::Search(sa, sb).gapAlong(n);
}

}  // namespace pincer::tasks
