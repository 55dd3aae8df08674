#include "pincer/tasks/judge/exact/masonry.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"

namespace pincer::exact {
namespace {

// a H + b P >= c
struct HalfPlane {
  double a, b, c;
};

std::vector<HalfPlane> thrustLimits(int voussoirs, double thickness) {
  PINCER_ASSERT(voussoirs >= 1);
  PINCER_ASSERT(0 < thickness && thickness < 2);  // of the mean radius
  const double inner = 1 - thickness / 2, outer = 1 + thickness / 2, angle = M_PI / voussoirs;
  const double weight = 0.5 * (outer * outer - inner * inner) * math::sin(angle);
  const double centroid =
      2.0 / 3 * math::cos(angle / 2) * (math::cube(outer) - math::cube(inner)) / (outer * outer - inner * inner);
  std::vector<HalfPlane> limits;
  double V = 0, M = 0;
  const auto addJoint = [&](double f) {
    limits.push_back({-inner * math::cos(f), 1, inner * V * math::sin(f) - M});  // P + M >= r_i (V sin f + H cos f)
    limits.push_back({outer * math::cos(f), -1, M - outer * V * math::sin(f)});  // P + M <= r_e (V sin f + H cos f)
  };
  const bool crown_joint = voussoirs % 2 == 0;
  if (crown_joint) addJoint(0);
  for (int i = 0; i < (voussoirs + 1) / 2; ++i) {
    const bool keystone = !crown_joint && i == 0;  // half of it belongs to this side
    const double begin = crown_joint ? i * angle : (i - 0.5) * angle;
    const double share = keystone ? 0.5 : 1;
    // Of half the keystone: its own half's moment. The two halves of a trapezoid have their centroids at
    // x = its first moment over half its area.
    const double x = keystone ? (math::cube(outer) - math::cube(inner)) / 6 * math::sin(angle / 2) *
                                    math::sin(angle / 2) * math::cos(angle / 2) / (0.5 * weight)
                              : centroid * math::sin(begin + angle / 2);
    V += share * weight;
    M += share * weight * x;
    addJoint(begin + angle);
  }
  return limits;
}

// P between the highest lower and the lowest upper limit at this H: positive if there is room.
double room(const std::vector<HalfPlane>& limits, double H) {
  double low = -INFINITY, high = INFINITY;
  for (const HalfPlane& l : limits) {
    const double P = (l.c - l.a * H) / l.b;
    if (l.b > 0)
      low = std::max(low, P);
    else
      high = std::min(high, P);
  }
  return high - low;
}

}  // namespace

// The room is a concave function of H: its largest value by golden section; H is below the weight of the whole arch.
bool semicircularArchStands(int voussoirs, double thickness) {
  const std::vector<HalfPlane> limits = thrustLimits(voussoirs, thickness);
  double low = 0, high = M_PI * thickness;
  constexpr double kGolden = 0.6180339887498949;  // the golden section
  for (int i = 0; i < 100; ++i) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    if (room(limits, a) < room(limits, b))
      low = a;
    else
      high = b;
  }
  return room(limits, 0.5 * (low + high)) >= 0;
}

double leastThicknessOfArch(int voussoirs) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (semicircularArchStands(voussoirs, middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace pincer::exact
