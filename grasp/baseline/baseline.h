// baseline: published ways to render a finger, to compare ours with. Selected per finger (FingerModel::method).
//
//   god_object     the proxy moves to the point nearest to the device outside of all surfaces: min |p - p_F|^2 with n_i . (p - p_i) >= 0.
//                  No friction. C. B. Zilles, J. K. Salisbury, IROS 1995, 146-151 (Lagrange multipliers, eq. 4-6)
//   force_shading  the same with the goal shifted along the shaded normal's plane, and a friction cone: the proxy stays while the device is within
//                  atan(mu) of the normal through it. D. C. Ruspini, K. Kolarov, O. Khatib, SIGGRAPH 1997, 345-352; what CHAI3D renders with
//   penalty        no proxy: f = k depth - d v along the normal of the nearest surface, friction mu f_n min(1, |v_t| / 1 mm/s) against the motion
//
//   god_object and force_shading: f = k (p - p_F);   k, d  the coupling's first entries [N/m, N s/m];  p proxy, p_F device [m]
// As published they know no dynamics: forces are worked out from the poses of the last tick, and act on the bodies as outer forces during this
// one. That (and not these few lines) is what the coupled solve replaces. Departure: a proxy on a moving body rides with it.
#pragma once
#include <span>

#include "grasp/step.h"

namespace pincer::grasp {

// Forces of all fingers that aren't kProxy: on the bodies' momenta, and into `scratch.baselines`, their reports. Allocates nothing.
void renderBaselines(const GraspModel& model, GraspState& state, GraspScratch& scratch, std::span<const FingerInput> inputs);

}  // namespace pincer::grasp
