#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <sstream>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/run_tasks.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/app/run_options.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/lab/findings/findings_report.h"
#include "pincer/tasks/lab/sessions/study_runs.h"
#include "pincer/tasks/lab/sessions/variant_runs.h"

namespace pincer::tasks {
namespace {

constexpr const char* kFindingsExample = R"(
Do the published findings follow from what people can feel? Simulated experiments of the published designs,
each judged as the original was: of the five studies with one finger, and of both manipulation tasks beside
controls that change one thing. The participants' parameters are the same whatever comes out; their hashes
stand in the report. Each experiment is a session in --out; what was interrupted or killed goes on with the
same command.

Examples:
  pincer run findings --experiments 20 --out out/findings
  pincer run findings --only primary,infinite-noise --out out/manipulation
  pincer run findings --only discrimination,localisation,identification --study-experiments 20 --out out/studies)";

struct FindingsArguments {
  FindingsOptions options;
  StudyRuns studies;
  RunOptions run;
  std::string part;
  bool markdown = false;
};

FindingsResult runManipulationFindings(const FindingsOptions& options, const std::string& directory) {
  std::unique_ptr<Progress> line;
  return runVariants(options, directory, interruptFlag(), [&](std::int64_t done, std::int64_t total) {
    if (!line) line = std::make_unique<Progress>("experiments", total);
    line->update(done);
  });
}

StudySessions runStudyFindings(StudyRuns studies, const FindingsOptions& options, const std::string& directory) {
  studies.seed = options.seed;
  studies.threads = options.threads;
  studies.only = options.only;
  studies.directory = directory;
  std::unique_ptr<Progress> line;
  return runPublishedStudies(studies, interruptFlag(), [&](std::int64_t done, std::int64_t total) {
    if (!line) line = std::make_unique<Progress>("studies", total);
    line->update(done);
  });
}

// Of both: the manipulation tasks' own people, and the same with the tactors parked.
ClaimTable judgeAll(StudySessions sessions, const FindingsResult& result) {
  for (const VariantResult& variant : result.variants) {
    if (variant.name == findingsVariants().front().name) sessions.studies["manipulation"] = variant.sessions;
    if (variant.name == "frozen-tactor") sessions.parked["manipulation"] = variant.sessions;
  }
  return judgeClaims(sessions);
}

bool isEmpty(const ClaimTable& table) { return table.participants.empty(); }

// "2/5": the second of five parts.
void readPart(const std::string& text, StudyRuns& studies) {
  int part = 0, parts = 0;
  char slash = 0, more = 0;
  std::istringstream in(text);
  if (text.empty()) return;
  const bool read = static_cast<bool>(in >> part >> slash >> parts) && !(in >> more);
  if (!read || slash != '/' || part < 1 || parts < part || parts > 1000)
    refuseUsage(fmt::format("findings: --part {} isn't of the form K/N with 1 <= K <= N <= 1000. Take for example 2/5.",
                            printable(text)));
  studies.part = part;
  studies.parts = parts;
}

int runFindingsCommand(FindingsArguments arguments) {
  asUsage([&] { validate(arguments.options); });
  readPart(arguments.part, arguments.studies);
  const std::string directory = outputDirectory(arguments.run, "findings");
  const StudySessions studies = runStudyFindings(arguments.studies, arguments.options, directory + "/sessions");
  const FindingsResult result = runManipulationFindings(arguments.options, directory + "/sessions");
  const ClaimTable claims = judgeAll(studies, result);
  const bool interrupted = interruptFlag();
  if (result.variants.empty() && isEmpty(claims)) {
    if (!interrupted)
      refuseUsage(fmt::format("findings: no variant's or study's name holds one of \"{}\".", arguments.options.only));
    print(stderr, "pincer: interrupted before an experiment was whole. The same command with --out {} goes on.\n",
          printablePath(directory));
    return kExitInterrupted;
  }
  if (interrupted)
    print(stderr,
          "pincer: interrupted; these are the experiments that were whole. The same command with --out {} goes on.\n",
          printablePath(directory));
  if (!result.variants.empty()) print("{}", findingsText(result));
  print("{}", arguments.markdown ? claimTableMarkdown(claims) : claimTableText(claims));
  if (arguments.run.report) {
    makeDirectory(directory);
    writeFindingsPage(result, claims, directory + "/report.html");
    print("Report: {}/report.html\n", printablePath(directory));
  }
  return interrupted ? kExitInterrupted : kExitOk;
}

}  // namespace

void addFindingsTask(CLI::App& run, int& exit_code) {
  auto arguments = std::make_shared<FindingsArguments>();
  FindingsOptions& options = arguments->options;
  CLI::App* command =
      run.add_subcommand("findings", "Do the published findings follow? Many simulated experiments, with controls");
  command->add_option("--experiments", options.experiments, "Of the primary analysis")->capture_default_str();
  command->add_option("--control-experiments", options.control_experiments, "Of every other variant")
      ->capture_default_str();
  command->add_option("--study-experiments", arguments->studies.experiments, "Of every study with one finger")
      ->check(wholeWithin(0, 1000))
      ->capture_default_str();
  command
      ->add_option("--study-controls", arguments->studies.controls,
                   "Likewise under each control: what follows must vanish")
      ->check(wholeWithin(0, 1000))
      ->capture_default_str();
  command
      ->add_option("--study-participants", arguments->studies.participants, "In each of them (default: as published)")
      ->check(wholeWithin(2, 1000));
  command->add_option("--part", arguments->part,
                      "K/N: run only the K-th of N parts of the studies; the table shows all that --out holds");
  command->add_flag("--markdown", arguments->markdown, "Print the table of claims as Markdown");
  command->add_option("--participants", options.participants, "In an experiment of the manipulation tasks")
      ->capture_default_str();
  command->add_option("--pickups", options.pickups, "Of every friction, per participant and condition")
      ->capture_default_str();
  command->add_option("--alignments", options.alignments, "Per participant and condition")->capture_default_str();
  command->add_option("--threads", options.threads, "That work at once")->capture_default_str();
  addSeedOption(*command, options.seed, "Of all that varies");
  command->add_option("--only", options.only,
                      "Only variants and studies whose name holds one of these, separated by commas");
  command->add_option("--out", arguments->run.out,
                      "Directory for report and sessions (default: out/findings-DATE-TIME)");
  command->add_flag("!--no-report", arguments->run.report, "Only the table");
  command->footer(kFindingsExample);
  command->callback([arguments, &exit_code] { exit_code = runFindingsCommand(*arguments); });
}

}  // namespace pincer::tasks
