#include "pincer/contact/shape/solid_feature.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {
namespace {

// Names: corners, then edges, then what a solid has one or two of.
constexpr std::uint32_t kEdges = 1u << 14, kFaces = 2u << 14, kRims = 3u << 14, kNameBits = (1u << 14) - 1;

double shareOf(const Vec3& from, const Vec3& to, const Vec3& p) {
  const Vec3 line = to - from;
  return line.dot(p - from) / line.squaredNorm();
}
Vec3 nearestOnSegment(const Vec3& from, const Vec3& to, const Vec3& p) {
  return from + std::clamp(shareOf(from, to, p), 0.0, 1.0) * (to - from);
}

}  // namespace

SolidFeature::SolidFeature(const Shape& shape, const Vec3& c, const Vec3& d, double skin, double lift, double slack)
    : rho_(skin) {
  PINCER_ASSERT(isUnitIfFinite(d) && lift > 0);
  facetOf(shape, d, face_);
  if (const auto* cut = std::get_if<CylinderWithFlat>(&shape)) flat_ = cut->flat_distance;
  const double rounding = roundingOf(shape);
  rho_ += rounding;
  if (face_.count > 2)
    setOnPolygon(c, lift, slack);
  else if (face_.count == 2)
    setLine(face_, c, rounding, slack);
  else
    setPoint(face_.corners[0].p, face_.corners[0].vertex);
}

void SolidFeature::setPoint(const Vec3& p, std::uint32_t name) {
  kind_ = Kind::point;
  from_ = p;
  name_ = name & kNameBits;
}

void SolidFeature::setSegment(const Vec3& from, const Vec3& to, std::uint32_t name) {
  kind_ = Kind::segment;
  from_ = from;
  to_ = to;
  name_ = kEdges | (name & kNameBits);
}

// A capsule's core, a cylinder's round wall, which ends at its rims, or a sharp edge.
void SolidFeature::setLine(const Facet& f, const Vec3& c, double rounding, double slack) {
  const FacetCorner &a = f.corners[0], &b = f.corners[1];
  const double length = (b.p - a.p).norm(), along = length * shareOf(a.p, b.p, c);
  const bool is_wall = f.line_radius > 0 && !(rounding > 0), is_at_a = along<slack, is_at_b = along> length - slack;
  if (is_wall) {
    circle_ = f.line_radius;
    if (is_at_a || is_at_b) return setOnRim((is_at_a ? a : b).p.z());
    const double z = std::max(a.p.z(), b.p.z());
    rho_ += circle_;
    return setSegment({0, 0, -z}, {0, 0, z}, a.edge);
  }
  if (is_at_a) return setPoint(a.p, a.vertex);
  if (is_at_b) return setPoint(b.p, b.vertex);
  setSegment(a.p, b.p, a.edge);
}

void SolidFeature::setOnPolygon(const Vec3& c, double lift, double slack) {
  circle_ = face_.rim_radius;
  for (int i = 0; i < face_.count; ++i) {
    if (!face_.isStraight(i)) continue;
    const FacetCorner &a = face_.corners[static_cast<std::size_t>(i)],
                      &b = face_.corners[static_cast<std::size_t>((i + 1) % face_.count)];
    const Vec3 inwards = face_.n.cross(b.p - a.p).normalized();
    if (!(inwards.dot(c - a.p) < slack)) continue;
    const double length = (b.p - a.p).norm(), along = length * shareOf(a.p, b.p, c);
    if (along < slack) return setPoint(a.p, a.vertex);
    if (along > length - slack) return setPoint(b.p, b.vertex);
    return setSegment(a.p, b.p, a.edge);
  }
  if (circle_ > 0 && c.head<2>().norm() > circle_ - slack) return setOnRim(face_.corners[0].p.z());
  kind_ = Kind::face;
  name_ = kFaces | face_.corners[0].vertex;
  lift_ = lift;
  rho_ += lift;
  for (int i = 0; i < face_.count; ++i) face_.corners[static_cast<std::size_t>(i)].p -= lift * face_.n;
}

void SolidFeature::setOnRim(double z) {
  kind_ = Kind::circle;
  from_ = Vec3(0, 0, z);
  name_ = kRims | (z < 0);
}

Vec3 SolidFeature::nearest(const Vec3& p) const {
  switch (kind_) {
    case Kind::point:
      return from_;
    case Kind::segment:
      return nearestOnSegment(from_, to_, p);
    case Kind::circle:
      return nearestOnCircle(p);
    case Kind::face:
      return nearestOfFace(p);
  }
  return from_;
}

// An arc where a flat cuts the circle off.
Vec3 SolidFeature::nearestOnCircle(const Vec3& p) const {
  const double length = p.head<2>().norm(), z = from_.z();
  const Vec2 on = length > 0 ? Vec2(circle_ / length * p.head<2>()) : Vec2(-circle_, 0);
  if (!(on.x() > flat_)) return {on.x(), on.y(), z};
  const double half_chord = std::sqrt((circle_ - flat_) * (circle_ + flat_));
  return {flat_, on.y() < 0 ? -half_chord : half_chord, z};
}

// Within the circle, if there is one, and inside all straight sides; else the nearest point of a side.
Vec3 SolidFeature::nearestOfFace(const Vec3& p) const {
  Vec3 best = p - face_.n.dot(p - face_.corners[0].p) * face_.n;
  if (circle_ > 0 && best.head<2>().norm() > circle_) best.head<2>() *= circle_ / best.head<2>().norm();
  bool is_inside = true;
  Vec3 on_side = best;
  double least2 = kInfinity;
  for (int i = 0; i < face_.count; ++i) {
    if (!face_.isStraight(i)) continue;
    const Vec3 &a = face_.corners[static_cast<std::size_t>(i)].p,
               &b = face_.corners[static_cast<std::size_t>((i + 1) % face_.count)].p;
    is_inside = is_inside && face_.n.cross(b - a).dot(best - a) >= 0;
    const Vec3 s = nearestOnSegment(a, b, best);
    if ((s - best).squaredNorm() < least2) least2 = (s - best).squaredNorm(), on_side = s;
  }
  return is_inside ? best : on_side;
}

bool SolidFeature::isEnd(const Vec3& c, double slack) const {
  if (kind_ == Kind::segment) return std::min((c - from_).norm(), (c - to_).norm()) < slack;
  if (kind_ != Kind::face) return false;
  if (circle_ > 0 && c.head<2>().norm() > circle_ - slack) return true;
  for (int i = 0; i < face_.count; ++i) {
    if (!face_.isStraight(i)) continue;
    const Vec3 &a = face_.corners[static_cast<std::size_t>(i)].p,
               &b = face_.corners[static_cast<std::size_t>((i + 1) % face_.count)].p;
    if (face_.n.cross(b - a).normalized().dot(c - a) < slack) return true;
  }
  return false;
}

}  // namespace pincer::contact
