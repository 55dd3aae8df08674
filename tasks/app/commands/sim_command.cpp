#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/scene/scene_ranges.h"
#include "pincer/tasks/run/scene/sim_run.h"
#include "pincer/tasks/run/servo/servo_text.h"
#include "pincer/tasks/view/sim_view.h"

namespace pincer::tasks {
namespace {

constexpr const char* kSimExample = R"(
Runs the bodies and fingers of a scene file (docs/scenes.md), shows where they end up, and checks what the scene expects.
Exit code 1 if an expectation fails.

Examples:
  pincer sim tasks/scenes/s4_pinch.json --out pinch.csv --every 0.1
  pincer sim pickup --duration 2.5 --screenshot pickup.png
  pincer sim pickup --view --devices mouse)";

struct SimArguments {
  std::string scene, devices = "scene";
  ViewOptions view;
  SimOptions options;
  bool json = false;
};

int watch(Simulation& simulation, const SimArguments& arguments, const std::atomic<bool>& interrupted) {
  ViewOptions view = arguments.view;
  view.title = arguments.scene;
  const WatchResult result = watchScene(simulation, view, arguments.devices == "mouse", interrupted);
  print("{}\nLifted by up to {:.1f} mm.\n", servoText(result.servo, simulation.scene().options.h), 1e3 * result.lift);
  return interrupted ? kExitInterrupted : kExitOk;
}

int runSim(const SimArguments& arguments) {
  Scene scene = readSceneOrBuiltin(arguments.scene);
  asUsage([&] { applyOptions(arguments.options, scene); });
  Simulation simulation(std::move(scene));
  const std::atomic<bool>& interrupted = interruptFlag();  // until now there was nothing to end cleanly: a signal ends the program at once
  if (arguments.view.view) return watch(simulation, arguments, interrupted);
  SimResult result = [&] {
    Progress progress("sim", simulation.scene().ticks());
    return runScene(simulation, arguments.options, interrupted, [&](std::int64_t done) { progress.update(done); });
  }();
  if (!arguments.view.screenshot.empty()) writePng(pictureOf(simulation), arguments.view.screenshot);
  print("{}", arguments.json ? simJson(simulation, arguments.options, result) : simText(simulation, arguments.options, result));
  if (result.interrupted) return kExitInterrupted;
  return result.broke || result.log.anyFailed() ? kExitCheckFailed : kExitOk;
}

}  // namespace

void addSimCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<SimArguments>();
  CLI::App* command = app.add_subcommand("sim", "Plain physics of a scene: states, records, expectations");
  command->add_option("scene", arguments->scene, "Scene file (JSON), or the name of a built-in scene")->required();
  command->add_option("--duration", arguments->options.duration, "Simulated time in place of the scene's [s]")
      ->check(within(ranges::kDuration));
  command->add_option("--every", arguments->options.every, "Time between recorded rows in place of the scene's [s]")
      ->check(within(ranges::kDuration));
  command->add_option("--out", arguments->options.csv, "Write the recorded quantities to this CSV file");
  command->add_flag("--grasp", arguments->options.grasp,
                    "Say how well the fingers hold each body at the end: slip margins, force closure, epsilon");
  command->add_flag("--awake", arguments->options.awake, "Compute every tick, also those that would repeat the last one");
  addViewOptions(*command, arguments->view);
  command->add_option("--devices", arguments->devices, "With --view: who moves the fingers, the scene or your mouse")
      ->check(CLI::IsMember({"scene", "mouse"}))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Print the result as JSON");
  command->footer(kSimExample);
  command->callback([arguments, &exit_code] { exit_code = runSim(*arguments); });
}

}  // namespace pincer::tasks
