// shell_contact: a place of the surface over whose normal a fingertip's centre lies, as walks find it (shell_solver.h).
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "pincer/contact/math.h"
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

// A point of the surface: barycentric coordinates of a triangle's corners 0, 1, 2, each >= 0, their sum 1.
struct Foot {
  std::int32_t triangle = 0;
  std::array<double, 3> b = {1.0 / 3, 1.0 / 3, 1.0 / 3};

  bool isOnFace() const { return std::min({b[0], b[1], b[2]}) > 0; }  // not on an edge or a vertex
};

// Work that a walk took.
struct WalkCost {
  int steps = 0;      // within faces, and visits of edges and vertices
  int crossings = 0;  // of edges
};

// How the foot moves with the centre: coordinates 1 and 2 change by du.dC, dv.dC [1/m]. Zero where it isn't known.
struct FootMotion {
  Vec3 du = Vec3::Zero(), dv = Vec3::Zero();
};

struct ShellContact {
  Foot foot;
  Vec3 n = Vec3::UnitZ();  // unit; C - h n is the contact point to within 1e-9 m
  double h = 0;            // [m], negative when the centre lies under the surface
  // false: no solution within the budget of 20 steps, and `foot` is where the walk began, or where it met
  bool converged = false;
  WalkCost cost;
  FootMotion motion = {};
};

inline Foot footOf(const SurfaceSlot& slot) {
  return {slot.triangle, {std::max(0.0, 1 - slot.u - slot.v), slot.u, slot.v}};
}
inline bool knowsMotion(const SurfaceSlot& slot) { return slot.du != Vec3(Vec3::Zero()); }

}  // namespace pincer::contact
