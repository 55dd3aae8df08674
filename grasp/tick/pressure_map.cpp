#include "pincer/grasp/pressure_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pincer/contact/assert.h"

namespace pincer::grasp {
namespace {

constexpr int kRings = 3, kSpokes = 8;               // 24 points stand for a patch
constexpr double kShare = 1.0 / (kRings * kSpokes);  // of the load that a point carries [-]

// Radii of the rings that halve each third of the load, over their mean: sqrt(m), and sqrt(1
// - (1 - m)^(2/3)), for m = 1/6, 1/2, 5/6.
constexpr std::array<double, kRings> kEven = {0.6038502962160023, 1.0458993932116325, 1.350250310572365};
constexpr std::array<double, kRings> kHertz = {0.5696773984788521, 1.0243369922570644, 1.4059856092640834};
constexpr double kHalfRoot = 0.70710678118654752440;
constexpr double kCos = 0.92387953251128675613, kSin = 0.38268343236508977173;  // of 22.5 degrees

// Unit directions; the rings take turns, so that the points don't lie on rays.
using Spokes = std::array<std::array<double, 2>, kSpokes>;
// Every 45 degrees, from x on.
constexpr Spokes kStraight = {{{1, 0},
                               {kHalfRoot, kHalfRoot},
                               {0, 1},
                               {-kHalfRoot, kHalfRoot},
                               {-1, 0},
                               {-kHalfRoot, -kHalfRoot},
                               {0, -1},
                               {kHalfRoot, -kHalfRoot}}};
// Half way between those.
constexpr Spokes kTurned = {{{kCos, kSin},
                             {kSin, kCos},
                             {-kSin, kCos},
                             {-kCos, kSin},
                             {-kCos, -kSin},
                             {-kSin, -kCos},
                             {kSin, -kCos},
                             {kCos, -kSin}}};

// A place along one axis: the taxel before it and how far on, 0 .. 1, it lies towards the next.
struct Cell {
  int index;
  double on;
  bool beyond;
};
Cell cellOf(double x, double pitch, int count) {
  const double last = count - 1, at = x / pitch + last / 2;
  const double inside = std::clamp(at, 0.0, last);
  const int index = std::min(static_cast<int>(inside), count - 2);
  constexpr double kRoundOff = 1e-9;  // of a taxel's pitch
  return {index, inside - index, std::abs(at - inside) > kRoundOff};
}

void add(const Taxel& force, double share, Taxel& taxel) {
  taxel.normal += share * force.normal;
  taxel.tangential += share * force.tangential;
}

// True if the point lies beyond the rim.
bool addPoint(const PressureGrid& grid, const Vec2& place, const Taxel& force, std::span<Taxel> map) {
  const Cell row = cellOf(place.x(), grid.pitch, grid.rows), column = cellOf(place.y(), grid.pitch, grid.columns);
  Taxel* const corner = &map[static_cast<std::size_t>(row.index * grid.columns + column.index)];
  add(force, (1 - row.on) * (1 - column.on), corner[0]);
  add(force, (1 - row.on) * column.on, corner[1]);
  add(force, row.on * (1 - column.on), corner[grid.columns]);
  add(force, row.on * column.on, corner[grid.columns + 1]);
  return row.beyond || column.beyond;
}

}  // namespace

Vec2 taxelPlace(const PressureGrid& grid, int row, int column) {
  return {grid.pitch * (row - 0.5 * (grid.rows - 1)), grid.pitch * (column - 0.5 * (grid.columns - 1))};
}

double spread(const PressureGrid& grid, const PadForce& contact, std::span<Taxel> map) {
  PINCER_ASSERT(map.size() == static_cast<std::size_t>(grid.rows * grid.columns));
  if (!(contact.radius > 0)) return addPoint(grid, contact.place, contact.force, map) ? contact.force.normal : 0;
  const auto& radii = contact.hertz ? kHertz : kEven;
  const double around = contact.torsion / contact.radius;  // sum of the points' forces around the middle [N]
  double beyond = 0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double r = contact.radius * radii[static_cast<std::size_t>(ring)];
    for (const auto& [c, s] : ring % 2 ? kTurned : kStraight) {
      Taxel force{kShare * contact.force.normal, kShare * (contact.force.tangential + around * Vec2(-s, c))};
      if (addPoint(grid, contact.place + r * Vec2(c, s), force, map)) beyond += force.normal;
    }
  }
  return beyond;
}

}  // namespace pincer::grasp
