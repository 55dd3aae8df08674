// sweep: the same scene or study many times, with one or two of its numbers changed, and what came of each.
//
// Points are shared among threads; each has its own place in the table, so that neither their number nor their order changes a digit.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "pincer/tasks/lab/report/gnuplot.h"
#include "pincer/tasks/lab/sweep/variation.h"

namespace pincer::tasks {

struct SweepTable {
  std::string what;                          // was run
  std::vector<std::string> parameters;       // what varied
  std::vector<std::string> measures;         // with unit
  std::vector<bool> plotted;                 // per measure
  std::vector<std::vector<double>> points;   // values of the parameters
  std::vector<std::vector<double>> results;  // of each point, one per measure; empty: not done
  bool interrupted = false;
};

struct SweepOptions {
  int threads = 2;
  std::function<void(std::int64_t done, std::int64_t total)> progress = {};  // from any thread, one at a time
};

// Fills in `results`. `measure` is called from any thread, once per point, and not again once `interrupted`. Passes on what it throws.
void runSweep(SweepTable& table, const SweepOptions& options, const std::atomic<bool>& interrupted,
              const std::function<std::vector<double>(std::size_t point)>& measure);

std::string sweepText(const SweepTable& table);
std::string sweepCsv(const SweepTable& table);
// One panel per plotted measure over the first parameter, a line for each value of the second.
Figure sweepFigure(const SweepTable& table);
// sweep.csv, sweep.png and sweep.svg in `directory`, which is made if missing. Throws InputError. Returns their paths.
std::vector<std::string> writeSweep(const SweepTable& table, const std::string& directory);

}  // namespace pincer::tasks
