#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/tasks/judge/bench/engine/engine_bench.h"

namespace pincer::tasks {
namespace {

constexpr double kErrorGoal = 1e-3, kCostGoal = 0.5;  // of the best peer's, one or the other

bool isOwn(const Contestant& contestant) { return contestant.engine == "pincer"; }
bool isPlainTick(const RaceRun& run) { return run.step.h == 1e-3 && run.step.tolerance == 0; }

// A ratio in words where there is none: `none` says why, the value is what it tends to.
Record ratioRecord(std::string metric, const std::optional<double>& ratio, const char* none, double tends_to) {
  if (ratio) return unbounded(std::move(metric), *ratio, "-");
  return unbounded(metric + ": " + none, tends_to, "-");
}

std::string stepText(const BenchStep& step) { return fmt::format("{:g} ms", 1e3 * step.h); }

void addComparison(const std::vector<Contestant>& contestants, const std::vector<RaceRun>& runs,
                   std::vector<Record>& records) {
  const Comparison c = compareWithPeers(contestants, runs);
  if (!c.any) {
    records.push_back(unbounded("no other engine moved as it should", 0, "-"));
    return;
  }
  const std::string best =
      fmt::format("best peer ({} at {})", contestants[c.best.contestant].name(), stepText(c.best.step));
  records.push_back(ratioRecord("error at the cost of the " + best + ", ratio", c.at_best.error,
                                "pincer isn't that cheap", kInfinity));
  records.push_back(ratioRecord("cost at its error, ratio", c.at_best.cost, "none reached", kInfinity));
  records.push_back(atMost("lesser of these over the goals 1e-3 and 0.5", c.share_of_goal, "-", 1));
  if (!c.own.ok()) return;
  records.push_back(
      ratioRecord("pincer at 1 ms, error over any peer's at equal cost", c.at_own.error, "none is as cheap", 0));
  records.push_back(
      ratioRecord("pincer at 1 ms, cost over any peer's at equal error", c.at_own.cost, "none reached it", 0));
}

}  // namespace

Comparison compareWithPeers(const std::vector<Contestant>& contestants, const std::vector<RaceRun>& runs) {
  Comparison c;
  c.share_of_goal = std::nan("");
  c.own.failure = "not run";
  std::vector<WorkPoint> ours, theirs;
  for (const RaceRun& run : runs) {
    const bool own = isOwn(contestants[run.contestant]);
    if (own && isPlainTick(run) && contestants[run.contestant].setting.empty()) c.own = run;
    if (!run.ok()) continue;
    (own ? ours : theirs).push_back(run.point());
    if (own) continue;
    const bool better =
        !c.any || run.error < c.best.error || (run.error == c.best.error && run.point().cost < c.best.point().cost);
    if (better) c.best = run;
    c.any = true;
  }
  if (!c.any) return c;
  const std::vector<WorkPoint> our_frontier = frontierOf(ours), their_frontier = frontierOf(theirs);
  c.at_best = ratiosAt(our_frontier, c.best.point());
  const double by_error = c.at_best.error.value_or(kInfinity) / kErrorGoal,
               by_cost = c.at_best.cost.value_or(kInfinity) / kCostGoal;
  if (std::isfinite(std::min(by_error, by_cost))) c.share_of_goal = std::min(by_error, by_cost);
  if (!c.own.ok()) return c;
  const WorkRatios reverse = ratiosAt(their_frontier, c.own.point());
  if (reverse.error) c.at_own.error = 1 / *reverse.error;
  if (reverse.cost) c.at_own.cost = 1 / *reverse.cost;
  return c;
}

namespace {

// Complaints about a contestant's runs, at most one line for failures and one for complaints.
void addTroubles(const Contestant& contestant, std::size_t k, const std::vector<RaceRun>& runs,
                 std::vector<Record>& records) {
  int count = 0, failed = 0, complaints = 0;
  std::string failure, complaint;
  for (const RaceRun& run : runs) {
    if (run.contestant != k) continue;
    if (run.absent) return records.push_back(unbounded(fmt::format("{}: {}", contestant.name(), run.failure), 0, "-"));
    ++count;
    if (!run.ok() && failed++ == 0) failure = fmt::format("at {}: {}", stepText(run.step), run.failure);
    if (!run.complaint.empty() && complaints++ == 0)
      complaint = fmt::format("at {}: {}", stepText(run.step), run.complaint);
  }
  // a tolerance may be out of reach, and then says so
  const bool plain = isOwn(contestant) && contestant.setting.empty();
  const auto add = [&](const std::string& what, int n) {
    records.push_back(plain ? exactly(what, n, "-", 0) : unbounded(what, n, "-"));
  };
  if (failed > 0) add(fmt::format("{}: failed runs of {}, {}", contestant.name(), count, failure), failed);
  if (complaints > 0) add(fmt::format("{}: flagged runs of {}, {}", contestant.name(), count, complaint), complaints);
}

}  // namespace

std::vector<Record> recordsOfRace(const BenchScene& scene, const std::vector<Contestant>& contestants,
                                  const std::vector<RaceRun>& runs) {
  std::vector<Record> records;
  for (std::size_t k = 0; k < contestants.size(); ++k) {
    const bool own = isOwn(contestants[k]);
    for (const RaceRun& run : runs) {
      if (run.contestant != k || !run.ok() || !isPlainTick(run)) continue;
      const std::string at = contestants[k].name() + " at 1 ms: ";
      records.push_back(atMost(at + scene.metric, run.error, scene.unit, own ? scene.error_bound : kInfinity));
      records.push_back(atMost(at + "cost per step", run.us_per_step, "us", own ? scene.cost_bound : kInfinity));
    }
    addTroubles(contestants[k], k, runs, records);
  }
  const bool has_peers =
      std::any_of(contestants.begin(), contestants.end(), [](const Contestant& c) { return !isOwn(c); });
  if (has_peers) addComparison(contestants, runs, records);
  return records;
}

}  // namespace pincer::tasks
