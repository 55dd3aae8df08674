// grasp_quality: how well fingers hold a body, from the contacts of one tick. Off the tick: it
// allocates, and takes milliseconds to seconds.
//
// Sources: C. Ferrari, J. Canny, ICRA 1992, 2290-2295 (epsilon, volume); V.-D. Nguyen, Int. J. Robotics Res.
// 7 (1988) 3-16 (force closure); T. Yoshikawa, K. Nagai, IEEE Trans. Robotics Autom. 7 (1991) 67-77
// (internal force: the part that moves nothing).
#pragma once
#include <array>
#include <vector>

#include "pincer/grasp/step.h"

namespace pincer::grasp {

using Vec6 = Eigen::Matrix<double, 6, 1>;

// A finger's contact with the body, in frame C (axes t1, t2, n; n out of the body).
struct GraspContact {
  int finger = 0;
  Vec3 p_W = Vec3::Zero();       // [m]
  Mat3 R_WC = Mat3::Identity();  // columns (t1, t2, n)
  double mu = 0;                 // [-], >= 0
  double torsion_radius = 0;     // e [m]; 0 for a point contact
  double f_n = 0;                // pressed on the body, >= 0 [N]
  Vec2 f_T_C = Vec2::Zero();     // on the body, along t1 and t2 [N]
  double tau_n = 0;              // on the body, about -n [N m]
};

// The fingers' contacts on `body` that pressed in the last tick, in the engine's order. `scratch` as that tick left it.
std::vector<GraspContact> graspContacts(const GraspModel& model, const GraspScratch& scratch, int body);

// How far from slipping: 1 - sqrt(f_T^2 + (tau_n/e)^2) / (mu f_n). 1: no tangential load; 0: slips. 0 for a
// contact that doesn't press or has no friction.
double slipMargin(const GraspContact& contact);

struct GraspQuality {
  std::vector<GraspContact> contacts;
  double rho = 0;  // length that makes torques forces: the furthest contact's distance from the centre of mass [m]
  int rank = 0;    // of the grasp matrix, 0 .. 6
  bool force_closure = false;  // any small wrench can be resisted by squeezing
  // the least wrench (f, tau/rho) that the grasp can resist per newton of summed normal force, over directions
  double epsilon = 0;
  Vec6 weakest_W = Vec6::Zero();  // its direction (f, tau/rho), unit
  double volume = 0;              // of the 6-dimensional set of wrenches, good to some per cent (quality/wrench_set.h)
  std::vector<double> slip_margins;  // per contact
  std::vector<Vec3> internal_f_W;  // per contact: the part of its force on the body that the other contacts cancel [N]
  double squeeze = 0;              // summed normal force [N]
  // The wrench cone along the world's axes: the largest force or torque on the body that its
  // contacts can resist per newton of squeeze, alone: pushes along x, -x, y, -y, z, -z [N/N], then
  // turns about them [N m/N]; 0 where none is resisted.
  std::array<double, 12> resisted{};
  double least_squeeze = 0;  // that could hold the body's weight [N]; infinite if none can
};

// `body` must be a dynamic one. Empty contacts: rank 0, least_squeeze infinite.
GraspQuality graspQuality(const GraspModel& model, const GraspState& state, const GraspScratch& scratch, int body);

// Of given contacts, about the centre of mass p_WC, for a body of weight `weight_W` [N].
GraspQuality graspQuality(std::vector<GraspContact> contacts, const Vec3& p_WC, const Vec3& weight_W);

}  // namespace pincer::grasp
