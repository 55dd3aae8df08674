#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

bool isNameLetter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'; }

}  // namespace

void requireName(const std::string& name, const JsonValue& place) {
  if (name.empty() || !std::all_of(name.begin(), name.end(), isNameLetter))
    place.reject("isn't a name: letters, digits, - and _ only.");
  if (name.size() > kLongestName)
    place.reject(fmt::format("is too long for a name: it has {} letters, at most {} go.", name.size(), kLongestName));
}

void SceneNames::take(const std::string& name, const JsonValue& place) {
  requireName(name, place);
  if (taken_.insert(name).second) return;
  place.reject(fmt::format(
      "can't be called \"{}\": another body, joint, drive, frame or finger is. Names tell them apart in quantities.",
      name));
}

void SceneNames::takeBody(const std::string& name, const JsonValue& place, const Scene& scene) {
  take(name, place);
  bodies_.emplace(name, static_cast<int>(scene.bodies.size()));
}

std::string SceneNames::readNext(const JsonValue& json, const std::string& otherwise) {
  const JsonValue* value = json.find("name");
  std::string name = value ? value->text() : otherwise;
  take(name, value ? *value : json);
  return name;
}

std::string SceneNames::readNextBody(const JsonValue& json, const Scene& scene) {
  std::string name = readNext(json, fmt::format("body{}", scene.bodies.size()));
  bodies_.emplace(name, static_cast<int>(scene.bodies.size()));
  return name;
}

int SceneNames::bodyNamed(const JsonValue& json, const Scene& scene) const {
  const auto found = bodies_.find(json.text());
  if (found != bodies_.end()) return found->second;
  std::vector<std::string_view> bodies;
  for (const engine::BodySpec& body : scene.bodies) bodies.push_back(body.name);
  return static_cast<int>(json.oneOf(bodies));
}

int SceneNames::jointNamed(const JsonValue& json, const Scene& scene) {
  std::vector<std::string_view> joints;
  for (const engine::JointModel& joint : scene.joints) joints.push_back(joint.name);
  return static_cast<int>(json.oneOf(joints));
}

}  // namespace pincer::tasks
