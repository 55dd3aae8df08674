// scene_parts: the parts of a scene file, each read by a page of its own. Used by scene.cpp alone.
#pragma once
#include <string>
#include <vector>

#include "tasks/scene/scene.h"
#include "tasks/scene/strict_json.h"

namespace pincer::tasks {

// The largest length that a scene may name [m]: more is a mistaken unit, since these are worlds of the size of hands.
constexpr double kLongestLength = 100;

inline constexpr NumberRule kLength = {
    .min = 0, .max = kLongestLength, .min_open = true, .remedy = "Lengths are in metres: 20 mm is 0.02."};
inline constexpr NumberRule kCoordinate = {
    .min = -kLongestLength, .max = kLongestLength, .remedy = "Positions are in metres: 20 mm is 0.02."};

// `file` is the scene's own name: files that it names are relative to its folder.
std::string besideScene(const std::string& file, const std::string& name);

// Adds one body and its start to `scene`.
void readBody(const JsonValue& json, Scene& scene);
contact::Shape readShape(const JsonValue& json, const std::string& file);
// Pose of a half-space in W, from its normal and a point on it.
Pose readHalfSpacePose(const JsonValue& shape);

// Sets where the body starts; `start_rotation` is its rotation vector there, if the keyframes say nothing.
SceneMotion readBodyTrajectory(const JsonValue& json, engine::BodyStart& start, const Vec3& start_rotation);
engine::JointModel readJoint(const JsonValue& json, const Scene& scene);
ScenePair readPair(const JsonValue& json, const Scene& scene);

// Corners given as "points" or in a "file".
std::vector<Vec3> readPoints(const JsonValue& json, const std::string& file);
contact::FingerShape readFingerShape(const JsonValue& json, const std::string& file);

SceneFinger readFinger(const JsonValue& json, const Scene& scene);

// Both after bodies, fingers, tick and duration are known.
Recording readRecording(const JsonValue& json, const Scene& scene);
Expectation readExpectation(const JsonValue& json, const Scene& scene);

// The name under "name", or `otherwise`. It must be new in the scene, for quantities go by it.
std::string readName(const JsonValue& json, const Scene& scene, const std::string& otherwise);

}  // namespace pincer::tasks
