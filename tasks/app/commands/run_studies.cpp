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
#include "pincer/tasks/app/device_options.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/app/run_options.h"
#include "pincer/tasks/app/terminal_person.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/lab/finger/live_finger.h"
#include "pincer/tasks/lab/report/study_report.h"
#include "pincer/tasks/lab/sessions/session_hash.h"
#include "pincer/tasks/lab/sessions/study_experiments.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/lab/sessions/study_session.h"
#include "pincer/tasks/run/servo/servo_text.h"
#include "pincer/tasks/view/finger_view.h"
#include "pincer/tasks/view/trial_view.h"

namespace pincer::tasks {
namespace {

struct StudyArguments {
  RunOptions run;
  DeviceRunOptions devices;
  ViewOptions view;
  std::optional<std::int64_t> person;  // from 1
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
  if (arguments.run.out.empty())
    refuseUsage("run: --resume needs --out DIR, the directory of the session to go on with.");
  if (!arguments.study_file.empty() || arguments.participants || arguments.seed)
    refuseUsage(
        "run: --resume goes on with the session's own parameters. Leave out --study, --participants and --seed.");
  const SessionReader session(arguments.run.out + "/session.db");
  const SessionInfo& info = session.info();
  if (info.task != task)
    throw InputError(
        fmt::format("{}: a session of {}, not of {}. Resume it as that.", session.path(), info.task, task));
  if (session.complete())
    throw InputError(session.path() + ": the session is complete; there is nothing to go on with.");
  parseStudy(info.protocol_json, session.path() + ": protocol", study);
  study.seed = info.seed;
  const bool with_people = arguments.devices.devices != "sim";
  if (with_people != personOf(info).has_value()) {
    throw InputError(fmt::format("{}: the session is of {}. Resume it with --devices {}.", session.path(),
                                 with_people ? "simulated participants" : "a person",
                                 with_people ? "sim" : "mouse, or the devices worn"));
  }
  if (!with_people && participantsJson(study) != info.participants_json)
    throw InputError(
        session.path() +
        ": other participants began it than this version simulates. Go on with the version that began it: " +
        info.version + ".");
  return study;
}

int strideOf(const RunOptions& options) {
  const int rate = options.sample_rate;
  if (rate >= 1 && rate <= 1000 && 1000 % rate == 0) return 1000 / rate;
  refuseUsage(fmt::format(
      "run: --sample-rate {} is out of range: a whole number in [1, 1000] Hz that divides 1000. Take for example 1000, "
      "200, 50 or 20.",
      rate));
}

int showStudy(const StudyArguments& arguments, const std::string& directory, const StudyOutcome& outcome) {
  const SessionReader session(directory + "/session.db");
  const StudySummary summary = summariseStudy(session, session.responses());
  print("{}\n", arguments.run.json ? studySummaryJson(summary) : formatStudyTable(summary));
  const auto say = [&](const std::string& line) { print(arguments.run.json ? stderr : stdout, "{}\n", line); };
  const bool by_the_clock =
      arguments.run.servo.clock != ServoClock::kVirtual || arguments.view.view || arguments.devices.devices != "sim";
  if (by_the_clock) say(servoText(outcome.servo, 1 / arguments.run.servo.rate));
  if (!by_the_clock) say(throughputText(static_cast<double>(outcome.servo.ticks) / arguments.run.servo.rate));
  say(fmt::format("Session: {}", printablePath(session.path())));
  say(fmt::format("state_hash {}", sessionHash(session, outcome.samples_hash)));
  if (outcome.interrupted) {
    say(fmt::format("Interrupted after {}; what is done is safe. Go on: the same task with --resume --out {}",
                    counted(outcome.trials, "trial"), printablePath(directory)));
    return kExitInterrupted;
  }
  if (arguments.run.report)
    say(fmt::format(
        "Report: {}",
        printablePath(writeStudyReport(session, directory + "/report.html", {.interrupted = &interruptFlag()}).html)));
  std::int64_t unanswered = 0;
  for (const StudyCondition& c : summary.conditions) unanswered += c.unanswered;
  return unanswered > 0 ? kExitCheckFailed : kExitOk;
}

// Who does the trials, and who watches; lives as long as the session.
struct FingerCast {
  std::unique_ptr<HandDevices> devices;
  std::unique_ptr<FingerStage> window;
  std::unique_ptr<TerminalPerson> terminal;
  FingerHost host;
};

// A person on devices: its finger is theirs, and the operator at the terminal switches forces on.
void wearDevices(const StudyArguments& arguments, const ServoOptions& servo, FingerCast& cast) {
  AnswerBox& keys = cast.window ? cast.window->keys() : cast.terminal->keys();
  cast.host.finger = [devices = cast.devices.get(), &keys,
                      oldest = kOldestSample * servo.watchdog](const FingerPlace& place) {
    return std::make_unique<LiveFinger>(place, *devices, keys, oldest);
  };
  cast.host.arm = [asked = arguments.devices, devices = cast.devices.get()](const std::string& why) {
    const std::string complaint = devices->complaint();
    return operatorArms(asked, complaint.empty() ? why : why + "\n" + complaint);
  };
}

// Somebody who takes part in a study answers its questions; who only tries, or goes
// on in a session without answers, doesn't.
bool isParticipant(const StudyArguments& arguments) {
  return arguments.person || (arguments.resume && !SessionReader(arguments.run.out + "/session.db").survey().empty());
}

std::unique_ptr<FingerCast> castOf(const std::string& task, const StudyArguments& arguments, ServoOptions& servo) {
  auto cast = std::make_unique<FingerCast>();
  const std::string& choice = arguments.devices.devices;
  if (arguments.view.view) servo.clock = ServoClock::kPaced;
  DeviceRunOptions devices = arguments.devices;
  devices.which.fingers = 1;
  cast->devices = openDevices(devices, servo);
  ViewOptions view = arguments.view;
  view.title = task;
  cast->window = asUsage([&] { return fingerStageOf(choice, view, servo, interruptFlag()); });
  if (cast->window) cast->host = cast->window->host();
  if (choice == "sim") {
    cast->host.show = {};
    cast->host.ask = {};
    return cast;
  }
  if (!cast->window) {
    cast->terminal = std::make_unique<TerminalPerson>(servo, interruptFlag());
    cast->host.serve = [person = cast->terminal.get()](FingerTrial& trial, const TrialPlace& place) {
      return person->serve(trial, place);
    };
    cast->host.show = [person = cast->terminal.get()](const StudyPage& page) { return person->show(page); };
    cast->host.ask = [person = cast->terminal.get()](const AskedQuestion& question) { return person->ask(question); };
  }
  if (!isParticipant(arguments)) cast->host.ask = {};
  if (cast->devices) wearDevices(arguments, servo, *cast);
  return cast;
}

// Which participant a person is.
std::int64_t personNumber(const StudyArguments& arguments, int participants) {
  const std::int64_t person = arguments.person.value_or(1);
  if (person >= 1 && person <= participants) return person - 1;
  refuseUsage(
      fmt::format("run: --person {} isn't one of the study's {} participants. Give 1 to {}, or more --participants.",
                  person, participants, participants));
}

template <class Study, class MakeExperiment>
int runStudyTask(const std::string& task, const Study& published, const StudyArguments& arguments,
                 const MakeExperiment& make) {
  const std::atomic<bool>& interrupted = interruptFlag();
  const Study study = arguments.resume ? resumedStudy(task, published, arguments) : studyOf(published, arguments);
  if (arguments.print_study) {
    print("{}\n", studyJson(study));
    return kExitOk;
  }
  StudyArguments served = arguments;  // by devices that have a clock of their own
  const auto cast = castOf(task, arguments, served.run.servo);
  auto experiment = make(study, served.run.servo, strideOf(arguments.run));
  const std::string directory = arguments.resume ? arguments.run.out : outputDirectory(arguments.run, task);
  makeDirectory(directory);
  StudySession session;
  session.resume = arguments.resume;
  session.path = directory + "/session.db";
  session.host = cast->host;
  session.waits = served.run.servo.clock != ServoClock::kReal;
  const bool with_people = arguments.devices.devices != "sim";
  if (with_people)
    session.host.person =
        arguments.resume ? personOf(SessionReader(session.path).info()) : personNumber(arguments, study.participants);
  session.info = studySessionInfo(
      task, study.seed, studyJson(study), with_people ? personJson(*session.host.person) : participantsJson(study),
      served.run.servo, arguments.run.sample_rate, with_people ? arguments.devices.devices : "simulated");
  std::unique_ptr<Progress> line = with_people ? nullptr : std::make_unique<Progress>("study", 1000);
  const StudyOutcome outcome = runStudySession(experiment, session, interrupted, [&](const StudyProgress& p) {
    if (line) line->update(std::lround(1000 * p.share));
  });
  line.reset();
  return showStudy(served, directory, outcome);
}

std::shared_ptr<StudyArguments> addStudyTask(CLI::App& run, const std::string& task, const char* what, const char* more,
                                             CLI::App*& command) {
  auto arguments = std::make_shared<StudyArguments>();
  arguments->run.sample_rate = 20;  // hours of strokes
  command = run.add_subcommand(task, what);
  command->add_option("--participants", arguments->participants,
                      "How many simulated participants (default: as many as were published)");
  addSeedOption(*command, arguments->seed, "Of all that varies; the same seed gives the same session", 1);
  command->add_option("--study", arguments->study_file,
                      "File with parameters that differ from the published design (JSON)");
  command->add_flag("--print-study", arguments->print_study,
                    "Print all parameters as JSON with what they mean, and run nothing");
  command->add_flag("--resume", arguments->resume, "Go on with the interrupted or killed session in --out");
  command->add_option("--person", arguments->person,
                      "Which of the participants the person is, from 1: decides the order of conditions, and asks the "
                      "study's questions (default: 1, and "
                      "none is asked)");
  addRunOptions(*command, arguments->run);
  addDeviceOptions(*command, arguments->devices);
  addTrialViewOptions(*command, arguments->view);
  command->footer(
      fmt::format("\n{}\n\nExamples:\n  pincer run {} --participants 2 --out out/{}\n"
                  "  pincer run {} --devices mouse --view          your own finger, on the mouse; answer by keys\n"
                  "  pincer run {} --devices usb --person 3        on an arm and a display (docs/devices/setup.md)",
                  more, task, task, task, task));
  return arguments;
}

void addArcTask(CLI::App& run, int& exit_code, const ArcStudy& published, const char* what, const char* more) {
  CLI::App* command = nullptr;
  const auto arguments = addStudyTask(run, published.task, what, more, command);
  command->callback([arguments, published, &exit_code] {
    const auto make = [](const ArcStudy& s, const ServoOptions& servo, int stride) {
      return ArcExperiment(s, servo, stride);
    };
    exit_code = runStudyTask(published.task, published, *arguments, make);
  });
}

}  // namespace

void addSmoothnessTask(CLI::App& run, int& exit_code) {
  addArcTask(run, exit_code, smoothnessStudy(), "From how many segments on does a polygon feel like a circle?",
             "A finger strokes a polygon and a circle and says which was rougher, with facets, force shading and "
             "tactile shading.");
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
  const auto arguments = addStudyTask(
      run, "shape-identification", "Which of seven solids is it?",
      "A finger feels solids, shaded or not, with and without a contact location display, and names them.", command);
  command->callback([arguments, &exit_code] {
    const auto make = [](const ShapeStudy& s, const ServoOptions& servo, int stride) {
      return ShapeExperiment(s, servo, stride);
    };
    exit_code = runStudyTask("shape-identification", ShapeStudy{}, *arguments, make);
  });
}

void addLocalisationTask(CLI::App& run, int& exit_code) {
  CLI::App* command = nullptr;
  const auto arguments =
      addStudyTask(run, "repeated-localisation", "Where on the fingerpad is the tactor?",
                   "The tactor goes to one of five places; the participant names the place felt.", command);
  command->callback([arguments, &exit_code] {
    const auto make = [](const LocalisationStudy& s, const ServoOptions& servo, int stride) {
      return LocalisationExperiment(s, servo, stride);
    };
    exit_code = runStudyTask("repeated-localisation", LocalisationStudy{}, *arguments, make);
  });
}

}  // namespace pincer::tasks
