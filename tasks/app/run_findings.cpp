#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "tasks/app/app.h"
#include "tasks/app/interrupt.h"
#include "tasks/app/progress.h"
#include "tasks/app/run_options.h"
#include "tasks/app/run_tasks.h"
#include "tasks/findings/findings_report.h"
#include "tasks/session/atomic_file.h"

namespace pincer::tasks {
namespace {

constexpr const char* kFindingsExample = R"(
Do the published findings of both manipulation tasks follow from what people can feel? Simulated experiments of the published design, each
judged as the original was, beside controls that change one thing. The participants' parameters are the same whatever comes out; their hash
stands in the report.

Example:
  pincer run findings --experiments 20 --out out/findings)";

struct FindingsArguments {
  FindingsOptions options;
  RunOptions run;
};

int runFindingsCommand(const FindingsArguments& arguments) {
  const std::atomic<bool>& interrupted = interruptFlag();
  std::unique_ptr<Progress> line;
  const FindingsResult result = runFindings(arguments.options, interrupted, [&](std::int64_t done, std::int64_t total) {
    if (!line) line = std::make_unique<Progress>("participants", total);
    line->update(done);
  });
  line.reset();
  if (result.variants.empty()) {
    fmt::print(stderr, "pincer: interrupted before an experiment was whole; nothing was written.\n");
    return kExitInterrupted;
  }
  const int exit_code = result.interrupted ? kExitInterrupted : kExitOk;
  if (result.interrupted) fmt::print(stderr, "pincer: interrupted; these are the experiments that were whole.\n");
  fmt::print("{}", findingsText(result));
  if (!arguments.run.report) return exit_code;
  const std::string directory = outputDirectory(arguments.run, "findings");
  makeDirectory(directory);
  writeFindingsPage(result, directory + "/report.html");
  fmt::print("Report: {}/report.html\n", directory);
  return exit_code;
}

}  // namespace

void addFindingsTask(CLI::App& run, int& exit_code) {
  auto arguments = std::make_shared<FindingsArguments>();
  FindingsOptions& options = arguments->options;
  CLI::App* command = run.add_subcommand("findings", "Do the published findings follow? Many simulated experiments, with controls");
  command->add_option("--experiments", options.experiments, "Of the primary analysis")->capture_default_str();
  command->add_option("--control-experiments", options.control_experiments, "Of every other variant")->capture_default_str();
  command->add_option("--participants", options.participants, "In an experiment")->capture_default_str();
  command->add_option("--pickups", options.pickups, "Of every friction, per participant and condition")->capture_default_str();
  command->add_option("--alignments", options.alignments, "Per participant and condition")->capture_default_str();
  command->add_option("--threads", options.threads, "That work at once")->capture_default_str();
  command->add_option("--seed", options.seed, "Of all that varies")->capture_default_str();
  command->add_option("--only", options.only, "Only variants whose name holds one of these, separated by commas");
  command->add_option("--out", arguments->run.out, "Directory for the report (default: out/findings-DATE-TIME)");
  command->add_flag("!--no-report", arguments->run.report, "Only the table");
  command->footer(kFindingsExample);
  command->callback([arguments, &exit_code] { exit_code = runFindingsCommand(*arguments); });
}

}  // namespace pincer::tasks
