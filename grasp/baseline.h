// baseline: published ways to render a finger, to compare ours with, in place of grasp::step.
//
//   god_object     the proxy moves to the point nearest to the device outside of all surfaces: min |p -
//                  p_F|^2 with n_i . (p - p_i) >= 0. No friction. C. B. Zilles, J. K. Salisbury, IROS
//                  1995, 146-151 (Lagrange multipliers, eq. 4-6)
//   force_shading  the same with the goal shifted along the shaded normal's plane, and a friction cone: the proxy stays
//                  while the device is within atan(mu) of the normal through it. D. C. Ruspini, K. Kolarov, O. Khatib,
//                  SIGGRAPH 1997, 345-352; what CHAI3D renders with
//   friction_cone  the proxy stays while it lies within the circle that the cone of the device cuts out of the surface,
//                  of radius mu depth about the foot, and else moves to the circle's nearest point; mu_s until it
//                  slips, then mu_d until it is held again. No shading. W. S. Harwin, N. Melder, Eurohaptics 2002,
//                  82-85; N. Melder, W. S. Harwin, HAPTICS 2004, 234-241
//   penalty        no proxy: f = k depth - d v along the normal of the nearest surface, friction mu f_n
//                  min(1, |v_t| / 1 mm/s) against the motion
//
//   all but penalty: f = k (p - p_F);   k, d  the coupling's first entries [N/m, N s/m];  p proxy, p_F device [m]
// As published they know no dynamics: forces are worked out from the poses of the last tick, and act on the
// bodies as outer forces during this one. That (and not these few lines) is what the coupled solve replaces.
// Departure: a proxy on a moving body rides with it.
#pragma once
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "pincer/grasp/step.h"

namespace pincer::grasp {

// How contact with a finger is worked out: ours, or as published.
enum class FingerMethod : unsigned char { kProxy, kGodObject, kForceShading, kPenalty, kFrictionCone };
// As scenes and the command line name them, in the order of the enumeration.
inline constexpr std::array<std::string_view, 5> kFingerMethodNames = {"proxy", "god_object", "force_shading",
                                                                       "penalty", "friction_cone"};

// The memory of a finger that isn't kProxy, from tick to tick.
struct BaselineState {
  bool has_proxy = false;
  bool slips = false;        // of the friction cone: it moved at the last tick
  int body = -1;             // on which the proxy rests, -1: none
  Vec3 p_P = Vec3::Zero();   // the proxy: in that body's frame, else in W [m]
  Vec3 p_WF = Vec3::Zero();  // of the device at the last tick [m]
};

// A grasp some of whose fingers are rendered as published. What these remember belongs to the
// state of the world: copy it with a snapshot.
class BaselineFingers {
 public:
  explicit BaselineFingers(std::vector<FingerMethod> methods);  // one per finger of the model

  // As grasp::step. Allocates nothing.
  GraspReport step(const GraspModel& model, GraspState& state, GraspScratch& scratch,
                   std::span<const FingerInput> inputs, std::span<const engine::MotionInput> motions = {},
                   std::span<const engine::DriveInput> controls = {});

 private:
  std::vector<FingerMethod> methods_;
  std::vector<BaselineState> memories_;
  std::vector<FingerReport> reports_;  // of this tick
};

}  // namespace pincer::grasp
