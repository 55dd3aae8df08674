// Sweeps: what a path names, which values are taken, and that the table tells the physics whoever worked on it.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <filesystem>
#include <fstream>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/lab/experiments/localisation.h"
#include "pincer/tasks/lab/sweep/one_finger_sweep.h"
#include "pincer/tasks/lab/sweep/scene_sweep.h"
#include "pincer/tasks/lab/sweep/study_sweep.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/scene/json_change.h"
#include "pincer/tasks/run/simulation.h"
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
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR(decades[static_cast<std::size_t>(i)], std::pow(10.0, i - 3), 1e-12 * std::pow(10.0, i - 3));
  EXPECT_EQ(decades.back(), 10);
  for (const char* wrong :
       {"a", "a=", "=1", "a=x", "a=1:2", "a=1:2:1", "a=1:2:2.5", "a=0:2:3:log", "a=1:2:3:lin", "a=1,,2", "a=nan"}) {
    EXPECT_TRUE(contains(errorOf([&] { parseVariation(wrong); }), "Write PATH=")) << wrong;
  }
}

// 0.1 + 0.5 (0.5 - 0.1) is 0.30000000000000004: a shard's row differed from the whole sweep's
// in the last digit of how it was written.
TEST(Variation, HasTheValuesThatAPersonWouldWrite) {
  EXPECT_EQ(parseVariation("a=0.1:0.5:9").values,
            (std::vector<double>{0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5}));
  EXPECT_EQ(parseVariation("a=-0.3:0.3:7").values, (std::vector<double>{-0.3, -0.2, -0.1, 0, 0.1, 0.2, 0.3}));
  EXPECT_EQ(parseVariation("a=0:1:4").values[1], 0.33333333333333);  // 14 places: of numbers up to 1
  EXPECT_EQ(parseVariation("a=1e-9:3e-9:3").values[1], 2e-9);
  EXPECT_EQ(parseVariation("a=1e9:3e9:3").values[1], 2e9);
  EXPECT_EQ(parseVariation("a=0.001:10:5:log").values, (std::vector<double>{0.001, 0.01, 0.1, 1, 10}));
}

// Any range of decimals of up to six digits: each value, written plainly, has no more digits than the step needs.
RC_GTEST_PROP(Variation, WritesDecimalStepsPlainly, ()) {
  const int from = *rc::gen::inRange(-1000, 1000), step = *rc::gen::inRange(1, 100), count = *rc::gen::inRange(2, 50);
  const int scale = *rc::gen::inRange(0, 4);
  const auto written = [&](int k) { return fmt::format("{}e-{}", from + k * step, scale); };
  const std::vector<double> values =
      parseVariation(fmt::format("a={}:{}:{}", written(0), written(count - 1), count)).values;
  for (int k = 0; k < count; ++k)
    RC_ASSERT(values[static_cast<std::size_t>(k)] == std::strtod(written(k).c_str(), nullptr));
}

TEST(Variation, OfSeveralMakesEveryCombination) {
  const SweepGrid grid = crossed({{"a", {1, 2}}, {"b", {5, 6, 7}}, {"c", {0, 9}}}, 12);
  ASSERT_EQ(grid.points.size(), 12u);
  EXPECT_EQ(grid.points[1], (std::vector<double>{1, 5, 9}));
  EXPECT_EQ(grid.points[7], (std::vector<double>{2, 5, 9}));
  EXPECT_NE(errorOf([] { crossed({{"a", {1, 2}}, {"b", {5, 6, 7}}}, 5); }), "");
  EXPECT_TRUE(contains(errorOf([] { crossed({{"a", {1, 2}}, {"a", {5}}}, 5); }), "given twice"));
}

TEST(Variation, ZippedGoesInStep) {
  const SweepGrid grid = zipped({{"a", {1, 2}}, {"b", {5, 6}}, {"c", {9}}}, 2);
  EXPECT_EQ(grid.points, (std::vector<std::vector<double>>{{1, 5, 9}, {2, 6, 9}}));
  EXPECT_TRUE(contains(errorOf([] { zipped({{"a", {1, 2}}, {"b", {5, 6, 7}}}, 9); }), "a has 2 values beside 3"));
}

TEST(Variation, CasesComeFromATable) {
  const tests::TemporaryDirectory dir;
  const auto cases = [&](const char* text) {
    std::ofstream(dir / "c.csv") << text;
    return readCases(dir / "c.csv", 3);
  };
  const SweepGrid grid = cases("sphere.mass, \"duration\"\n0.1,0.2\n\n0.3, 0.4\n");
  EXPECT_EQ(grid.paths, (std::vector<std::string>{"sphere.mass", "duration"}));
  EXPECT_EQ(grid.points, (std::vector<std::vector<double>>{{0.1, 0.2}, {0.3, 0.4}}));
  EXPECT_TRUE(contains(errorOf([&] { cases("a,b\n1\n"); }), "c.csv:2: 1 values under 2 headings"));
  EXPECT_TRUE(contains(errorOf([&] { cases("a\n1\nx\n"); }), "c.csv:3: \"x\" isn't a number"));
  EXPECT_TRUE(contains(errorOf([&] { cases("a\n"); }), "no case"));
  EXPECT_TRUE(contains(errorOf([&] { cases("a,a\n1,2\n"); }), "given twice"));
  EXPECT_TRUE(contains(errorOf([&] { cases("a\n1\n2\n3\n4\n"); }), "more than 3 runs"));
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
  EXPECT_EQ(ballWith("ball.material.mu_s", 0.7).bodies[1].material.mu_s, 0.7)
      << "neither object nor key is in the file";
  EXPECT_EQ(ballWith("tick", 0.002).options.h, 0.002);
}

TEST(JsonChange, SaysWhatIsWrongWithAPathOrValue) {
  const auto said = [](const char* path, double value = 1) { return errorOf([&] { ballWith(path, value); }); };
  EXPECT_TRUE(contains(said("bal.mass"), "Did you mean \"ball\"?")) << said("bal.mass");
  EXPECT_TRUE(contains(said("ball.mas"), "Did you mean \"mass\"?")) << said("ball.mas");
  EXPECT_TRUE(contains(said("ball.mass", -1), "ball.json:3: bodies[1].mass = -1 is out of range"))
      << said("ball.mass", -1);
  EXPECT_TRUE(contains(said("ball.name"), "is no number")) << said("ball.name");
  EXPECT_TRUE(contains(said("ball.position[3]"), "has 3 elements")) << said("ball.position[3]");
  EXPECT_TRUE(contains(said("ball.mass[0]"), "a list in brackets")) << said("ball.mass[0]");
  for (const char* path : {"", "ball..mass", "ball[", "ball[x]", "[0]", "ball.position[2]x"}) {
    EXPECT_TRUE(contains(said(path), "isn't the path of a number")) << path << ": " << said(path);
  }
}

SweepJob pinchJob(const std::vector<std::string>& vary, std::vector<std::string> measures) {
  std::vector<Variation> variations;
  for (const std::string& text : vary) variations.push_back(parseVariation(text));
  return sceneSweep(parseSceneOrBuiltin("s4_pinch"), sceneText("s4_pinch"),
                    {crossed(variations, kMostSceneCases), std::move(measures)});
}

SweepTable ran(SweepJob job, const SweepOptions& options = {}) {
  runSweep(job, options, kNever);
  return job.table;
}

SweepTable pinchSweep(int threads) {
  SweepOptions options;
  options.threads = threads;
  return ran(pinchJob({"sphere.material.mu_s=0.20:0.28:9", "duration=0.02"}, {"sphere.p_z", "left.normal_force:max"}),
             options);
}

// At which friction does the grasp begin to slip? mu* = m g / 2 F = 0.24525. Below it the sphere
// falls, and the fingers, L from its middle, push it on the faster the lower it is: m z'' = m g - 2 F
// mu + 2 F (1 + mu^2) z / L, to first order in z.
TEST(SceneSweep, TellsAtWhichFrictionThePinchBeginsToSlip) {
  constexpr double kTime = 0.02, kForce = 2, kMass = 0.1, kArm = 0.028;
  const SweepTable table = pinchSweep(2);
  ASSERT_EQ(table.results.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    const double mu = table.points[i][0], fall = std::max(0.0, 9.81 - 2 * mu * kForce / kMass);
    const double rate = std::sqrt(2 * kForce * (1 + mu * mu) / (kMass * kArm));
    const double drop = fall / (rate * rate) * (std::cosh(rate * kTime) - 1);
    // what is left out: z^2, and the fingers' own mass
    EXPECT_NEAR(table.results[i].values[0], 0.1 - drop, 0.01 * drop + 1e-12) << mu;
    EXPECT_NEAR(table.results[i].values[1], 2, 0.01) << mu;
    EXPECT_EQ(table.results[i].values[2] > 0, fall > 0) << "the scene expects it to be held";
  }
}

TEST(SceneSweep, IsTheSameToTheBitWhateverTheThreads) {
  const SweepTable one = pinchSweep(1), four = pinchSweep(4);
  EXPECT_EQ(sweepJson(one), sweepJson(four));
  EXPECT_EQ(sweepCsv(one), sweepCsv(four));
}

TEST(SceneSweep, RefusesBeforeItRunsAnything) {
  const auto said = [](const char* vary, const char* measure) { return errorOf([&] { pinchJob({vary}, {measure}); }); };
  EXPECT_TRUE(contains(said("sphere.mass=-1,-2", "sphere.p_z"), "mass = -1 is out of range"));
  EXPECT_TRUE(contains(said("sphere.maas=1,2", "sphere.p_z"), "Did you mean"));
  EXPECT_TRUE(contains(said("sphere.mass=0.1", "sphere.pz"), "quantity \"sphere.pz\" isn't known"));
  EXPECT_TRUE(contains(said("sphere.mass=0.1", "sphere.p_z:mean"), ":min or :max"));
}

TEST(SceneSweep, ACaseThatCantBeRunIsARowWithItsError) {
  const SweepTable table = ran(pinchJob({"sphere.mass=0.1,-1,0.2", "duration=0.01"}, {"sphere.p_z"}));
  EXPECT_EQ(table.done(), 3u);
  EXPECT_EQ(table.failed(), 1u);
  EXPECT_TRUE(contains(table.results[1].error, "mass = -1 is out of range")) << table.results[1].error;
  EXPECT_TRUE(std::isnan(table.results[1].values[0]));
  EXPECT_TRUE(table.results[2].error.empty());
}

TEST(SceneSweep, HasTheHashOfEachState) {
  const SweepTable table = ran(pinchJob({"duration=0.01,0.02"}, {"sphere.p_z"}));
  Scene scene = readBuiltinScene("s4_pinch");
  scene.duration = 0.02;
  Simulation simulation(std::move(scene));
  while (simulation.ticks() < 20) simulation.tick();
  EXPECT_EQ(table.results[1].state_hash, hashText(simulation.state().world));
  EXPECT_NE(table.results[0].state_hash, table.results[1].state_hash);
}

TEST(SceneSweep, StopsWhereItIsInterrupted) {
  std::atomic<bool> interrupted{false};
  SweepOptions options;
  options.threads = 1;
  options.progress = [&](std::int64_t done, std::int64_t) { interrupted = done == 1; };
  SweepJob job = pinchJob({"duration=0.01,0.02,0.03"}, {"energy"});
  runSweep(job, options, interrupted);
  EXPECT_TRUE(job.table.interrupted);
  EXPECT_EQ(sweepText(job.table).find("0.02"), std::string::npos) << sweepText(job.table);
}

// A success is held for a second; some of eight spheres are up within half a minute.
TEST(StudySweep, TellsThatNobodyPicksUpASphereWithinASecond) {
  StudySweep sweep;
  sweep.grid = crossed({parseVariation("sphere_pickup.timeout=1,30"), parseVariation("sphere_pickup.repetitions=1")},
                       kMostStudyCases);
  sweep.participants = 1;
  const SweepTable table = ran(studySweep("sphere-pickup", sweep));
  const auto column =
      std::find(table.measures.begin(), table.measures.end(), "spheres picked up within the time, CLD + force [%]") -
      table.measures.begin();
  ASSERT_LT(column, static_cast<std::ptrdiff_t>(table.measures.size()));
  EXPECT_EQ(table.results[0].values[static_cast<std::size_t>(column)], 0);
  EXPECT_GT(table.results[1].values[static_cast<std::size_t>(column)], 0);
  sweep.grid = crossed({parseVariation("people.tactor_sdd=1,2")}, kMostStudyCases);
  EXPECT_TRUE(contains(errorOf([&] { studySweep("sphere-pickup", sweep); }), "Did you mean"));
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
  sweep.grid = crossed({parseVariation("repetitions=1,2")}, kMostStudyCases);
  const SweepTable table = ran(oneFingerSweep("repeated-localisation", sweep));
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
    // [mm]
    EXPECT_NEAR(table.results[static_cast<std::size_t>(repetitions - 1)].values[0], 1e3 * answers.sum / answers.count,
                1e-9);
  }
  sweep.grid = crossed({parseVariation("repetition=1")}, kMostStudyCases);
  EXPECT_TRUE(contains(errorOf([&] { oneFingerSweep("repeated-localisation", sweep); }), "Did you mean"));
}

TEST(SweepCommand, WritesTableAndPicture) {
  const tests::TemporaryDirectory dir;
  const auto done = tests::runPincer({"sweep", "s4_pinch", "--vary", "sphere.material.mu_s=0.2,0.3", "--vary",
                                      "duration=0.05,0.1", "--measure", "sphere.p_z", "--out", dir / "out"});
  EXPECT_EQ(done.exit_code, kExitOk) << done.error;
  for (const char* name : {"sweep.csv", "sweep.png", "sweep.svg"})
    EXPECT_GT(std::filesystem::file_size(dir / "out" + "/" + name), 100u) << name;
  EXPECT_TRUE(contains(done.out, "sphere.p_z [m]")) << done.out;
  EXPECT_EQ(tests::runPincer({"sweep", "s4_pinch"}).exit_code, kExitUsage);
  EXPECT_EQ(tests::runPincer({"sweep", "s4_pinch", "--vary", "sphere.mass=much"}).exit_code, kExitUsage);
  const auto three = tests::runPincer(
      {"sweep", "s4_pinch", "--vary", "duration=0.01", "--vary", "tick=0.001", "--vary", "sphere.mass=1,2"});
  EXPECT_EQ(three.exit_code, kExitOk) << three.error;
  const auto again = tests::runPincer({"sweep", "s4_pinch", "--vary", "duration=1", "--out", dir / "out"});
  EXPECT_EQ(again.exit_code, kExitBadInput);
  EXPECT_TRUE(contains(again.error, "--resume")) << again.error;
}

}  // namespace
}  // namespace pincer::tasks
