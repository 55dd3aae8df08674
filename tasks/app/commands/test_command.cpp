#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <thread>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/contact/io/counted.h"
#include "pincer/contact/io/printable.h"
#include "pincer/devices/window/surface.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/app/terminal.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/scene/scene_test.h"
#include "pincer/tasks/view/sim_view.h"

namespace pincer::tasks {
namespace {

constexpr const char* kTestExample = R"(
Runs every scene that expects something (docs/scenes.md, "expect") and says which expectations fail: quantity,
time, wanted, measured. Of a scene that fails it leaves a picture and a log in --out; the log replays it: to
the bit, or the first tick that differs. Exit code 1 if a scene fails, 3 if one can't be read.

Examples:
  pincer test tasks/scenes --junit report.xml
  pincer test pickup s4_pinch --jobs 2
  pincer test SCENE.json --update-hashes
  pincer test --replay out/SCENE.log.json)";

struct TestArguments {
  std::vector<std::string> paths;
  std::string junit, out, replay;
  int jobs = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 256u));
  bool update_hashes = false;
};

// A picture and a log of each scene that failed, under names that tell scenes of the same name apart.
class FailureKeeper {
 public:
  explicit FailureKeeper(std::string folder) : folder_(std::move(folder)) {}

  void keep(const SceneVerdict& verdict, const Simulation& simulation) {
    if (folder_.empty()) return;
    makeDirectory(folder_);
    const std::string stem = std::filesystem::path(verdict.file).stem().string();
    std::string name = stem;
    for (int n = 2; !taken_.insert(name).second; ++n) name = fmt::format("{}-{}", stem, n);
    const std::string path = folder_ + "/" + name;
    writeAtomically(path + ".log.json", sceneLog(verdict.file));
    try {
      writePng(pictureOf(simulation), path + ".png");
    } catch (const devices::DisplayError& error) {  // a machine without OpenGL tests all the same
      print(stderr, "pincer: no picture of {}: {}\n", printable(verdict.file), error.what());
    }
  }

 private:
  std::string folder_;
  std::set<std::string> taken_;
};

void printVerdict(const SceneVerdict& verdict) {
  const std::string name = printablePath(verdict.file);
  if (verdict.isGood())
    return print("{} {} ({})\n", good(" ok  "), name,
                 counted(static_cast<std::int64_t>(verdict.expectations), "expectation"));
  if (!verdict.run && verdict.error.empty()) return print("  -   {}: interrupted\n", name);
  print("{} {}\n", bad("FAILS"), name);
  if (!verdict.error.empty()) print("        {}\n", printableMessage(verdict.error));
  for (const std::string& failure : verdict.failures) print("        {}\n", printable(failure, kLongestMessage));
}

int exitCodeOf(const std::vector<SceneVerdict>& verdicts) {
  const auto any = [&](auto is) { return std::any_of(verdicts.begin(), verdicts.end(), is); };
  if (any([](const SceneVerdict& v) { return !v.error.empty(); })) return kExitBadInput;
  if (any([](const SceneVerdict& v) { return !v.failures.empty(); })) return kExitCheckFailed;
  return any([](const SceneVerdict& v) { return !v.run; }) ? kExitInterrupted : kExitOk;
}

int replayLog(const std::string& log) {
  const std::string difference = replaySceneLog(log, interruptFlag());
  if (interruptFlag()) return kExitInterrupted;
  print("{}\n", difference.empty() ? "The same to the bit." : difference);
  return difference.empty() ? kExitOk : kExitCheckFailed;
}

int runTest(const TestArguments& arguments) {
  if (!arguments.replay.empty()) return replayLog(arguments.replay);
  if (arguments.paths.empty()) refuseUsage("test: a scene or a folder of scenes is required");
  const std::vector<std::string> files = findSceneTests(arguments.paths);
  SceneTestOptions options;
  options.jobs = arguments.jobs;
  options.update_hashes = arguments.update_hashes;
  FailureKeeper keeper(arguments.out);
  options.failed = [&](const SceneVerdict& verdict, const Simulation& simulation) { keeper.keep(verdict, simulation); };
  const std::vector<SceneVerdict> verdicts = [&] {
    Progress line("scenes", static_cast<std::int64_t>(files.size()));
    options.progress = [&](const SceneVerdict&, std::size_t done, std::size_t) {
      line.update(static_cast<std::int64_t>(done));
    };
    return runSceneTests(files, options, interruptFlag());
  }();
  for (const SceneVerdict& verdict : verdicts) printVerdict(verdict);
  const auto good_ones =
      std::count_if(verdicts.begin(), verdicts.end(), [](const SceneVerdict& v) { return v.isGood(); });
  print("{} of {} as expected\n", good_ones, counted(static_cast<std::int64_t>(verdicts.size()), "scene"));
  if (!arguments.junit.empty()) writeAtomically(arguments.junit, junitText(verdicts));
  return exitCodeOf(verdicts);
}

}  // namespace

void addTestCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<TestArguments>();
  CLI::App* command = app.add_subcommand("test", "Scenes as tests: every scene that expects something");
  command->add_option("paths", arguments->paths, "Scene files, folders of them, names of built-in scenes");
  command->add_option("--junit", arguments->junit,
                      "Write the verdicts to this file, as CI servers read them (JUnit XML)");
  command->add_option("--out", arguments->out, "Folder for a picture and a log of each scene that fails");
  command->add_option("--jobs", arguments->jobs, "Scenes at once; verdicts are the same")
      ->check(wholeWithin(1, 256))
      ->capture_default_str();
  command->add_flag("--update-hashes", arguments->update_hashes,
                    "Write the measured hashes into the files, where others are expected");
  command->add_option("--replay", arguments->replay, "Run the scene of such a log again, and compare to the bit")
      ->excludes("paths");
  command->footer(kTestExample);
  command->callback([arguments, &exit_code] { exit_code = runTest(*arguments); });
}

}  // namespace pincer::tasks
