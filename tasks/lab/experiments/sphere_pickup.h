// sphere_pickup: the protocol of "pick up spheres of different friction" (A. J. Doxon,
// dissertation, University of Utah, 2014).
//
// Index finger and thumb, facing each other, pick up an object that lies in a shallow dish, without seeing it,
// under conditions (hand_condition.h), as published two: force only (tactors parked) and contact location display +
// force. Every participant does every friction `repetitions` times per condition, in an order shuffled by the seed;
// every other participant begins with the last condition. Smallest grip that can carry the object: m g / (2 mu).
// Sizes that Doxon leaves open are ours (docs: design of the tasks).
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pincer/contact/error.h"
#include "pincer/contact/surface_contact.h"
#include "pincer/tasks/lab/experiments/hand_condition.h"
#include "pincer/tasks/lab/experiments/hand_setup.h"

namespace pincer::tasks {

struct ObjectFile {
  std::string path;                 // of a closed mesh: OBJ, STL, PLY or OFF
  std::string units = "mm";         // m, cm, mm, in
  std::optional<double> size = {};  // its largest dimension is made this [m], 0.005 .. 0.2, whatever the units
  contact::SurfaceVariant shading = contact::SurfaceVariant::smooth;  // how fingers feel it
};

struct SpherePickupOptions {
  double radius = 0.020;                                  // of the sphere [m], 0.005 .. 0.05
  double mass = 0.075;                                    // of the object [kg], 0.001 .. 1
  std::vector<double> frictions{0.30, 0.45, 0.60, 0.90};  // mu_s of the object [-], each 0.05 .. 5
  double dynamic_ratio = 0.85;                            // mu_d / mu_s [-], (0, 1]
  double torsion_radius = 3.3e-3;                         // of the soft fingertip's patch [m], 0 .. 0.02
  double dish_radius = 0.150;                             // of curvature [m], 0.1 .. 10
  double dish_friction = 0.5;  // mu of the dish [-], 0 .. 5; with the object: the geometric mean
  HandSetup hand;
  double success_height = 0.050;  // [m], 0.005 .. 0.08 (the arms' reach)
  double hold_time = 1.0;         // at that height [s], 0 .. 10
  double timeout = 60;            // [s], 1 .. 600
  int repetitions = 5;            // of every friction per condition, 1 .. 1000
  std::vector<HandCondition> conditions = publishedHandConditions();
  int participants = 1;  // 1 .. 1000
  std::uint64_t seed = 1;
  std::optional<ObjectFile> object;  // in place of the sphere
  // Shading by which fingers feel the sphere, a mesh; absent: its closed form. Bodies
  // and mass know the closed form in any case.
  std::optional<contact::SurfaceVariant> shading = contact::SurfaceVariant::smooth;
};

// Throws InputError naming the first value out of range, its range and the remedy.
void validate(const SpherePickupOptions& options);

// One trial of the protocol.
struct PickupTrialSpec {
  std::int64_t trial = 0;        // within the session, from 0
  std::int64_t participant = 0;  // from 0
  std::int64_t index = 0;        // place in the participant's order, from 0
  HandCondition condition;
  double mu_s = 0.5, mu_d = 0.5;
  std::uint64_t seed = 0;  // of all that varies in this trial
  bool training = false;
};

// Every trial of the study, in the order of its doing; those of one participant, their `trial` from 0. Throws as
// validate().
std::vector<PickupTrialSpec> pickupTrials(const SpherePickupOptions& options);
std::vector<PickupTrialSpec> pickupTrialsOf(const SpherePickupOptions& options, std::int64_t participant);

// The seed of a participant's own constants.
std::uint64_t participantSeed(const SpherePickupOptions& options, std::int64_t participant);

}  // namespace pincer::tasks
