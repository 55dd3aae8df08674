#include "pincer/tasks/judge/bench/engine/engine_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/run/csv.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

// Tables of all scenes, written anew after each.
struct EngineTables {
  CsvTable runs{"scene",  "engine", "setting", "step_ms",     "tolerance_m",
                "metric", "error",  "unit",    "us_per_step", "us_per_simulated_second",
                "failure"};
  CsvTable ratios{"scene",
                  "best_peer",
                  "step_ms",
                  "its_error",
                  "unit",
                  "its_us_per_simulated_second",
                  "error_at_its_cost_ratio",
                  "cost_at_its_error_ratio",
                  "pincer_1ms_error",
                  "pincer_1ms_us_per_step",
                  "error_ratio_at_1ms",
                  "cost_ratio_at_1ms"};

  void add(const BenchScene& scene, const std::vector<Contestant>& contestants, const std::vector<RaceRun>& results) {
    for (const RaceRun& run : results) {
      const Contestant& c = contestants[run.contestant];
      runs.row(std::string_view(scene.name), std::string_view(c.engine), std::string_view(c.setting), 1e3 * run.step.h,
               run.step.tolerance, std::string_view(scene.metric), run.error, std::string_view(scene.unit),
               run.us_per_step, run.us_per_step / run.step.h, std::string_view(run.failure),
               std::string_view(run.complaint));
    }
    const Comparison c = compareWithPeers(contestants, results);
    if (!c.any) return;
    const auto value = [](const std::optional<double>& x) { return x.value_or(std::nan("")); };
    ratios.row(std::string_view(scene.name), std::string_view(contestants[c.best.contestant].name()),
               1e3 * c.best.step.h, c.best.error, std::string_view(scene.unit), c.best.point().cost,
               value(c.at_best.error), value(c.at_best.cost), c.own.error, c.own.us_per_step, value(c.at_own.error),
               value(c.at_own.cost));
  }

  void write(const std::string& directory) const {
    writeAtomically(directory + "/runs.csv", runs.text());
    writeAtomically(directory + "/ratios.csv", ratios.text());
  }
};

std::vector<Record> runBenchScene(const BenchScene& scene, const std::vector<Contestant>& contestants,
                                  const EngineBenchOptions& options, EngineTables& tables, MeasureContext& context) {
  const std::vector<RaceRun> runs = race(scene, contestants, options.race, context);
  if (context.interrupted()) return {};
  if (!options.out.empty()) {
    tables.add(scene, contestants, runs);
    plotRace(options.out, scene, contestants, runs);
    tables.write(options.out);
  }
  return recordsOfRace(scene, contestants, runs);
}

}  // namespace

std::vector<Measurement> engineMeasurements(const EngineBenchOptions& options) {
  std::vector<Contestant> contestants = pincerContestants();
  if (options.peers) {
    std::vector<Contestant> peers = enginePeers();
    if (peers.empty()) {
      throw InputError(
          "--peers: no other engine is built in. Configure with -DPINCER_PEERS=ON; .ci/packages lists what that needs "
          "(\"peer\").");
    }
    std::move(peers.begin(), peers.end(), std::back_inserter(contestants));
  }
  std::vector<Measurement> measurements;
  const auto tables = std::make_shared<EngineTables>();
  for (BenchScene& scene : benchScenes(options.whole, options.models)) {
    const auto shared = std::make_shared<const BenchScene>(std::move(scene));
    const auto run = [=](MeasureContext& context) {
      return runBenchScene(*shared, contestants, options, *tables, context);
    };
    measurements.push_back({shared->name, run});
  }
  measurements.push_back(stepLatencyMeasurement(contestants));
  measurements.push_back(solveLatencyMeasurement(options.race.rounds));
  measurements.push_back(sleepMeasurement(options.race.rounds));
  for (Measurement& family : familyMeasurements(options.whole, options.peers))
    measurements.push_back(std::move(family));
  return measurements;
}

}  // namespace pincer::tasks
