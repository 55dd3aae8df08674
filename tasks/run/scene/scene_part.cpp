// The shapes of a body of several, and an inertia that is given.
#include <fmt/format.h>

#include <set>

#include "pincer/engine/motion/mass.h"
#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

constexpr std::size_t kMostParts = 1024;  // of a body
constexpr int kMostBits = 2147483647;     // 2^31 - 1: 31 groups, what a signed 32-bit integer holds

std::uint32_t readBits(const JsonValue& json, std::string_view key) {
  const JsonValue* bits = json.find(key);
  return bits ? static_cast<std::uint32_t>(
                    bits->integer(0, kMostBits, "A sum of powers of two, one for each group: 1, 2, 4, ..."))
              : 1u;
}

Pose readPartPose(const JsonValue& json, const contact::Shape& shape) {
  if (!std::holds_alternative<contact::HalfSpace>(shape))
    return {quatFromRotationVector(readVector(json, "rotation", ranges::kRotation)),
            readVector(json, "position", ranges::kCoordinate)};
  for (const std::string_view key : {"position", "rotation"})
    refuse(json, key, "doesn't go with a half-space: its shape has \"point\" and \"normal\".");
  return readHalfSpacePose(json.at("shape"));
}

// One shape, or those of a file of pieces.
std::vector<contact::Shape> readPartShapes(const JsonValue& json, const std::string& file, SceneHulls& hulls) {
  const JsonValue* pieces = json.find("pieces");
  if (!pieces)
    return {readShape(json.at("shape", "For example {\"type\": \"sphere\", \"radius\": 0.02}."), file, hulls)};
  refuse(json, "shape", "doesn't go with \"pieces\". Keep one of the two.");
  return readPieces(*pieces, file);
}

// The entry's mass, by volume.
void weigh(const JsonValue& json, std::vector<engine::ColliderSpec>& parts) {
  const auto volume = [&] {
    double sum = 0;
    for (const engine::ColliderSpec& part : parts) sum += engine::volumeOf(part.shape);
    return sum;
  };
  const std::optional<double> weight = readWeight(json, volume);
  if (!weight) return;
  if (parts.size() == 1) {
    parts[0].mass = *weight;
    return;
  }
  const double whole = volume();
  for (engine::ColliderSpec& part : parts) part.mass = *weight * engine::volumeOf(part.shape) / whole;
}

std::vector<engine::ColliderSpec> readPart(const JsonValue& json, const std::string& file, SceneHulls& hulls) {
  json.allowOnly(keys::kPart);
  engine::ColliderSpec common;
  if (const JsonValue* material = json.find("material")) common.material = readMaterial(*material);
  if (const JsonValue* collides = json.find("collides")) {
    collides->allowOnly(keys::kCollides);
    common.bits = {readBits(*collides, "as"), readBits(*collides, "with")};
  }
  std::vector<engine::ColliderSpec> parts;
  for (const contact::Shape& shape : readPartShapes(json, file, hulls)) {
    engine::ColliderSpec& part = parts.emplace_back(common);
    part.shape = shape;
    part.X_BS = readPartPose(json, shape);
  }
  weigh(json, parts);
  return parts;
}

std::string readPartName(const JsonValue& json, std::size_t number, std::set<std::string>& taken) {
  const JsonValue* name = json.find("name");
  const std::string text = name ? name->text() : fmt::format("shape{}", number);
  const JsonValue& place = name ? *name : json;
  requireName(text, place);
  if (!taken.insert(text).second) place.reject(fmt::format("is the second shape of this body called \"{}\".", text));
  return text;
}

}  // namespace

std::vector<engine::ColliderSpec> readParts(const JsonValue& json, const std::string& file, SceneHulls& hulls) {
  const std::vector<JsonValue>& entries = json.array();
  if (entries.empty()) json.reject("is empty. Give the body one shape or more.");
  std::vector<engine::ColliderSpec> parts;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::string name = readPartName(entries[i], i, taken);
    std::vector<engine::ColliderSpec> of_entry = readPart(entries[i], file, hulls);
    for (std::size_t k = 0; k < of_entry.size(); ++k) {
      of_entry[k].name = of_entry.size() == 1 ? name : fmt::format("{}-{}", name, k);
      parts.push_back(std::move(of_entry[k]));
    }
  }
  if (parts.size() > kMostParts)
    json.reject(fmt::format("has {} shapes; a body has at most {}.", parts.size(), kMostParts));
  return parts;
}

// The tensor in the axes that "rotation" turns to: moments on the diagonal, products xy, xz, yz beside it.
engine::GivenInertia readInertia(const JsonValue& json) {
  json.allowOnly(keys::kInertia);
  const Vec3 moments = json.at("moments", "[xx, yy, zz] in kg m^2.").vector(ranges::kMoment);
  const Vec3 products = readVector(json, "products", ranges::kProduct);
  Mat3 I = moments.asDiagonal();
  I(0, 1) = I(1, 0) = products[0];
  I(0, 2) = I(2, 0) = products[1];
  I(1, 2) = I(2, 1) = products[2];
  const Mat3 R = quatFromRotationVector(readVector(json, "rotation", ranges::kRotation)).toRotationMatrix();
  const Mat3 turned = R * I * R.transpose();
  return {readVector(json, "center", ranges::kCoordinate),
          json.find("rotation") ? Mat3(0.5 * (turned + turned.transpose())) : I};
}

}  // namespace pincer::tasks
