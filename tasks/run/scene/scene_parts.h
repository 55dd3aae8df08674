// scene_parts: the parts of a scene file, each read by a page of its own. Used by scene.cpp alone.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/run/scene/scene_ranges.h"

namespace pincer::tasks {

// `file` is the scene's own name: files that it names are relative to its folder.
std::string besideScene(const std::string& file, const std::string& name);

// Refuses at `place` what isn't letters, digits, - and _, or is too long.
void requireName(const std::string& name, const JsonValue& place);

// Everything that has a name in a scene, while it is read: bodies, joints, tendons, drives, frames and fingers.
class SceneNames {
 public:
  // The name under "name", or `otherwise`, now that of the next part. It must be
  // new in the scene, for quantities go by it.
  std::string readNext(const JsonValue& json, const std::string& otherwise);
  // The same of a body, which is to be the scene's next one.
  std::string readNextBody(const JsonValue& json, const Scene& scene);
  // Makes `name` one of the scene's; refused at `place` if it is taken, or isn't a name.
  void take(const std::string& name, const JsonValue& place);
  void takeBody(const std::string& name, const JsonValue& place, const Scene& scene);
  // The index of the body that `json` names; throws with a did-you-mean.
  int bodyNamed(const JsonValue& json, const Scene& scene) const;
  // The index of the joint, as bodyNamed.
  static int jointNamed(const JsonValue& json, const Scene& scene);

 private:
  std::unordered_set<std::string> taken_;
  std::unordered_map<std::string, int> bodies_;  // their places in the scene: a robot's parts may stand before them
};

// The hulls of a scene's shapes, while it is read. Equal ones are one: a robot has the same fingertip several times.
class SceneHulls {
 public:
  // Throws InputError as contact::Polytope::hullOf.
  std::shared_ptr<const contact::Polytope> hullOf(const std::vector<Vec3>& points);

 private:
  struct Known {
    std::vector<Vec3> points;
    std::shared_ptr<const contact::Polytope> hull;
  };
  std::vector<Known> known_;
};

// The mass of what has this volume [m^3], by "mass" or "density"; nothing if neither is there.
std::optional<double> readWeight(const JsonValue& json, const std::function<double()>& volume);
void refuse(const JsonValue& json, std::string_view key, std::string_view because);
Vec3 readVector(const JsonValue& json, std::string_view key, const NumberRule& rule);  // zero if there is none
bool isSupport(const contact::Shape& shape);                                           // half-spaces and dishes
engine::Material readMaterial(const JsonValue& json);
// The entries of a body's "shapes".
std::vector<engine::ColliderSpec> readParts(const JsonValue& json, const std::string& file, SceneHulls& hulls);
engine::GivenInertia readInertia(const JsonValue& json);

// Adds one body and its start to `scene`.
void readBody(const JsonValue& json, SceneNames& names, SceneHulls& hulls, Scene& scene);
contact::Shape readShape(const JsonValue& json, const std::string& file, SceneHulls& hulls);
// The convex pieces of a file.
std::vector<contact::Shape> readPieces(const JsonValue& json, const std::string& file);
// Pose of a half-space in W, from its normal and a point on it.
Pose readHalfSpacePose(const JsonValue& shape);

// Sets where the body starts; `start_rotation` is its rotation vector there, if the keyframes say nothing.
SceneMotion readBodyTrajectory(const JsonValue& json, engine::BodyStart& start, const Vec3& start_rotation);
// Refuses at `time` a last point that doesn't come later than the one before, or that would be
// reached faster than `fastest` per second.
void requireOnward(const std::vector<TimedPoint>& points, double fastest, const JsonValue& time);
engine::JointModel readJoint(const JsonValue& json, SceneNames& names, const Scene& scene);
engine::CouplingModel readCoupling(const JsonValue& json, const Scene& scene);
// A length made of joints' ways, for drives to pull at.
struct SceneTendon {
  std::string name;
  std::vector<engine::DriveTerm> terms;
};
SceneTendon readTendon(const JsonValue& json, SceneNames& names, const Scene& scene);
SceneDrive readDrive(const JsonValue& json, const std::vector<SceneTendon>& tendons, SceneNames& names,
                     const Scene& scene);
// A number: a control that stays; or {"keyframes": ..}.
void readDriveControl(const JsonValue& json, SceneDrive& drive);
BodyFrame readFrame(const JsonValue& json, SceneNames& names, const Scene& scene);
ScenePair readPair(const JsonValue& json, const SceneNames& names, const Scene& scene);

// Corners given as "points" or in a "file".
std::vector<Vec3> readPoints(const JsonValue& json, const std::string& file);
contact::FingerShape readFingerShape(const JsonValue& json, const std::string& file);

SceneFinger readFinger(const JsonValue& json, const std::string& usual_name, SceneNames& names, const Scene& scene);
// A finger "on" a body, as the body, joints and pair that it is.
void addCarriedFinger(const JsonValue& json, const std::string& usual_name, SceneNames& names, Scene& scene);

// A quantity of joints or drives in the unit of one that slides, or of one that turns.
const QuantityKind& inUnitOf(bool slides, const QuantityKind& kind);

// Both after bodies, fingers, tick and duration are known.
Recording readRecording(const JsonValue& json, const Scene& scene);
Expectation readExpectation(const JsonValue& json, const Scene& scene);

}  // namespace pincer::tasks
