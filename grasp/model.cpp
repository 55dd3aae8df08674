#include "grasp/model.h"

#include <fmt/format.h>

namespace pincer::grasp {
namespace {

void check(const FingerModel& finger) {
  if (!(finger.radius > 0 && finger.radius <= 1)) {
    throw InputError(fmt::format("finger \"{}\": radius = {} is out of range (0, 1]. It is in metres; a fingertip has about 0.008.",
                                 finger.name, finger.radius));
  }
  if (!(finger.reach >= 0 && finger.reach <= 10)) {
    throw InputError(fmt::format("finger \"{}\": reach = {} is out of range [0, 10]. It is in metres; 0.03 is the usual one.", finger.name,
                                 finger.reach));
  }
  const double tolerance = 1e-6;
  const bool orthonormal = std::abs(finger.pad_normal_F.norm() - 1) < tolerance && std::abs(finger.distal_F.norm() - 1) < tolerance &&
                           std::abs(finger.pad_normal_F.dot(finger.distal_F)) < tolerance;
  if (!orthonormal) {
    throw InputError(
        fmt::format("finger \"{}\": pad_normal and distal must be unit vectors at right angles. Normalise them.", finger.name));
  }
}

}  // namespace

GraspModel buildGrasp(engine::WorldBuilder builder, std::vector<FingerModel> fingers) {
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    check(fingers[i]);
    fingers[i].coupling.name = fingers[i].name;
    if (builder.addPoint(fingers[i].coupling) != static_cast<int>(i)) {
      throw InputError("the world already has driven points; fingers come first. Add other points after the fingers.");
    }
  }
  return {builder.build(), std::move(fingers)};
}

}  // namespace pincer::grasp
