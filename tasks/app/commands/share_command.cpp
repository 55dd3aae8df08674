#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/commands/share_page.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/scene/scene_ranges.h"
#include "pincer/tasks/run/scene/sim_run.h"
#include "pincer/tasks/share/share_scene.h"
#include "pincer/tasks/share/web_page.h"

namespace pincer::tasks {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShareExample = R"(
One HTML file that plays the session or scene in three dimensions in any browser, without pincer and without a
network. A session is replayed first, and the page says whether it came again to the bit.

Examples:
  pincer share pickup --out pickup.html
  pincer share out/first/session.db --trial 3 --out trial3.html)";

struct ShareArguments {
  std::string source, out, title;
  std::optional<std::int64_t> trial;  // from 1
  SimOptions scene;
  bool other_version = false;
};

// The session that a path means: the file, or the one in a directory; nothing where it isn't a session.
std::optional<std::string> sessionAt(const std::string& path) {
  if (fs::is_directory(path)) return (fs::path(path) / "session.db").string();
  if (!fs::is_regular_file(path)) return {};
  constexpr std::string_view kBegin = "SQLite format 3";  // of any SQLite file; a NUL follows
  std::string begin(kBegin.size(), '\0');
  std::ifstream(path, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == kBegin ? std::optional(path) : std::nullopt;
}

int shareScene(const ShareArguments& arguments) {
  if (arguments.trial || arguments.other_version) {
    refuseUsage(fmt::format("share: --trial and --other-version are for sessions, and {} is a scene",
                            printable(arguments.source)));
  }
  Scene scene = readSceneOrBuiltin(arguments.source);
  if (!scene.remarks.empty()) print(stderr, "{}", scene.remarks);
  asUsage([&] { applyOptions(arguments.scene, scene); });
  const std::string name = fs::path(arguments.source).stem().string();
  WebPage page;
  page.title = arguments.title.empty() ? name : arguments.title;
  if (!scene.description.empty()) page.notes.push_back(scene.description);
  Simulation simulation(std::move(scene));
  MeshTable meshes;
  Progress progress("share", simulation.scene().ticks());
  page.recordings.push_back(
      recordScene(simulation, name, meshes, interruptFlag(), [&](std::int64_t done) { progress.update(done); }));
  page.notes.push_back(
      fmt::format("state_hash {} after {}.", hashText(simulation.state().world), counted(simulation.ticks(), "tick")));
  writePage(page, meshes, arguments.out.empty() ? name + ".html" : arguments.out);
  return kExitOk;
}

int shareSession(const ShareArguments& arguments, const std::string& path) {
  if (arguments.scene.duration) refuseUsage("share: --duration is for scenes; a session is as long as it was");
  SessionReader session(path);
  session.heed(interruptFlag());
  ReplayOptions options;
  options.other_version = arguments.other_version;
  if (arguments.trial) options.trial = *arguments.trial - 1;
  const std::string beside = (fs::path(path).parent_path() / "replay.html").string();
  const SessionPage page =
      writeSessionPage(session, options, arguments.title, arguments.out.empty() ? beside : arguments.out);
  return page.same ? kExitOk : kExitCheckFailed;
}

}  // namespace

void addShareCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ShareArguments>();
  CLI::App* command = app.add_subcommand("share", "A session or scene as a web page that anyone can play");
  command
      ->add_option("source", arguments->source,
                   "Session file or its directory; scene file, or name of a built-in scene")
      ->required();
  command->add_option("-o,--out", arguments->out,
                      "Where to write the page (default: replay.html beside the session, SCENE.html here)");
  command->add_option("--title", arguments->title, "Of the page (default: the scene's name, the session's task)");
  command->add_option("--trial", arguments->trial, "Only this trial, from 1 (default: all)")
      ->check(wholeWithin(1, 1'000'000'000));
  command->add_option("--duration", arguments->scene.duration, "Of a scene: simulated time in place of the scene's [s]")
      ->check(within(ranges::kDuration));
  command->add_flag("--other-version", arguments->other_version,
                    "Also a session that another version made: bits may differ");
  command->footer(kShareExample);
  command->callback([arguments, &exit_code] {
    requirePageShell();
    const std::optional<std::string> session = sessionAt(arguments->source);
    exit_code = session ? shareSession(*arguments, *session) : shareScene(*arguments);
  });
}

}  // namespace pincer::tasks
