// Sweeps: what a path names, which values are taken, and that the table tells the physics whoever worked on it.
#include <gtest/gtest.h>

#include <filesystem>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/lab/experiments/localisation.h"
#include "pincer/tasks/lab/sweep/one_finger_sweep.h"
#include "pincer/tasks/lab/sweep/scene_sweep.h"
#include "pincer/tasks/lab/sweep/study_sweep.h"
#include "pincer/tasks/run/scene/json_change.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::errorOf;

const std::atomic<bool> kNever{false};

TEST(Variation, IsReadAsItIsWritten) {
  EXPECT_EQ(parseVariation("sphere.mass=0.05,0.1").path, "sphere.mass");
  EXPECT_EQ(parseVariation("a=0.05,0.1").values, (std::vector<double>{0.05, 0.1}));
  EXPECT_EQ(parseVariation("a=1:2:5").values, (std::vector<double>{1, 1.25, 1.5, 1.75, 2}));
  const std::vector<double> decades = parseVariation("a=0.001:10:5:log").values;
  ASSERT_EQ(decades.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(decades[static_cast<std::size_t>(i)], std::pow(10.0, i - 3), 1e-12 * std::pow(10.0, i - 3));
  EXPECT_EQ(decades.back(), 10);
  for (const char* wrong : {"a", "a=", "=1", "a=x", "a=1:2", "a=1:2:1", "a=1:2:2.5", "a=0:2:3:log", "a=1:2:3:lin", "a=1,,2", "a=nan"}) {
    EXPECT_TRUE(contains(errorOf([&] { parseVariation(wrong); }), "Write PATH=")) << wrong;
  }
}

TEST(Variation, OfTwoMakesEveryPair) {
  const auto points = gridOf({{"a", {1, 2}}, {"b", {5, 6, 7}}}, 6);
  ASSERT_EQ(points.size(), 6u);
  EXPECT_EQ(points[1], (std::vector<double>{1, 6}));
  EXPECT_EQ(points[3], (std::vector<double>{2, 5}));
  EXPECT_NE(errorOf([] { gridOf({{"a", {1, 2}}, {"b", {5, 6, 7}}}, 5); }), "");
}

constexpr const char* kBall = R"({"version": 1, "duration": 1,
  "bodies": [{"name": "floor", "shape": {"type": "half_space"}},
             {"name": "ball", "shape": {"type": "sphere", "radius": 0.02}, "mass": 0.1, "position": [0, 0, 0.02]}]})";

Scene ballWith(const char* path, double value) {
  JsonValue json = parseJson(kBall, "ball.json");
  setNumber(json, scenePath(json, path), value);
  return sceneOf(json, "ball.json");
}

TEST(JsonChange, SetsTheNumberThatThePathNames) {
  EXPECT_EQ(ballWith("ball.mass", 0.3).bodies[1].mass, 0.3);
  EXPECT_EQ(ballWith("bodies[1].mass", 0.3).bodies[1].mass, 0.3);
  EXPECT_EQ(ballWith("ball.position[2]", 0.5).starts[1].X_WB.p.z(), 0.5);
  EXPECT_EQ(ballWith("ball.material.mu_s", 0.7).bodies[1].material.mu_s, 0.7) << "neither object nor key is in the file";
  EXPECT_EQ(ballWith("tick", 0.002).options.h, 0.002);
}

TEST(JsonChange, SaysWhatIsWrongWithAPathOrValue) {
  const auto said = [](const char* path, double value = 1) { return errorOf([&] { ballWith(path, value); }); };
  EXPECT_TRUE(contains(said("bal.mass"), "Did you mean \"ball\"?")) << said("bal.mass");
  EXPECT_TRUE(contains(said("ball.mas"), "Did you mean \"mass\"?")) << said("ball.mas");
  EXPECT_TRUE(contains(said("ball.mass", -1), "ball.json:3: bodies[1].mass = -1 is out of range")) << said("ball.mass", -1);
  EXPECT_TRUE(contains(said("ball.name"), "is no number")) << said("ball.name");
  EXPECT_TRUE(contains(said("ball.position[3]"), "has 3 elements")) << said("ball.position[3]");
  EXPECT_TRUE(contains(said("ball.mass[0]"), "a list in brackets")) << said("ball.mass[0]");
  for (const char* path : {"", "ball..mass", "ball[", "ball[x]", "[0]", "ball.position[2]x"}) {
    EXPECT_TRUE(contains(said(path), "isn't the path of a number")) << path << ": " << said(path);
  }
}

SweepTable pinchSweep(int threads) {
  SceneSweep sweep;
  sweep.variations = {parseVariation("sphere.material.mu_s=0.20:0.28:9"), parseVariation("duration=0.02")};
  sweep.measures = {"sphere.p_z", "left.normal_force:max"};
  SweepOptions options;
  options.threads = threads;
  return sweepScene(parseSceneOrBuiltin("s4_pinch"), sweep, options, kNever);
}

// At which friction does the grasp begin to slip? mu* = m g / 2 F = 0.24525. Below it the sphere falls, and the fingers, L from its middle, push it
// on the faster the lower it is: m z'' = m g - 2 F mu + 2 F (1 + mu^2) z / L, to first order in z.
TEST(SceneSweep, TellsAtWhichFrictionThePinchBeginsToSlip) {
  constexpr double kTime = 0.02, kForce = 2, kMass = 0.1, kArm = 0.028;
  const SweepTable table = pinchSweep(2);
  ASSERT_EQ(table.results.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    const double mu = table.points[i][0], fall = std::max(0.0, 9.81 - 2 * mu * kForce / kMass);
    const double rate = std::sqrt(2 * kForce * (1 + mu * mu) / (kMass * kArm));
    const double drop = fall / (rate * rate) * (std::cosh(rate * kTime) - 1);
    EXPECT_NEAR(table.results[i][0], 0.1 - drop, 0.01 * drop + 1e-12) << mu;  // what is left out: z^2, and the fingers' own mass
    EXPECT_NEAR(table.results[i][1], 2, 0.01) << mu;
    EXPECT_EQ(table.results[i][2] > 0, fall > 0) << "the scene expects it to be held";
  }
}

TEST(SceneSweep, IsTheSameToTheBitWhateverTheThreads) {
  const SweepTable one = pinchSweep(1), four = pinchSweep(4);
  EXPECT_EQ(one.results, four.results);
  EXPECT_EQ(sweepCsv(one), sweepCsv(four));
}

TEST(SceneSweep, RefusesBeforeItRunsAnything) {
  const auto said = [](const char* vary, const char* measure) {
    SceneSweep sweep;
    sweep.variations = {parseVariation(vary)};
    sweep.measures = {measure};
    return errorOf([&] { sweepScene(parseSceneOrBuiltin("s4_pinch"), sweep, {}, kNever); });
  };
  EXPECT_TRUE(contains(said("sphere.mass=0.1,-1", "sphere.p_z"), "mass = -1 is out of range"));
  EXPECT_TRUE(contains(said("sphere.mass=0.1", "sphere.pz"), "quantity \"sphere.pz\" isn't known"));
  EXPECT_TRUE(contains(said("sphere.mass=0.1", "sphere.p_z:mean"), ":min or :max"));
}

TEST(SceneSweep, StopsWhereItIsInterrupted) {
  std::atomic<bool> interrupted{false};
  SweepOptions options;
  options.threads = 1;
  options.progress = [&](std::int64_t done, std::int64_t) { interrupted = done == 1; };
  const SweepTable table =
      sweepScene(parseSceneOrBuiltin("s4_pinch"), {{parseVariation("duration=0.01,0.02,0.03")}, {"energy"}}, options, interrupted);
  EXPECT_TRUE(table.interrupted);
  EXPECT_EQ(sweepText(table).find("0.02"), std::string::npos) << sweepText(table);
}

// A success is held for a second; some of eight spheres are up within half a minute.
TEST(StudySweep, TellsThatNobodyPicksUpASphereWithinASecond) {
  StudySweep sweep;
  sweep.variations = {parseVariation("sphere_pickup.timeout=1,30"), parseVariation("sphere_pickup.repetitions=1")};
  sweep.participants = 1;
  const SweepTable table = sweepStudy("sphere-pickup", sweep, {}, kNever);
  const auto column = std::find(table.measures.begin(), table.measures.end(), "spheres picked up within the time, CLD + force [%]") -
                      table.measures.begin();
  ASSERT_LT(column, static_cast<std::ptrdiff_t>(table.measures.size()));
  EXPECT_EQ(table.results[0][static_cast<std::size_t>(column)], 0);
  EXPECT_GT(table.results[1][static_cast<std::size_t>(column)], 0);
  sweep.variations = {parseVariation("people.tactor_sdd=1,2")};
  EXPECT_TRUE(contains(errorOf([&] { sweepStudy("sphere-pickup", sweep, {}, kNever); }), "Did you mean"));
}

struct Answers final : StudySink {
  void sample(const SampleRecord&) override {}
  void event(const EventRecord&) override {}
  void response(const ResponseRecord& r) override { sum += std::abs(r.answer_value - r.level), ++count; }
  double sum = 0;
  int count = 0;
};

TEST(OneFingerSweep, EachPointIsTheStudyWithItsNumber) {
  StudySweep sweep;
  sweep.participants = 1;
  sweep.variations = {parseVariation("repetitions=1,2")};
  const SweepTable table = sweepOneFinger("repeated-localisation", sweep, {}, kNever);
  ASSERT_EQ(table.measures.size(), 1u);
  ASSERT_EQ(table.results.size(), 2u);
  for (const int repetitions : {1, 2}) {
    LocalisationStudy study;
    study.participants = 1;
    study.repetitions = repetitions;
    LocalisationExperiment experiment(study, {}, 1000);
    Answers answers;
    runStudy(experiment, study.seed, {}, answers, kNever);
    EXPECT_EQ(answers.count, 5 * repetitions);
    EXPECT_NEAR(table.results[static_cast<std::size_t>(repetitions - 1)][0], 1e3 * answers.sum / answers.count, 1e-9);  // [mm]
  }
  sweep.variations = {parseVariation("repetition=1")};
  EXPECT_TRUE(contains(errorOf([&] { sweepOneFinger("repeated-localisation", sweep, {}, kNever); }), "Did you mean"));
}

TEST(SweepCommand, WritesTableAndPicture) {
  const tests::TemporaryDirectory dir;
  const auto done = tests::runPincer({"sweep", "s4_pinch", "--vary", "sphere.material.mu_s=0.2,0.3", "--vary", "duration=0.05,0.1",
                                      "--measure", "sphere.p_z", "--out", dir / "out"});
  EXPECT_EQ(done.exit_code, kExitOk) << done.error;
  for (const char* name : {"sweep.csv", "sweep.png", "sweep.svg"})
    EXPECT_GT(std::filesystem::file_size(dir / "out" + "/" + name), 100u) << name;
  EXPECT_TRUE(contains(done.out, "sphere.p_z [m]")) << done.out;
  EXPECT_EQ(tests::runPincer({"sweep", "s4_pinch"}).exit_code, kExitUsage);
  EXPECT_EQ(tests::runPincer({"sweep", "s4_pinch", "--vary", "sphere.mass=much"}).exit_code, kExitUsage);
  const auto three = tests::runPincer({"sweep", "s4_pinch", "--vary", "duration=1", "--vary", "tick=0.001", "--vary", "sphere.mass=1"});
  EXPECT_EQ(three.exit_code, kExitUsage);
  EXPECT_TRUE(contains(three.error, "one or two")) << three.error;
}

}  // namespace
}  // namespace pincer::tasks
