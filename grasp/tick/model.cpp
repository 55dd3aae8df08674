#include "pincer/grasp/model.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/pair_query.h"

namespace pincer::grasp {
namespace {

void checkPadRange(const FingerModel& finger, const char* what, double value, double high, const char* remedy) {
  if (value >= 0 && value <= high) return;
  throw InputError(
      fmt::format("finger \"{}\": {} = {} is out of range [0, {}]. {}", finger.name, what, value, high, remedy));
}

void checkCoupling(const FingerModel& finger) {
  checkPadRange(finger, "patch_radius", finger.pad.patch_radius, 0.1,
                "It is in metres; a fingertip's patch has 0.004 to 0.006.");
  checkPadRange(finger, "modulus", finger.pad.modulus, 1e12, "It is in pascals; a fingertip has about 1e5.");
  checkPadRange(finger, "effective_radius", finger.pad.effective_radius, 10,
                "It is in metres; 0 takes the fingertip's own.");
  if (finger.pad.patch_radius > 0 && finger.pad.modulus > 0) {
    throw InputError(
        fmt::format("finger \"{}\": patch_radius and modulus both say how large the patch is. Keep one.", finger.name));
  }
  if (finger.along_normal && finger.coupling.locked.any()) {
    throw InputError(fmt::format(
        "finger \"{}\": locked axes are the world's, its stiffness is along the contact's. Keep one.", finger.name));
  }
}

void checkTaxels(const FingerModel& finger) {
  constexpr int kFewest = 2, kMost = 64;  // taxels a side: forces are shared between neighbours
  const PressureGrid& grid = finger.taxels;
  if (grid.rows == 0 && grid.columns == 0) return;
  for (const int n : {grid.rows, grid.columns}) {
    if (n >= kFewest && n <= kMost) continue;
    throw InputError(
        fmt::format("finger \"{}\": taxels in {} rows and {} columns are out of range {} .. {} each. A fingerpad's "
                    "sensor has 8 x 6.",
                    finger.name, grid.rows, grid.columns, kFewest, kMost));
  }
  if (grid.pitch > 0 && grid.pitch <= 0.1) return;
  throw InputError(
      fmt::format("finger \"{}\": pitch of the taxels = {} is out of range (0, 0.1]. It is in metres; 0.002 is usual.",
                  finger.name, grid.pitch));
}

void check(const FingerModel& finger) {
  if (finger.shape) {
    const std::string problem = contact::problemWith(*finger.shape);
    if (!problem.empty()) throw InputError(fmt::format("finger \"{}\": {}", finger.name, problem));
  }
  checkCoupling(finger);
  checkTaxels(finger);
  if (!(finger.radius > 0 && finger.radius <= 1)) {
    throw InputError(
        fmt::format("finger \"{}\": radius = {} is out of range (0, 1]. It is in metres; a fingertip has about 0.008.",
                    finger.name, finger.radius));
  }
  if (!(finger.reach >= 0 && finger.reach <= 10)) {
    throw InputError(
        fmt::format("finger \"{}\": reach = {} is out of range [0, 10]. It is in metres; 0.03 is the usual one.",
                    finger.name, finger.reach));
  }
  const double tolerance = 1e-6;
  const bool orthonormal = std::abs(finger.pad_normal_F.norm() - 1) < tolerance &&
                           std::abs(finger.distal_F.norm() - 1) < tolerance &&
                           std::abs(finger.pad_normal_F.dot(finger.distal_F)) < tolerance;
  if (!orthonormal) {
    throw InputError(fmt::format(
        "finger \"{}\": pad_normal and distal must be unit vectors at right angles. Normalise them.", finger.name));
  }
}

}  // namespace

double patchRadius(const SoftPad& pad, double tip_radius, double f_n) {
  PINCER_ASSERT(!(f_n < 0));
  if (pad.patch_radius > 0) return pad.patch_radius;
  if (!(pad.modulus > 0)) return 0;
  const double R = pad.effective_radius > 0 ? pad.effective_radius : tip_radius;
  return math::cbrt(0.75 * f_n * R / pad.modulus);
}

double torsionRadius(const SoftPad& pad, double tip_radius, double f_n) {
  constexpr double kLeastForce = 1e-3;  // a patch of no size would be no patch, and the contact's rows would change [N]
  if (pad.patch_radius > 0) return 2.0 / 3 * pad.patch_radius;
  return 3.0 / 16 * std::numbers::pi * patchRadius(pad, tip_radius, std::max(f_n, kLeastForce));
}

GraspModel buildGrasp(engine::WorldBuilder builder, std::vector<FingerModel> fingers) {
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    check(fingers[i]);
    if (fingers[i].shape) fingers[i].radius = contact::boundingRadiusOf(*fingers[i].shape);
    fingers[i].coupling.name = fingers[i].name;
    if (builder.addPoint(fingers[i].coupling) != static_cast<int>(i)) {
      throw InputError("the world already has driven points; fingers come first. Add other points after the fingers.");
    }
  }
  return {builder.build(), std::move(fingers)};
}

void feelAs(GraspModel& model, int body, contact::Shape shape) {
  PINCER_DEMAND(isIndex(body, model.world.bodies.size()), "feelAs: there is such a body");
  engine::BodyModel& b = model.world.bodies[static_cast<std::size_t>(body)];
  engine::ColliderModel& collider = model.world.colliders[static_cast<std::size_t>(b.first_collider)];
  const double reach = contact::boundingRadius(shape);
  if (b.collider_count != 1 || !std::isfinite(reach) || !std::isfinite(collider.bounding_radius))
    throw InputError(fmt::format(
        "body \"{}\": fingers can feel another surface of a body of one bounded shape only. Give it one, or give its "
        "shapes the surface that is to be felt.",
        b.name));
  collider.bounding_radius = std::max(collider.bounding_radius, reach);
  b.bounding_radius = std::max(b.bounding_radius, reach + (collider.X_BS.p - b.X_BI.p).norm());
  if (std::holds_alternative<contact::Mesh>(shape)) b.may_be_hollow = model.world.has_hollows = true;
  model.felt.push_back({b.first_collider, std::move(shape)});
}

}  // namespace pincer::grasp
