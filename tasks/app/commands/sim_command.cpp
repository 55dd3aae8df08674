#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/app/sim_text.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/scene/scene_ranges.h"
#include "pincer/tasks/run/scene/sim_run.h"
#include "pincer/tasks/run/servo/servo_text.h"
#include "pincer/tasks/view/sim_view.h"

namespace pincer::tasks {
namespace {

constexpr const char* kSimExample = R"(
Runs the bodies and fingers of a scene file (docs/scenes.md), shows where they end up, and checks what the
scene expects. Exit code 1 if an expectation fails.

Examples:
  pincer sim tasks/scenes/s4_pinch.json --out pinch.csv --every 0.1
  pincer sim pickup --duration 2.5 --screenshot pickup.png
  pincer sim pickup --view --devices mouse
  pincer sim s1_tumbling_box s4_pinch --json)";

struct SimArguments {
  std::vector<std::string> scenes;
  std::string devices = "scene";
  ViewOptions view;
  SimOptions options;
  RobotFileOptions robots;
  bool json = false;
};

std::string endedEarly(const Simulation& simulation) {
  return fmt::format("The window was closed at {:g} s of {:g} s: what is expected later wasn't judged.\n",
                     simulation.time(), static_cast<double>(simulation.scene().ticks()) * simulation.scene().options.h);
}

int watch(Simulation& simulation, const SimArguments& arguments, const std::atomic<bool>& interrupted) {
  ViewOptions view = arguments.view;
  view.title = arguments.scenes.front();
  const WatchResult result = watchScene(simulation, view, arguments.devices == "mouse", interrupted);
  print("{}\nLifted by up to {:.1f} mm.\n", servoText(result.servo, simulation.scene().options.h), 1e3 * result.lift);
  if (result.pulled) print("A body was pulled by hand: what the scene expects from then on wasn't judged.\n");
  if (arguments.devices == "mouse" || result.pulled) return interrupted ? kExitInterrupted : kExitOk;
  print("{}{}", expectationsText(result.log), result.ended ? "" : endedEarly(simulation));
  if (interrupted) return kExitInterrupted;
  return result.log.anyFailed() ? kExitCheckFailed : kExitOk;
}

int runOne(const SimArguments& arguments, const std::string& file) {
  Scene scene = readSceneOrBuiltin(file, arguments.robots);
  if (!scene.remarks.empty()) print(stderr, "{}", scene.remarks);
  asUsage([&] { applyOptions(arguments.options, scene); });
  Simulation simulation(std::move(scene));
  // until now there was nothing to end cleanly: a signal ends the program at once
  const std::atomic<bool>& interrupted = interruptFlag();
  if (arguments.view.view) return watch(simulation, arguments, interrupted);
  SimResult result = [&] {
    Progress progress("sim", simulation.scene().ticks());
    return runScene(simulation, arguments.options, interrupted, [&](std::int64_t done) { progress.update(done); });
  }();
  if (!arguments.view.screenshot.empty())
    writePng(pictureOf(simulation, arguments.view.as_operator), arguments.view.screenshot);
  print("{}", arguments.json ? simJson(simulation, arguments.options, result)
                             : simText(simulation, arguments.options, result));
  if (result.interrupted) return kExitInterrupted;
  return result.broke || result.log.anyFailed() ? kExitCheckFailed : kExitOk;
}

// Of several the first bad exit code; their JSON is a list.
int runSim(const SimArguments& arguments) {
  if (arguments.scenes.size() == 1) return runOne(arguments, arguments.scenes.front());
  if (arguments.view.view || !arguments.view.screenshot.empty() || !arguments.options.csv.empty())
    refuseUsage("sim: --view, --screenshot and --out are for one scene. Give one, or leave them out");
  int exit_code = kExitOk;
  for (const std::string& file : arguments.scenes) {
    if (arguments.json) print("{}", &file == &arguments.scenes.front() ? "[\n" : ",\n");
    const int code = runOne(arguments, file);
    if (exit_code == kExitOk) exit_code = code;
    if (code == kExitInterrupted) break;
  }
  if (arguments.json) print("]\n");
  return exit_code;
}

}  // namespace

void addSimCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<SimArguments>();
  CLI::App* command = app.add_subcommand("sim", "Plain physics of a scene: states, records, expectations");
  command
      ->add_option("scene", arguments->scenes, "Scene or robot files (JSON, MJCF, URDF), or names of built-in scenes")
      ->required();
  command->add_option("--duration", arguments->options.duration, "Simulated time in place of the scene's [s]")
      ->check(within(ranges::kDuration));
  command->add_option("--every", arguments->options.every, "Time between recorded rows in place of the scene's [s]")
      ->check(within(ranges::kDuration));
  command->add_option("--out", arguments->options.csv, "Write the recorded quantities to this CSV file");
  command->add_flag("--grasp", arguments->options.grasp,
                    "Say how well the fingers hold each body at the end: slip margins, force closure, epsilon");
  command->add_flag("--awake", arguments->options.awake,
                    "Compute every tick, also those that would repeat the last one");
  command->add_option("--keyframe", arguments->robots.keyframe,
                      "Of a robot's file: where it starts and what its drives are told; else as drawn");
  command->add_option("--allow", arguments->robots.allowed_folders, "Further folders that robots' files may lie in")
      ->allow_extra_args(false);
  addViewOptions(*command, arguments->view);
  command->add_flag(
      "--from-operator", arguments->view.as_operator,
      "Look from where the operator stands, in place of where most is seen; a scene's camera goes before both");
  command->add_option("--devices", arguments->devices, "With --view: who moves the fingers, the scene or your mouse")
      ->check(CLI::IsMember({"scene", "mouse"}))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Print the result as JSON: the same bytes at each run");
  command->add_flag("--timing", arguments->options.timing, "With --json: also how long ticks took");
  command->footer(kSimExample);
  command->callback([arguments, &exit_code] { exit_code = runSim(*arguments); });
}

}  // namespace pincer::tasks
