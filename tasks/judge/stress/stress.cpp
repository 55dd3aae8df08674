#include "pincer/tasks/judge/stress/stress.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "pincer/tasks/judge/stress/checks.h"
#include "pincer/tasks/judge/stress/random_world.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

struct WorldResult {
  std::string fault;  // the first, with its tick; empty if none
  int ticks = 0, flagged = 0;
  std::uint64_t hash = 0;  // of the state at the end
};

std::string faultOfTick(const StressWorld& world, const grasp::GraspState& state, const grasp::GraspScratch& scratch,
                        bool flagged, double energy) {
  const engine::WorldModel& model = world.model.world;
  if (std::string fault = faultOfState(model, state.world); !fault.empty()) return fault;
  if (std::string fault = faultOfCones(grasp::worldOf(scratch)); !fault.empty()) return fault;
  if (!flagged) {
    if (std::string fault = faultOfLaw(model, grasp::worldOf(scratch)); !fault.empty()) return fault;
  }
  // of the energy: of a body that turns by 0.5 rad in a tick it swings by 2e-6 of itself
  constexpr double kRoundOff = 1e-5;
  const double now = totalEnergy(model, state.world), most = energy + world.allowed_lift + world.mostWork();
  return now <= most + kRoundOff * (std::abs(most) + 1e-6)
             ? std::string()
             : fmt::format("energy {:.6g} J, began with {:.6g} J", now, most);
}

constexpr double kCap = 5e-4;    // of one world in kCappedEvery, again: half a tick of 1 kHz [s]
constexpr int kCappedEvery = 5;  // worlds; chosen: such a world runs up to kMostRuns times more

// How a world is run: none of it may change a bit, but for the budget [s].
struct RunAs {
  int threads = 1;
  double budget = 0;
  int ticks_per_scratch = std::numeric_limits<int>::max();  // then a new one goes on from the state
};

// `tick_times` gets this thread's [us].
WorldResult runWorld(StressClass kind, std::uint64_t seed, const RunAs& as, std::vector<double>& tick_times) {
  StressWorld world(kind, seed, as.threads);
  world.model.world.options.solver.budget = as.budget;
  grasp::GraspState state = grasp::makeState(world.model, world.starts, world.startDevices());
  grasp::ScratchHandle scratch = grasp::makeScratch(world.model);
  const double energy = totalEnergy(world.model.world, state.world);
  WorldResult result;
  for (; result.ticks < world.ticks; ++result.ticks) {
    const auto inputs = world.nextInputs();
    if ((result.ticks + 1) % as.ticks_per_scratch == 0) scratch = grasp::makeScratch(world.model);
    const double begin = threadCpuSeconds();
    const engine::StepReport report = grasp::step(world.model, state, *scratch, inputs, {}, {}, world.controls());
    tick_times.push_back(1e6 * (threadCpuSeconds() - begin));
    const bool flagged = report.status != engine::kStepOk;
    result.flagged += flagged;
    result.fault = faultOfTick(world, state, *scratch, flagged, energy);
    if (result.fault.empty()) continue;
    result.fault = fmt::format("seed {}, tick {}: {}", seed, result.ticks, result.fault);
    break;
  }
  result.hash = engine::hashOf(state.world);
  return result;
}

// With the cap. Ticks that took longer are timed again: all runs compute the same bits,
// and what interrupts one doesn't come again.
WorldResult runCapped(StressClass kind, std::uint64_t seed, std::vector<double>& tick_times) {
  constexpr int kMostRuns = 3;  // of which a tick's least time counts; chosen: an interruption rarely comes thrice
  std::vector<double> least;
  const WorldResult result = runWorld(kind, seed, {.budget = kCap}, least);
  for (int n = 1; n<kMostRuns&& * std::max_element(least.begin(), least.end())> 1e6 * kCap; ++n) {
    std::vector<double> times;
    runWorld(kind, seed, {.budget = kCap}, times);
    for (std::size_t i = 0; i < least.size(); ++i) least[i] = std::min(least[i], times[i]);
  }
  tick_times.insert(tick_times.end(), least.begin(), least.end());
  return result;
}

std::vector<Record> stressClass(StressClass kind, const StressOptions& options, MeasureContext& context) {
  constexpr int kAgainEvery = 20;      // worlds; chosen: such a world runs twice more, on two threads and forgetfully
  constexpr int kTicksPerScratch = 3;  // chosen: new memory costs some ticks
  std::vector<Record> failures;
  std::vector<double> tick_times, capped_times, untimed;
  int ticks = 0, flagged = 0, differing = 0, remembering = 0, capped = 0, capped_failed = 0;
  const auto note = [&failures](const std::string& fault) {
    constexpr std::size_t kShown = 8;  // faults by name; the last one counts all further ones
    if (!fault.empty() && failures.size() < kShown)
      failures.push_back(exactly(fault, 1, "-", 0));
    else if (!fault.empty())
      failures.back().value += 1;
  };
  for (int i = 0; i < options.seeds && !context.interrupted(); ++i) {
    context.progress(static_cast<double>(i) / options.seeds);
    const std::uint64_t seed = options.first_seed + static_cast<std::uint64_t>(i);
    const WorldResult result = runWorld(kind, seed, {}, tick_times);
    ticks += result.ticks;
    flagged += result.flagged;
    if (i % kAgainEvery == 0) {
      differing += runWorld(kind, seed, {.threads = 2}, untimed).hash != result.hash;
      remembering += runWorld(kind, seed, {.ticks_per_scratch = kTicksPerScratch}, untimed).hash != result.hash;
    }
    note(result.fault);
    if (i % kCappedEvery != 0) continue;
    ++capped;
    capped_failed += !runCapped(kind, seed, capped_times).fault.empty();
  }
  double failed = 0;
  for (const Record& record : failures) failed += record.value;
  std::vector<Record> records = {
      exactly(fmt::format("unflagged failures in {} worlds", options.seeds), failed, "-", 0),
      exactly(fmt::format("other bits on two threads, of every {}th world", kAgainEvery), differing, "-", 0),
      exactly(fmt::format("other bits from states alone, of every {}th world", kAgainEvery), remembering, "-", 0),
      unbounded("flagged ticks", ticks > 0 ? 100.0 * flagged / ticks : 0, "%")};
  for (const auto& [name, q] :
       {std::pair("median", 0.5), std::pair("p99", 0.99), std::pair("p99.9", 0.999), std::pair("longest", 1.0)})
    records.push_back(unbounded(fmt::format("tick, {}", name), quantileOf(tick_times, q), "us"));
  // of the worlds, and one: what a needle that spins fast costs doesn't fit every budget
  constexpr double kCappedFailures = 0.03;
  records.push_back(atMost(fmt::format("failures in {} worlds capped at {:.0f} us", capped, 1e6 * kCap), capped_failed,
                           "-", std::max(1.0, kCappedFailures * capped)));
  for (const auto& [name, q] : {std::pair("p99.9", 0.999), std::pair("longest", 1.0)})
    records.push_back(
        unbounded(fmt::format("tick, {}, capped at {:.0f} us", name, 1e6 * kCap), quantileOf(capped_times, q), "us"));
  records.insert(records.end(), failures.begin(), failures.end());
  return records;
}

}  // namespace

std::vector<Measurement> stressMeasurements(const StressOptions& options) {
  std::vector<Measurement> all;
  for (std::size_t i = 0; i < std::size(kStressClassNames); ++i) {
    all.push_back({fmt::format("stress/{}", kStressClassNames[i]), [=](MeasureContext& context) {
                     return stressClass(static_cast<StressClass>(i), options, context);
                   }});
  }
  return all;
}

}  // namespace pincer::tasks
