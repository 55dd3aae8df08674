// engine_bench: `pincer bench engine`: accuracy against cost, scene by scene, for
// pincer and the engines that are built in.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/judge/bench/engine/bench_scene.h"
#include "pincer/tasks/judge/bench/engine/race.h"
#include "pincer/tasks/run/measure/measurement.h"

namespace pincer::tasks {

struct EngineBenchOptions {
  bool peers = false;       // beside other engines, where they are built in
  bool whole = false;       // scenes of a minute last a minute, and there are 1000 spheres
  std::string models = {};  // directory of robots in MJCF that are run too; empty: none
  std::string out = {};     // directory for CSV files and plots; empty: none
  RaceOptions race;
};

// One measurement per scene, and the latency of single steps. Throws InputError.
std::vector<Measurement> engineMeasurements(const EngineBenchOptions& options);

// S9: each step of S4 timed on its own.
Measurement stepLatencyMeasurement(std::vector<Contestant> contestants);

// Cost of solving contacts, 2 to 32 of them, warm; of each tick the least of so many rounds.
Measurement solveLatencyMeasurement(int rounds);

// Cost of bodies at rest beside one that moves; the least of so many rounds.
Measurement sleepMeasurement(int rounds);

// Walls of bricks, heaps of balls and hulls, pegs in holes, by sizes; `whole`: stand for a minute, and the large ones;
// `peers`: beside familyPeers().
std::vector<Measurement> familyMeasurements(bool whole, bool peers);

// The records of a scene: pincer's runs against its bounds, the others' beside
// them, and the ratios to the best of them.
std::vector<Record> recordsOfRace(const BenchScene& scene, const std::vector<Contestant>& contestants,
                                  const std::vector<RaceRun>& runs);

// How pincer compares with all other engines together.
struct Comparison {
  bool any = false;    // some peer moved as it should
  RaceRun best;        // of the peers': the least error, whatever it cost
  WorkRatios at_best;  // there: pincer's error at its cost, pincer's cost at its error
  RaceRun own;         // pincer's plain run at 1 ms
  // there: pincer's error over the peers' at equal cost, and cost at equal error; none: no peer is as cheap, as good
  WorkRatios at_own;
  // the lesser of at_best.error / 1e-3 and at_best.cost / 0.5; the goal is met up to 1. NaN: neither is known
  double share_of_goal = 0;
};
Comparison compareWithPeers(const std::vector<Contestant>& contestants, const std::vector<RaceRun>& runs);

// A work-precision diagram, DIRECTORY/scene.png, with its table. Creates the directory. Throws InputError.
void plotRace(const std::string& directory, const BenchScene& scene, const std::vector<Contestant>& contestants,
              const std::vector<RaceRun>& runs);

}  // namespace pincer::tasks
