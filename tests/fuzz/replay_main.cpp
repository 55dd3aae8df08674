// fuzz_replay: every target over its seeds, over what once broke a promise, and over changed copies
// of both, by any compiler: each day's test.
//
//   fuzz_replay FOLDER [--only TARGET] [--changes N] [--file FILE]
//
// FOLDER holds seeds/TARGET/* and regressions/TARGET/*. Ends by itself if all promises are kept; else the program is
// aborted, and the last line names the file and the change.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "pincer/tests/campaign/mutation.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {
namespace {

namespace fs = std::filesystem;

struct Target {
  const char* name;
  void (*run)(Bytes);
};

constexpr Target kTargets[] = {
    {"mesh_obj", mesh_obj},
    {"mesh_stl", mesh_stl},
    {"mesh_ply", mesh_ply},
    {"mesh_off", mesh_off},
    {"mesh_repair", mesh_repair},
    {"usb_frame", usb_frame},
    {"falcon_packet", falcon_packet},
    {"haply_message", haply_message},
    {"json", json},
    {"xml", xml},
    {"mjcf", mjcf},
    {"urdf", urdf},
    {"scene", scene},
    {"scene_step", scene_step},
    {"scene_schema", scene_schema},
    {"trajectory", trajectory},
    {"calibration", calibration},
    {"recording", recording},
    {"replay_log", replay_log},
    {"session", session},
    {"study", study},
    {"sweep_cases", sweep_cases},
};

struct Plan {
  fs::path folder, file;
  std::string only;
  int changes = 30;  // of each file
};

Plan planOf(int argc, char** argv) {
  Plan plan;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--only" && has_value) {
      plan.only = argv[++i];
    } else if (word == "--changes" && has_value) {
      plan.changes = std::atoi(argv[++i]);
    } else if (word == "--file" && has_value) {
      plan.file = argv[++i];
    } else {
      plan.folder = word;
    }
  }
  return plan;
}

std::string contentOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<fs::path> filesOf(const Plan& plan, const std::string& target) {
  if (!plan.file.empty()) return {plan.file};
  std::vector<fs::path> files;
  for (const char* kind : {"seeds", "regressions"}) {
    const fs::path folder = plan.folder / kind / target;
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void give(const Target& target, const std::string& bytes) {
  target.run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

// The file as it is, then changed; the same changes whenever and wherever.
int runOver(const Target& target, const fs::path& file, int changes) {
  const std::string bytes = contentOf(file);
  give(target, bytes);
  campaign::RandomNumbers random(1);
  for (int change = 1; change <= changes; ++change) {
    fmt::print(stderr, "\r{} {} change {}    ", target.name, file.filename().string(), change);
    give(target, change % 2 == 0 ? campaign::mutatedBytes(random, bytes) : campaign::mutatedText(random, bytes));
  }
  return 1 + changes;
}

int runAll(const Plan& plan) {
  int targets = 0;
  for (const Target& target : kTargets) {
    if (!plan.only.empty() && plan.only != target.name) continue;
    const std::vector<fs::path> files = filesOf(plan, target.name);
    if (files.empty()) {
      fmt::print(stderr, "{} has no seeds in {}\n", target.name, plan.folder.string());
      return 1;
    }
    int inputs = 0;
    for (const fs::path& file : files) inputs += runOver(target, file, plan.changes);
    fmt::print(stderr, "\r{:<16} {:>4} files, {:>6} inputs: promises kept\n", target.name, files.size(), inputs);
    ++targets;
  }
  return targets > 0 ? 0 : 2;
}

}  // namespace
}  // namespace pincer::fuzz

int main(int argc, char** argv) {
  const auto plan = pincer::fuzz::planOf(argc, argv);
  if (plan.folder.empty() && plan.file.empty()) {
    fmt::print(stderr, "fuzz_replay FOLDER [--only TARGET] [--changes N] [--file FILE]\n");
    return 2;
  }
  return pincer::fuzz::runAll(plan);
}
