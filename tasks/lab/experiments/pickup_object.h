// pickup_object: what is to be picked up, and how it lies in the dish.
//
// The dish's lowest point is W's origin. A sphere rests at (0, 0, radius). An object from a file is moved so that its
// centre of mass is B's origin, laid just above the dish and let settle, with its motion damped as by the hand that
// lays it: a ball in a dish would roll for ever. The pinch is planned along W's x axis through the centre of mass.
#pragma once
#include <cstdint>
#include <optional>

#include "pincer/contact/shape.h"
#include "pincer/engine/model.h"
#include "pincer/tasks/lab/experiments/sphere_pickup.h"

namespace pincer::tasks {

struct PickupObject {
  contact::Shape shape;
  std::optional<contact::Shape> felt;  // by fingers in its place
  Pose rest_X_WB;                      // at rest in the dish
  Vec3 place_W;                        // of the pinch: the centre of mass at rest [m]
  double half_width = 0;               // half the distance between the outermost surface points on the pinch line [m]
  double asymmetry = 0;                // how far the middle of these two is from `place_W` along the pinch line [m]
  double antipodal_angle = 0;  // largest angle between the pinch line and the surface normal at its two ends [rad]
};

// Reads, checks and settles the object. Throws InputError: unreadable or open mesh, unknown unit, wrong size, an object
// that finds no rest or is too wide for the pinch.
PickupObject makePickupObject(const SpherePickupOptions& options);

// World options and bodies of the task, the same for settling and for the trials: body 0 the dish, body 1 the object.
constexpr int kDishBody = 0, kObjectBody = 1;
engine::WorldBuilder pickupWorld(const SpherePickupOptions& options, const contact::Shape& object, double mu_s,
                                 double mu_d);

}  // namespace pincer::tasks
