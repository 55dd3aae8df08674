// The scene reader: what it makes of a good file, and one line of complaint for each thing that can be wrong with one.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "pincer/contact/finger_query.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/grasp/baseline.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

const std::string kSourceDir = PINCER_SOURCE_DIR;

std::string contentOf(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string messageFor(const std::string& json) {
  try {
    parseScene(json, "s.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// A scene of one body whose further keys are `body`, with further keys `scene`.
std::string sceneWith(const std::string& body, const std::string& scene = "") {
  return "{\"version\": 1, \"duration\": 1, \"bodies\": [{\"shape\": {\"type\": \"sphere\", \"radius\": 0.02}" + body +
         "}]" + scene + "}";
}
std::string sceneWithShape(const std::string& shape) {
  return "{\"version\": 1, \"duration\": 1, \"bodies\": [{\"mass\": 1, \"shape\": " + shape + "}]}";
}
std::string sceneWithFinger(const std::string& finger) {
  return sceneWith(", \"mass\": 1", ", \"fingers\": [{" + finger + "}]");
}
std::string sceneExpecting(const std::string& expectation) {
  return sceneWith(", \"mass\": 1", ", \"expect\": [{" + expectation + "}]");
}

TEST(SceneReader, UnderstandsTheGripperOfTheManual) {
  const std::string manual = contentOf(kSourceDir + "/docs/scenes.md");
  const std::size_t begin = manual.find("```jsonc\n", manual.find("## A two-jaw gripper")) + 9;
  Simulation simulation(parseScene(manual.substr(begin, manual.find("```", begin) - begin), "docs/scenes.md"));
  while (simulation.ticks() < simulation.scene().ticks()) EXPECT_EQ(simulation.tick().status, engine::kStepOk);
  // the floor's is 0; the jaws sag by 20 um
  EXPECT_NEAR(simulation.bodyPose(0).p.z() + simulation.bodyPose(1).p.z(), 0.098, 3e-5);
}

TEST(SceneReader, UnderstandsTheExampleOfTheManual) {
  const std::string manual = contentOf(kSourceDir + "/docs/scenes.md");
  const std::size_t begin = manual.find("```jsonc\n") + 9;
  const Scene scene = parseScene(manual.substr(begin, manual.find("```", begin) - begin), "docs/scenes.md");
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_FALSE(scene.bodies[0].dynamic);
  EXPECT_EQ(scene.bodies[1].name, "ball");
  EXPECT_EQ(scene.bodies[1].mass, 0.075);
  EXPECT_EQ(scene.bodies[1].material.mu_d, 0.5);
  EXPECT_EQ(scene.bodies[1].material.torsion_radius, 0.0033);
  EXPECT_EQ(scene.starts[1].v_W, Vec3(0.1, 0, 0));
  EXPECT_NEAR(2 * std::atan2(scene.starts[1].X_WB.q.z(), scene.starts[1].X_WB.q.w()), 1.5708, 1e-15);
  ASSERT_EQ(scene.fingers.size(), 1u);
  EXPECT_TRUE(scene.fingers[0].model.coupling.locked[1]);
  EXPECT_FALSE(scene.fingers[0].model.coupling.locked[0]);
  EXPECT_EQ(scene.fingers[0].trajectory.at(1).p_W, Vec3(0.15, 0, 0.02));
  EXPECT_EQ(scene.record.every, 10);
  EXPECT_EQ(scene.record.quantities.size(), 3u);
  EXPECT_EQ(scene.expectations[0].tick, Expectation::kAlways);
  EXPECT_EQ(scene.expectations[1].tick, 2000);
  EXPECT_EQ(buildWorld(scene).fingers.size(), 1u);
}

TEST(SceneReader, ReadsEverySceneOfTheRepository) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kSourceDir + "/tasks/scenes")) {
    if (entry.path().extension() != ".json") continue;
    EXPECT_NO_THROW(buildWorld(readScene(entry.path().string()))) << entry.path();
    ++scenes;
  }
  EXPECT_GE(scenes, 10);
}

TEST(SceneReader, GivesShapesTheirHalves) {
  const auto shape = [](const std::string& json) { return parseScene(sceneWithShape(json), "s.json").bodies[0].shape; };
  EXPECT_EQ(std::get<contact::Box>(shape(R"({"type": "box", "size": [0.02, 0.04, 0.08]})")).half,
            Vec3(0.01, 0.02, 0.04));
  EXPECT_EQ(std::get<contact::Capsule>(shape(R"({"type": "capsule", "radius": 0.01, "length": 0})")).half_length, 0);
  EXPECT_EQ(std::get<contact::Cylinder>(shape(R"({"type": "cylinder", "radius": 0.01, "length": 0.08})")).half_length,
            0.04);
  const auto flat = std::get<contact::CylinderWithFlat>(
      shape(R"({"type": "cylinder_with_flat", "radius": 0.02, "length": 0.08, "flat_distance": 0.014})"));
  EXPECT_EQ(flat.half_length, 0.04);
  EXPECT_EQ(flat.flat_distance, 0.014);
}

TEST(SceneReader, TurnsAHalfSpacesNormalToItsPlace) {
  const Scene scene = parseScene(R"({"version": 1, "duration": 1, "bodies": [
      {"shape": {"type": "half_space", "normal": [3, 0, 4], "point": [1, 2, 3]}}]})",
                                 "s.json");
  EXPECT_NEAR((scene.starts[0].X_WB.q * Vec3(0, 0, 1) - Vec3(0.6, 0, 0.8)).norm(), 0, 1e-15);
  EXPECT_EQ(scene.starts[0].X_WB.p, Vec3(1, 2, 3));
  EXPECT_FALSE(scene.bodies[0].dynamic);
}

TEST(SceneReader, MovesADrivenBodyFromKeyframeToKeyframe) {
  const Scene scene = parseScene(
      sceneWith(
          R"(, "position": [0, 0, 1], "trajectory": {"keyframes": [{"time": 0}, {"time": 2, "rotation": [0, 0, 12]}]})"),
      "s.json");
  EXPECT_TRUE(buildWorld(scene).world.bodies[0].driven);
  const engine::MotionInput middle = scene.motions.at(0).at(1);
  EXPECT_EQ(middle.X_WB.p, Vec3(0, 0, 1));
  // half way of a minimum-jerk turn
  EXPECT_NEAR(std::abs(middle.X_WB.q.dot(quatFromRotationVector(Vec3(0, 0, 6)))), 1, 1e-15);
  EXPECT_NEAR(middle.motion.w_W.z(), 1.875 * 6, 1e-12);  // whose largest rate is 15/8 of the mean
}

TEST(SceneReader, GivesPairsTheirOwnMaterial) {
  const Scene scene = parseScene(
      sceneWith(R"(, "mass": 1}, {"shape": {"type": "half_space"})",
                R"(, "pairs": [{"bodies": ["body1", "body0"], "material": {"mu_s": 0.9, "restitution": 0.7}}])"),
      "s.json");
  const grasp::GraspModel model = buildWorld(scene);
  EXPECT_EQ(model.world.pairs.at(0).material.mu_s, 0.9);
  EXPECT_EQ(model.world.pairs.at(0).material.restitution, 0.7);
}

TEST(SceneReader, MultipliesDensityByVolume) {
  const Scene scene = parseScene(sceneWith(", \"density\": 1000"), "s.json");
  EXPECT_NEAR(scene.bodies[0].mass, 1000 * 4.0 / 3 * 3.14159265358979 * 8e-6, 1e-15);
}

TEST(SceneReader, TurnsASolidOnTheLathe) {
  const auto read = [](const std::string& json) { return parseScene(sceneWithShape(json), "s.json"); };
  const Scene cone = read(R"({"type": "mesh", "lathe": [[0, 0], [0.02, 0], [0, 0.03]], "segments": 12})");
  EXPECT_EQ(std::get<contact::Mesh>(cone.bodies[0].shape).surface->triangles().triangles.size(), 24u);
  const auto error = [&](const std::string& json) { return tests::errorOf([&] { read(json); }); };
  EXPECT_NE(error(R"({"type": "mesh", "lathe": [[0, 0], [0, 0.02], [0, 0.03]]})").find("profile[1]"),
            std::string::npos);
  EXPECT_NE(error(R"({"type": "mesh", "lathe": [[0, 0], [0.02], [0, 0.03]]})").find("lathe[1]"), std::string::npos);
  EXPECT_NE(error(R"({"type": "mesh"})").find("either"), std::string::npos);
  EXPECT_NE(error(R"({"type": "mesh", "lathe": [[0, 0], [0.02, 0], [0, 0.03]], "units": "mm"})").find("goes with"),
            std::string::npos);
}

TEST(SceneReader, ReadsAMeshAndATrajectoryBesideTheScene) {
  const tests::TemporaryDirectory directory;
  std::ofstream(directory / "tetra.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  std::ofstream(directory / "way.csv") << "time,x,y,z\n0,1,0,0\n1,2,0,0\n";
  std::ofstream(directory / "s.json") << R"({"version": 1, "duration": 1,
    "bodies": [{"shape": {"type": "mesh", "file": "tetra.obj", "units": "cm", "scale": 2}, "density": 1000}],
    "fingers": [{"trajectory": {"csv": "way.csv"}}]})";
  const Scene scene = readScene(directory / "s.json");
  EXPECT_NEAR(scene.bodies[0].mass, 1000 * 8e-6 / 6, 1e-15);  // edges of 20 mm: V = a^3/6
  EXPECT_EQ(scene.fingers[0].trajectory.at(1).p_W, Vec3(2, 0, 0));
}

// Over an edge of a cube, at equal height over both faces: a facet's normal is one
// face's, the smooth surface's lies between.
TEST(SceneReader, SelectsHowAMeshIsFelt) {
  const tests::TemporaryDirectory directory;
  std::ofstream(directory / "cube.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                                           "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\n";
  const auto normalWith =
      [&](const std::string& options) {
        std::ofstream(directory / "s.json")
            << R"({"version": 1, "duration": 1, "bodies": [{"mass": 1, "shape": {"type": "mesh",
      "file": "cube.obj", "units": "cm")"
            << options << "}}]}";
        const Scene scene = readScene(directory / "s.json");
        contact::SurfaceTracker tracker;
        contact::PatchCache cache(64);
        return contact::querySphere(scene.bodies[0].shape, {0.005, 0.014, 0.0139}, 0.008, 0, tracker, cache).main().n_B;
      };
  const Vec3 across = Vec3(0, 4, 3.9).normalized();
  EXPECT_LT((normalWith("") - across).norm(), 1e-6);
  EXPECT_LT((normalWith(", \"shading\": \"smooth\"") - across).norm(), 1e-6);
  EXPECT_LT((normalWith(", \"shading\": \"facet\"") - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((normalWith(", \"shading\": \"force\", \"crease_angle\": 3") - across).norm(), 0.5)
      << "interpolated between the corners'";
  EXPECT_GT((normalWith(", \"shading\": \"force\", \"crease_angle\": 3") - Vec3::UnitY()).norm(), 0.1);
}

struct Complaint {
  const char* name;
  std::string json;
  std::string message;
};

class SceneComplaints : public testing::TestWithParam<Complaint> {};
TEST_P(SceneComplaints, NamePlaceValueRangeAndRemedy) { EXPECT_EQ(messageFor(GetParam().json), GetParam().message); }

const std::vector<Complaint> kComplaints = {
    {"NegativeFriction", sceneWith(",\n\"mass\": 1, \"material\": {\n\"mu_s\": -0.3}"),
     "s.json:3: bodies[0].material.mu_s = -0.3 is out of range [0, 100]. A friction coefficient can't be negative; "
     "typical: skin on "
     "plastic 0.6."},
    {"NegativeMass", sceneWith(", \"mass\": -1"),
     "s.json:1: bodies[0].mass = -1 is out of range [1e-09, 1000000]. Masses are in kilograms: 75 g is 0.075."},
    {"UnknownKey", sceneWith(", \"mas\": 1"), "s.json:1: bodies[0].mas isn't a known key. Did you mean \"mass\"?"},
    {"NoMass", sceneWith(""),
     "s.json:1: bodies[0] lacks the key \"mass\" [kg] (or \"density\" [kg/m^3], or \"static\": true)."},
    {"MassAndDensity", sceneWith(", \"mass\": 1, \"density\": 1"),
     "s.json:1: bodies[0].density = 1 says again what \"mass\" says. Keep one of the two."},
    {"DynamicAboveStaticFriction", sceneWith(", \"mass\": 1, \"material\": {\"mu_s\": 0.3, \"mu_d\": 0.4}"),
     "s.json:1: bodies[0].material.mu_d = 0.4 is out of range [0, 0.3]. Dynamic friction isn't larger than static "
     "friction (mu_s)."},
    {"WrongVersion", "{\"version\": 2}", "s.json:1: version = 2 is out of range [1, 1]. This program reads version 1."},
    {"NoVersion", "{}", "s.json:1: the whole file lacks the key \"version\". This program reads version 1."},
    {"UnknownShape", sceneWithShape("{\"type\": \"spere\"}"),
     "s.json:1: bodies[0].shape.type = \"spere\" isn't known. Did you mean \"sphere\"?"},
    {"RadiusInMillimetres", sceneWithShape("{\"type\": \"sphere\", \"radius\": 200}"),
     "s.json:1: bodies[0].shape.radius = 200 is out of range [1e-06, 100]. Lengths are in metres: 20 mm is 0.02."},
    {"FlatOutside",
     sceneWithShape("{\"type\": \"cylinder_with_flat\", \"radius\": 0.02, \"length\": 0.1, \"flat_distance\": 0.02}"),
     "s.json:1: bodies[0].shape.flat_distance = 0.02 isn't smaller than the radius 0.02: nothing would be cut off. Use "
     "the type "
     "\"cylinder\"."},
    {"FractionOfATick", "{\"version\": 1, \"duration\": 0.0005, \"bodies\": []}",
     "s.json:1: duration = 0.0005 isn't a whole number of ticks of 0.001 s."},
    {"EmptyWorld", "{\"version\": 1, \"duration\": 1, \"bodies\": []}",
     "s.json:1: bodies is empty, and there is no finger: nothing could happen."},
    {"StaticWithVelocity", sceneWith(", \"static\": true, \"velocity\": [1, 0, 0]"),
     "s.json:1: bodies[0].velocity doesn't go with a body that never moves. Remove the key."},
    {"MassAndTrajectory", sceneWith(", \"mass\": 1, \"trajectory\": {\"keyframes\": [{\"time\": 0}]}"),
     "s.json:1: bodies[0].mass = 1 doesn't go with a trajectory, which the body follows whatever touches it. Remove "
     "the key."},
    {"NoKeyframe", sceneWith(", \"trajectory\": {\"keyframes\": []}"),
     "s.json:1: bodies[0].trajectory has no keyframe. For a body that rests, use \"static\": true."},
    {"PairWithoutMaterial",
     sceneWith(", \"mass\": 1}, {\"shape\": {\"type\": \"half_space\"}",
               ", \"pairs\": [{\"bodies\": [\"body0\", \"body1\"]}]"),
     "s.json:1: pairs[0] lacks the key \"material\", what the two are to each other (or \"touch\": false)."},
    {"PairOfOne", sceneWith(", \"mass\": 1", ", \"pairs\": [{\"bodies\": [\"body0\", \"body0\"], \"touch\": false}]"),
     "s.json:1: pairs[0].bodies names one body twice. A body doesn't touch itself."},
    {"JointOfAWall", sceneWith(", \"static\": true", ", \"joints\": [{\"type\": \"pivot\", \"body\": \"body0\"}]"),
     "s.json:1: joints[0].body = \"body0\" never moves by itself: a joint has nothing to hold. Name the moving body "
     "here, this one under "
     "\"to\"."},
    {"JointType", sceneWith(", \"mass\": 1", ", \"joints\": [{\"type\": \"hinge\", \"body\": \"body0\"}]"),
     "s.json:1: joints[0].type = \"hinge\" isn't known. Known here: pivot, slider, ball, weld."},
    {"DampedWeld",
     sceneWith(", \"mass\": 1", ", \"joints\": [{\"type\": \"weld\", \"body\": \"body0\", \"damping\": 1}]"),
     "s.json:1: joints[0].damping = 1 doesn't go with this type: only pivots and sliders have one free axis. Remove "
     "the key."},
    {"LooseFinger", sceneWithFinger("\"position\": [0, 0, 1], \"stiffness\": [100, 0, 100]"),
     "s.json:1: fingers[0] has neither mass nor stiffness along y: nothing says where it is. Give it a mass or a "
     "stiffness, or lock the "
     "axis."},
    {"FingerNowhere", sceneWithFinger("\"radius\": 0.01"),
     "s.json:1: fingers[0] needs \"position\" [m] for a finger that rests, or \"trajectory\"."},
    {"BackwardsKeyframes",
     sceneWithFinger("\"trajectory\": {\"keyframes\": [{\"time\": 1, \"position\": [0, 0, 0]}, {\"time\": 1, "
                     "\"position\": [0, 0, 0]}]}"),
     "s.json:1: fingers[0].trajectory.keyframes[1].time = 1 can't be: time 1 doesn't follow 1. Times must increase "
     "from one point to the "
     "next."},
    {"UnknownAxis", sceneWithFinger("\"position\": [0, 0, 1], \"locked\": [\"w\"]"),
     "s.json:1: fingers[0].locked[0] = \"w\" isn't known. Did you mean \"x\"?"},
    {"SameName", sceneWithFinger("\"position\": [0, 0, 1], \"name\": \"body0\""),
     "s.json:1: fingers[0].name = \"body0\" can't be called \"body0\": another body, joint, drive, frame or finger is. "
     "Names tell them "
     "apart in quantities."},
    {"UnknownOwner", sceneExpecting("\"quantity\": \"bodi0.p_z\", \"time\": 1, \"value\": 1, \"tolerance\": 1"),
     "s.json:1: expect[0].quantity = \"bodi0.p_z\" names no body, joint, drive, frame or finger of this scene. Did you "
     "mean \"body0\"?"},
    {"UnknownQuantity", sceneExpecting("\"quantity\": \"enrgy\", \"time\": 1, \"value\": 1, \"tolerance\": 1"),
     "s.json:1: expect[0].quantity = \"enrgy\" isn't known. Did you mean \"energy\"?"},
    {"EqualWithoutTolerance", sceneExpecting("\"quantity\": \"energy\", \"time\": 1, \"value\": 1"),
     "s.json:1: expect[0] lacks the key \"tolerance\": how far the measured value may lie from \"value\", in its "
     "unit."},
    {"AfterTheEnd", sceneExpecting("\"quantity\": \"energy\", \"time\": 2, \"value\": 1, \"tolerance\": 1"),
     "s.json:1: expect[0].time = 2 is out of range [0, 1]. Within the scene's duration."},
};

INSTANTIATE_TEST_SUITE_P(One, SceneComplaints, testing::ValuesIn(kComplaints),
                         [](const auto& complaint) { return std::string(complaint.param.name); });

TEST(SceneReader, SaysWhereTheSceneNamesABadMesh) {
  const std::string missing =
      messageFor(sceneWithShape("\n{\"type\": \"mesh\", \"file\": \"none.obj\", \"units\": \"mm\"}"));
  EXPECT_EQ(missing.substr(0, missing.find("none.obj")), "s.json:2: bodies[0].shape can't be used: ");
  const std::string unit =
      messageFor(sceneWithShape("{\"type\": \"mesh\", \"file\": \"none.obj\", \"units\": \"furlong\"}"));
  EXPECT_NE(unit.find("furlong"), std::string::npos) << unit;
  const std::string shading = messageFor(
      sceneWithShape("{\"type\": \"mesh\", \"file\": \"none.obj\", \"units\": \"mm\", \"shading\": \"facets\"}"));
  EXPECT_NE(shading.find("Did you mean \"facet\"?"), std::string::npos) << shading;
}

std::string sceneOfFinger(const std::string& finger) {
  return "{\"version\": 1, \"duration\": 1, \"bodies\": [], \"fingers\": [" + finger + "]}";
}

TEST(SceneFingers, TipsPadsAndCouplingsAreRead) {
  const Scene scene = parseScene(
      sceneOfFinger(
          "{\"shape\": {\"type\": \"ellipsoid\", \"semi_axes\": [0.009, 0.008, 0.007]}, \"position\": [0, 0, 1],"
          "\"stiffness\": {\"normal\": 2000, \"tangential\": 800}, \"modulus\": 1e5, \"twist_stiffness\": 0.3,"
          "\"method\": \"penalty\", \"arm\": {\"mass\": 0.06, \"damping\": 0.4}, \"rotation\": [0, 0.5, 0]}"),
      "test");
  const grasp::FingerModel& f = scene.fingers.front().model;
  ASSERT_TRUE(f.shape && f.arm);
  EXPECT_EQ(std::get<contact::EllipsoidTip>(*f.shape).semi_axes, Vec3(0.009, 0.008, 0.007));
  EXPECT_EQ(f.radius, 0.009);
  EXPECT_TRUE(f.along_normal);
  EXPECT_EQ(f.coupling.stiffness, Vec3(800, 800, 2000));
  EXPECT_EQ(f.coupling.twist_stiffness, 0.3);
  EXPECT_EQ(f.pad.modulus, 1e5);
  EXPECT_EQ(scene.fingers.front().method, grasp::FingerMethod::kPenalty);
  EXPECT_EQ(f.arm->damping, 0.4);
  EXPECT_EQ(scene.fingers.front().turn.at(0.5).p_W, Vec3(0, 0.5, 0));
}

TEST(SceneFingers, ContradictionsAreNamed) {
  const auto message = [](const std::string& finger) { return messageFor(sceneOfFinger(finger)); };
  EXPECT_NE(message("{\"position\": [0, 0, 1], \"radius\": 0.01, \"shape\": {\"type\": \"sphere\", \"radius\": 0.01}}")
                .find("says again"),
            std::string::npos);
  EXPECT_NE(message("{\"position\": [0, 0, 1], \"patch_radius\": 0.005, \"modulus\": 1e5}").find("Keep one"),
            std::string::npos);
  EXPECT_NE(message("{\"position\": [0, 0, 1], \"stiffness\": {\"normal\": 1, \"tangential\": 1}, \"locked\": [\"x\"]}")
                .find("along the contact's"),
            std::string::npos);
  EXPECT_NE(message("{\"position\": [0, 0, 1], \"method\": \"penality\"}").find("Did you mean \"penalty\"?"),
            std::string::npos);
}

// The schema that editors use and the reader know the same keys.
TEST(SceneSchema, NamesExactlyTheKeysThatTheReaderKnows) {
  const JsonValue schema = readJson(kSourceDir + "/docs/scene.schema.json", kSceneFile);
  const std::vector<std::pair<std::string, std::span<const std::string_view>>> parts = {
      {"scene", keys::kScene},
      {"solver", keys::kSolver},
      {"body", keys::kBody},
      {"part", keys::kPart},
      {"pieces", keys::kPieces},
      {"collides", keys::kCollides},
      {"inertia", keys::kInertia},
      {"body_trajectory", keys::kBodyTrajectory},
      {"body_keyframe", keys::kBodyKeyframe},
      {"pair", keys::kPair},
      {"joint", keys::kJoint},
      {"coupling", keys::kCoupling},
      {"tendon", keys::kTendon},
      {"drive", keys::kDrive},
      {"drive_trajectory", keys::kDriveTrajectory},
      {"drive_keyframe", keys::kDriveKeyframe},
      {"frame", keys::kFrame},
      {"robot", keys::kRobot},
      {"material", keys::kMaterial},
      {"finger", keys::kFinger},
      {"trajectory", keys::kTrajectory},
      {"keyframe", keys::kKeyframe},
      {"record", keys::kRecord},
      {"expectation", keys::kExpectation},
      {"sphere", keys::kSphere},
      {"box", keys::kBox},
      {"capsule", keys::kCapsule},
      {"cylinder", keys::kCylinder},
      {"cylinder_with_flat", keys::kCylinderWithFlat},
      {"half_space", keys::kHalfSpace},
      {"dish", keys::kDish},
      {"mesh", keys::kMesh},
      {"convex", keys::kConvex},
      {"sphere_tip", keys::kSphereTip},
      {"capsule_tip", keys::kCapsuleTip},
      {"ellipsoid_tip", keys::kEllipsoidTip},
      {"pad_tip", keys::kPadTip}};
  for (const auto& [name, words] : parts) {
    const std::vector<std::string>& found = schema.at("$defs").at(name).at("properties").keys();
    EXPECT_EQ(std::vector<std::string>(words.begin(), words.end()), found) << name;
  }
  EXPECT_EQ(schema.at("$defs").at("shape").at("oneOf").array().size(), keys::kShapeTypes.size());
}

// The manual names every quantity.
TEST(SceneManual, NamesEveryQuantity) {
  const std::string manual = contentOf(kSourceDir + "/docs/scenes.md");
  for (const auto& kinds : {worldQuantities(), bodyQuantities(), fingerQuantities()}) {
    for (const QuantityKind& kind : kinds)
      EXPECT_NE(manual.find('`' + std::string(kind.name) + '`'), std::string::npos) << kind.name;
  }
}

}  // namespace
}  // namespace pincer::tasks
