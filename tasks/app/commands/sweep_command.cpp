#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "pincer/contact/error.h"
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

namespace pincer::tasks {
namespace {

constexpr const char* kSweepExample = R"(
Runs a scene (docs/scenes.md), or a study of simulated participants (docs/experiments.md), once for each value of one or two of its numbers, and
prints what came of it. PATH names the number as messages do; in a scene a body, joint or finger may stand for its place.

  --vary PATH=FROM:TO:N        N values, evenly          --vary PATH=A,B,C        these
  --vary PATH=FROM:TO:N:log    in equal ratios

Examples:
  pincer sweep s4_pinch --vary sphere.material.mu_s=0.1:0.5:9 --vary duration=1 --measure sphere.p_z
  pincer sweep pickup --vary sphere.mass=0.05:0.2:4 --vary sphere.material.mu_s=0.6,0.9 --measure sphere.p_z:max --out out/pickup
  pincer sweep sphere-pickup --vary people.tactor_sd=0.0005:0.01:5:log --participants 4
  pincer sweep delay-discrimination --vary conditions[1].travel_share=0.4:0.8:5 --out out/front-end)";

struct SweepArguments {
  std::string what, out;
  std::vector<std::string> vary;
  SceneSweep scene;
  StudySweep study;
  SweepOptions options;
};

SweepTable sweepAny(const SweepArguments& arguments) {
  std::vector<Variation> variations;
  for (const std::string& text : arguments.vary) variations.push_back(asUsage([&] { return parseVariation(text); }));
  if (variations.size() > 2) refuseUsage("sweep: --vary is given more than twice. A table and a picture show one or two numbers");
  if (variations.size() == 2 && variations[0].path == variations[1].path)
    refuseUsage(fmt::format("sweep: --vary {} is given twice. Name two numbers, or give all values at once: A,B,C", variations[0].path));
  std::unique_ptr<Progress> line;
  SweepOptions options = arguments.options;
  options.progress = [&](std::int64_t done, std::int64_t total) {
    if (!line) line = std::make_unique<Progress>("runs", total);
    line->update(done);
  };
  if (isSweptStudy(arguments.what) || isStudy(arguments.what)) {
    StudySweep sweep = arguments.study;
    sweep.variations = variations;
    const auto run = isStudy(arguments.what) ? sweepOneFinger : sweepStudy;
    return run(arguments.what, sweep, options, interruptFlag());
  }
  SceneSweep sweep = arguments.scene;
  sweep.variations = variations;
  return sweepScene(parseSceneOrBuiltin(arguments.what), sweep, options, interruptFlag());
}

int sweep(const SweepArguments& arguments) {
  const SweepTable table = sweepAny(arguments);
  const bool nothing = std::all_of(table.results.begin(), table.results.end(), [](const auto& r) { return r.empty(); });
  if (nothing) {
    print(stderr, "pincer: interrupted before a run was whole; nothing was written.\n");
    return kExitInterrupted;
  }
  print("{}", sweepText(table));
  if (!arguments.out.empty()) {
    for (const std::string& path : writeSweep(table, arguments.out)) print("{}\n", printablePath(path));
  }
  if (table.interrupted) print(stderr, "pincer: interrupted; these are the runs that were whole.\n");
  return table.interrupted ? kExitInterrupted : kExitOk;
}

}  // namespace

void addSweepCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<SweepArguments>();
  CLI::App* command = app.add_subcommand("sweep", "A scene or study for many values of one or two of its numbers");
  command
      ->add_option(
          "what", arguments->what,
          "Scene file (JSON), name of a built-in scene, sphere-pickup, cylinder-alignment, manipulation, or a study with one finger")
      ->required();
  command->add_option("--vary", arguments->vary, "PATH=FROM:TO:N, PATH=FROM:TO:N:log or PATH=A,B,C; once or twice")
      ->required()
      ->expected(1)
      ->take_all();
  command->add_option("--measure", arguments->scene.measures,
                      "Of a scene: a quantity at the end, or with :min, :max over the whole run (default: those that it records)");
  command->add_option("--participants", arguments->study.participants, "Of a study")->check(wholeWithin(1, 1000))->capture_default_str();
  addSeedOption(*command, arguments->study.seed, "Of a study");
  command->add_option("--threads", arguments->options.threads, "That work at once; the table is the same")
      ->check(wholeWithin(1, 256))
      ->capture_default_str();
  command->add_option("--out", arguments->out, "Directory for sweep.csv and its picture (PNG, SVG)");
  command->footer(kSweepExample);
  command->callback([arguments, &exit_code] { exit_code = sweep(*arguments); });
}

}  // namespace pincer::tasks
