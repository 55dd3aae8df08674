// Scenes as tests: hashes pinned and renewed, verdicts, JUnit, logs that replay.
#include "pincer/tasks/run/scene/scene_test.h"

#include <gtest/gtest.h>

#include <fstream>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::errorOf;
using tests::readFile;
using tests::runPincer;
using tests::TemporaryDirectory;

// A ball falls for 0.1 s; `expect`: its expectations.
std::string ballScene(const std::string& expect) {
  return R"({"version": 1, "duration": 0.1, // falls
  "bodies": [{"name": "ball", "shape": {"type": "sphere", "radius": 0.02}, "mass": 1}],
  "expect": [)" +
         expect + "]}\n";
}

std::string pathWith(const TemporaryDirectory& dir, const char* name, const std::string& text) {
  std::ofstream(dir / name) << text;
  return dir / name;
}

TEST(HashExpectation, IsFilledInHoldsAndTellsOfAChange) {
  const TemporaryDirectory dir;
  const std::string file = pathWith(
      dir, "s.json", ballScene("\n    {\"hash\": \"\", \"time\": \"end\"},\n    {\"hash\": \"\", \"time\": 0.05}"));
  EXPECT_EQ(runPincer({"test", file}).exit_code, kExitCheckFailed);
  EXPECT_EQ(runPincer({"test", file, "--update-hashes"}).exit_code, kExitOk);
  const std::string pinned = readFile(file);
  EXPECT_TRUE(contains(pinned, "// falls")) << "the rest of the file stays as it was";
  EXPECT_EQ(runPincer({"test", file}).exit_code, kExitOk);
  EXPECT_EQ(runPincer({"test", file, "--update-hashes"}).exit_code, kExitOk);
  EXPECT_EQ(readFile(file), pinned);
  Scene scene = readScene(file);
  Simulation simulation(scene);
  while (simulation.ticks() < 100) simulation.tick();
  EXPECT_EQ(scene.expectations[0].hash, hashText(simulation.state().world));
  EXPECT_NE(scene.expectations[0].hash, scene.expectations[1].hash);
  std::string other = pinned;
  other.replace(other.find("\"mass\": 1"), 9, "\"mass\": 1, \"velocity\": [1e-9, 0, 0]");
  EXPECT_EQ(runPincer({"test", pathWith(dir, "o.json", other)}).exit_code, kExitCheckFailed)
      << "it drifts by a nanometre a second";
  EXPECT_EQ(runPincer({"sim", dir / "o.json"}).exit_code, kExitCheckFailed);
}

TEST(HashExpectation, SaysWhatIsWrong) {
  const auto said = [](const std::string& expect) { return errorOf([&] { parseScene(ballScene(expect), "s.json"); }); };
  EXPECT_TRUE(contains(said(R"({"hash": "12", "time": "end"})"), "is no hash"));
  EXPECT_TRUE(contains(said(R"({"hash": "0123456789abcdeF", "time": "end"})"), "is no hash"));
  EXPECT_TRUE(contains(said(R"({"hash": "", "time": "always"})"), "a hash is that of one"));
  EXPECT_TRUE(contains(said(R"({"hash": "", "time": "end", "value": 1})"), "value"));
}

TEST(TestCommand, NamesQuantityTimeWantedAndMeasured) {
  const TemporaryDirectory dir;
  pathWith(dir, "good.json", ballScene(R"({"quantity": "ball.p_x", "time": "end", "value": 0, "tolerance": 0})"));
  pathWith(
      dir, "bad.json",
      ballScene(R"({"quantity": "ball.p_z", "time": 0.1, "value": 0, "tolerance": 1e-3, "because": "it <floats>"})"));
  pathWith(dir, "no-scene.json", "{\"participants\": 3}");
  const auto done = runPincer({"test", dir / ".", "--junit", dir / "r.xml", "--out", dir / "failed", "--jobs", "2"});
  EXPECT_EQ(done.exit_code, kExitCheckFailed) << done.error;
  EXPECT_TRUE(
      contains(done.out, "ball.p_z at 0.1 s == 0 +- 0.001 m: measured -0.04905, off by 0.049, because it <floats>"))
      << done.out;
  EXPECT_TRUE(contains(done.out, "1 of 2 scenes as expected")) << done.out;
  const std::string junit = readFile(dir / "r.xml");
  EXPECT_TRUE(contains(junit, "<testsuite name=\"pincer\" tests=\"2\" failures=\"1\" errors=\"0\" skipped=\"0\""))
      << junit;
  EXPECT_TRUE(contains(junit, "because it &lt;floats&gt;")) << junit;
  const auto again = runPincer({"test", "--replay", dir / "failed/bad.log.json"});
  EXPECT_EQ(again.exit_code, kExitOk) << again.error;
  pathWith(dir, "bad.json", ballScene(R"({"quantity": "ball.p_z", "time": 0.1, "value": 0, "tolerance": 1e-3})") + " ");
  std::string changed = readFile(dir / "bad.json");
  changed.replace(changed.find("\"mass\": 1"), 9, "\"mass\": 1, \"velocity\": [1, 0, 0]");
  pathWith(dir, "bad.json", changed);
  const auto differs = runPincer({"test", "--replay", dir / "failed/bad.log.json"});
  EXPECT_EQ(differs.exit_code, kExitCheckFailed);
  EXPECT_TRUE(contains(differs.out, "tick 0 (0 s) differs first")) << differs.out;
}

TEST(TestCommand, EndsWithTheDocumentedCodes) {
  const TemporaryDirectory dir;
  EXPECT_EQ(runPincer({"test"}).exit_code, kExitUsage);
  EXPECT_EQ(runPincer({"test", dir / "."}).exit_code, kExitBadInput) << "nothing there";
  pathWith(dir, "broken.json", "{\"version\": 1,");
  pathWith(dir, "bad.json", ballScene(R"({"quantity": "ball.p_z", "time": 0.1, "value": 0, "tolerance": 1e-3})"));
  const auto mixed = runPincer({"test", dir / ".", "--junit", dir / "r.xml"});
  EXPECT_EQ(mixed.exit_code, kExitBadInput) << "a file that can't be read is worse than a failure";
  EXPECT_TRUE(contains(readFile(dir / "r.xml"), "failures=\"1\" errors=\"1\""));
  const auto nothing = runPincer({"test", pathWith(dir, "none.json", ballScene(""))});
  EXPECT_EQ(nothing.exit_code, kExitBadInput);
  EXPECT_TRUE(contains(nothing.out, "expects nothing")) << nothing.out;
}

TEST(SimCommand, RunsSeveralScenesAndSaysTheSameAtEachRun) {
  const auto first = runPincer({"sim", "s4_pinch", "s1_tumbling_box", "--duration", "0.01", "--json"});
  EXPECT_EQ(first.exit_code, kExitOk) << first.error;
  EXPECT_EQ(first.out, runPincer({"sim", "s4_pinch", "s1_tumbling_box", "--duration", "0.01", "--json"}).out);
  const JsonValue list = parseJson(first.out, "stdout");
  ASSERT_EQ(list.array().size(), 2u);
  EXPECT_EQ(list.array()[1].at("state_hash").text().size(), 16u);
  EXPECT_EQ(runPincer({"sim", "s4_pinch", "s1_tumbling_box", "--out", "x.csv"}).exit_code, kExitUsage);
}

}  // namespace
}  // namespace pincer::tasks
