// The URDF reader: what it makes of good files, by closed forms and beside the same robot in MJCF, and a line of
// complaint for each bad one.
#include "pincer/tasks/run/robot/urdf.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "pincer/tasks/run/robot/import_report.h"
#include "pincer/tasks/run/robot/mjcf.h"
#include "pincer/tasks/run/robot/robot_pose.h"
#include "pincer/tasks/run/robot/robot_scene.h"
#include "pincer/tasks/run/robot/urdf_grammar.h"
#include "pincer/tasks/run/scene/scene_robot.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

constexpr double kRoundOff = 1e-14;  // of numbers of order 1, through a few products

// A cube of 2 m, in metres.
constexpr const char* kCube = R"(v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
)";

constexpr const char* kMass =
    R"(<inertial><mass value="2"/><inertia ixx="1" ixy=".1" ixz="0" iyy="2" iyz="0" izz="2"/></inertial>)";

std::string link(const std::string& name, const std::string& inside = kMass) {
  return "<link name=\"" + name + "\">" + inside + "</link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& inside = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/>" + inside + "</joint>";
}

class UrdfReader : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  RobotImport read(const std::string& inside) {
    return readUrdf(write("robot.urdf", "<robot name=\"test\">\n" + inside + "\n</robot>"));
  }
  Robot robot(const std::string& inside) { return read(inside).robot; }
  std::string complaint(const std::string& inside) {
    return tests::errorOf([&] { read(inside); });
  }
  // A link that swings on another.
  static std::string pair(const std::string& of_joint, const std::string& of_link = kMass,
                          const std::string& type = "continuous") {
    return link("base", "") + link("arm", of_link) + joint("turn", type, "base", "arm", of_joint);
  }
  Simulation simulationOf(const std::string& path) {
    std::string remarks;
    return Simulation(parseScene(robotSceneText(path, remarks), path + ".json"));
  }

  tests::TemporaryDirectory folder_;
};

TEST_F(UrdfReader, LinksHangOnTheirParentsWhateverTheirOrderInTheFile) {
  const Robot r = robot(joint("b", "continuous", "one", "two") + link("two") + joint("a", "continuous", "base", "one") +
                        link("one") + link("base"));
  ASSERT_EQ(r.bodies.size(), 3u);
  EXPECT_EQ(r.bodies[0].name, "base");
  EXPECT_EQ(r.bodies[1].name, "one");
  EXPECT_EQ(r.bodies[2].parent, 1);
  EXPECT_TRUE(r.bodies[0].joints.empty());
}

TEST_F(UrdfReader, RollPitchYawTurnAboutAxesThatStandStill) {
  const Robot r = robot(pair(R"(<origin xyz="1 2 3" rpy="1.5707963267948966 1.5707963267948966 0"/>)"));
  const Pose& X = r.bodies[1].X_PB;
  EXPECT_EQ(X.p, Vec3(1, 2, 3));
  EXPECT_LT((X.q * Vec3::UnitX() + Vec3::UnitZ()).norm(), kRoundOff);  // x, by roll to x, by pitch to -z
  EXPECT_LT((X.q * Vec3::UnitZ() + Vec3::UnitY()).norm(), kRoundOff);  // z, by roll to -y, by pitch to -y
  const Robot by_quaternion = robot(pair(R"(<origin quat_xyzw="0 0 2 2"/>)"));
  EXPECT_LT((by_quaternion.bodies[1].X_PB.q * Vec3::UnitX() - Vec3::UnitY()).norm(), kRoundOff);
}

TEST_F(UrdfReader, InertiasAreTurnedWithTheirOrigin) {
  const Robot r = robot(pair("", R"(<inertial><origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><mass value="3"/>
    <inertia ixx="1" ixy=".1" ixz=".2" iyy="2" iyz=".3" izz="2.5"/></inertial>)"));
  const engine::MassProperties& m = r.bodies[1].inertia;
  EXPECT_EQ(m.mass, 3);
  EXPECT_EQ(m.p_BBcm, Vec3(0, 0, 1));
  // x' = y and y' = -x: I_xx = I'_yy, I_xy = -I'_xy, I_xz = -I'_yz, I_yz = I'_xz
  EXPECT_NEAR(m.I_BBcm(0, 0), 2, kRoundOff);
  EXPECT_NEAR(m.I_BBcm(0, 1), -.1, kRoundOff);
  EXPECT_NEAR(m.I_BBcm(0, 2), -.3, kRoundOff);
  EXPECT_NEAR(m.I_BBcm(1, 2), .2, kRoundOff);
}

TEST_F(UrdfReader, CollisionsAreTheShapesOfTheirLink) {
  write("cube.obj", kCube);
  const Robot r = robot(link("base", R"(
    <collision><origin xyz="1 0 0"/><geometry><box size="2 4 6"/></geometry></collision>
    <collision name="c"><geometry><cylinder radius=".5" length="3"/></geometry></collision>
    <collision><geometry><sphere radius=".25"/></geometry></collision>
    <collision><geometry><capsule radius=".1" length="2"/></geometry></collision>
    <collision><geometry><mesh filename="cube.obj" scale="1 1 -.5"/></geometry></collision>
    <collision><geometry><mesh filename="cube.obj" scale="1 1 -.5"/></geometry></collision>
    <collision><geometry><mesh filename="cube.obj" scale="2"/></geometry></collision>
    <visual><geometry><mesh filename="gone.dae"/></geometry></visual>)"));
  const std::vector<RobotGeom>& geoms = r.bodies[0].geoms;
  ASSERT_EQ(geoms.size(), 7u);
  EXPECT_EQ(geoms[0].half, Vec3(1, 2, 3));
  EXPECT_EQ(geoms[0].X_BG.p, Vec3(1, 0, 0));
  EXPECT_EQ(geoms[1].name, "c");
  EXPECT_EQ(geoms[1].half[1], 1.5);
  EXPECT_EQ(geoms[2].half[0], .25);
  EXPECT_EQ(geoms[3].half[1], 1);
  ASSERT_EQ(r.meshes.size(), 2u) << "one file of one scale is one mesh";
  EXPECT_EQ(geoms[4].mesh, geoms[5].mesh);
  EXPECT_EQ(r.meshes[0].triangles.vertices[0], Vec3(-1, -1, .5));
  EXPECT_EQ(r.meshes[1].triangles.vertices[0], Vec3(-2, -2, -2));
}

TEST_F(UrdfReader, JointsOfEachType) {
  const Robot r =
      robot(link("base") + link("a") + link("b") + link("c") + link("d") + link("e") + link("f") +
            joint("revolute", "revolute", "base", "a", R"(<axis xyz="0 0 2"/><limit lower="-1" upper="2"/>)") +
            joint("continuous", "continuous", "a", "b", R"(<dynamics damping=".5" friction=".25"/>)") +
            joint("prismatic", "prismatic", "b", "c", R"(<axis xyz="0 1 0"/><limit upper=".5"/>)") +
            joint("fixed", "fixed", "c", "d") + joint("planar", "planar", "d", "e", R"(<axis xyz="0 0 1"/>)") +
            joint("floating", "floating", "base", "f", R"(<origin xyz="0 0 1"/>)"));
  const auto jointsOf = [&](std::size_t i) -> const std::vector<RobotJoint>& { return r.bodies[i].joints; };
  EXPECT_EQ(jointsOf(1).at(0).axis_B, Vec3::UnitZ());
  EXPECT_EQ(*jointsOf(1).at(0).limits, Vec2(-1, 2));
  EXPECT_EQ(jointsOf(2).at(0).axis_B, Vec3::UnitX());
  EXPECT_EQ(jointsOf(2).at(0).damping, .5);
  EXPECT_EQ(jointsOf(2).at(0).friction, .25);
  EXPECT_FALSE(jointsOf(2).at(0).limits);
  EXPECT_EQ(jointsOf(3).at(0).kind, RobotJointKind::kSlide);
  EXPECT_EQ(*jointsOf(3).at(0).limits, Vec2(0, .5));
  EXPECT_TRUE(jointsOf(4).empty());
  ASSERT_EQ(jointsOf(5).size(), 3u);
  EXPECT_EQ(jointsOf(5)[0].axis_B, Vec3::UnitX());
  EXPECT_EQ(jointsOf(5)[1].kind, RobotJointKind::kSlide);
  EXPECT_EQ(jointsOf(5)[2].kind, RobotJointKind::kHinge);
  EXPECT_EQ(jointsOf(6).at(0).kind, RobotJointKind::kFree);
  EXPECT_EQ(r.bodies[6].parent, -1);
}

// Directions in the plane were not of length 1 where its normal was nearly -z.
TEST_F(UrdfReader, APlanarJointsDirectionsAreUnitAndSquareToItsNormal) {
  for (const double tilt : {0.0, 1e-6, 1e-5, 1e-4, 1e-3, 0.1}) {
    const Robot r = robot(link("base") + link("a") +
                          joint("slide", "planar", "base", "a", fmt::format(R"(<axis xyz="{} 0 -1"/>)", tilt)));
    const std::vector<RobotJoint>& joints = r.bodies[1].joints;
    ASSERT_EQ(joints.size(), 3u);
    const Vec3 &x = joints[0].axis_B, &y = joints[1].axis_B, &z = joints[2].axis_B;
    EXPECT_NEAR(x.norm(), 1, 1e-15) << tilt;
    EXPECT_LT((x.cross(y) - z).norm(), 1e-10) << tilt;  // round-off over the least tilt
  }
}

TEST_F(UrdfReader, AMimicOfAMimicFollowsTheOneThatLeads) {
  const Robot r =
      robot(link("base") + link("a") + link("b") + link("c") + joint("lead", "continuous", "base", "a") +
            joint("second", "continuous", "base", "b", R"(<mimic joint="lead" multiplier="2" offset="1"/>)") +
            joint("third", "continuous", "base", "c", R"(<mimic joint="second" multiplier="-3"/>)"));
  ASSERT_EQ(r.couplings.size(), 2u);
  EXPECT_EQ(r.couplings[0].polynomial, (std::vector<double>{1, 2}));
  EXPECT_EQ(r.couplings[1].leader, "lead");
  EXPECT_EQ(r.couplings[1].polynomial, (std::vector<double>{-3, -6}));
}

TEST_F(UrdfReader, PackagesAreFoundBelowTheModelAndNowhereElseUnlessAllowed) {
  const auto robotWith = [](const std::string& uri) {
    return "<robot name=\"r\">" +
           link("base", "<collision><geometry><mesh filename=\"" + uri + "\"/></geometry></collision>") + "</robot>";
  };
  write("hand/meshes/cube.obj", kCube);
  const std::string beside = write("robot.urdf", robotWith("package://hand/meshes/cube.obj"));
  EXPECT_EQ(readUrdf(beside).robot.meshes.size(), 1u);
  const std::string at_root = write("hand/robot.urdf", robotWith("package://hand/meshes/cube.obj"));
  EXPECT_EQ(readUrdf(at_root).robot.meshes.size(), 1u);
  const std::string inner = write("hand/urdf/robot.urdf", robotWith("package://hand/meshes/cube.obj"));
  const std::string outside = tests::errorOf([&] { readUrdf(inner); });
  EXPECT_NE(outside.find("lies outside of the model's folder. If you trust it, give --allow"), std::string::npos)
      << outside;
  EXPECT_EQ(readUrdf(inner, {folder_ / "hand"}).robot.meshes.size(), 1u);
  const std::string gone = tests::errorOf([&] { readUrdf(write("r.urdf", robotWith("package://hand/gone.obj"))); });
  EXPECT_NE(gone.find("r.urdf:1: <mesh> names the file \"package://hand/gone.obj\", and there is neither"),
            std::string::npos)
      << gone;
  for (const char* bad : {"/etc/passwd", "file:///etc/passwd", "package://hand/../../../../../../etc/passwd"}) {
    const std::string said = tests::errorOf([&] { readUrdf(write("r.urdf", robotWith(bad))); });
    EXPECT_NE(said.find("r.urdf:1: <mesh> names the file"), std::string::npos) << bad << ": " << said;
  }
}

TEST_F(UrdfReader, ComplaintsNameLineAndRemedy) {
  const std::string limit = R"(<limit lower="-1" upper="1"/>)";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "has no <link>."},
      {link("a") + link("b"), "\"b\" is held by no joint, as \"a\" at "},
      {link("a") + link("a"), "is the second link called \"a\""},
      {link("a") + link("b") + joint("j", "fixed", "a", "c"), "names the link \"c\", which the file doesn't have."},
      {link("base") + joint("j", "fixed", "bases", "base"), "Did you mean \"base\"?"},
      {link("a") + link("b") + joint("j", "fixed", "a", "b") + joint("j", "fixed", "b", "a"),
       "is the second joint called \"j\""},
      {link("a") + link("b") + link("c") + joint("i", "fixed", "a", "c") + joint("j", "fixed", "b", "c"),
       "\"j\" holds link \"c\", which joint \"i\" holds already. URDF has trees only"},
      {link("a") + link("b") + joint("i", "fixed", "a", "b") + joint("j", "fixed", "b", "a"),
       "closes a loop: link \"b\" hangs on what hangs on it."},
      {link("r") + link("a") + link("b") + joint("i", "fixed", "a", "b") + joint("j", "fixed", "b", "a"),
       "closes a loop"},
      {link("a") + joint("j", "fixed", "a", "a"), "holds link \"a\" to itself"},
      {pair("", ""), "\"turn\" moves no mass: neither link \"arm\""},
      {pair("", R"(<inertial><mass value="0"/><inertia ixx="1" iyy="1" izz="1"/></inertial>)"), "moves no mass"},
      {pair("", R"(<inertial><mass value="-1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>)"), "is negative."},
      {pair("", R"(<inertial><mass value="1"/></inertial>)"), "needs an <inertia>."},
      {pair("", R"(<inertial><mass value="1"/><inertia ixx="1" iyy="1"/></inertial>)"), "needs the attribute \"izz\"."},
      {pair("", R"(<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="3"/></inertial>)"), "is no body's"},
      {pair("", R"(<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="2"/></inertial>)"), "is no body's"},
      {pair("<limit lower=\"1\" upper=\"-1\"/>", kMass, "revolute"), "has its limits upside down: lower 1 is above"},
      {pair("<limit effort=\"1\" velocity=\"1\"/>", kMass, "revolute"), "leaves joint \"turn\" no way"},
      {pair("", kMass, "revolute"), "is revolute and needs a <limit>."},
      {pair("", kMass, "hinge"), "type=\"hinge\" is none of the words that go there."},
      {pair("<axis xyz=\"0 0 0\"/>"), "has no length"},
      {pair("<axis xyz=\"0 1\"/>"), "has 2 numbers where 3 are wanted."},
      {pair("<origin rpy=\"0 nan 0\"/>"), "which isn't a finite number"},
      {pair("<origin rpy=\"0 pi 0\"/>"), "which isn't a finite number"},
      {pair("<origin rpy=\"0 ${pi} 0\"/>"), "<origin> is written for xacro."},
      {pair("<origin rpy=\"0 0\"/>"), "rpy=\"0 0\" has 2 numbers where 3 are wanted."},
      {pair("<origin rpy=\"0 0 1\" quat_xyzw=\"0 0 0 1\"/>"), "second way to say the turn"},
      {pair("<origin/><origin/>"), "is the second one of this <joint>."},
      {pair("<dynamics damping=\"-1\"/>"), "is negative. A damper brakes."},
      {pair("<mimic joint=\"turns\"/>"), "no joint of one coordinate. Did you mean \"turn\"?"},
      {pair("<mimic joint=\"turn\"/>"), "follow itself"},
      {pair("<limits/>"), "isn't an element that URDF knows within <joint>. Did you mean \"limit\"?"},
      {pair("<axis xy=\"0 0 1\"/>"), "which URDF doesn't know there. Did you mean \"xyz\"?"},
      {pair("<axis>0 0 1</axis>"), "holds the text \"0 0 1\""},
      {link("a", "<collision><geometry><box size=\"1 1 0\"/></geometry></collision>"),
       "isn't positive along each axis."},
      {link("a", "<collision><geometry><cylinder radius=\"1\"/></geometry></collision>"),
       "needs the attribute \"length\""},
      {link("a", "<collision><geometry/></collision>"), "holds 0 shapes."},
      {link("a", "<collision><geometry><mesh filename=\"gone.stl\"/></geometry></collision>"),
       "<mesh> names the file \"gone.stl\""},
      {link("a", "<collision><geometry><plane normal=\"0 0 1\"/></geometry></collision>"), "<plane> isn't taken."},
      {link("a") + link("b") + link("c") + joint("i", "prismatic", "a", "b", limit) + joint("j", "floating", "b", "c"),
       "\"j\" is floating on link \"b\", which moves."},
      {"<xacro:include filename=\"a.xacro\"/>", "<xacro:include> is written for xacro. Expand the file first: xacro"},
      {"<link name=\"${name}\"/>", "<link> is written for xacro."},
      {"<link name=\"a\"><visual><origin xyz=\"0 0 $(arg height)\"/></visual></link>",
       "<origin> is written for xacro."},
      {"<loop_joint/>", "<loop_joint> isn't taken."},
  };
  for (const auto& [inside, wanted] : cases) {
    const std::string message = complaint(inside);
    EXPECT_NE(message.find("robot.urdf:"), std::string::npos) << inside << ": " << message;
    EXPECT_NE(message.find(wanted), std::string::npos) << inside << ": " << message;
  }
  const std::string mjcf = tests::errorOf([&] { readUrdf(write("a.urdf", "<mujoco/>")); });
  EXPECT_NE(mjcf.find("isn't <robot>"), std::string::npos) << mjcf;
}

TEST_F(UrdfReader, WhatHasNoEffectIsCountedByName) {
  const ImportNotes notes =
      read(
          pair("<limit effort=\"1\" velocity=\"2\"/><safety_controller k_velocity=\"1\"/><origin rpy=\"90 0 0\"/>") +
          R"(<gazebo reference="arm"><mu1>0.9</mu1><mu2>0.9</mu2></gazebo><transmission name="t"><type>x</type></transmission>)")
          .notes;
  std::set<std::string> names;
  for (const ImportNote& note : notes.all()) names.insert(note.what);
  EXPECT_EQ(names, (std::set<std::string>{"limit effort", "limit velocity", "safety_controller", "gazebo mu1",
                                          "gazebo mu2", "transmission type", "origin rpy above a turn"}));
}

// Drake's, for one; and a remark to simulators that merge fixed links.
TEST_F(UrdfReader, WhatOtherProgramsAddIsCountedByName) {
  const ImportNotes notes =
      read(
          "<drake:collision_filter_group name=\"g\"/>" + link("a") + link("b", "<drake:x/>") +
          R"(<joint name="j" type="fixed" dont_collapse="true" drake:y="1"><parent link="a"/><child link="b"/></joint>)")
          .notes;
  std::set<std::string> names;
  for (const ImportNote& note : notes.all()) names.insert(note.what);
  EXPECT_EQ(names,
            (std::set<std::string>{"drake:collision_filter_group", "drake:x", "joint dont_collapse", "joint drake:y"}));
}

// A terminal may obey bytes above 127, too: they begin commands in some.
TEST_F(UrdfReader, NamesOfIgnoredPartsDontReachTheTerminalAsTheyAre) {
  const std::string text = importText(read(link("base") + "<gazebo><a\x9b/></gazebo>"));
  EXPECT_NE(text.find("gazebo a"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x9b'), std::string::npos) << text;
}

// The schema that ROS publishes (urdf.xsd of urdfdom): elements, the elements that they hold, and their attributes.
TEST(UrdfGrammar, KnowsThePublishedSchema) {
  constexpr const char* kSchema = R"(robot > joint link material transmission : name version
link > inertial visual collision : name type
inertial > origin mass inertia :
mass > : value
inertia > : ixx ixy ixz iyy iyz izz
origin > : xyz rpy quat_xyzw
collision > origin geometry verbose : name
geometry > box cylinder sphere mesh :
box > : size
cylinder > : radius length
sphere > : radius
mesh > : filename scale
joint > origin parent child axis calibration dynamics limit safety_controller mimic : name type
parent > : link
child > : link
axis > : xyz
dynamics > : damping friction
limit > : lower upper effort velocity
mimic > : joint multiplier offset
)";
  std::istringstream lines(kSchema);
  int elements = 0, attributes = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name, word;
    words >> name >> word;
    const GrammarRow* row = nullptr;
    for (const GrammarRow& r : urdf::rows()) row = r.name == name ? &r : row;
    ASSERT_NE(row, nullptr) << name;
    bool is_attribute = false;
    while (words >> word) {
      Verdict verdict;
      if (word == ":") {
        is_attribute = true;
      } else if (is_attribute) {
        EXPECT_TRUE(findAttribute(*row, word, verdict)) << name << " " << word;
        ++attributes;
      } else {
        EXPECT_NE(findRow(urdf::rows(), name, word), nullptr) << word << " within " << name;
        ++elements;
      }
    }
  }
  EXPECT_EQ(elements, 26);
  EXPECT_EQ(attributes, 35);
}

TEST(UrdfGrammar, HasEveryAttributeOnce) {
  for (const GrammarRow& row : urdf::rows()) {
    std::set<std::string> seen;
    for (const std::string_view list : {row.read, row.looks, row.ignored, row.refused})
      forEachWord(list, [&](std::string_view w) { EXPECT_TRUE(seen.insert(std::string(w)).second) << row.name << w; });
    forEachWord(row.parents, [&](std::string_view parent) {
      EXPECT_EQ(findRow(urdf::rows(), parent, row.tag), &row) << row.tag << " within " << parent << " is two rows";
    });
    EXPECT_FALSE(row.verdict == Verdict::kRefused && row.reason.empty()) << row.name << ": a refusal says why";
  }
}

// A trunk that slides, a leg with a coupled foot, a fixed tip.
constexpr const char* kUrdf = R"(<robot name="small">
  <link name="rail"/>
  <link name="cart"><inertial><origin xyz="0 0 .05" rpy=".1 .2 .3"/><mass value="2"/>
    <inertia ixx=".01" ixy=".001" ixz="0" iyy=".02" iyz=".002" izz=".02"/></inertial>
    <collision><origin xyz="0 0 .02" rpy="0 .5 0"/><geometry><box size=".2 .1 .04"/></geometry></collision></link>
  <link name="leg"><inertial><origin xyz="0 0 -.1"/><mass value=".5"/><inertia ixx=".002" iyy=".002" izz=".001"/></inertial>
    <collision><origin xyz="0 0 -.1"/><geometry><cylinder radius=".02" length=".2"/></geometry></collision></link>
  <link name="foot"><inertial><mass value=".2"/><inertia ixx=".001" iyy=".001" izz=".001"/></inertial>
    <collision><geometry><sphere radius=".03"/></geometry></collision></link>
  <link name="tip"><inertial><mass value=".1"/><inertia ixx=".0001" iyy=".0001" izz=".0001"/></inertial></link>
  <joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 0 1" rpy=".3 -.2 .1"/>
    <axis xyz="1 0 0"/><limit lower="-.3" upper=".4" effort="5" velocity="2"/><dynamics damping=".3" friction=".1"/></joint>
  <joint name="hip" type="revolute"><parent link="cart"/><child link="leg"/><origin xyz=".05 .08 0" rpy=".4 .2 -.7"/>
    <axis xyz="0 3 4"/><limit lower="-2" upper="2"/><dynamics damping=".01"/></joint>
  <joint name="ankle" type="continuous"><parent link="leg"/><child link="foot"/><origin xyz="0 0 -.2"/><axis xyz="0 1 0"/>
    <mimic joint="hip" multiplier="-.5" offset=".1"/></joint>
  <joint name="toe" type="fixed"><parent link="foot"/><child link="tip"/><origin xyz=".05 0 0" rpy="0 0 .3"/></joint>
</robot>)";
constexpr const char* kMjcf =
    R"(<mujoco model="small"><compiler angle="radian" eulerseq="XYZ"/><option timestep=".001"/>
  <worldbody><body name="rail">
    <body name="cart" pos="0 0 1" euler=".3 -.2 .1"><joint name="slide" type="slide" axis="1 0 0" range="-.3 .4" damping=".3" frictionloss=".1"/>
      <inertial pos="0 0 .05" euler=".1 .2 .3" mass="2" fullinertia=".01 .02 .02 .001 0 .002"/>
      <geom type="box" size=".1 .05 .02" pos="0 0 .02" euler="0 .5 0"/>
      <body name="leg" pos=".05 .08 0" euler=".4 .2 -.7"><joint name="hip" axis="0 3 4" range="-2 2" damping=".01"/>
        <inertial pos="0 0 -.1" mass=".5" diaginertia=".002 .002 .001"/><geom type="cylinder" size=".02 .1" pos="0 0 -.1"/>
        <body name="foot" pos="0 0 -.2"><joint name="ankle" axis="0 1 0"/>
          <inertial pos="0 0 0" mass=".2" diaginertia=".001 .001 .001"/><geom size=".03"/>
          <body name="tip" pos=".05 0 0" euler="0 0 .3"><inertial pos="0 0 0" mass=".1" diaginertia=".0001 .0001 .0001"/></body>
        </body></body></body></body></worldbody>
  <equality><joint joint1="ankle" joint2="hip" polycoef=".1 -.5"/></equality></mujoco>)";

TEST_F(UrdfReader, TheSameRobotInMjcfGivesTheSameBits) {
  Simulation urdf = simulationOf(write("small.urdf", kUrdf)), mjcf = simulationOf(write("small.xml", kMjcf));
  Simulation named(parseScene(R"({"version": 1, "duration": 1, "tick": 0.001, "combination": "maximum",
    "bodies": [], "robots": [{"name": "it", "file": "small.urdf"}]})",
                              folder_ / "scene.json"));
  const double start = quantityOf("slide.position", urdf.scene()).measure(urdf.moment());
  for (int n = 0; n < 500; ++n) {
    ASSERT_EQ(urdf.tick().status, engine::kStepOk);
    mjcf.tick();
    named.tick();
  }
  EXPECT_GT(std::abs(quantityOf("slide.position", urdf.scene()).measure(urdf.moment()) - start), .01) << "it moves";
  EXPECT_EQ(engine::hashOf(urdf.state().world), engine::hashOf(mjcf.state().world));
  EXPECT_EQ(engine::hashOf(urdf.state().world), engine::hashOf(named.state().world));
}

TEST_F(UrdfReader, AScenesDriveMovesAJointOfTheRobot) {
  write("small.urdf", kUrdf);
  Simulation sim(parseScene(R"({"version": 1, "duration": 1, "tick": 0.001, "gravity": [0, 0, 0], "bodies": [],
    "robots": [{"name": "it", "file": "small.urdf"}], "drives": [{"name": "push", "joint": "it_slide", "type": "position",
    "stiffness": 400, "damping": 60, "target": 0.2}]})",
                            folder_ / "scene.json"));
  for (int n = 0; n < 3000; ++n) sim.tick();
  // Dry friction of 0.1 N leaves it at most 0.1/400 m off.
  EXPECT_NEAR(quantityOf("it_slide.position", sim.scene()).measure(sim.moment()), .2, .1 / 400 + 1e-9);
}

}  // namespace
}  // namespace pincer::tasks
