#include "pincer/tests/campaign/failing_works.h"

#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

#include "pincer/tests/campaign/inputs.h"
#include "pincer/tests/campaign/session_checks.h"

namespace pincer::campaign {
namespace {

fs::path callLibrary(const Ground& ground) { return ground.build / "failing_calls.so"; }
fs::path allocationLibrary(const Ground& ground) { return ground.build / "libfail_malloc.so"; }

// A run of its own, in a folder of its own, which it returns.
fs::path runUndisturbed(const Ground& ground, const Work& work,
                        const std::vector<std::pair<std::string, std::string>>& variables) {
  Launch launch;
  launch.program = ground.pincer;
  launch.arguments = work.arguments;
  launch.folder = ground.out / "undisturbed";
  launch.log = ground.out / "undisturbed-log";
  launch.environment = {{"DISPLAY", std::nullopt}, {"WAYLAND_DISPLAY", std::nullopt}};
  launch.environment.insert(launch.environment.end(), variables.begin(), variables.end());
  launch.limit = 60;
  fs::remove_all(launch.folder);
  fs::create_directories(launch.folder);
  run(launch);
  return launch.folder;
}

// Lines "NAME COUNT", or a count alone.
void addCounts(const fs::path& file, Counts& counts) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t blank = line.find(' ');
    const long n = std::stol(blank == line.npos ? line : line.substr(blank));
    if (n > 0) counts[blank == line.npos ? kAllocation : line.substr(0, blank)] = n;
  }
}

// Files that an undisturbed run writes, by name; made once per command line.
const std::map<std::string, std::string>& soundOutputs(const Ground& ground, const Work& work) {
  static std::map<std::vector<std::string>, std::map<std::string, std::string>> kept;
  const auto found = kept.find(work.arguments);
  if (found != kept.end()) return found->second;
  const fs::path folder = runUndisturbed(ground, work, {});
  auto& outputs = kept[work.arguments];
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    const bool compared = extension == ".csv" || extension == ".tsv" || extension == ".ply" || extension == ".json";
    if (compared && !work.is_session) outputs[fs::relative(entry.path(), folder)] = readFile(entry.path());
  }
  return outputs;
}

// A file that stands under its name is whole, whatever happened; after success all stand there.
void requireWholeOutputs(Case& c, const Work& work, const Ended& ended) {
  for (const auto& [name, bytes] : soundOutputs(c.ground, work)) {
    const bool there = fs::exists(c.folder / name);
    if (!there && ended.exit_code == 0 && ended.signal == 0)
      c.fault(Verdict::kLost, "said that all was well, but there is no " + name);
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

// Makes it fail, in the words of the two libraries: the only place that knows their variables.
void arrange(const Ground& ground, const Failure& failure, const fs::path& log, Launch& launch) {
  const auto set = [&](const char* name, std::string value) {
    launch.environment.emplace_back(name, std::move(value));
  };
  if (failure.call == kAllocation) {
    set("LD_PRELOAD", allocationLibrary(ground));
    return set("PINCER_FAIL_MALLOC", std::to_string(failure.at) + (failure.lasts ? "+" : ""));
  }
  set("LD_PRELOAD", callLibrary(ground));
  set("CAMPAIGN_FAIL_CALL", failure.call);
  set("CAMPAIGN_FAIL_AT", std::to_string(failure.at));
  set("CAMPAIGN_FAIL_ERROR", std::to_string(failure.error));
  set("CAMPAIGN_FAIL_LOG", log);
  if (failure.lasts) set("CAMPAIGN_FAIL_FOREVER", "1");
}

}  // namespace

std::vector<Work> works(const Ground& ground) {
  return {{pickupArguments("out"), true},
          {{"export", pickupSession(ground), "--out", "csv"}},
          {{"export", studySession(ground), "--bids", "bids"}},
          {{"sim", "s4_pinch", "--duration", "0.5", "--out", "table.csv"}},
          {{"mesh", "info", ground.inputs() / "meshes/star_knob.obj"}},
          {{"mesh", "convert", ground.inputs() / "meshes/star_knob.obj", "out.ply", "--units", "mm"}},
          {{"import", robotFile(ground)}},
          {{"run", "manipulation", "--write-study", "study.json"}},
          {{"sweep", "s4_pinch", "--vary", "duration=0.01,0.02", "--threads", "2", "--out", "sweep"}},
          {{"report", pickupSession(ground), "--html", "report.html"}}};
}

const Counts& callsOf(const Ground& ground, const Work& work) {
  static std::map<std::vector<std::string>, Counts> kept;
  Counts& counts = kept[work.arguments];
  if (!counts.empty()) return counts;
  const fs::path calls = ground.out / "calls", allocations = ground.out / "allocations";
  runUndisturbed(ground, work, {{"LD_PRELOAD", callLibrary(ground)}, {"CAMPAIGN_COUNT_CALLS", calls}});
  runUndisturbed(ground, work, {{"LD_PRELOAD", allocationLibrary(ground)}, {"PINCER_COUNT_MALLOC", allocations}});
  addCounts(calls, counts);
  addCounts(allocations, counts);
  if (!counts.contains(kAllocation) || counts.size() < 2)
    throw std::runtime_error("the calls of an undisturbed run could not be counted");
  return counts;
}

void runWithFailure(Case& c, const Work& work, const Failure& failure) {
  soundOutputs(c.ground, work);
  const fs::path log = c.folder.parent_path() / "failed";
  Launch launch = c.pincer(work.arguments);
  arrange(c.ground, failure, log, launch);
  const Ended ended = c.run(launch, {.may_leave_parts = failure.call == "unlink",
                                     .may_keep_journal = failure.call == "write" && failure.lasts});
  if (fs::exists(log) || failure.call == kAllocation) c.hit();
  requireSound(c, work, ended, failure.lasts);
}

}  // namespace pincer::campaign
