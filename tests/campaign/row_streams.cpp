// Where the program writes: standard streams closed, full, cut off; links planted at names
// that it might write through; full disks.
#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "pincer/tests/campaign/inputs.h"
#include "pincer/tests/campaign/rows.h"
#include "pincer/tests/campaign/session_checks.h"

namespace pincer::campaign {
namespace {

std::vector<std::vector<std::string>> writers(const Ground& ground) {
  return {{"sim", "s4_pinch", "--duration", "0.1", "--out", "out.csv"},
          {"mesh", "convert", ground.inputs() / "meshes/cube.obj", "out.obj", "--units", "m"},
          {"export", pickupSession(ground), "--out", "out"},
          {"export", studySession(ground), "--bids", "out"},
          {"run", "manipulation", "--write-study", "out.json"},
          {"sweep", "s4_pinch", "--vary", "duration=0.01,0.02", "--out", "out"},
          {"report", pickupSession(ground), "--html", "out.html"},
          pickupArguments("out")};
}

std::vector<std::vector<std::string>> speakers(const Ground& ground) {
  std::vector<std::vector<std::string>> all = writers(ground);
  all.insert(all.end(), {{"--help"},
                         {"run", "--nonsense"},
                         {"schema", "scene"},
                         {"sim", "no-such-scene"},
                         {"plan", "s4_pinch", "--ticks", "100"},
                         {"mesh", "info", "none.obj", "--units", "m"}});
  return all;
}

struct Streams {
  Stream in, out, error;
};

const std::vector<Streams>& streams() {
  static const std::vector<Streams> kStreams = [] {
    std::vector<Streams> all;
    for (int mask = 1; mask < 8; ++mask) {
      const auto closed = [&](int bit, Stream open) { return (mask & bit) != 0 ? Stream::kClosed : open; };
      all.push_back({closed(1, Stream::kNothing), closed(2, Stream::kKept), closed(4, Stream::kKept)});
    }
    for (const Stream harmed : {Stream::kFull, Stream::kBrokenPipe}) {
      all.push_back({Stream::kNothing, harmed, Stream::kKept});
      all.push_back({Stream::kNothing, Stream::kKept, harmed});
      all.push_back({Stream::kNothing, harmed, harmed});
    }
    return all;
  }();
  return kStreams;
}

bool isSession(const std::vector<std::string>& arguments) {
  return arguments[0] == "run" && arguments[1] == "sphere-pickup";
}

// A session is whole or can be made so; a file that stands under its name isn't empty.
void requireOutputs(Case& c, const std::vector<std::string>& arguments) {
  if (isSession(arguments)) return completeSession(c);
  for (const char* name : {"out.csv", "out.obj", "out.json", "out.html"}) {
    if (fs::exists(c.folder / name) && readFile(c.folder / name).size() < 8)
      c.fault(Verdict::kWrong, std::string(name) + " is empty or cut off");
  }
}

constexpr const char* kPrecious = "This file belongs to somebody else.\n";

void requirePrecious(Case& c, const fs::path& file) {
  if (readFile(file) != kPrecious)
    c.fault(Verdict::kLost, "a file of somebody else was written through a planted link");
}

// Calls `act` in a mount namespace of its own, where `folder` is a file system of so
// many bytes. False where that isn't allowed.
template <class Act>
bool onSmallDisk(const fs::path& folder, long bytes, Act act) {
  const int mine = ::open("/proc/self/ns/mnt", O_RDONLY | O_CLOEXEC);
  if (::unshare(CLONE_NEWNS) != 0) return false;
  ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
  const bool mounted = ::mount("none", folder.c_str(), "tmpfs", 0, fmt::format("size={}", bytes).c_str()) == 0;
  if (mounted) act();
  if (mounted) ::umount(folder.c_str());
  ::setns(mine, CLONE_NEWNS);
  ::close(mine);
  return mounted;
}

}  // namespace

int allStreams(const Ground& ground) { return static_cast<int>(streams().size() * speakers(ground).size()); }

void breakStreams(Case& c) {
  const auto all = speakers(c.ground);
  const std::size_t which = scattered(c.ground, c.number, streams().size() * all.size());
  const Streams& s = streams()[which % streams().size()];
  const std::vector<std::string>& arguments = all[which / streams().size()];
  Launch launch = c.pincer(arguments);
  launch.in = s.in, launch.out = s.out, launch.error = s.error;
  const bool cut_off = s.out == Stream::kBrokenPipe || s.error == Stream::kBrokenPipe;
  // A filter that is cut off ends by SIGPIPE, as filters do; a session must not.
  std::vector<int> signals;
  if (cut_off && !isSession(arguments)) signals = {SIGPIPE};
  c.run(launch, {.signals = signals, .may_be_silent = s.error != Stream::kKept});
  requireOutputs(c, arguments);
}

void plantLinks(Case& c) {
  const auto all = writers(c.ground);
  const std::vector<std::string>& arguments = all[static_cast<std::size_t>(c.number) % all.size()];
  const fs::path precious = c.folder.parent_path() / "precious";
  const auto restore = [&] { std::ofstream(precious) << kPrecious; };
  restore();
  fs::create_directories(c.folder / "out");
  const bool into_parts = !c.chance(0.3);
  std::vector<std::string> names = {"out.csv",       "out.obj",         "out.json",      "out.html",
                                    "out/trial.csv", "out/session.csv", "out/sweep.csv", "out/dataset_description.json",
                                    "out/session.db"};
  if (into_parts) {
    for (std::string& name : names) name += ".part";
  }
  // Into the output's own place only a broken link or a loop is planted: to write through a
  // link that the user made is the user's wish.
  for (const std::string& name : names) {
    if (into_parts) fs::create_symlink(precious, c.folder / name);
    if (!into_parts) fs::create_symlink("nowhere/at-all", c.folder / name);
  }
  Launch launch = c.pincer(arguments);
  launch.folder = c.folder;
  const Ended ended = c.runUnjudged(launch);
  c.judge(launch, ended, {});
  requirePrecious(c, precious);
}

void fillDisk(Case& c) {
  const auto all = writers(c.ground);
  const std::vector<std::string>& arguments = all[static_cast<std::size_t>(c.number) % all.size()];
  Launch launch = c.pincer(arguments);
  const int way = c.below(3);
  if (way == 0) {
    launch.owner_rights = true;
    fs::permissions(c.folder, fs::perms::owner_read | fs::perms::owner_exec);
    c.run(launch);
    fs::permissions(c.folder, fs::perms::owner_all);
  } else if (way == 1) {
    launch.largest_file = static_cast<long>(c.random.uniform(0, 200'000));
    c.run(launch);
    requireOutputs(c, arguments);
  } else {
    const long bytes = 4096 * static_cast<long>(c.random.uniform(1, 250));
    if (!onSmallDisk(c.folder, bytes, [&] { c.run(launch); }))
      c.skip("file systems of its own need root: only permissions and size limits were tried");
  }
}

}  // namespace pincer::campaign
