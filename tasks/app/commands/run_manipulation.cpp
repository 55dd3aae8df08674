#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

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
#include "pincer/tasks/lab/experiments/live_hands.h"
#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/experiments/pickup_object.h"
#include "pincer/tasks/lab/report/finding_words.h"
#include "pincer/tasks/lab/report/report.h"
#include "pincer/tasks/lab/sessions/manipulation_session.h"
#include "pincer/tasks/lab/sessions/session_hash.h"
#include "pincer/tasks/run/servo/servo_text.h"
#include "pincer/tasks/view/trial_view.h"

namespace pincer::tasks {
namespace {

constexpr const char* kSpherePickupExample = R"(
Index finger and thumb pick up spheres of different friction that lie in a dish, with and without contact
location displays.

Examples:
  pincer run sphere-pickup --repetitions 2 --seed 7 --out out/first
  pincer run sphere-pickup --devices mouse --view      your own fingers, on the mouse
  pincer run sphere-pickup --devices usb               on arms and displays (docs/devices/setup.md))";

constexpr const char* kCylinderExample = R"(
Index finger and thumb find the flat of an upright cylinder and turn it towards the monitor, with and without
contact location displays.

Example:
  pincer run cylinder-alignment --repetitions 3 --seed 7 --out out/first)";

constexpr const char* kManipulationExample = R"(
The whole study: 12 participants, both tasks in one condition, then both in the other, training before each. A
session that was interrupted or killed goes on with --resume.

Examples:
  pincer run manipulation --seed 1 --out out/study
  pincer run manipulation --write-study study.json      every parameter, with what it means
  pincer run manipulation --study study.json --out out/study
  pincer run manipulation --resume --out out/study)";

// Words of options: of --shading, by closed forms; of --condition, all of them, by either word.
constexpr const char *kExactly = "exactly", *kAllConditions = "all", *kBothConditions = "both";

struct ManipulationArguments {
  RunOptions run;
  DeviceRunOptions devices;
  ViewOptions view;
  std::string condition = kAllConditions, strategy, object, units, shading, study_file, write_study;
  std::optional<double> size;
  bool resume = false, free_body = false, print_study = false;
  std::optional<std::int64_t> person;  // from 1
  ManipulationStudy study;
};

contact::SurfaceVariant variantOf(const std::string& name) {
  const auto& names = contact::kSurfaceVariantNames;
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? contact::SurfaceVariant::smooth
                              : static_cast<contact::SurfaceVariant>(found - names.begin());
}

ObjectFile objectOf(const ManipulationArguments& arguments) {
  return {arguments.object, arguments.units.empty() ? "mm" : arguments.units, arguments.size,
          variantOf(arguments.shading)};
}

// The command's study, changed by the file.
ManipulationStudy studyOf(const ManipulationArguments& arguments) {
  ManipulationStudy study = arguments.study;
  if (!arguments.study_file.empty()) study = readStudyFile(arguments.study_file, study);
  if (taskName(arguments.study) == "manipulation" || taskName(study) == taskName(arguments.study)) return study;
  throw InputError(fmt::format("{}: its tasks are those of {}. Leave them out, or give the file to `pincer run {}`.",
                               printablePath(arguments.study_file), taskName(study), taskName(study)));
}

// The one that --condition names, or all.
std::vector<HandCondition> conditionsOf(const ManipulationArguments& arguments, const ManipulationStudy& study) {
  if (arguments.condition == kAllConditions || arguments.condition == kBothConditions) return study.conditions;
  std::string known;
  for (const HandCondition& condition : study.conditions) {
    if (condition.name == arguments.condition) return {condition};
    known += condition.name + ", ";
  }
  refuseUsage(fmt::format("run: --condition {} is none of the study's. Give {}or {} for all of them.",
                          printable(arguments.condition), known, kAllConditions));
}

ManipulationSessionOptions optionsOf(const ManipulationArguments& arguments) {
  ManipulationSessionOptions options;
  options.study = studyOf(arguments);
  options.servo = arguments.run.servo;
  options.sample_rate = arguments.run.sample_rate;
  options.study.conditions = conditionsOf(arguments, options.study);
  if (!arguments.strategy.empty())
    options.study.people.strategy = arguments.strategy == "simple" ? Strategy::kSimple : Strategy::kRational;
  if (arguments.free_body) options.study.alignment.pivot = false;
  if (!arguments.object.empty()) options.study.pickup.object = objectOf(arguments);
  if (arguments.object.empty() && arguments.size) {
    refuseUsage("run: --size is that of a mesh, and none is given. Give --object FILE, or --radius for the sphere.");
  }
  if (arguments.object.empty() && !arguments.shading.empty()) {
    options.study.pickup.shading.reset();
    if (arguments.shading != kExactly) options.study.pickup.shading = variantOf(arguments.shading);
    options.study.alignment.shading = options.study.pickup.shading;
  } else if (arguments.shading == kExactly) {
    refuseUsage(
        "run: --shading exactly is for sphere and cylinder, and --object FILE has no closed form. Leave one of them "
        "out.");
  }
  return options;
}

std::int64_t faultsOfStudy(const SessionSummary& summary) {
  std::int64_t faults = 0;
  for (const CellSummary& cell : summary.cells) faults += cell.allFrictions() ? cell.faults : 0;
  return faults;
}

int showStudy(const ManipulationArguments& arguments, const std::string& directory,
              const ManipulationSessionResult& result) {
  const SessionReader session(directory + "/session.db");
  const SessionSummary summary = summariseSession(session);
  print("{}\n", arguments.run.json ? summaryJson(summary) : formatTable(summary));
  const auto say = [&](const std::string& line) { print(arguments.run.json ? stderr : stdout, "{}\n", line); };
  const ServoOptions& servo = arguments.run.servo;
  const bool by_the_clock =
      servo.clock != ServoClock::kVirtual || arguments.view.view || arguments.devices.devices != "sim";
  if (by_the_clock) say(servoText(result.servo, 1 / servo.rate));
  say(fmt::format("Session: {}", printablePath(session.path())));
  say(fmt::format("state_hash {}", sessionHash(session, result.samples_hash)));
  if (!by_the_clock) say(throughputText(static_cast<double>(result.servo.ticks) / servo.rate));
  if (result.interrupted) {
    say(fmt::format("Interrupted after {}; what is done is safe. Go on: the same command with --resume --out {}",
                    counted(result.trials, "trial"), printablePath(directory)));
    return kExitInterrupted;
  }
  if (arguments.run.report)
    say(fmt::format(
        "Report: {}",
        printablePath(writeReport(session, directory + "/report.html", {.interrupted = &interruptFlag()}).html)));
  for (const std::string& words : findingWords(summary)) say("\n" + words);
  const std::int64_t faults = faultsOfStudy(summary);
  if (faults > 0)
    say(fmt::format("Trials that ended in a fault: {}; their events say why: pincer export {}", faults,
                    printablePath(session.path())));
  return faults > 0 ? kExitCheckFailed : kExitOk;
}

// Whose hands do the trials, and who watches; lives as long as the session.
struct Stage {
  std::unique_ptr<HandDevices> devices;
  std::unique_ptr<TrialStage> window;
  std::unique_ptr<TerminalPerson> terminal;
};

// Somebody who takes part in a study reads its pages and answers its questions; who only tries, or goes
// on in a session without answers, doesn't.
bool isParticipant(const ManipulationArguments& arguments) {
  if (arguments.devices.devices == "sim") return false;
  return arguments.person || (arguments.resume && !SessionReader(arguments.run.out + "/session.db").survey().empty());
}

// Which participant the person is, from 0.
std::int64_t personOf(const ManipulationArguments& arguments, const ManipulationStudy& study) {
  const std::int64_t person = arguments.person.value_or(1);
  if (person >= 1 && person <= study.participants) return person - 1;
  refuseUsage(fmt::format("run: --person {} isn't one of the study's {}. Give 1 to {}, or more --participants.", person,
                          counted(study.participants, "participant"), study.participants));
}

Stage setStage(const ManipulationArguments& arguments, ManipulationSessionOptions& options,
               const std::atomic<bool>& interrupted) {
  Stage stage;
  const std::string& choice = arguments.devices.devices;
  if (arguments.view.view) options.servo.clock = ServoClock::kPaced;
  stage.devices = openDevices(arguments.devices, options.servo);
  ViewOptions view = arguments.view;
  view.title = taskName(options.study);
  stage.window = asUsage([&] { return hostOf(choice, view, options.servo, interrupted); });
  if (stage.window) options.host = stage.window->host();
  if (!isParticipant(arguments)) options.host.show = {}, options.host.ask = {};
  if (choice != "sim") options.devices = choice;
  if (choice != "sim") options.host.person = personOf(arguments, options.study);
  if (stage.devices) {
    if (!stage.window) {
      stage.terminal = std::make_unique<TerminalPerson>(options.servo, interrupted);
      options.host.serve = [person = stage.terminal.get()](HandsCycle& cycle, std::size_t trial, std::size_t trials) {
        return person->serve(cycle, trial, trials);
      };
      if (isParticipant(arguments)) {
        options.host.show = [person = stage.terminal.get()](const StudyPage& page) { return person->show(page); };
        options.host.ask = [person = stage.terminal.get()](const AskedQuestion& question) {
          return person->ask(question);
        };
      }
    }
    AnswerBox* keys = stage.window ? &stage.window->keys() : &stage.terminal->keys();
    options.host.hands = [devices = stage.devices.get(), keys, oldest = kOldestSample * options.servo.watchdog](
                             HandTrial& trial) { return std::make_unique<LiveHands>(trial, *devices, oldest, keys); };
    options.host.arm = [asked = arguments.devices, devices = stage.devices.get()](const std::string& why) {
      const std::string complaint = devices->complaint();
      return operatorArms(asked, complaint.empty() ? why : why + "\n" + complaint);
    };
  }
  return stage;
}

// Of a trial that ended in a fault, the devices may know why.
void sayComplaint(const Stage& stage) {
  const std::string complaint = stage.devices ? stage.devices->complaint() : "";
  if (!complaint.empty()) print(stderr, "The devices reported: {}\n", complaint);
}

int runManipulation(const ManipulationArguments& arguments) {
  const std::atomic<bool>& interrupted = interruptFlag();
  std::unique_ptr<Progress> line;
  const auto progress = [&](const TrialProgress& at) {
    if (!line) line = std::make_unique<Progress>("trials", static_cast<std::int64_t>(at.total));
    line->update(static_cast<std::int64_t>(at.done));
  };
  const auto finish = [&](const std::string& directory, const ManipulationSessionResult& result) {
    line.reset();
    return showStudy(arguments, directory, result);
  };
  if (arguments.resume) {
    if (arguments.run.out.empty())
      refuseUsage("run: --resume needs --out DIR, the directory of the session to go on with.");
    ManipulationSessionOptions options = optionsOf(arguments);
    const Stage stage = setStage(arguments, options, interrupted);
    const auto result = resumeManipulationSession(options, arguments.run.out + "/session.db", interrupted, progress);
    sayComplaint(stage);
    return finish(arguments.run.out, result);
  }
  ManipulationSessionOptions options = optionsOf(arguments);
  asUsage([&] { validate(options); });  // a study file was checked by itself
  if (arguments.print_study) {
    print("{}\n", studyFile(options.study));
    return kExitOk;
  }
  if (!arguments.write_study.empty()) {
    writeAtomically(arguments.write_study, studyFile(options.study));
    print("Study: {}\n", printablePath(arguments.write_study));
    return kExitOk;
  }
  makePickupObjects(options.study);  // bad options and objects are named before anything is written
  const Stage stage = setStage(arguments, options, interrupted);
  const std::string directory = outputDirectory(arguments.run, taskName(options.study));
  makeDirectory(directory);
  const auto result = runManipulationSession(options, directory + "/session.db", interrupted, progress);
  sayComplaint(stage);
  return finish(directory, result);
}

void addShadingOption(CLI::App& command, ManipulationArguments& arguments) {
  command
      .add_option("--shading", arguments.shading,
                  "How fingers feel the object's mesh (default: smooth); exactly: the closed form")
      ->check(CLI::IsMember({"smooth", "facet", "force", "smooth_published", kExactly}));
}

void addPickupOptions(CLI::App& command, ManipulationArguments& arguments) {
  SpherePickupOptions& pickup = arguments.study.pickup;
  command.add_option("--repetitions", pickup.repetitions, "Of every friction per condition")->capture_default_str();
  command.add_option("--friction", pickup.frictions, "Static frictions of the object")->capture_default_str();
  command.add_option("--mass", pickup.mass, "Of the object [kg]")->capture_default_str();
  command.add_option("--radius", pickup.radius, "Of the sphere [m]")->capture_default_str();
  command.add_option("--object", arguments.object,
                     "Closed mesh (OBJ, STL, PLY or OFF) to pick up in place of the sphere");
  command.add_option("--units", arguments.units, "Length unit of the mesh (default: mm)")
      ->check(CLI::IsMember({"m", "cm", "mm", "in"}));
  command.add_option("--size", arguments.size, "Scales the mesh to this largest dimension, in place of --units [m]");
  addShadingOption(command, arguments);
}

void addAlignmentOptions(CLI::App& command, ManipulationArguments& arguments) {
  CylinderAlignmentOptions& alignment = arguments.study.alignment;
  command.add_option("--repetitions", alignment.repetitions, "Trials per condition")->capture_default_str();
  command.add_option("--friction", alignment.friction, "Static friction of the cylinder")->capture_default_str();
  addShadingOption(command, arguments);
  command.add_flag("--free-body", arguments.free_body, "The cylinder stands free on a table in place of a pivot");
}

// Options that every command has; then `example`, and the callback.
CLI::App* addManipulationCommand(CLI::App& run, const char* name, const char* what, const char* example,
                                 const std::shared_ptr<ManipulationArguments>& arguments, int& exit_code) {
  CLI::App* command = run.add_subcommand(name, what);
  command
      ->add_option("--condition", arguments->condition,
                   "What the fingers feel: force, cld+force, another that the study file names, or all")
      ->capture_default_str();
  command->add_option("--study", arguments->study_file,
                      "Changes the design by this study file; counts over other options");
  command->add_flag("--print-study", arguments->print_study,
                    "Prints the study file with every parameter and what it means, and does nothing else");
  command->add_option("--participants", arguments->study.participants, "How many simulated participants")
      ->capture_default_str();
  command->add_option("--person", arguments->person,
                      "Which of the participants a person is, from 1: decides the order of conditions, and asks the "
                      "study's questions (default: 1, and "
                      "none is asked)");
  command->add_option("--strategy", arguments->strategy, "Of simulated participants (default: rational)")
      ->check(CLI::IsMember({"rational", "simple"}));
  addSeedOption(*command, arguments->study.seed, "Of all that varies; the same seed gives the same session");
  command->add_flag("--resume", arguments->resume, "Go on with the interrupted or killed session in --out");
  addRunOptions(*command, arguments->run);
  addDeviceOptions(*command, arguments->devices);
  addTrialViewOptions(*command, arguments->view);
  command->footer(example);
  command->callback([arguments, &exit_code] { exit_code = runManipulation(*arguments); });
  return command;
}

}  // namespace

void addSpherePickupTask(CLI::App& run, int& exit_code) {
  auto arguments = std::make_shared<ManipulationArguments>();
  arguments->study.tasks = {HandTask::kPickup};
  arguments->study.participants = 1;
  arguments->study.training.pickups = 0;
  addPickupOptions(*addManipulationCommand(run, "sphere-pickup", "Pick up spheres of different friction",
                                           kSpherePickupExample, arguments, exit_code),
                   *arguments);
}

void addCylinderAlignmentTask(CLI::App& run, int& exit_code) {
  auto arguments = std::make_shared<ManipulationArguments>();
  arguments->study.tasks = {HandTask::kAlignment};
  arguments->study.participants = 1;
  arguments->study.training.alignments = 0;
  addAlignmentOptions(
      *addManipulationCommand(run, "cylinder-alignment", "Find the flat of a cylinder and turn it to the monitor",
                              kCylinderExample, arguments, exit_code),
      *arguments);
}

void addManipulationTask(CLI::App& run, int& exit_code) {
  auto arguments = std::make_shared<ManipulationArguments>();
  CLI::App* command =
      addManipulationCommand(run, "manipulation", "The published study: both tasks, 12 participants, training",
                             kManipulationExample, arguments, exit_code);
  command->add_option("--write-study", arguments->write_study, "Writes the study file and does nothing else");
}

}  // namespace pincer::tasks
