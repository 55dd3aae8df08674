// Fingertips in scene files.
#include <fmt/format.h>

#include "pincer/contact/polytope.h"
#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

contact::FingerShape readPadTip(const JsonValue& json, const std::string& file) {
  json.allowOnly(keys::kPadTip);
  const JsonValue* rounding = json.find("rounding");
  try {
    return contact::PadTip{contact::Polytope::hullOf(readPoints(json, file), "pad"),
                           rounding ? rounding->number(ranges::kTipLength) : 5e-4};
  } catch (const InputError& error) {
    json.reject(fmt::format("can't be used: {}", error.what()));
  }
}

contact::FingerShape readCapsuleTip(const JsonValue& json) {
  const JsonValue& half = json.at("half", "From the middle to one end of its axis, in the finger's frame [m].");
  const Vec3 half_F = half.vector(ranges::kTipCoordinate);
  if (!isWithin(half_F.norm(), ranges::kTipLength))
    half.reject(fmt::format("has a length of {:g} m, which {}", half_F.norm(), outOfRange(ranges::kTipLength)));
  return contact::CapsuleTip{json.at("radius", "In metres.").number(ranges::kTipLength), half_F};
}

contact::FingerShape readTip(const JsonValue& json, const std::string& file) {
  switch (json.at("type", "sphere, capsule, ellipsoid or pad.").oneOf(keys::kFingerShapeTypes)) {
    case 0:
      json.allowOnly(keys::kSphereTip);
      return contact::Sphere{json.at("radius", "In metres.").number(ranges::kTipLength)};
    case 1:
      json.allowOnly(keys::kCapsuleTip);
      return readCapsuleTip(json);
    case 2:
      json.allowOnly(keys::kEllipsoidTip);
      return contact::EllipsoidTip{json.at("semi_axes", "Along the finger's axes [m].").vector(ranges::kTipLength)};
    default:
      return readPadTip(json, file);
  }
}

}  // namespace

contact::FingerShape readFingerShape(const JsonValue& json, const std::string& file) {
  contact::FingerShape shape = readTip(json, file);
  const std::string problem = contact::problemWith(shape);
  if (!problem.empty()) json.reject("can't be used: " + problem);
  const double radius = contact::boundingRadiusOf(shape);
  if (!isWithin(radius, ranges::kTipLength))
    json.reject(fmt::format("reaches {:g} m from its origin, which {}", radius, outOfRange(ranges::kTipLength)));
  return shape;
}

}  // namespace pincer::tasks
