// Sweeps that are kept: what was killed goes on, shards join to the bytes of the whole.
#include "pincer/tasks/lab/sweep/sweep_store.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/lab/sweep/scene_sweep.h"
#include "pincer/tasks/lab/sweep/sweep_machines.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::errorOf;
using tests::readFile;
using tests::TemporaryDirectory;

const std::atomic<bool> kGoesOn{false};
constexpr std::size_t kCases = 13;

// Three numbers, and one case that can't be run.
SweepJob someJob() {
  SweepGrid grid{{"sphere.mass", "sphere.material.mu_s", "duration"}, {}};
  for (std::size_t i = 0; i < kCases; ++i)
    grid.points.push_back({i == 4 ? -1 : 0.05 * static_cast<double>(i + 1), 0.3, 0.03});
  return sceneSweep(parseSceneOrBuiltin("s4_pinch"), sceneText("s4_pinch"),
                    {grid, {"sphere.p_z", "left.normal_force:max", "energy"}});
}

// Runs a shard until `most` further cases are whole, as a kill would leave it; true: its end was reached.
bool runSome(const std::string& directory, const SweepShard& shard, std::size_t most) {
  SweepJob job = someJob();
  SweepStore store(directory, job, shard, true);
  std::atomic<bool> killed{most == 0};
  SweepOptions options{1, shard, {}, {}};
  options.finished = [&](std::size_t point, const CaseResult& result) {
    store.add(point, result);
    killed = --most == 0;
  };
  runSweep(job, options, killed);
  if (!killed) store.finish(job.table);
  return !killed;
}

void runWhole(const std::string& directory, const SweepShard& shard = {}) {
  SweepJob job = someJob();
  SweepStore store(directory, job, shard, false);
  SweepOptions options{2, shard, {}, [&](std::size_t point, const CaseResult& result) { store.add(point, result); }};
  runSweep(job, options, kGoesOn);
  store.finish(job.table);
}

TEST(SweepStore, ComesBackAsItWas) {
  const TemporaryDirectory dir;
  runWhole(dir / "a");
  const StoredSweep back = readSweep(dir / "a");
  SweepJob job = someJob();
  runSweep(job, {}, kGoesOn);
  EXPECT_EQ(sweepJson(back.table), sweepJson(job.table));
  EXPECT_EQ(back.definition, job.definition);
  EXPECT_EQ(back.table.failed(), 1u);
}

// Whatever the number of shards, wherever each is cut off, in whatever order they are given.
TEST(SweepMerge, OfShardsThatWereKilledIsTheWholeByteByByte) {
  const TemporaryDirectory dir;
  runWhole(dir / "whole");
  const std::string whole = readFile(dir / "whole/sweep.db");
  std::mt19937 random(7);
  for (const int count : {1, 2, 3, 7}) {
    std::vector<std::string> folders;
    for (int i = 1; i <= count; ++i) {
      folders.push_back(dir / fmt::format("{}-{}", count, i));
      while (!runSome(folders.back(), {i, count}, 1 + random() % 3)) {
      }
    }
    std::shuffle(folders.begin(), folders.end(), random);
    const StoredSweep merged = mergeSweeps(folders);
    const std::string out = dir / fmt::format("merged-{}", count);
    std::filesystem::create_directory(out);
    writeSweepStore(out, merged.definition, merged.shard, merged.table);
    EXPECT_EQ(readFile(out + "/sweep.db"), whole) << count;
    EXPECT_EQ(sweepCsv(merged.table), sweepCsv(readSweep(dir / "whole").table)) << count;
  }
}

TEST(SweepMerge, NamesWhatIsMissingTwiceUnfinishedOrOfAnotherSweep) {
  const TemporaryDirectory dir;
  runWhole(dir / "a", {1, 3});
  runWhole(dir / "a-again", {1, 3});
  runWhole(dir / "c", {3, 3});
  runWhole(dir / "half", {1, 2});
  runSome(dir / "b", {2, 3}, 2);
  const auto said = [&](std::vector<const char*> names) {
    std::vector<std::string> folders;
    for (const char* name : names) folders.push_back(dir / name);
    return errorOf([&] { mergeSweeps(folders); });
  };
  EXPECT_TRUE(contains(said({"a", "c"}), "shards are missing: 2/3")) << said({"a", "c"});
  EXPECT_TRUE(contains(said({"a", "a-again"}), "shard 1/3 is there twice")) << said({"a", "a-again"});
  EXPECT_TRUE(contains(said({"a", "b", "c"}), "shard 2/3 lacks 2 of its cases")) << said({"a", "b", "c"});
  EXPECT_TRUE(contains(said({"a", "half"}), "shards of one division")) << said({"a", "half"});
  EXPECT_TRUE(contains(said({"nowhere"}), "nowhere")) << said({"nowhere"});
  const TemporaryDirectory other;
  SweepJob job = someJob();
  job.definition += " ";
  SweepStore(other / "x", job, {2, 3}, false);
  EXPECT_TRUE(contains(errorOf([&] { mergeSweeps({dir / "a", other / "x"}); }), "aren't shards of one sweep"));
}

TEST(SweepStore, RefusesAnotherSweepAnotherShardAndASecondWriter) {
  const TemporaryDirectory dir;
  SweepJob job = someJob();
  const auto open = [&](const SweepShard& shard, bool resume) { SweepStore(dir / "a", job, shard, resume); };
  open({1, 2}, false);
  EXPECT_TRUE(contains(errorOf([&] { open({1, 2}, false); }), "--resume"));
  EXPECT_TRUE(contains(errorOf([&] { open({2, 2}, true); }), "shard 1/2, not shard 2/2"));
  job.definition += " ";
  EXPECT_TRUE(contains(errorOf([&] { open({1, 2}, true); }), "another sweep"));
  job = someJob();
  const SweepStore first(dir / "a", job, {1, 2}, true);
  EXPECT_NE(errorOf([&] { open({1, 2}, true); }), "") << "two programs write it";
}

TEST(SweepMachines, QuoteWhatAShellWouldTake) {
  EXPECT_EQ(shellText({"pincer", "a b", "it's", "mu=0.1:0.5:9", "conditions[1].x=1", ""}),
            "pincer 'a b' 'it'\\''s' mu=0.1:0.5:9 'conditions[1].x=1' ''");
  const MachinePlan plan{{"pincer", "sweep", "s4_pinch", "--vary", "sphere.mass=1,2"}, "out/x", 3, 2, "0:10:00"};
  EXPECT_TRUE(contains(
      parallelFile(plan),
      "\npincer sweep s4_pinch --vary sphere.mass=1,2 --threads 2 --shard 3/3 --out out/x/shard-3 --resume\n"));
  EXPECT_TRUE(contains(slurmFile(plan), "#SBATCH --array=1-3\n"));
  EXPECT_TRUE(contains(slurmFile(plan), "#SBATCH --time=0:10:00\n"));
}

TEST(SweepCommand, RunsShardsAndMergesThem) {
  const TemporaryDirectory dir;
  const auto sweep = [&](std::vector<std::string> more) {
    std::vector<std::string> all{"sweep",  "s4_pinch",      "--vary",    "sphere.mass=0.1,-1,0.2",
                                 "--vary", "duration=0.03", "--measure", "sphere.p_z"};
    all.insert(all.end(), more.begin(), more.end());
    return tests::runPincer(all);
  };
  EXPECT_EQ(sweep({"--out", dir / "whole"}).exit_code, kExitCheckFailed) << "a case can't be run";
  for (const char* shard : {"1/2", "2/2"})
    sweep({"--shard", shard, "--out", dir / fmt::format("shard-{}", shard[0]), "--resume"});
  const auto merged = tests::runPincer({"sweep", "merge", dir / "shard-2", dir / "shard-1", "--out", dir / "merged"});
  EXPECT_EQ(merged.exit_code, kExitOk) << merged.error;
  for (const char* name : {"sweep.csv", "sweep.db", "sweep.svg"})
    EXPECT_EQ(readFile(dir / "merged/" + name), readFile(dir / "whole/" + name)) << name;
  EXPECT_EQ(sweep({"--out", dir / "h5", "--format", "hdf5"}).exit_code, kExitCheckFailed);
  sweep({"--out", dir / "h5-again", "--format", "hdf5"});
  EXPECT_EQ(readFile(dir / "h5/sweep.h5"), readFile(dir / "h5-again/sweep.h5"));
  for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
           {"--shard", "3/2", "--out", "x"}, {"--shard", "1/2"}, {"--resume"}, {"--cases", "c.csv"}}) {
    EXPECT_EQ(sweep(wrong).exit_code, kExitUsage) << wrong[0];
  }
}

}  // namespace
}  // namespace pincer::tasks
