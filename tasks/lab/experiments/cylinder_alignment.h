// cylinder_alignment: the protocol of "turn the cylinder so that its flat faces the monitor" (A. J. Doxon,
// dissertation, University of Utah, 2014).
//
// Index finger and thumb find the flat of an upright cylinder, without seeing it, and turn it, under
// the same conditions as sphere pickup. The cylinder stands on a damped vertical pivot, or free on a table.
//
//   theta   direction of the flat's outward normal about W's z axis [rad];   theta* = pi/2: towards
//           the monitor, away from the operator (+y)
//   start   theta - theta* = +- U[start_min, start_max]
//   error   wrap(theta - theta*) when the participant answers; a time-out is censored data
//
// Sizes that Doxon leaves open are ours (docs/experiments.md).
#pragma once
#include <cstdint>
#include <vector>

#include "pincer/tasks/lab/experiments/hand_scene.h"
#include "pincer/tasks/lab/experiments/sphere_pickup.h"

namespace pincer::tasks {

struct CylinderAlignmentOptions {
  double radius = 0.020;            // [m], 0.01 .. 0.05
  double length = 0.080;            // [m], 0.02 .. 0.2
  double mass = 0.150;              // [kg], 0.01 .. 1
  double flat_half_angle = 0.7854;  // that the flat takes of the circle, half of it [rad], 0.2 .. 1.2
  double friction = 0.6;            // mu_s of the cylinder [-], 0.05 .. 5
  double dynamic_ratio = 0.85;      // mu_d / mu_s [-], 0.01 .. 1
  double torsion_radius = 3.3e-3;   // of the soft fingertip's patch [m], 0 .. 0.02
  bool pivot = true;                // false: free on a table
  double pivot_damping = 0.01;      // [N m s/rad], 0 .. 0.1
  double table_friction = 0.5;      // mu of the table under a free cylinder [-], 0 .. 5
  HandSetup hand;
  // as of the sphere (sphere_pickup.h)
  std::optional<contact::SurfaceVariant> shading = contact::SurfaceVariant::smooth;
  double start_min = 0.7854, start_max = 3.1416;  // of |theta - theta*| [rad], 0 .. pi
  double timeout = 120;                           // [s], 1 .. 600
  int repetitions = 10;                           // per condition, 1 .. 1000
  std::vector<HandCondition> conditions = publishedHandConditions();
  int participants = 1;  // 1 .. 1000
  std::uint64_t seed = 1;
};

// Distance of the flat from the axis [m].
double flatDistance(const CylinderAlignmentOptions& options);

// Throws InputError naming the first value out of range, its range and the remedy.
void validate(const CylinderAlignmentOptions& options);

struct CylinderTrialSpec {
  std::int64_t trial = 0, participant = 0, index = 0;  // as in PickupTrialSpec
  HandCondition condition;
  double start_angle = 0;  // theta - theta* [rad]
  std::uint64_t seed = 0;
  bool training = false;
};

// How far each of `count` trials begins from the target, with a sign: signs balanced to one, sizes uniform.
std::vector<double> startAngles(const CylinderAlignmentOptions& options, int count, std::uint64_t seed);

// Direction of the flat and of the target, and the one from the other within (-pi, pi] [rad].
constexpr double kTargetAngle = 1.5707963267948966;
double flatAngle(const Pose& X_WB);
double wrapAngle(double angle);

HandScene makeCylinderScene(const CylinderAlignmentOptions& options, const CylinderTrialSpec& spec);

}  // namespace pincer::tasks
