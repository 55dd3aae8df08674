// pressure_map: the forces on a finger's skin, spread over a grid of taxels, as tactile
// sensors and displays with many pins have it.
//
//   sum_k f_k = f,   sum_k x_k n_k = x n,   sum_k (x_k t_ky - y_k t_kx) = tau + x t_y - y t_x
//   to round-off, for each contact
//
//   x_k = (x_k, y_k)  place of taxel k over the skin from the pad's centre, (distal, radial) [m]
//   x                 that of the contact (pad_place.h)
//   f_k = (t_kx, t_ky, n_k), f  force on the finger: along the skin (distal, radial) and into it [N]
//   tau  moment of the contact's patch about the skin's outward normal [N m]
//
// A contact is a patch of 24 points, on three rings of equal load: even pressure, or Hertz's where the pad has a
// modulus; without a patch it is a point. Each point's force goes to the four taxels around it in proportion
// (bilinear), which keeps sums and moments. The rings' mean radius is e, the radius of the torsional limit: along the
// skin each carries its share of t and a part around the middle of tau / e, so that the root mean square of friction
// over pressure is mu exactly where the contact is on its limit surface, (t / n)^2 + (tau / e n)^2 = mu^2. Where a
// patch reaches beyond the rim its force is put on the taxels there: sums are kept, moments aren't
// (FingerReport::off_grid). In a tick that was cut by an impact the map is that of one contact with the tick's mean
// force. Source of the limit surface: R. D. Howe, M. R. Cutkosky, Int. J. Robotics Res. 15 (1996) 554-572.
#pragma once
#include "pincer/grasp/step.h"

namespace pincer::grasp {

// Place of a taxel over the skin from the pad's centre, (distal, radial) [m]; row 0 is the
// most proximal, column 0 at negative radial.
Vec2 taxelPlace(const PressureGrid& grid, int row, int column);

// One contact's force to be spread, in the directions of the skin there.
struct PadForce {
  Vec2 place = Vec2::Zero();  // [m]
  Taxel force;                // [N]
  double torsion = 0;         // tau [N m]
  double radius = 0;          // e [m]; 0: a point
  bool hertz = false;         // the patch's pressure is Hertz's, not even
};

// Adds a contact to the map, rows x columns taxels. Returns the normal force that lies beyond the rim [N].
double spread(const PressureGrid& grid, const PadForce& contact, std::span<Taxel> map);

}  // namespace pincer::grasp
