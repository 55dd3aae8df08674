#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/contact/io/counted.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/run_tasks.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/app/run_options.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/lab/report/study_report.h"
#include "pincer/tasks/lab/sessions/session_hash.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/lab/sessions/study_session.h"
#include "pincer/tasks/run/servo/servo_text.h"

namespace pincer::tasks {
namespace {

struct StudyArguments {
  RunOptions run;
  std::string study_file;
  std::optional<int> participants;
  std::optional<std::uint64_t> seed;
  bool print_study = false, resume = false;
};

// A study's parameters: the published design, changed by the file and then by the command line.
template <class Study>
Study studyOf(Study study, const StudyArguments& arguments) {
  if (!arguments.study_file.empty()) readStudy(arguments.study_file, study);
  if (arguments.participants) study.participants = *arguments.participants;
  if (arguments.seed) study.seed = *arguments.seed;
  asUsage([&] { validate(study); });  // the file was checked by itself
  return study;
}

// Of a session that is to go on: its parameters, whoever takes part being the same as today.
template <class Study>
Study resumedStudy(const std::string& task, Study study, const StudyArguments& arguments) {
  if (arguments.run.out.empty()) refuseUsage("run: --resume needs --out DIR, the directory of the session to go on with.");
  if (!arguments.study_file.empty() || arguments.participants || arguments.seed)
    refuseUsage("run: --resume goes on with the session's own parameters. Leave out --study, --participants and --seed.");
  const SessionReader session(arguments.run.out + "/session.db");
  const SessionInfo& info = session.info();
  if (info.task != task)
    throw InputError(fmt::format("{}: a session of {}, not of {}. Resume it as that.", session.path(), info.task, task));
  if (session.complete()) throw InputError(session.path() + ": the session is complete; there is nothing to go on with.");
  parseStudy(info.protocol_json, session.path() + ": protocol", study);
  study.seed = info.seed;
  if (participantsJson(study) != info.participants_json)
    throw InputError(session.path() + ": other participants began it than this version simulates. Go on with the version that began it: " +
                     info.version + ".");
  return study;
}

int strideOf(const RunOptions& options) {
  const int rate = options.sample_rate;
  if (rate >= 1 && rate <= 1000 && 1000 % rate == 0) return 1000 / rate;
  refuseUsage(
      fmt::format("run: --sample-rate {} is out of range: a whole number in [1, 1000] Hz that divides 1000. Take for example 1000, "
                  "200, 50 or 20.",
                  rate));
}

int showStudy(const StudyArguments& arguments, const std::string& directory, const StudyOutcome& outcome) {
  const SessionReader session(directory + "/session.db");
  const StudySummary summary = summariseStudy(session, session.responses());
  print("{}\n", arguments.run.json ? studySummaryJson(summary) : formatStudyTable(summary));
  const auto say = [&](const std::string& line) { print(arguments.run.json ? stderr : stdout, "{}\n", line); };
  if (arguments.run.servo.clock != ServoClock::kVirtual) say(servoText(outcome.servo, 1 / arguments.run.servo.rate));
  const double simulated = static_cast<double>(outcome.servo.ticks) / arguments.run.servo.rate;
  say(throughputText(simulated));
  say(fmt::format("Session: {}", printablePath(session.path())));
  say(fmt::format("state_hash {}", sessionHash(session)));
  if (outcome.interrupted) {
    say(fmt::format("Interrupted after {}; what is done is safe. Go on: the same task with --resume --out {}",
                    counted(outcome.trials, "trial"), printablePath(directory)));
    return kExitInterrupted;
  }
  if (arguments.run.report)
    say(fmt::format("Report: {}",
                    printablePath(writeStudyReport(session, directory + "/report.html", {.interrupted = &interruptFlag()}).html)));
  std::int64_t unanswered = 0;
  for (const StudyCondition& c : summary.conditions) unanswered += c.unanswered;
  return unanswered > 0 ? kExitCheckFailed : kExitOk;
}

template <class Study, class MakeExperiment>
int runStudyTask(const std::string& task, const Study& published, const StudyArguments& arguments, const MakeExperiment& make) {
  const std::atomic<bool>& interrupted = interruptFlag();
  const Study study = arguments.resume ? resumedStudy(task, published, arguments) : studyOf(published, arguments);
  if (arguments.print_study) {
    print("{}\n", studyJson(study));
    return kExitOk;
  }
  auto experiment = make(study, arguments.run.servo, strideOf(arguments.run));
  const std::string directory = arguments.resume ? arguments.run.out : outputDirectory(arguments.run, task);
  makeDirectory(directory);
  StudySession session;
  session.resume = arguments.resume;
  session.info =
      studySessionInfo(task, study.seed, studyJson(study), participantsJson(study), arguments.run.servo, arguments.run.sample_rate);
  session.path = directory + "/session.db";
  Progress line("study", 1000);
  const StudyOutcome outcome =
      runStudySession(experiment, session, interrupted, [&](const StudyProgress& p) { line.update(std::lround(1000 * p.share)); });
  return showStudy(arguments, directory, outcome);
}

std::shared_ptr<StudyArguments> addStudyTask(CLI::App& run, const std::string& task, const char* what, const char* more,
                                             CLI::App*& command) {
  auto arguments = std::make_shared<StudyArguments>();
  arguments->run.sample_rate = 20;  // hours of strokes
  command = run.add_subcommand(task, what);
  command->add_option("--participants", arguments->participants, "How many simulated participants (default: 12)");
  addSeedOption(*command, arguments->seed, "Of all that varies; the same seed gives the same session", 1);
  command->add_option("--study", arguments->study_file, "File with parameters that differ from the published design (JSON)");
  command->add_flag("--print-study", arguments->print_study, "Print all parameters as JSON with what they mean, and run nothing");
  command->add_flag("--resume", arguments->resume, "Go on with the interrupted or killed session in --out");
  addRunOptions(*command, arguments->run);
  command->footer(fmt::format("\n{}\n\nExample:\n  pincer run {} --participants 2 --out out/{}", more, task, task));
  return arguments;
}

void addArcTask(CLI::App& run, int& exit_code, const ArcStudy& published, const char* what, const char* more) {
  CLI::App* command = nullptr;
  const auto arguments = addStudyTask(run, published.task, what, more, command);
  command->callback([arguments, published, &exit_code] {
    const auto make = [](const ArcStudy& s, const ServoOptions& servo, int stride) { return ArcExperiment(s, servo, stride); };
    exit_code = runStudyTask(published.task, published, *arguments, make);
  });
}

}  // namespace

void addSmoothnessTask(CLI::App& run, int& exit_code) {
  addArcTask(run, exit_code, smoothnessStudy(), "From how many segments on does a polygon feel like a circle?",
             "A finger strokes a polygon and a circle and says which was rougher, with facets, force shading and tactile shading.");
}

void addBacklashTask(CLI::App& run, int& exit_code) {
  addArcTask(run, exit_code, backlashStudy(), "How much backlash of a contact location display is noticed?",
             "Virtual backlash is added to the display, on a cylinder of low curvature and on a sharp edge.");
}

void addDelayTask(CLI::App& run, int& exit_code) {
  addArcTask(run, exit_code, delayStudy(), "How much delay of a contact location display is noticed?",
             "A FIFO delays the display's commands, for its whole travel or with the tactor held at two thirds of it.");
}

void addShapeTask(CLI::App& run, int& exit_code) {
  CLI::App* command = nullptr;
  const auto arguments =
      addStudyTask(run, "shape-identification", "Which of seven solids is it?",
                   "A finger feels solids, shaded or not, with and without a contact location display, and names them.", command);
  command->callback([arguments, &exit_code] {
    const auto make = [](const ShapeStudy& s, const ServoOptions& servo, int stride) { return ShapeExperiment(s, servo, stride); };
    exit_code = runStudyTask("shape-identification", ShapeStudy{}, *arguments, make);
  });
}

void addLocalisationTask(CLI::App& run, int& exit_code) {
  CLI::App* command = nullptr;
  const auto arguments = addStudyTask(run, "repeated-localisation", "Where on the fingerpad is the tactor?",
                                      "The tactor goes to one of five places; the participant names the place felt.", command);
  command->callback([arguments, &exit_code] {
    const auto make = [](const LocalisationStudy& s, const ServoOptions& servo, int stride) {
      return LocalisationExperiment(s, servo, stride);
    };
    exit_code = runStudyTask("repeated-localisation", LocalisationStudy{}, *arguments, make);
  });
}

}  // namespace pincer::tasks
