#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numeric>

#include "pincer/tests/campaign/row.h"
#include "pincer/tests/campaign/verdicts.h"

namespace pincer::campaign {
namespace {

// times what the session of inputs.h takes: beyond it hangs, on a machine as busy as this one too
constexpr double kSlowest = 20;

std::uint64_t seedOf(const Ground& ground, const std::string& row, int number) {
  std::uint64_t hash = 14695981039346656037u ^ ground.seed;
  for (const char c : row) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash + 0x9e3779b97f4a7c15u * static_cast<std::uint64_t>(number);
}

Verdict kindOf(const Ended& e) {
  if (e.stopped) return Verdict::kStopped;
  return e.exit_code == 0 || e.exit_code == 1 ? Verdict::kFine
         : e.exit_code == 5                   ? Verdict::kStopped
                                              : Verdict::kRefused;
}

}  // namespace

Case::Case(const Ground& g, std::string row, int n, Tally& tally)
    : ground(g),
      number(n),
      random(seedOf(g, row, n)),
      folder(g.out / row / std::to_string(n) / "work"),
      log_(g.out / row / std::to_string(n) / "log"),
      row_(std::move(row)),
      tally_(tally) {
  fs::remove_all(folder.parent_path());
  fs::create_directories(folder);
  fs::create_directories(log_);
}

Case::~Case() {
  std::error_code ignored;
  if (!faulty_) fs::remove_all(folder.parent_path(), ignored);
}

Launch Case::pincer(std::vector<std::string> arguments) const {
  Launch launch;
  launch.program = ground.pincer;
  launch.arguments = std::move(arguments);
  launch.folder = folder;
  launch.log = log_ / std::to_string(launches_);
  launch.limit = std::max(launch.limit, kSlowest * ground.session_time);
  launch.environment = {{"DISPLAY", std::nullopt}, {"WAYLAND_DISPLAY", std::nullopt}};
  return launch;
}

Ended Case::runUnjudged(const Launch& asked) {
  Launch launch = asked;
  launch.log = log_ / std::to_string(launches_++);
  last_command_ = shellText(launch);
  Ended ended = campaign::run(launch);
  ++tally_.runs;
  tally_.seconds += ended.seconds;
  return ended;
}

Ended Case::run(const Launch& launch, const Expect& expect) {
  const std::set<std::string> before = filesIn(launch.folder);
  Ended ended = runUnjudged(launch);
  judge(launch, ended, expect);
  const std::string stray = strayIn(launch, ended, before, expect);
  if (!stray.empty() && !expect.may_leave_parts) fault(Verdict::kWrong, "left behind: " + stray, last_command_);
  return ended;
}

void Case::judge(const Launch& launch, const Ended& ended, const Expect& expect) {
  const auto found = verdictOn(launch, ended, expect);
  if (found) return fault(found->verdict, found->why, shellText(launch));
  ++tally_.counts[static_cast<std::size_t>(kindOf(ended))];
}

void Case::fault(Verdict verdict, const std::string& why, const std::string& command) {
  ++tally_.counts[static_cast<std::size_t>(verdict)];
  tally_.faults.push_back({row_, number, verdict, why, command});
  faulty_ = true;
}

void Case::count(Verdict verdict, std::int64_t runs) {
  tally_.counts[static_cast<std::size_t>(verdict)] += runs;
  tally_.runs += runs;
}

fs::path Case::write(const std::string& name, const std::string& bytes) const {
  const fs::path file = folder / name;
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

std::size_t scattered(const Ground& ground, int k, std::size_t size) {
  RandomNumbers random(ground.seed);
  std::size_t step = size < 3 ? 1 : 1 + random.bits() % (size - 1);
  while (std::gcd(step, size) != 1) ++step;
  return (random.bits() % size + static_cast<std::size_t>(k) % size * step) % size;
}

std::string readFile(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace pincer::campaign
