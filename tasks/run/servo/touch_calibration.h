// touch_calibration: where one arm stands beside another, found by holding the two handles together at several places.
//
//   | p_A - (c + t + Rz(psi) (p_B - c)) | = d      at every place: p_A, p_B where the handles' middles are in W
//                                                  as if both arms stood as they were told to
//
//   c       reset place of arm B in W [m]; its base turns about the vertical through it
//   t, psi  by how much B's base is off that: offset [m], turn about W's z [rad] (ArmBase)
//   d       distance of the two middles, the same at all places: the handles are round [m]
// Least squares over the places by Gauss and Newton, from several turns; the best of them counts.
#pragma once
#include <span>
#include <string>

#include "pincer/tasks/run/servo/device_calibration.h"

namespace pincer::tasks {

struct HandleTouch {
  Vec3 a_W, b_W;  // the handles' middles [m]
};

constexpr std::size_t kFewestTouches = 8;  // the five unknowns, and three more by which a wrong place shows

struct TouchFinding {
  ArmBase base;            // of B
  double distance = 0;     // d [m]
  double residual = 0;     // rms of | .. | - d [m]
  std::size_t worst = 0;   // the place without which the others fit best
  double worst_error = 0;  // | .. | - d of it, by the others' fit [m]
  double sure_offset = 0;  // standard errors, from the residual: of t, the longest of its axes [m]
  double sure_turn = 0;    // of psi [rad]
};

// At least kFewestTouches touches, or throws InputError.
TouchFinding findBase(std::span<const HandleTouch> touches, const Vec3& reset_B_W);

// Is the finding good for a session? A sentence with the remedy; empty: it is.
std::string touchOddity(const TouchFinding& finding);

}  // namespace pincer::tasks
