// Calls of the operating system that fail, allocations that fail. Then: a sentence, nothing half-made, and what was finished is there.
#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "pincer/tests/campaign/inputs.h"
#include "pincer/tests/campaign/rows.h"
#include "pincer/tests/campaign/session_checks.h"

namespace pincer::campaign {
namespace {

struct Work {
  std::vector<std::string> arguments;
  bool is_session = false;
};

std::vector<Work> works(const Ground& ground) {
  return {{pickupArguments("out"), true},
          {{"export", pickupSession(ground), "--out", "csv"}},
          {{"export", studySession(ground), "--bids", "bids"}},
          {{"sim", "s4_pinch", "--duration", "0.5", "--out", "table.csv"}},
          {{"mesh", "convert", ground.inputs() / "meshes/star_knob.obj", "out.ply", "--units", "mm"}},
          {{"run", "manipulation", "--write-study", "study.json"}},
          {{"sweep", "s4_pinch", "--vary", "duration=0.01,0.02", "--threads", "2"}},
          {{"report", pickupSession(ground), "--html", "report.html"}}};
}

// Half of the draws are sessions: they have the most to lose. A report takes seconds, so it is rare.
const Work& draw(Case& c, const std::vector<Work>& all) {
  if (c.chance(0.5)) return all[0];
  return all[c.chance(0.06) ? all.size() - 1 : static_cast<std::size_t>(1 + c.below(all.size() - 2))];
}

// Evenly on a logarithmic scale, 1 .. most: the first calls, and then ever fewer.
long drawNumber(Case& c, double most) { return static_cast<long>(std::exp(c.random.uniform(0, std::log(most + 1)))); }

using Counts = std::map<std::string, long>;

fs::path callLibrary(const Ground& ground) { return ground.build / "failing_calls.so"; }

fs::path allocationLibrary(const Ground& ground) {
  for (const char* name : {"fail_malloc.so", "libfail_malloc.so", "tests/libfail_malloc.so", "tests/campaign/libfail_malloc.so"}) {
    if (fs::exists(ground.build / name)) return ground.build / name;
  }
  return {};
}

// A run of its own, in a folder of its own.
void runUndisturbed(const Ground& ground, Launch launch) {
  launch.folder = ground.out / "undisturbed";
  fs::remove_all(launch.folder);
  fs::create_directories(launch.folder);
  run(launch);
}

// How often an undisturbed run calls each function of the library, as "write 12"; of allocations the number alone. Counted once per command line.
const Counts& callsOf(Case& c, const Work& work, const fs::path& library, const char* variable) {
  static std::map<std::pair<fs::path, std::vector<std::string>>, Counts> kept;
  Counts& counts = kept[{library, work.arguments}];
  if (!counts.empty()) return counts;
  const fs::path file = c.ground.out / "counts";
  Launch launch = c.pincer(work.arguments);
  launch.environment.emplace_back("LD_PRELOAD", library.string());
  launch.environment.emplace_back(variable, file.string());
  runUndisturbed(c.ground, launch);
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t blank = line.find(' ');
    const long n = std::stol(blank == line.npos ? line : line.substr(blank));
    if (n > 0) counts[line.substr(0, blank == line.npos ? 0 : blank)] = n;
  }
  if (counts.empty()) throw std::runtime_error("the calls of an undisturbed run could not be counted");
  return counts;
}

// What an undisturbed run writes, by name; made once per command line.
const std::map<std::string, std::string>& soundOutputs(Case& c, const Work& work) {
  static std::map<std::vector<std::string>, std::map<std::string, std::string>> kept;
  const auto found = kept.find(work.arguments);
  if (found != kept.end()) return found->second;
  Launch launch = c.pincer(work.arguments);
  runUndisturbed(c.ground, launch);
  launch.folder = c.ground.out / "undisturbed";
  auto& outputs = kept[work.arguments];
  for (const auto& entry : fs::recursive_directory_iterator(launch.folder)) {
    const std::string extension = entry.path().extension();
    const bool compared = extension == ".csv" || extension == ".tsv" || extension == ".ply" || extension == ".json";
    if (compared && !work.is_session) outputs[fs::relative(entry.path(), launch.folder)] = readFile(entry.path());
  }
  return outputs;
}

// A file that stands under its name is whole, whatever happened; after success all stand there.
void requireWholeOutputs(Case& c, const Work& work, const Ended& ended) {
  for (const auto& [name, bytes] : soundOutputs(c, work)) {
    const bool there = fs::exists(c.folder / name);
    if (!there && ended.exit_code == 0 && ended.signal == 0) c.fault(Verdict::kLost, "said that all was well, but there is no " + name);
    if (there && readFile(c.folder / name) != bytes) c.fault(Verdict::kWrong, name + " isn't whole");
  }
}

void requireSound(Case& c, const Work& work, const Ended& ended, bool lasts) {
  if (!work.is_session) return requireWholeOutputs(c, work, ended);
  const SessionState state = stateOf(c.folder / "out/session.db");
  const bool ended_well = ended.exit_code == 0 && ended.signal == 0;
  if (ended_well) return requireWhole(c);
  if (state.readable && state.state == "running" && !lasts) c.fault(Verdict::kWrong, "the session is left \"running\"");
  completeSession(c);
}

// tests/campaign/fail_malloc.cpp; the only place that knows its variables.
void failAllocations(Launch& launch, const fs::path& library, long at, bool forever) {
  launch.environment.emplace_back("LD_PRELOAD", library);
  launch.environment.emplace_back("PINCER_FAIL_MALLOC", std::to_string(at) + (forever ? "+" : ""));
}

}  // namespace

void failCall(Case& c) {
  static const std::vector<int> kErrors = {ENOSPC, EIO, EMFILE, EINTR, EACCES, EROFS, ENOMEM, EDQUOT};
  const std::vector<Work> all = works(c.ground);
  const Work& work = draw(c, all);
  soundOutputs(c, work);
  const Counts& counts = callsOf(c, work, callLibrary(c.ground), "CAMPAIGN_COUNT_CALLS");
  const auto& [call, most] = *std::next(counts.begin(), c.below(counts.size()));
  const int error = call == "write" && c.chance(0.2) ? 0 : c.anyOf(kErrors);
  const bool forever = error != EINTR && c.chance(0.4);
  Launch launch = c.pincer(work.arguments);
  launch.environment.emplace_back("LD_PRELOAD", callLibrary(c.ground).string());
  launch.environment.emplace_back("CAMPAIGN_FAIL_CALL", call);
  launch.environment.emplace_back("CAMPAIGN_FAIL_AT", std::to_string(drawNumber(c, static_cast<double>(most))));
  launch.environment.emplace_back("CAMPAIGN_FAIL_ERROR", std::to_string(error));
  launch.environment.emplace_back("CAMPAIGN_FAIL_LOG", (c.folder.parent_path() / "failed").string());
  if (forever) launch.environment.emplace_back("CAMPAIGN_FAIL_FOREVER", "1");
  const Ended ended = c.run(launch, {.may_leave_parts = call == "unlink"});
  if (fs::exists(c.folder.parent_path() / "failed")) c.hit();
  requireSound(c, work, ended, forever);
}

void failAllocation(Case& c) {
  const fs::path library = allocationLibrary(c.ground);
  if (library.empty()) return c.skip("there is no fail_malloc.so in the build directory");
  const std::vector<Work> all = works(c.ground);
  const Work& work = draw(c, all);
  soundOutputs(c, work);
  const bool forever = c.chance(0.3);
  Launch launch = c.pincer(work.arguments);
  const long most = callsOf(c, work, library, "PINCER_COUNT_MALLOC").begin()->second;
  failAllocations(launch, library, drawNumber(c, static_cast<double>(most)), forever);
  const Ended ended = c.run(launch);
  requireSound(c, work, ended, forever);
}

}  // namespace pincer::campaign
