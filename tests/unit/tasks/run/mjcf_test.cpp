// The MJCF reader: what it makes of good files, by closed forms and by the rules of the format,
// and a line of complaint for each bad one.
#include "pincer/tasks/run/robot/mjcf.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "pincer/tasks/run/robot/mjcf_grammar.h"
#include "pincer/tasks/run/robot/robot_pose.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

constexpr double kRoundOff = 1e-14;  // of numbers of order 1, through a few products

class MjcfReader : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  RobotImport read(const std::string& inside) {
    return readMjcf(write("robot.xml", "<mujoco model=\"test\">\n" + inside + "\n</mujoco>"));
  }
  Robot robot(const std::string& inside) { return read(inside).robot; }
  std::string complaint(const std::string& inside) {
    return tests::errorOf([&] { read(inside); });
  }
  // A body with a joint and a ball of 1 kg; `geom` adds attributes.
  static std::string body(const std::string& joint, const std::string& attributes = "") {
    return "<worldbody><body name=\"a\" " + attributes + ">" + joint +
           "<geom name=\"g\" size=\".1\" mass=\"1\"/></body></worldbody>";
  }

  tests::TemporaryDirectory folder_;
};

TEST_F(MjcfReader, ClassesInheritWhateverTheirOrderInTheFile) {
  const Robot r = robot(R"(
    <asset/>
    <worldbody><body childclass="inner"><joint name="j"/><geom size=".1"/></body></worldbody>
    <default><joint damping="3"/><default class="outer"><joint armature="5" axis="0 1 0"/><default class="inner"><joint armature="7"/></default>
    </default></default>)");
  const RobotJoint& joint = r.bodies.at(0).joints.at(0);
  EXPECT_EQ(joint.damping, 3);
  EXPECT_EQ(joint.armature, 7);
  EXPECT_EQ(joint.axis_B, Vec3(0, 1, 0));
}

TEST_F(MjcfReader, AnElementsOwnClassBeatsThatOfItsBody) {
  const Robot r = robot(
      R"(<default><default class="x"><joint damping="1"/></default><default class="y"><joint damping="2"/></default></default>
    <worldbody><body childclass="x"><joint name="j" class="y"/><geom size=".1"/></body></worldbody>)");
  EXPECT_EQ(r.bodies.at(0).joints.at(0).damping, 2);
}

TEST_F(MjcfReader, AnglesAreDegreesUnlessTheCompilerSaysOtherwise) {
  const Robot degrees = robot(body("<joint range=\"-90 180\" springref=\"45\" ref=\"90\"/>"));
  const RobotJoint& joint = degrees.bodies.at(0).joints.at(0);
  EXPECT_NEAR((*joint.limits)[0], -std::numbers::pi / 2, kRoundOff);
  EXPECT_NEAR(joint.spring_rest, std::numbers::pi / 4, kRoundOff);
  EXPECT_NEAR(joint.reference, std::numbers::pi / 2, kRoundOff);
  const Robot slide = robot(body("<joint type=\"slide\" range=\"-90 180\"/>"));
  EXPECT_EQ((*slide.bodies.at(0).joints.at(0).limits)[1], 180);
  const Robot radians = robot("<compiler angle=\"radian\"/>" + body("<joint range=\"-1 2\"/>"));
  EXPECT_EQ((*radians.bodies.at(0).joints.at(0).limits)[1], 2);
}

TEST_F(MjcfReader, FiveWaysToSayOneTurn) {
  // A quarter turn about z.
  for (const std::string turn :
       {"quat=\"1 0 0 1\"", "axisangle=\"0 0 2 90\"", "euler=\"0 0 90\"", "xyaxes=\"0 3 0 -1 1 0\""}) {
    const Robot r = robot(body("<joint/>", turn));
    EXPECT_LT((r.bodies.at(0).X_PB.q * Vec3::UnitX() - Vec3::UnitY()).norm(), kRoundOff) << turn;
  }
  const Robot r = robot(body("<joint/>", "zaxis=\"1 0 0\""));
  EXPECT_LT((r.bodies.at(0).X_PB.q * Vec3::UnitZ() - Vec3::UnitX()).norm(), kRoundOff);
  EXPECT_LT((r.bodies.at(0).X_PB.q * Vec3::UnitY() - Vec3::UnitY()).norm(), kRoundOff);  // the least turn
}

TEST_F(MjcfReader, EulerAnglesTurnAboutAxesThatMoveOrStandStill) {
  const Robot moving = robot("<compiler eulerseq=\"xyz\"/>" + body("<joint/>", "euler=\"90 90 0\""));
  const Robot still = robot("<compiler eulerseq=\"XYZ\"/>" + body("<joint/>", "euler=\"90 90 0\""));
  // x, by y to -z, by x to y
  EXPECT_LT((moving.bodies.at(0).X_PB.q * Vec3::UnitX() - Vec3::UnitY()).norm(), kRoundOff);
  EXPECT_LT((still.bodies.at(0).X_PB.q * Vec3::UnitX() + Vec3::UnitZ()).norm(), kRoundOff);  // x, by x to x, by y to -z
}

TEST_F(MjcfReader, FramesMoveWhatStandsInThem) {
  const Robot r = robot(R"(<worldbody><body name="a"><frame pos="1 0 0" euler="0 0 90"><joint axis="1 0 0" pos="0 1 0"/>
    <geom size=".1" pos="1 0 0"/><body name="b" pos="2 0 0"><geom size=".1"/></body></frame></body></worldbody>)");
  EXPECT_LT((r.bodies.at(0).joints.at(0).axis_B - Vec3(0, 1, 0)).norm(), kRoundOff);
  EXPECT_LT((r.bodies.at(0).joints.at(0).p_B - Vec3(0, 0, 0)).norm(), kRoundOff);
  EXPECT_LT((r.bodies.at(0).geoms.at(0).X_BG.p - Vec3(1, 1, 0)).norm(), kRoundOff);
  EXPECT_LT((r.bodies.at(1).X_PB.p - Vec3(1, 2, 0)).norm(), kRoundOff);
}

TEST_F(MjcfReader, ACapsuleBetweenTwoPoints) {
  const Robot r =
      robot("<worldbody><body><geom type=\"capsule\" fromto=\"0 0 0 0 3 4\" size=\".5\"/></body></worldbody>");
  const RobotGeom& geom = r.bodies.at(0).geoms.at(0);
  EXPECT_LT((geom.X_BG.p - Vec3(0, 1.5, 2)).norm(), kRoundOff);
  EXPECT_NEAR(geom.half[1], 2.5, kRoundOff);
  EXPECT_LT((geom.X_BG.q * Vec3::UnitZ() - Vec3(0, -.6, -.8)).norm(), kRoundOff);  // from the second end to the first
}

TEST_F(MjcfReader, VisibleGeomsWeighUnlessTheirMassOrDensityIs0) {
  const Robot r = robot(
      R"(<worldbody><body><geom type="box" size=".1 .2 .3" contype="0" conaffinity="0"/><geom size=".1" density="0"/>
    <geom size=".1" mass="0"/></body></worldbody>)");
  const engine::MassProperties& m = r.bodies.at(0).inertia;
  EXPECT_NEAR(m.mass, 48, 48 * kRoundOff);  // 0.2 x 0.4 x 0.6 m of 1000 kg/m^3
  EXPECT_NEAR(m.I_BBcm(0, 0), 48 / 12.0 * (.4 * .4 + .6 * .6), 10 * kRoundOff);
}

TEST_F(MjcfReader, InertialSaysMoreThanGeoms) {
  const std::string inside =
      R"(<worldbody><body><inertial mass="2" pos="0 0 1" diaginertia="1 2 2.5" euler="0 0 90"/><geom size=".1"/></body></worldbody>)";
  const engine::MassProperties m = robot(inside).bodies.at(0).inertia;
  EXPECT_EQ(m.mass, 2);
  EXPECT_NEAR(m.I_BBcm(0, 0), 2, kRoundOff);
  EXPECT_NEAR(m.I_BBcm(1, 1), 1, kRoundOff);
  const engine::MassProperties of_geoms = robot("<compiler inertiafromgeom=\"true\"/>" + inside).bodies.at(0).inertia;
  EXPECT_NEAR(of_geoms.mass, 4e3 / 3 * std::numbers::pi * 1e-3, kRoundOff * 10);
}

// A cube of 2 m as a mesh: of every rule but the shell's the mass of the box.
TEST_F(MjcfReader, AMeshOfACubeWeighsAsTheBox) {
  const std::string cube = R"(vertex="-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 1 1 1 1 -1 1 1"
    face="0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 7")";
  const auto massOf = [&](const std::string& rule) {
    return robot("<asset><mesh name=\"m\" " + cube + " inertia=\"" + rule +
                 "\" scale=\"1 1 .5\"/></asset><worldbody><body>" +
                 "<geom type=\"mesh\" mesh=\"m\" density=\"3\" pos=\"0 0 7\"/></body></worldbody>")
        .bodies.at(0)
        .inertia;
  };
  for (const char* rule : {"convex", "legacy", "exact"}) {
    const engine::MassProperties m = massOf(rule);
    EXPECT_NEAR(m.mass, 12, 100 * kRoundOff) << rule;
    EXPECT_LT((m.p_BBcm - Vec3(0, 0, 7)).norm(), 100 * kRoundOff) << rule;
    EXPECT_NEAR(m.I_BBcm(0, 0), 12 / 12.0 * (4 + 1), 100 * kRoundOff) << rule;
  }
  // Six faces of 2 x 2 and 2 x 1: area 16; of the z axis: 2 faces of 4 with (4 + 4)/12,
  // 4 faces of 2 at distance 1 with 1 + 4/12.
  const engine::MassProperties shell = massOf("shell");
  EXPECT_NEAR(shell.mass, 3 * 16, 100 * kRoundOff);
  EXPECT_NEAR(shell.I_BBcm(2, 2), 3 * (2 * 4 * 8 / 12.0 + 4 * 2 * (1 + 4 / 12.0)), 1000 * kRoundOff);
}

TEST_F(MjcfReader, APositionsDefaultChangesGeneral) {
  const Robot r = robot(
      R"(<default><default class="c"><position kp="7" kv="2" forcerange="-3 3"/></default></default>)" +
      body("<joint name=\"j\"/>") +
      R"(<actuator><general class="c" joint="j"/><motor joint="j"/><velocity kv="5" joint="j"/><position class="c" kp="9" joint="j"/></actuator>)");
  EXPECT_EQ(r.drives.at(0).gain, 7);
  EXPECT_EQ(r.drives.at(0).bias, Vec3(0, -7, -2));
  EXPECT_EQ((*r.drives.at(0).forces)[1], 3);
  EXPECT_EQ(r.drives.at(1).gain, 1);
  EXPECT_EQ(r.drives.at(1).bias, Vec3(0, 0, 0));
  EXPECT_EQ(r.drives.at(2).bias, Vec3(0, 0, -5));
  EXPECT_EQ(r.drives.at(3).bias, Vec3(0, -9, -2));
}

TEST_F(MjcfReader, AJointThatATendonNamesTwiceCountsWithTheSum) {
  const Robot r = robot(body("<joint name=\"j\"/>") +
                        "<tendon><fixed name=\"t\"><joint joint=\"j\" coef=\"1\"/><joint joint=\"j\" coef=\".5\"/>"
                        "</fixed></tendon>");
  ASSERT_EQ(r.tendons.at(0).joints.size(), 1u);
  EXPECT_EQ(r.tendons[0].joints[0].second, 1.5);
}

TEST_F(MjcfReader, AnArmatureIsEnoughForAJointToMove) {
  const Robot r = robot("<worldbody><body><joint armature=\".1\"/><site/></body></worldbody>");
  EXPECT_EQ(r.bodies.size(), 1u);
}

TEST_F(MjcfReader, ARangeIsInheritedFromTheJoint) {
  const Robot r = robot("<compiler angle=\"radian\"/>" + body("<joint name=\"j\" range=\"-1 3\"/>") +
                        "<actuator><position joint=\"j\" inheritrange=\".5\"/></actuator>");
  EXPECT_EQ(*r.drives.at(0).controls, Vec2(0, 2));
}

// A ball of 1 kg and .1 m at .5 m from its hinge: I = 2/5 m r^2 + m l^2.
TEST_F(MjcfReader, AJointFeelsAllThatHangsOnIt) {
  const Robot r = robot(R"(<worldbody><body><joint axis="0 1 0" armature=".25"/><geom size=".1" mass="1" pos=".5 0 0"/>
    <body pos="1 0 0"><joint type="slide" axis="1 0 0"/><geom size=".1" mass="2"/></body></body></worldbody>)");
  const std::vector<double> own = ownInertias(r, bodyPoses(r, drawnCoordinates(r)));
  EXPECT_NEAR(own.at(0), .25 + .4 * .01 + .25 + .4 * 2 * .01 + 2, kRoundOff);
  EXPECT_NEAR(own.at(1), 2, kRoundOff);
}

TEST_F(MjcfReader, JointsOfOneBodyMoveItOneAfterTheOther) {
  const Robot r = robot(
      R"(<worldbody><body pos="1 0 0"><joint axis="0 0 1" pos="-1 0 0"/><joint type="slide" axis="1 0 0"/><geom size=".1"/></body></worldbody>)");
  const Pose X = bodyPoses(r, {std::numbers::pi / 2, 2}).at(0);
  EXPECT_LT((X.p - Vec3(0, 3, 0)).norm(), kRoundOff);  // turned about the origin to (0, 1, 0), then 2 along its own x
}

TEST_F(MjcfReader, IncludedFilesStandWhereTheyAreIncluded) {
  write("part.xml", "<mujocoinclude><body name=\"b\"><geom size=\".1\"/></body></mujocoinclude>");
  const Robot r =
      robot("<worldbody><body name=\"a\"><geom size=\".1\"/><include file=\"part.xml\"/></body></worldbody>");
  ASSERT_EQ(r.bodies.size(), 2u);
  EXPECT_EQ(r.bodies[1].parent, 0);
}

TEST_F(MjcfReader, FilesThatIncludeEachOtherAreRefused) {
  write("a.xml", "<x><include file=\"b.xml\"/></x>");
  write("b.xml", "<x><include file=\"a.xml\"/></x>");
  EXPECT_NE(complaint("<include file=\"a.xml\"/>").find("b.xml:1: <include> includes a.xml, which includes this one"),
            std::string::npos);
  EXPECT_NE(complaint("<include file=\"robot.xml\"/>").find("which includes this one"), std::string::npos);
}

TEST_F(MjcfReader, FilesOutsideOfTheFolderAreRefused) {
  const std::string message = complaint("<include file=\"/etc/passwd\"/>");
  EXPECT_NE(message.find("lies outside of the model's folder"), std::string::npos) << message;
  EXPECT_NE(complaint("<include file=\"../../../../../etc/passwd\"/>").find("outside"), std::string::npos);
  EXPECT_NE(
      complaint("<asset><mesh file=\"gone.stl\"/></asset>").find("robot.xml:2: <mesh> names the file \"gone.stl\""),
      std::string::npos);
}

TEST_F(MjcfReader, ComplaintsNameLineAndRemedy) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {body("<joint class=\"x\"/>"), "is of class \"x\", and no <default> has that name."},
      {body("<joint rang=\"1 2\"/>"),
       "has the attribute \"rang\", which MJCF doesn't know there. Did you mean \"range\"?"},
      {body("<joint range=\"2 1\"/>"), "range=\"2 1\" has its ends the wrong way round."},
      {body("<joint stiffness=\"1 2\"/>"), "isn't linear"},
      {body("<joint axis=\"0 0 0\"/>"), "has no length"},
      {body("<joint axis=\"0 nan 1\"/>"), "which isn't a finite number"},
      {body("<joint axis=\"0 1\"/>"), "has 2 numbers where 3 are wanted."},
      {body("<freejoint/><joint/>"), "a free joint is the only joint of a body of the world."},
      {"<worldbody><body name=\"b\"><joint name=\"j\"/><body><joint/><site/></body></body></worldbody>",
       "moves no mass"},
      {body("<joint/><geom type=\"plane\" size=\"1 1 1\"/>"), "Planes stand still: make it a box."},
      {body("<joint/><geom type=\"mesh\" mesh=\"m\"/>"), "is the name of no mesh of <asset>. None is known here."},
      {body("<joint name=\"j\"/>") + "<equality><joint joint1=\"j\" joint2=\"j\"/></equality>", "is the joint itself."},
      {body("<joint name=\"j\"/>") + "<actuator><position joint=\"j\" timeconst=\".1\"/></actuator>",
       "has the attribute \"timeconst\", which isn't taken. Drives act on joints and fixed tendons here, and at once."},
      {body("<joint name=\"j\"/><joint name=\"j\"/>"), "is the second joint called \"j\"."},
      {body("", "mocap=\"yes\""), "is none of the words that go there."},
      {"<worldbody><body><geom type=\"box\" size=\"1 1\"/></body></worldbody>",
       "of type box needs a size of 3 numbers."},
      {"<worldbody><body><geom size=\"-1\"/></body></worldbody>", "and sizes are positive."},
      {"<worldbody><geom type=\"mesh\" mesh=\"m\"/></worldbody>", "is the name of no mesh"},
      {"<worldbody><body quat=\"1 0 0 0\" euler=\"0 0 0\"/></worldbody>", "is turned in two ways."},
      {"<worldbody><bodies/></worldbody>", "isn't an element that MJCF knows within <worldbody>."},
      {"<tendon><spatial/></tendon>", "<spatial> isn't taken. Tendons over sites aren't known here"},
      {"<actuator><muscle/></actuator>", "<muscle> isn't taken. Drives here have no state of their own"},
      {"<actuator><motor/></actuator>", "needs either a joint or a tendon"},
      {"<actuator><motor joint=\"k\"/></actuator>", "joint=\"k\" is the name of no joint."},
      {"<actuator><general joint=\"k\" dyntype=\"integrator\"/></actuator>", "is none of the words"},
      {body("<joint name=\"j\" type=\"ball\"/>") + "<tendon><fixed><joint joint=\"j\" coef=\"1\"/></fixed></tendon>",
       "joint=\"j\" is neither hinge nor slide"},
      {body("<freejoint name=\"j\"/>") + "<equality><joint joint1=\"j\"/></equality>",
       "joint1=\"j\" is neither hinge nor slide"},
      {body("<freejoint/>") + "<equality><weld body1=\"a\" relpose=\"0 0 0 1 0 0 0\"/></equality>",
       "draw the bodies as they are welded."},
      {"<contact><exclude body1=\"a\" body2=\"b\"/></contact>", "is the name of no body."},
      {"<default class=\"a\"><default><joint/></default></default>", "needs the attribute \"class\""},
      {"<worldbody>text</worldbody>", "holds the text \"text\""},
      {"<option timestep=\"1\" timestep=\"2\"/>", "XML_ERROR_PARSING_ATTRIBUTE"},
      {"<worldbody>", "isn't well-formed XML"},
  };
  for (const auto& [inside, wanted] : cases) {
    const std::string message = complaint(inside);
    EXPECT_NE(message.find("robot.xml:"), std::string::npos) << inside << ": " << message;
    EXPECT_NE(message.find(wanted), std::string::npos) << inside << ": " << message;
  }
}

TEST_F(MjcfReader, WhatHasNoEffectIsCounted) {
  const ImportNotes notes =
      read(
          R"(<default><geom solref="1 1"/></default><worldbody><body><geom size=".1" solref="1 1" rgba="1 1 1 1"/></body></worldbody>
    <sensor><clock/><clock/></sensor><visual><map/></visual>)")
          .notes;
  ASSERT_EQ(notes.all().size(), 2u);
  EXPECT_EQ(notes.all()[0].what, "geom solref");
  EXPECT_EQ(notes.all()[0].count, 2);
  EXPECT_EQ(notes.all()[1].what, "sensor clock");
  EXPECT_EQ(notes.all()[1].count, 2);
}

TEST_F(MjcfReader, VelocitiesAndTimesOfKeyframesAreCounted) {
  const ImportNotes notes =
      read(body("<joint/>") + "<keyframe><key qvel=\"0\"/><key qvel=\"1\" time=\"2\"/></keyframe>").notes;
  ASSERT_EQ(notes.all().size(), 2u);
  EXPECT_EQ(notes.all()[0].what, "key qvel");
  EXPECT_EQ(notes.all()[1].what, "key time");
}

TEST_F(MjcfReader, ControlCharactersOfAFileDontReachTheTerminal) {
  const std::string message = complaint(body("<joint axis=\"0 \x1b[2J 1\"/>"));
  EXPECT_NE(message.find("which isn't a finite number"), std::string::npos);
  EXPECT_EQ(message.find('\x1b'), std::string::npos);
}

TEST_F(MjcfReader, ARelposeWithoutATurnWeldsAsDrawn) {
  EXPECT_TRUE(robot(body("<freejoint/>") + "<equality><weld body1=\"a\" relpose=\"0 1 0 0 0 0 0\"/></equality>")
                  .loops.at(0)
                  .is_weld);
}

TEST_F(MjcfReader, AMeshOfCornersAloneIsTheirHull) {
  const engine::MassProperties m = robot(R"(<asset><mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset>
    <worldbody><body><geom type="mesh" mesh="m" density="6"/></body></worldbody>)")
                                       .bodies.at(0)
                                       .inertia;
  EXPECT_NEAR(m.mass, 1, 100 * kRoundOff);
  EXPECT_LT((m.p_BBcm - Vec3::Constant(.25)).norm(), 100 * kRoundOff);
}

// Moments 1, 1 and 4 are no body's.
TEST_F(MjcfReader, MomentsAreBalancedWhereTheCompilerSaysSo) {
  const Robot r = robot(
      R"(<compiler balanceinertia="true"/><worldbody><body><inertial mass="1" pos="0 0 0" diaginertia="1 1 4"/></body>
    <body><inertial mass="1" pos="0 0 0" diaginertia="1 1 2"/></body></worldbody>)");
  EXPECT_LT((r.bodies.at(0).inertia.I_BBcm - 2 * Mat3::Identity()).norm(), kRoundOff);
  EXPECT_EQ(r.bodies.at(1).inertia.I_BBcm(2, 2), 2);
}

TEST(MjcfGrammar, HasEveryAttributeOnce) {
  for (const GrammarRow& row : mjcf::rows()) {
    std::set<std::string> seen;
    for (const std::string_view list : {row.read, row.looks, row.ignored, row.refused})
      forEachWord(list,
                  [&](std::string_view w) { EXPECT_TRUE(seen.insert(std::string(w)).second) << row.name << " " << w; });
    forEachWord(row.parents, [&](std::string_view parent) {
      EXPECT_EQ(mjcf::rowOf(parent, row.tag), &row) << row.tag << " within " << parent << " is two rows";
    });
    EXPECT_EQ(row.verdict == Verdict::kRefused, row.read.empty() && !row.reason.empty())
        << row.name << ": a refusal says why";
  }
}

// The published grammar, where PINCER_MJCF_SCHEMA names it: each of its elements, in each of its places,
// and each of their attributes has a verdict.
class PublishedGrammar {
 public:
  explicit PublishedGrammar(const std::string& path) {
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) readLine(line.substr(0, line.find('#')));
  }

  struct Element {
    std::string tag;
    std::vector<std::string> attributes, children;
  };
  std::map<std::string, Element> elements;

 private:
  void readLine(const std::string& line) {
    std::istringstream words(line);
    std::string first, second;
    words >> first >> second;
    if (first == "element" || first == "group") {
      open_ = second;
      Element& e = elements[first == "group" ? "use " + second : second];
      is_group_ = first == "group";
      const auto xml = line.find("xml=");
      e.tag = xml == std::string::npos ? second : line.substr(xml + 4, line.find_first_of(",)", xml) - xml - 4);
    } else if (first == "}") {
      open_.clear();
    } else if (!open_.empty()) {
      Element& e = elements[is_group_ ? "use " + open_ : open_];
      const std::set<std::string> constraints = {"exclusive", "together", "requires", "oneof"};
      if (first == "child") e.children.push_back(second);
      if (first == "use") e.attributes.push_back("use " + second);
      if (second == ":" && !constraints.count(first)) e.attributes.push_back(first);
    }
  }

  std::string open_;
  bool is_group_ = false;
};

TEST(MjcfGrammar, KnowsThePublishedGrammar) {
  const char* path = std::getenv("PINCER_MJCF_SCHEMA");
  if (!path) GTEST_SKIP() << "tests/run --robots=DIR";
  const PublishedGrammar published(path);
  ASSERT_GT(published.elements.size(), 100u);
  int attributes = 0;
  std::set<std::string> seen;
  const std::function<void(const std::string&, const GrammarRow&)> check = [&](const std::string& name,
                                                                               const GrammarRow& row) {
    if (row.verdict != Verdict::kRead || !seen.insert(std::string(row.name) + " " + name).second) return;
    const std::function<void(const std::string&)> checkAttributes = [&](const std::string& of) {
      for (const std::string& attribute : published.elements.at(of).attributes) {
        if (attribute.rfind("use ", 0) == 0) {
          checkAttributes(attribute);
          continue;
        }
        Verdict verdict;
        EXPECT_TRUE(findAttribute(row, attribute, verdict)) << row.name << " " << attribute;
        ++attributes;
      }
    };
    checkAttributes(name);
    for (const std::string& listed : published.elements.at(name).children) {
      // the world is a body there
      const std::string child = name == "mujoco" && listed == "body" ? "worldbody" : listed;
      const GrammarRow* inner = mjcf::rowOf(row.name, published.elements.at(child).tag);
      EXPECT_NE(inner, nullptr) << child << " within " << row.name;
      if (inner) check(child, *inner);
    }
  };
  check("mujoco", *mjcf::rowOf("", "mujoco"));
  EXPECT_GT(attributes, 200);
}

}  // namespace
}  // namespace pincer::tasks
