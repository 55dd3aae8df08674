// Scenes, studies, trajectories and calibrations from hostile files: bounded in time and memory,
// and named in messages that fit a terminal.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ctime>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/scene/json_change.h"
#include "pincer/tasks/run/servo/device_calibration.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::errorOf;
using tests::runPincer;
using tests::TemporaryDirectory;

// Far more than any of these take, and far less than they took [s].
constexpr double kSoon = PINCER_SANITIZED ? 20 : 5;

// Of the processor, so that a busy machine doesn't count.
double secondsOf(const std::function<void()>& act) {
  const std::clock_t start = std::clock();
  act();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// Of this process, now [bytes].
double memoryInUse() {
  std::ifstream file("/proc/self/statm");
  double all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

std::string sceneWith(const std::string& bodies) {
  return "{\"version\": 1, \"duration\": 0.01, \"gravity\": [0, 0, 0],\n\"bodies\": [" + bodies + "]}";
}

std::string balls(std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += fmt::format(
        "{}\n{{\"name\": \"ball{}\", \"shape\": {{\"type\": \"sphere\", \"radius\": 0.01}}, \"mass\": 0.1, "
        "\"position\": [{}, {}, {}]}}",
        i ? "," : "", i, 0.05 * static_cast<double>(i % 16), 0.05 * static_cast<double>(i / 16 % 16),
        0.05 * static_cast<double>(i / 256));
  }
  return text;
}

TEST(InputLimits, DevicesAndPipesAreNotReadAsScenesStudiesOrTrajectories) {
  const TemporaryDirectory folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {std::string("/dev/zero"), pipe, folder.path()}) {
    EXPECT_TRUE(contains(errorOf([&] { readScene(path); }), "a scene (a JSON file, docs/scenes.md) is needed here"))
        << path;
    EXPECT_TRUE(
        contains(errorOf([&] { readStudyFile(path); }), "a study (a JSON file, docs/experiments.md) is needed here"))
        << path;
    EXPECT_TRUE(
        contains(errorOf([&] { readTrajectoryCsv(path); }), "a trajectory (a CSV file, docs/scenes.md) is needed here"))
        << path;
    EXPECT_TRUE(contains(errorOf([&] { readCalibration(path); }),
                         "a calibration (a JSON file, docs/devices/setup.md) is needed here"))
        << path;
    EXPECT_EQ(runPincer({"run", "sphere-pickup", "--devices", "replay", "--recording", path, "--out", folder / "out"})
                  .exit_code,
              3)
        << path;
    EXPECT_EQ(runPincer({"run", "delay-discrimination", "--study", path}).exit_code, 3) << path;
    EXPECT_EQ(runPincer({"sim", path}).exit_code, 3) << path;
    EXPECT_EQ(runPincer({"report", path}).exit_code, 3) << path;
  }
}

TEST(InputLimits, AFileOf200MegabytesIsRefusedUnread) {
  const TemporaryDirectory folder;
  const std::string path = folder / "large.json";
  std::ofstream(path) << "{";
  ASSERT_EQ(::truncate(path.c_str(), 200'000'000), 0);
  const double before = memoryInUse();
  EXPECT_TRUE(contains(errorOf([&] { readScene(path); }),
                       "the file has 190.7 MB; a scene (a JSON file, docs/scenes.md) has at most 8 MB."));
  EXPECT_TRUE(contains(errorOf([&] { readTrajectoryCsv(path); }), "has at most 64 MB"));
  EXPECT_LT(memoryInUse() - before, 20e6);
}

// The worst that a file within the limits can do: as many values as it may have, each of them small.
TEST(InputLimits, AJsonFileAtItsLimitTakesBoundedMemory) {
  if (PINCER_SANITIZED) GTEST_SKIP() << "a sanitizer's own memory counts";
  std::string list = "[0";
  for (std::size_t i = 2; i < kMostJsonValues; ++i) list += ",0";
  const double before = memoryInUse();
  const JsonValue value = parseJson(list + "]", "f");
  EXPECT_LT(memoryInUse() - before, 150e6);
  EXPECT_EQ(value.array().size(), kMostJsonValues - 1);
  EXPECT_TRUE(contains(errorOf([&] { parseJson(list + ",0,0]", "f"); }), "there are more than 250000 values"));
  std::string nested;
  const std::string key(1000, 'k');
  for (int i = 0; i < 30; ++i) nested += fmt::format("{{\"{}\":", key);
  nested += list;  // every path would be 30,000 characters long
  nested += "]" + std::string(30, '}');
  EXPECT_TRUE(errorOf([&] { parseJson(nested.substr(0, 7'000'000), "f"); }).size() < 3 * kLongestMessage);
  EXPECT_LT(memoryInUse() - before, 300e6);
}

TEST(InputLimits, GarbageAfterANulByteIsNotPassedOver) {
  std::string text = R"({"version": 1, "duration": 1,
"bodies": []})";
  text += std::string("\0 garbage", 9);
  EXPECT_TRUE(contains(errorOf([&] { parseScene(text, "s.json"); }), "s.json:2: a NUL byte"));
}

TEST(InputLimits, AnUnknownKeyOf5MegabytesIsNamedAtOnceAndCut) {
  const std::string key(5'000'000, 'k');
  for (const std::string& text :
       {"{\"" + key + "\": 1}", "{\"version\": 1, \"duration\": 1, \"bodies\": [{\"" + key + "\": 1}]}",
        "{\"version\": 1, \"duration\": 1, \"bodies\": [{\"shape\": {\"type\": \"" + key + "\"}}]}",
        "{\"version\": 1, \"duration\": 1, \"bodies\": [{\"name\": \"" + key + "\"}]}",
        "{\"" + key + "\": 1, \"" + key + "\": 2}", "{\"version\": \"" + key + "\"}"}) {
    std::string said;
    EXPECT_LT(secondsOf([&] { said = errorOf([&] { parseScene(text, "s.json"); }); }), kSoon);
    EXPECT_TRUE(contains(said, "kkk") && contains(said, "...")) << said.substr(0, 300);
    EXPECT_LT(said.size(), 1000u);
  }
  const std::vector<std::string_view> words = {key, "mass"};
  EXPECT_LT(secondsOf([&] { EXPECT_EQ(closestWord(key + "x", words), ""); }), kSoon);
}

TEST(InputLimits, ManyKeysAreComparedInLessThanTheSquareOfTheirNumber) {
  std::string text = "{";
  for (int i = 0; i < 200'000; ++i) text += fmt::format("{}\"key{}\": 1", i ? "," : "", i);
  EXPECT_LT(secondsOf([&] { EXPECT_EQ(parseJson(text + "}", "f").keys().size(), 200'000u); }), kSoon);
  EXPECT_TRUE(contains(errorOf([&] { parseJson(text + ",\"key17\": 1}", "f"); }), "the key \"key17\" is there twice"));
}

TEST(InputLimits, EscapeSequencesInAFileDoNotReachTheTerminal) {
  const auto said = [](const std::string& text) { return errorOf([&] { parseScene(text, "s.json"); }); };
  for (const std::string& text :
       {std::string(R"({"\u001b[31mred": 1})"), std::string(R"({"version": "\u001b]0;title\u0007"})"),
        std::string(R"({"version": 1, "duration": 1, "bodies": [{"name": "a\u0000b"}]})"),
        std::string("{\"version\": \x1b[31m}"), std::string(R"({"a\u0000": 1, "a\u0000": 2})")}) {
    const std::string message = said(text);
    EXPECT_FALSE(message.empty());
    EXPECT_EQ(message.find_first_of(std::string("\x1b\x07\0", 3)), std::string::npos) << message;
  }
  const TemporaryDirectory folder;
  const std::string name = folder / "\x1b[31mred.json";
  EXPECT_FALSE(contains(runPincer({"sim", name}).error, "\x1b"));
  EXPECT_FALSE(contains(runPincer({"mesh", "info", name, "--units", "m"}).error, "\x1b"));
  EXPECT_FALSE(contains(runPincer({"sim", "s4_pinch", "--\x1b[31m"}).error, "\x1b"));
  std::ofstream(name) << R"({"version": 1, "duration": 0.01, "description": "a\u001b[31mb", "bodies": [)" << balls(1)
                      << "]}";
  const auto ran = runPincer({"sim", name});
  EXPECT_EQ(ran.exit_code, 0) << ran.error;
  EXPECT_FALSE(contains(ran.out, "\x1b[31m")) << ran.out;
  EXPECT_TRUE(contains(ran.out, "a\\x1b[31mb")) << ran.out;
}

TEST(InputLimits, AMessageListsSomeOfThousandsOfNames) {
  const std::string said = errorOf([&] {
    parseScene("{\"version\": 1, \"duration\": 1, \"bodies\": [" + balls(2000) +
                   R"(], "record": {"quantities": ["cube.p_z"]}})",
               "s");
  });
  EXPECT_TRUE(contains(said, "ball29 and 1970 more.")) << said;
}

// They took time with the square of their number: 20,000 a minute.
TEST(InputLimits, AsManyBodiesAsMayBeAreReadAndBuiltAtOnce) {
  const std::string text = sceneWith(balls(kMostBodies));
  EXPECT_LT(secondsOf([&] {
              Simulation simulation(parseScene(text, "s.json"));
              simulation.tick();
            }),
            kSoon);
  EXPECT_TRUE(contains(errorOf([&] { parseScene(sceneWith(balls(kMostBodies + 1)), "s.json"); }),
                       "s.json:2: bodies has 4097 elements; a scene has at most 4096"));
}

TEST(InputLimits, AsManyJointsAndPairsAsMayBeAreReadAndBuiltAtOnce) {
  std::string joints, pairs;
  for (std::size_t i = 0; i < kMostJoints; ++i)
    joints += fmt::format("{}{{\"type\": \"pivot\", \"body\": \"ball{}\"}}", i ? "," : "", i);
  for (std::size_t i = 0; i < kMostPairs; ++i)
    pairs += fmt::format("{}{{\"bodies\": [\"ball{}\", \"ball{}\"], \"material\": {{\"mu_s\": 0.1}}}}", i ? "," : "",
                         i % (kMostBodies - 1) + 1, i % 7 == 0 ? 0 : (i * 31) % (i % (kMostBodies - 1) + 1));
  const std::string text = "{\"version\": 1, \"duration\": 0.01, \"bodies\": [" + balls(kMostBodies) +
                           "],\n\"joints\": [" + joints + "],\n\"pairs\": [" + pairs + "]}";
  EXPECT_LT(secondsOf([&] { buildWorld(parseScene(text, "s.json")); }), 2 * kSoon);
}

// The counted partners are those that a look at every pair finds.
TEST(InputLimits, WhoMayTouchIsTheSameCountedAndListed) {
  std::string bodies = balls(20), pairs;
  bodies +=
      R"(, {"name": "floor", "shape": {"type": "half_space"}}, {"name": "wall", "shape": {"type": "box", "size": [1, 1, 1]}, "static": true})";
  for (int i = 1; i < 20; ++i) pairs += fmt::format("{{\"bodies\": [\"ball0\", \"ball{}\"], \"touch\": false}},", i);
  pairs += R"({"bodies": ["ball0", "floor"], "touch": false}, {"bodies": ["floor", "ball0"], "touch": false})";
  const auto touches = [&](const std::string& more) {
    return buildWorld(parseScene("{\"version\": 1, \"duration\": 1, \"bodies\": [" + bodies + "], \"pairs\": [" +
                                     pairs + more + "]}",
                                 "s"))
        .world;
  };
  EXPECT_TRUE(touches("").has_broad_phase);
  EXPECT_TRUE(touches("").bodies[0].may_touch);  // the wall
  const auto alone = touches(R"(, {"bodies": ["wall", "ball0"], "touch": false})");
  EXPECT_FALSE(alone.bodies[0].may_touch);
  for (std::size_t i = 1; i < alone.bodies.size(); ++i) EXPECT_TRUE(alone.bodies[i].may_touch) << i;
}

TEST(InputLimits, OfTwoMaterialsForOnePairTheLastCounts) {
  const std::string pairs =
      R"({"bodies": ["ball0", "ball1"], "material": {"mu_s": 0.1}}, {"bodies": ["ball2", "ball1"], "material": {"mu_s": 0.2}},
    {"bodies": ["ball1", "ball0"], "material": {"mu_s": 0.3}})";
  const auto world = buildWorld(parseScene("{\"version\": 1, \"duration\": 1, \"bodies\": [" + balls(3) +
                                               "], \"pairs\": [" + pairs + "]}",
                                           "s"))
                         .world;
  EXPECT_EQ(engine::materialOf(world, 0, 1).mu_s, 0.3);
  EXPECT_EQ(engine::materialOf(world, 1, 2).mu_s, 0.2);
  EXPECT_EQ(world.special_pairs.size(), 2u);
}

TEST(InputLimits, CalibrationsAndStudiesHaveBoundedLists) {
  const TemporaryDirectory folder;
  std::string values;
  for (int i = 0; i < 100; ++i) values += fmt::format("{}\"v{}\": 0", i ? "," : "", i);
  std::ofstream(folder / "c.json") << "{\"device\": \"A\", \"values\": {" << values << "}}";
  EXPECT_TRUE(
      contains(errorOf([&] { readCalibration(folder / "c.json"); }), "has 100 values; no device has more than 64"));
  std::string frictions = "0.5";
  for (int i = 0; i < 200; ++i) frictions += ", 0.5";
  EXPECT_TRUE(
      contains(errorOf([&] { parseStudyFile("{\"sphere_pickup\": {\"frictions\": [" + frictions + "]}}", "s"); }),
               "has 201 elements; at most 100 are allowed"));
}

}  // namespace
}  // namespace pincer::tasks
