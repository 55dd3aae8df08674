// The 2D algorithm on five segments of an arc of 0.9 rad and 100 mm, for each variant of shading:
// what contact makes of radius and curvature.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/contact/curve/curve.h"
#include "pincer/tasks/judge/bench/contact_bench.h"
#include "pincer/tasks/judge/bench/objects.h"

namespace pincer::tasks {
namespace {

using contact::Curve;
using contact::SurfaceVariant;

// [m], [rad]; finger's radius and depth [m]
constexpr double kArcRadius = 0.1, kArcSweep = 0.9, kArcFinger = 0.02, kArcDepth = 0.002;
constexpr double kArcTurn = kArcSweep / 5;

struct CurveFigures {
  double least_radius = std::numeric_limits<double>::infinity(), most_radius = -least_radius;  // error [-]
  double least_kappa = least_radius, most_kappa = -least_radius;  // error of the curvature [-]
  double place = 0;                                               // largest step on the finger [m]
  double turn = 0;                                                // and of the force's direction [rad]
};

double angleOf(const Vec2& p) { return math::atan2(-p.x(), p.y()); }  // counter-clockwise from +y

// Half a segment short of the ends, whose outer halves are straight, in steps of half a milliradian.
CurveFigures alongArc(SurfaceVariant variant) {
  constexpr int kSteps = 1440;  // of half a milliradian; chosen: well below a segment
  const Curve curve(contact::arcPolygon(kArcRadius, kArcTurn, kArcSweep), variant);
  const double reach = 0.5 * (kArcSweep - kArcTurn);
  contact::CurveTracker tracker;
  contact::CurveContact last;
  CurveFigures f;
  for (int i = 0; i <= kSteps; ++i) {
    const double a = reach * (2.0 * i / kSteps - 1);
    const contact::CurveContact c = curve.queryCircle(
        (kArcRadius + kArcFinger - kArcDepth) * Vec2(-math::sin(a), math::cos(a)), kArcFinger, tracker);
    const double radius = c.p_BS.norm() / kArcRadius - 1;
    f.least_radius = std::min(f.least_radius, radius);
    f.most_radius = std::max(f.most_radius, radius);
    if (i > 0) {
      const double turned = angleOf(c.n_B) - angleOf(last.n_B), moved = (c.p_BS - last.p_BS).norm();
      f.least_kappa = std::min(f.least_kappa, turned / moved * kArcRadius - 1);
      f.most_kappa = std::max(f.most_kappa, turned / moved * kArcRadius - 1);
      f.place = std::max(f.place, kArcFinger * std::abs(c.finger_angle - last.finger_angle));
      f.turn = std::max(f.turn, std::abs(turned));
    }
    last = c;
  }
  return f;
}

std::vector<Record> smoothArc(MeasureContext&) {
  const CurveFigures f = alongArc(SurfaceVariant::smooth);
  constexpr double kExpected = -0.405;  // cos(turn / 2) - 1
  return {atMost("radius error, off -0.405 % by",
                 std::max(100 * f.most_radius - kExpected, kExpected - 100 * f.least_radius), "%", 0.01),
          atLeast("curvature error, least", 100 * f.least_kappa, "%", -0.3),
          atMost("curvature error, most", 100 * f.most_kappa, "%", 0.7),
          unbounded("largest step on the finger per 0.5 mrad", 1e3 * f.place, "mm"),
          unbounded("largest turn of the force per 0.5 mrad", f.turn / kDegree, "deg")};
}

// The baselines must be what the literature says of them: facets throw contact and force by the turn
// between segments, force shading the place.
std::vector<Record> flatArc(SurfaceVariant variant) {
  const CurveFigures f = alongArc(variant);
  std::vector<Record> records = {atMost("largest step on the finger, off r theta by",
                                        1e3 * std::abs(f.place - kArcFinger * kArcTurn), "mm", 0.06)};
  const char* const turn = "largest turn of the force per 0.5 mrad";
  if (variant == SurfaceVariant::facet) {
    records.push_back(
        atMost("largest turn of the force, off theta by", std::abs(f.turn - kArcTurn) / kDegree, "deg", 0.1));
  } else {
    records.push_back(unbounded(turn, f.turn / kDegree, "deg"));
  }
  records.push_back(unbounded("radius error, least", 100 * f.least_radius, "%"));
  records.push_back(unbounded("radius error, most", 100 * f.most_radius, "%"));
  return records;
}

}  // namespace

std::vector<Measurement> curveMeasurements() {
  return {{"curve/arc-smooth", smoothArc},
          {"curve/arc-facet", [](MeasureContext&) { return flatArc(SurfaceVariant::facet); }},
          {"curve/arc-force", [](MeasureContext&) { return flatArc(SurfaceVariant::force); }}};
}

}  // namespace pincer::tasks
