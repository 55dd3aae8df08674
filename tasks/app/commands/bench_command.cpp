#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/commands/measure_command.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/judge/bench/contact_bench.h"
#include "pincer/tasks/judge/bench/devices/devices_bench.h"
#include "pincer/tasks/judge/bench/engine/engine_bench.h"
#include "pincer/tasks/judge/bench/grasp/grasp_bench.h"
#include "pincer/tasks/judge/bench/study_bench.h"
#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/view/view_bench.h"

namespace pincer::tasks {
namespace {

constexpr const char* kBenchExample = R"(
What touching a mesh costs and how well it is felt, each figure beside what pincer promises
(docs/benchmarks.md). Exit code 1 if a promise isn't kept. Times are this machine's, while it does whatever
else it does.

Examples:
  pincer bench contact
  pincer bench contact --list
  pincer bench contact --only stroke/creased --queries 1000000
  pincer bench contact --only shading --out out/bench)";

constexpr const char* kEngineExample = R"(
Scenes with exact answers, each at several steps: how far off, and what it costs (docs/benchmarks.md). Exit
code 1 if a promise isn't kept. With --peers other engines run the same scenes in the same run, and each
scene's records end with the ratios to the best of them.

Examples:
  pincer bench engine
  pincer bench engine --only s4
  pincer bench engine --peers --out out/bench
  pincer bench engine --peers --long --only capsule
  pincer bench engine --peers --only 'robots/*')";

constexpr const char* kStudyExample = R"(
Staircases, fitted psychometric functions and orders of conditions, judged by observers whose thresholds are
known. Exit code 1 if a promise isn't kept.

Examples:
  pincer bench study
  pincer bench study --only staircase --observers 20000)";

constexpr const char* kGraspExample = R"(
What fingers hold, feel and cost: friction cones, slip, drift, soft pads, rolling, energy that sampling makes
and passivity takes back, and published methods on the same scenes, each figure beside what pincer promises
(docs/grasp.md). Exit code 1 if a promise isn't kept.

Examples:
  pincer bench grasp
  pincer bench grasp --only hold
  pincer bench grasp --only coupling --out out/bench)";

constexpr const char* kDevicesExample = R"(
The simulated displays and arm, measured from outside, beside the published figures; the force limiter against
an adversary; two emulated arms and displays at 1 kHz under the real libusb, pulled out, plugged in and
disturbed (docs/usb-protocol.md). Exit code 1 if a promise isn't kept.

Examples:
  pincer bench devices
  pincer bench devices --only cld
  pincer bench devices --only usb --seconds 10 --cycles 20)";

struct BenchArguments {
  MeasureOptions measure;
  ContactBenchOptions contact;
  EngineBenchOptions engine;
  GraspBenchOptions grasp;
  DevicesBenchOptions devices;
  StudyBenchOptions study;
  ViewBenchOptions view;
};

void addContactBench(CLI::App& bench, const std::shared_ptr<BenchArguments>& arguments, int& exit_code) {
  CLI::App* contact =
      bench.add_subcommand("contact", "A finger on meshes: iterations, failures, continuity, errors, nanoseconds");
  addMeasureOptions(*contact, arguments->measure);
  contact->add_option("--queries", arguments->contact.queries, "Queries per object")
      ->check(wholeWithin(1000, 100'000'000))
      ->capture_default_str();
  contact->add_option("--meshes", arguments->contact.meshes,
                      "Directory of mesh files to touch too, each scaled to 80 mm");
  contact->add_option("--out", arguments->contact.out,
                      "Directory for tables (CSV) and plots of the contact's place on the finger");
  contact->add_flag("--peers", arguments->contact.peers,
                    "Measure Bullet and ODE on the same paths (built with -DPINCER_PEERS=ON)");
  contact->footer(kBenchExample);
  contact->callback([arguments, &exit_code] {
    exit_code = runMeasurements(contactMeasurements(arguments->contact), arguments->measure, "bench contact");
  });
}

void addEngineBench(CLI::App& bench, const std::shared_ptr<BenchArguments>& arguments, int& exit_code) {
  CLI::App* engine =
      bench.add_subcommand("engine", "Bodies with exact answers: error against cost, beside other engines");
  addMeasureOptions(*engine, arguments->measure);
  engine->add_option("--out", arguments->engine.out,
                     "Directory for runs.csv, ratios.csv and a work-precision diagram per scene");
  engine->add_option("--models", arguments->engine.models,
                     "Directory of MJCF files to run too, each from its first keyframe on");
  engine->add_flag("--peers", arguments->engine.peers, "Run other engines too (built with -DPINCER_PEERS=ON)");
  engine->add_flag("--long", arguments->engine.whole, "Scenes of a minute last a minute, and 1000 spheres fall");
  engine->add_option("--rounds", arguments->engine.race.rounds, "Rounds of timing; the least of them counts")
      ->check(wholeWithin(1, 100))
      ->capture_default_str();
  engine->footer(kEngineExample);
  engine->callback([arguments, &exit_code] {
    exit_code = runMeasurements(engineMeasurements(arguments->engine), arguments->measure, "bench engine");
  });
}

void addStudyBench(CLI::App& bench, const std::shared_ptr<BenchArguments>& arguments, int& exit_code) {
  CLI::App* study = bench.add_subcommand("study", "Staircases and fits, on observers whose thresholds are known");
  addMeasureOptions(*study, arguments->measure);
  study->add_option("--observers", arguments->study.observers, "Per measurement")
      ->check(wholeWithin(100, 1'000'000))
      ->capture_default_str();
  study->footer(kStudyExample);
  study->callback([arguments, &exit_code] {
    exit_code = runMeasurements(studyMeasurements(arguments->study), arguments->measure, "bench study");
  });
}

void addGraspBench(CLI::App& bench, const std::shared_ptr<BenchArguments>& arguments, int& exit_code) {
  CLI::App* grasp = bench.add_subcommand("grasp", "Fingers: what they hold, feel and cost, beside published methods");
  addMeasureOptions(*grasp, arguments->measure);
  grasp->add_option("--out", arguments->grasp.out, "Directory for the map of stiffness, mass and rate (CSV and PNG)");
  grasp->footer(kGraspExample);
  grasp->callback([arguments, &exit_code] {
    exit_code = runMeasurements(graspMeasurements(arguments->grasp), arguments->measure, "bench grasp");
  });
}

void addViewBench(CLI::App& bench, const std::shared_ptr<BenchArguments>& arguments, int& exit_code) {
  CLI::App* view =
      bench.add_subcommand("view", "Watching: pictures per second, a snapshot's cost, whether it delays the servo");
  addMeasureOptions(*view, arguments->measure);
  view->add_option("--pictures", arguments->view.pictures, "Pictures to time")
      ->check(wholeWithin(1, 10000))
      ->capture_default_str();
  view->add_option("--seconds", arguments->view.seconds, "Of the servo in real time, watched and not")
      ->check(within({.min = 0.1, .max = 3.9, .remedy = "In seconds."}))
      ->capture_default_str();
  view->footer("\nExample:\n  pincer bench view");
  view->callback([arguments, &exit_code] {
    exit_code = runMeasurements(viewMeasurements(arguments->view), arguments->measure, "bench view");
  });
}

void addDevicesBench(CLI::App& bench, const std::shared_ptr<BenchArguments>& arguments, int& exit_code) {
  CLI::App* devices =
      bench.add_subcommand("devices", "Displays, arm, force limiter and USB against what is published and promised");
  addMeasureOptions(*devices, arguments->measure);
  devices->add_option("--seconds", arguments->devices.seconds, "Of two hands at 1 kHz")
      ->check(within({.min = 1.0, .max = 3600.0, .remedy = "In seconds."}))
      ->capture_default_str();
  devices->add_option("--cycles", arguments->devices.cycles, "Of pulling out and plugging in")
      ->check(wholeWithin(1, 100000))
      ->capture_default_str();
  devices->add_option("--usb", arguments->devices.usb,
                      "The program that measures USB (default: devices_bench beside this one)");
  devices->add_flag(
      "--long", arguments->measure.thorough,
      "Ten million changed messages instead of 20,000; all of --cycles in connections to Haply's service");
  devices->footer(kDevicesExample);
  devices->callback([arguments, &exit_code] {
    exit_code = runMeasurements(deviceMeasurements(arguments->devices), arguments->measure, "bench devices");
  });
}

}  // namespace

void addBenchCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<BenchArguments>();
  CLI::App* bench = app.add_subcommand("bench", "Measure costs and quality against what pincer promises");
  bench->require_subcommand(1);
  bench->footer("\nExample:\n  pincer bench contact --only cost");
  addContactBench(*bench, arguments, exit_code);
  addEngineBench(*bench, arguments, exit_code);
  addGraspBench(*bench, arguments, exit_code);
  addDevicesBench(*bench, arguments, exit_code);
  addStudyBench(*bench, arguments, exit_code);
  addViewBench(*bench, arguments, exit_code);
}

}  // namespace pincer::tasks
