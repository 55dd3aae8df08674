// Nearest points of right cylinders: first in the section (x, y), then along z.
#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/shape/direction.h"

namespace pincer::contact {
namespace {

// Nearest point `p` of a section's outline, unit normal `n` there out of the section; query point = p + distance n.
struct SectionPoint {
  Vec2 p;
  Vec2 n;
  double distance;  // [m]
};

SectionPoint nearestOnDisc(double radius, const Vec2& q) {
  PINCER_ASSERT(radius > 0);
  const auto [n, length] = directionOf<Vec2>(q, Vec2::UnitX());
  return {radius * n, n, length - radius};
}

// The disc without x > flat_distance. Its corners (flat_distance, +-half_chord) are nearest to the
// points between their two normals; everywhere else the section, being the intersection of disc and
// half-plane, has the larger of their two distances.
SectionPoint nearestOnCutDisc(double radius, double flat_distance, const Vec2& q) {
  PINCER_ASSERT(0 < flat_distance && flat_distance < radius);
  const double half_chord = std::sqrt((radius - flat_distance) * (radius + flat_distance));
  const double y = std::abs(q.y());
  if (y > half_chord && q.x() * half_chord > y * flat_distance) {
    const Vec2 corner(flat_distance, std::copysign(half_chord, q.y()));
    const auto [n, distance] = directionOf<Vec2>(q - corner, Vec2::UnitX());
    return {corner, n, distance};
  }
  const SectionPoint round = nearestOnDisc(radius, q);
  const double beyond_flat = q.x() - flat_distance;
  return beyond_flat > round.distance ? SectionPoint{{flat_distance, q.y()}, Vec2::UnitX(), beyond_flat} : round;
}

// The section drawn out to |z| <= half_length.
NearestPoint drawnOut(const SectionPoint& s, double half_length, const Vec3& p_BC) {
  PINCER_ASSERT(half_length > 0);
  const double sign = p_BC.z() < 0 ? -1 : 1;  // not copysign: -0.0 must choose like 0.0
  const double beyond_end = std::abs(p_BC.z()) - half_length;
  if (s.distance > 0 && beyond_end > 0) {  // the rim
    const auto [m, distance] = directionOf<Vec2>({s.distance, beyond_end}, Vec2::UnitX());
    return {{s.p.x(), s.p.y(), sign * half_length}, {m.x() * s.n.x(), m.x() * s.n.y(), sign * m.y()}, distance};
  }
  if (s.distance >= beyond_end) return {{s.p.x(), s.p.y(), p_BC.z()}, {s.n.x(), s.n.y(), 0}, s.distance};
  return {{p_BC.x(), p_BC.y(), sign * half_length}, {0, 0, sign}, beyond_end};
}

}  // namespace

NearestPoint nearestPoint(const Cylinder& cylinder, const Vec3& p_BC) {
  return drawnOut(nearestOnDisc(cylinder.radius, p_BC.head<2>()), cylinder.half_length, p_BC);
}

NearestPoint nearestPoint(const CylinderWithFlat& cylinder, const Vec3& p_BC) {
  return drawnOut(nearestOnCutDisc(cylinder.radius, cylinder.flat_distance, p_BC.head<2>()), cylinder.half_length,
                  p_BC);
}

}  // namespace pincer::contact
