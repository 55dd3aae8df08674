#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "pincer/contact/error.h"
#include "pincer/contact/io/counted.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/app/run_options.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/lab/report/study_summary.h"
#include "pincer/tasks/lab/sweep/one_finger_sweep.h"
#include "pincer/tasks/lab/sweep/scene_sweep.h"
#include "pincer/tasks/lab/sweep/study_sweep.h"
#include "pincer/tasks/lab/sweep/sweep_machines.h"
#include "pincer/tasks/lab/sweep/sweep_store.h"

namespace pincer::tasks {
namespace {

constexpr const char* kSweepExample = R"(
Runs a scene (docs/scenes.md), or a study of simulated participants (docs/experiments.md), once for each value
of some of its numbers, and prints what came of it (docs/sweeps.md). PATH names the number as messages do; in
a scene a body, joint or finger may stand for its place.

  --vary PATH=FROM:TO:N        N values, evenly          --vary PATH=A,B,C        these
  --vary PATH=FROM:TO:N:log    in equal ratios           --cases FILE.csv         paths in the first line, then a case per line

Several are crossed, or with --zip taken in step. With --out every finished case is safe at once: what is
killed goes on with --resume. --shard I/N runs one share, `pincer sweep merge` joins the shares, and --for
parallel or slurm prints a file that has them run.

Examples:
  pincer sweep s4_pinch --vary sphere.material.mu_s=0.1:0.5:9 --vary duration=1 --measure sphere.p_z
  pincer sweep pickup --vary sphere.mass=0.05:0.2:4 --vary sphere.material.mu_s=0.6,0.9 --measure sphere.p_z:max --out out/pickup
  pincer sweep s4_pinch --vary sphere.mass=0.05:0.2:16 --for slurm --shards 4 --out out/mass
  pincer sweep merge DIR/shard-* --out DIR
  pincer sweep sphere-pickup --vary people.tactor_sd=0.0005:0.01:5:log --participants 4
  pincer sweep delay-discrimination --vary conditions[1].travel_share=0.4:0.8:5 --out out/front-end)";

constexpr std::array kFormatNames = {"csv", "json", "hdf5"};  // by SweepFormat

struct SweepArguments {
  std::string what, out, cases, shard, machines, format = "csv";
  std::vector<std::string> vary, merged;
  std::vector<std::string> measures;
  StudySweep study;
  SweepOptions options;
  MachinePlan plan;
  bool zip = false, resume = false;

  SweepFormat outputFormat() const {
    return static_cast<SweepFormat>(std::find(kFormatNames.begin(), kFormatNames.end(), format) - kFormatNames.begin());
  }
};

SweepGrid gridOf(const SweepArguments& arguments, std::size_t most) {
  if (!arguments.cases.empty()) return readCases(arguments.cases, most);
  std::vector<Variation> variations;
  for (const std::string& text : arguments.vary) variations.push_back(asUsage([&] { return parseVariation(text); }));
  return asUsage([&] { return arguments.zip ? zipped(variations, most) : crossed(variations, most); });
}

SweepJob jobOf(const SweepArguments& arguments) {
  if (isSweptStudy(arguments.what) || isStudy(arguments.what)) {
    StudySweep sweep = arguments.study;
    sweep.grid = gridOf(arguments, kMostStudyCases);
    return isStudy(arguments.what) ? oneFingerSweep(arguments.what, sweep) : studySweep(arguments.what, sweep);
  }
  return sceneSweep(parseSceneOrBuiltin(arguments.what), sceneText(arguments.what),
                    {gridOf(arguments, kMostSceneCases), arguments.measures});
}

void printTable(const SweepTable& table, const SweepArguments& arguments) {
  print("{}", sweepText(table));
  for (std::size_t i = 0; i < table.results.size(); ++i) {
    if (!table.results[i].error.empty())
      print(stderr, "pincer: case {}: {}\n", i, printableMessage(table.results[i].error));
  }
  if (arguments.out.empty()) return;
  for (const std::string& path : writeSweep(table, arguments.out, arguments.outputFormat()))
    print("{}\n", printablePath(path));
}

int runCases(SweepJob& job, const SweepArguments& arguments, SweepStore* store) {
  std::unique_ptr<Progress> line;
  SweepOptions options = arguments.options;
  options.progress = [&](std::int64_t done, std::int64_t total) {
    if (!line) line = std::make_unique<Progress>("runs", total);
    line->update(done);
  };
  if (store) options.finished = [&](std::size_t point, const CaseResult& result) { store->add(point, result); };
  runSweep(job, options, interruptFlag());
  line.reset();
  if (job.table.interrupted && job.table.done() == 0) {
    print(stderr, "pincer: interrupted before a run was whole; nothing was written.\n");
    return kExitInterrupted;
  }
  if (store && !job.table.interrupted) store->finish(job.table);
  printTable(job.table, arguments);
  if (job.table.interrupted) {
    print(stderr, "pincer: interrupted; these are the runs that were whole.{}\n", store ? " --resume goes on." : "");
    return kExitInterrupted;
  }
  if (const auto failed = static_cast<std::int64_t>(job.table.failed()); failed > 0) {
    print(stderr, "pincer: {} couldn't be run; the table has nan there.\n", counted(failed, "case"));
    return kExitCheckFailed;
  }
  return kExitOk;
}

int merge(const SweepArguments& arguments) {
  if (arguments.merged.empty()) refuseUsage("sweep merge: a folder for each shard is required");
  if (arguments.out.empty()) refuseUsage("sweep merge: --out is required");
  if (!arguments.vary.empty() || !arguments.cases.empty())
    refuseUsage("sweep merge: takes folders, --out and --format; --vary is for running");
  const StoredSweep whole = mergeSweeps(arguments.merged);
  makeDirectory(arguments.out);
  writeSweepStore(arguments.out, whole.definition, whole.shard, whole.table);
  printTable(whole.table, arguments);
  return kExitOk;
}

// The command as it was given, without what a shard's command adds.
std::vector<std::string> commandOf(const SweepArguments& arguments) {
  std::vector<std::string> command{"pincer", "sweep", arguments.what};
  const auto add = [&](const char* option, const std::string& value) {
    command.insert(command.end(), {option, value});
  };
  for (const std::string& text : arguments.vary) add("--vary", text);
  if (arguments.zip) command.emplace_back("--zip");
  if (!arguments.cases.empty()) add("--cases", arguments.cases);
  for (const std::string& text : arguments.measures) add("--measure", text);
  add("--participants", std::to_string(arguments.study.participants));
  add("--seed", std::to_string(arguments.study.seed));
  add("--format", arguments.format);
  return command;
}

int printMachineFile(const SweepArguments& arguments) {
  if (arguments.out.empty()) refuseUsage("sweep --for: --out is required, for the shards' folders");
  jobOf(arguments);  // says what is wrong before a cluster does
  MachinePlan plan = arguments.plan;
  plan.command = commandOf(arguments);
  plan.out = arguments.out;
  plan.threads = arguments.options.threads;
  print("{}", arguments.machines == "slurm" ? slurmFile(plan) : parallelFile(plan));
  return kExitOk;
}

int sweep(SweepArguments& arguments) {
  if (arguments.what == "merge") return merge(arguments);
  if (!arguments.merged.empty())
    refuseUsage(fmt::format("sweep: \"{}\" isn't expected: one scene or study at a time", arguments.merged.front()));
  if (arguments.vary.empty() == arguments.cases.empty()) refuseUsage("sweep: --vary is required, or --cases; not both");
  if (!arguments.machines.empty()) return printMachineFile(arguments);
  if (!arguments.shard.empty()) arguments.options.shard = asUsage([&] { return parseShard(arguments.shard); });
  if (arguments.out.empty() && (arguments.resume || !arguments.shard.empty()))
    refuseUsage("sweep: --resume and --shard need --out");
  SweepJob job = jobOf(arguments);
  std::unique_ptr<SweepStore> store;
  if (!arguments.out.empty())
    store = std::make_unique<SweepStore>(arguments.out, job, arguments.options.shard, arguments.resume);
  return runCases(job, arguments, store.get());
}

void addShareOptions(CLI::App& command, SweepArguments& arguments) {
  command.add_option("--shard", arguments.shard, "Only the I-th of N shares of the cases, as 2/7");
  command.add_flag("--resume", arguments.resume, "Go on with what is in --out, if anything is");
  command
      .add_option("--for", arguments.machines,
                  "Print a file that has the shards run: for GNU parallel, or a Slurm job array")
      ->check(CLI::IsMember({"parallel", "slurm"}));
  command.add_option("--shards", arguments.plan.shards, "With --for: how many")
      ->check(wholeWithin(1, 100'000))
      ->capture_default_str();
  command.add_option("--time-limit", arguments.plan.time_limit, "With --for slurm: of each shard")
      ->capture_default_str();
}

}  // namespace

void addSweepCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<SweepArguments>();
  CLI::App* command = app.add_subcommand("sweep", "A scene or study for many values of some of its numbers");
  command
      ->add_option("what", arguments->what,
                   "Scene file (JSON), name of a built-in scene, sphere-pickup, cylinder-alignment, manipulation, or a "
                   "study with one finger; or "
                   "merge")
      ->required();
  command->add_option("folders", arguments->merged, "Of merge: the shards' folders, in any order");
  command
      ->add_option("--vary", arguments->vary, "PATH=FROM:TO:N, PATH=FROM:TO:N:log or PATH=A,B,C; any number of times")
      ->expected(1)
      ->take_all();
  command->add_flag("--zip", arguments->zip, "Take the values of all --vary in step, instead of every combination");
  command->add_option("--cases", arguments->cases,
                      "In place of --vary: a CSV file, paths in its first line, then a case per line");
  command->add_option(
      "--measure", arguments->measures,
      "Of a scene: a quantity at the end, or with :min, :max over the whole run (default: those that it records)");
  command->add_option("--participants", arguments->study.participants, "Of a study")
      ->check(wholeWithin(1, 1000))
      ->capture_default_str();
  addSeedOption(*command, arguments->study.seed, "Of a study");
  command->add_option("--threads", arguments->options.threads, "That work at once; the table is the same")
      ->check(wholeWithin(1, 256))
      ->capture_default_str();
  command->add_option("--out", arguments->out,
                      "Directory for the table, its picture (PNG, SVG), and sweep.db, from which --resume goes on");
  command->add_option("--format", arguments->format, "Of the table")
      ->check(CLI::IsMember(std::vector<std::string>(kFormatNames.begin(), kFormatNames.end())))
      ->capture_default_str();
  addShareOptions(*command, *arguments);
  command->footer(kSweepExample);
  command->callback([arguments, &exit_code] { exit_code = sweep(*arguments); });
}

}  // namespace pincer::tasks
