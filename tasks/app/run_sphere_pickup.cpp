#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "tasks/app/app.h"
#include "tasks/app/device_options.h"
#include "tasks/app/interrupt.h"
#include "tasks/app/pickup_session.h"
#include "tasks/app/progress.h"
#include "tasks/app/run_options.h"
#include "tasks/app/run_tasks.h"
#include "tasks/app/servo_text.h"
#include "tasks/experiments/pickup_object.h"
#include "tasks/report/report.h"
#include "tasks/session/atomic_file.h"

namespace pincer::tasks {
namespace {

constexpr const char* kSpherePickupExample = R"(
Index finger and thumb pick up spheres of different friction that lie in a dish, with and without contact location displays.

Example:
  pincer run sphere-pickup --repetitions 2 --seed 7 --out out/first)";

struct SpherePickupArguments {
  RunOptions run;
  DeviceRunOptions devices;
  std::string condition = "both", object, units, shading;
  std::optional<double> size;
  SpherePickupOptions study;
};

contact::SurfaceVariant variantOf(const std::string& name) {
  const auto& names = contact::kSurfaceVariantNames;
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? contact::SurfaceVariant::smooth : static_cast<contact::SurfaceVariant>(found - names.begin());
}

ObjectFile objectOf(const SpherePickupArguments& arguments) {
  if (arguments.size && !arguments.units.empty()) {
    throw InputError("run: --size and --units contradict each other: --size scales the mesh whatever its unit. Give one of them.");
  }
  return {arguments.object, arguments.units.empty() ? "mm" : arguments.units, arguments.size, variantOf(arguments.shading)};
}

PickupSessionOptions optionsOf(const SpherePickupArguments& arguments) {
  PickupSessionOptions options{arguments.study, arguments.run.servo, {}, arguments.run.sample_rate};
  if (arguments.condition != "both") options.study.conditions = {pickupConditionOf(arguments.condition)};
  if (!arguments.object.empty()) options.study.object = objectOf(arguments);
  if (arguments.object.empty() && arguments.size) {
    throw InputError("run: --size is that of a mesh, and none is given. Give --object FILE, or --radius for the sphere.");
  }
  if (arguments.object.empty() && !arguments.shading.empty()) {
    throw InputError("run: --shading is that of a mesh, and none is given. Give --object FILE; the sphere is one exactly.");
  }
  return options;
}

PickupSessionResult runSession(const PickupSessionOptions& options, const std::string& session, const std::atomic<bool>& interrupted) {
  std::unique_ptr<Progress> line;
  return runPickupSession(options, session, interrupted, [&](const PickupProgress& progress) {
    if (!line) line = std::make_unique<Progress>("trials", static_cast<std::int64_t>(progress.total));
    line->update(static_cast<std::int64_t>(progress.done));
  });
}

std::int64_t faultsIn(const SessionSummary& summary) {
  std::int64_t faults = 0;
  for (const CellSummary& cell : summary.cells) faults += cell.allFrictions() ? cell.faults : 0;
  return faults;
}

int show(const SpherePickupArguments& arguments, const std::string& directory, const PickupSessionResult& result) {
  const SessionReader session(directory + "/session.db");
  const SessionSummary summary = summariseSession(session);
  fmt::print("{}\n", arguments.run.json ? summaryJson(summary) : formatTable(summary));
  const auto say = [&](const std::string& line) { fmt::print(arguments.run.json ? stderr : stdout, "{}\n", line); };
  const ServoOptions& servo = arguments.run.servo;
  if (servo.real_time || arguments.devices.devices != "sim") say(servoText(result.servo, 1 / servo.rate));
  say(fmt::format("Session: {}", session.path()));
  if (result.interrupted) {
    say(fmt::format("Interrupted after {} trials; they are safe. See them: pincer report {}", result.trials, session.path()));
    return kExitInterrupted;
  }
  if (arguments.run.report) say(fmt::format("Report: {}", writeReport(session, directory + "/report.html").html));
  const std::int64_t faults = faultsIn(summary);
  if (faults > 0) say(fmt::format("Trials that ended in a fault: {}; their events say why: pincer export {}", faults, session.path()));
  return faults > 0 ? kExitCheckFailed : kExitOk;
}

int runSpherePickup(const SpherePickupArguments& arguments) {
  const std::atomic<bool>& interrupted = interruptFlag();
  const std::string directory = outputDirectory(arguments.run, "sphere-pickup");
  PickupSessionOptions options = optionsOf(arguments);
  validate(options);
  makePickupObject(options.study);  // bad options and objects are named before anything is written
  const auto devices = openDevices(arguments.devices, options.servo);
  options.live = {devices.get(), [&](const std::string& why) { return operatorArms(arguments.devices, why); }};
  makeDirectory(directory);
  return show(arguments, directory, runSession(options, directory + "/session.db", interrupted));
}

void addStudyOptions(CLI::App& command, SpherePickupArguments& arguments) {
  SpherePickupOptions& study = arguments.study;
  command.add_option("--condition", arguments.condition, "What the fingers feel")
      ->check(CLI::IsMember({"force", "cld+force", "both"}))
      ->capture_default_str();
  command.add_option("--participants", study.participants, "How many simulated participants")->capture_default_str();
  command.add_option("--repetitions", study.repetitions, "Of every friction per condition")->capture_default_str();
  command.add_option("--friction", study.frictions, "Static frictions of the object")->capture_default_str();
  command.add_option("--mass", study.mass, "Of the object [kg]")->capture_default_str();
  command.add_option("--radius", study.radius, "Of the sphere [m]")->capture_default_str();
  command.add_option("--object", arguments.object, "Closed mesh (OBJ, STL, PLY or OFF) to pick up in place of the sphere");
  command.add_option("--units", arguments.units, "Length unit of the mesh (default: mm)")->check(CLI::IsMember({"m", "cm", "mm", "in"}));
  command.add_option("--size", arguments.size, "Scales the mesh to this largest dimension, in place of --units [m]");
  command.add_option("--shading", arguments.shading, "How the fingers feel the mesh (default: smooth)")
      ->check(CLI::IsMember({"smooth", "facet", "force", "smooth_published"}));
  command.add_option("--seed", study.seed, "Of all that varies; the same seed gives the same session")->capture_default_str();
}

}  // namespace

void addSpherePickupTask(CLI::App& run, int& exit_code) {
  auto arguments = std::make_shared<SpherePickupArguments>();
  CLI::App* command = run.add_subcommand("sphere-pickup", "Pick up spheres of different friction");
  addStudyOptions(*command, *arguments);
  addRunOptions(*command, arguments->run);
  addDeviceOptions(*command, arguments->devices);
  command->footer(kSpherePickupExample);
  command->callback([arguments, &exit_code] { exit_code = runSpherePickup(*arguments); });
}

}  // namespace pincer::tasks
