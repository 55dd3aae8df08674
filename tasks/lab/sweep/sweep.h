// sweep: the same scene or study many times, with some of its numbers changed, and what came of each case.
//
// Cases are shared among threads, or as shards among machines; each has its own place in the table, so that neither
// their number nor their order changes a digit. A case that can't be run is a row with its error, not the end.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "pincer/tasks/lab/report/gnuplot.h"
#include "pincer/tasks/lab/sweep/variation.h"

namespace pincer::tasks {

struct CaseResult {
  bool done = false;
  std::vector<double> values;  // one per measure; NaN where there is none, or an error
  std::string state_hash;      // of the state at a scene's end (quantity.h); of studies empty
  std::string error;           // why it couldn't be run; empty: it was
};

struct SweepTable {
  std::string what;                         // was run
  std::vector<std::string> parameters;      // what varied
  std::vector<std::string> measures;        // with unit
  std::vector<bool> plotted;                // per measure
  std::vector<std::vector<double>> points;  // of each case, the values of the parameters
  std::vector<CaseResult> results;          // of each case
  bool interrupted = false;

  std::size_t done() const;
  std::size_t failed() const;  // of these, with an error
};

// A sweep before it is run.
struct SweepJob {
  SweepTable table;  // without results
  // Everything that decides a result, but the program: two sweeps whose definitions are equal give equal tables.
  std::string definition;
  // A case by its index; from any thread, never twice. Throws InputError: the case's error.
  // After an interruption its values don't count.
  std::function<CaseResult(std::size_t, const std::atomic<bool>&)> measure;
};

// One share of a sweep: cases index - 1, index - 1 + count, ... of 1 <= index <= count.
struct SweepShard {
  int index = 1, count = 1;
  bool has(std::size_t point) const {
    return point % static_cast<std::size_t>(count) + 1 == static_cast<std::size_t>(index);
  }
};

// "2/7". Throws InputError that says how it is written.
SweepShard parseShard(const std::string& text);

struct SweepOptions {
  int threads = 2;
  SweepShard shard = {};
  std::function<void(std::int64_t done, std::int64_t total)> progress = {};        // from any thread, one at a time
  std::function<void(std::size_t point, const CaseResult& result)> finished = {};  // likewise: a case is whole
};

// Fills in the results of the shard's cases that aren't done. Passes on what `finished` throws,
// and what `measure` throws but InputError.
void runSweep(SweepJob& job, const SweepOptions& options, const std::atomic<bool>& interrupted);

// One case, whole: with its error where it can't be run.
CaseResult measuredCase(const SweepJob& job, std::size_t point, const std::atomic<bool>& interrupted);

std::string sweepText(const SweepTable& table);
std::string sweepCsv(const SweepTable& table);
std::string sweepJson(const SweepTable& table);
// One panel per plotted measure over the first parameter, a line for each value of the second, a column for each of the
// third; a heat map where two parameters have many values.
// at most three parameters; of three, at most 6 values of the second and 4 of the third
bool isDrawable(const SweepTable& table);
Figure sweepFigure(const SweepTable& table);

enum class SweepFormat { kCsv, kJson, kHdf5 };
// The table as sweep.csv, sweep.json or sweep.h5, and where it is drawable sweep.png and sweep.svg, in `directory`,
// which is made if missing. Throws InputError. Returns their paths.
std::vector<std::string> writeSweep(const SweepTable& table, const std::string& directory,
                                    SweepFormat format = SweepFormat::kCsv);
// Groups /parameters and /measures with a dataset of doubles per column, /state_hash and
// /error, all as long as the cases that are done.
void writeSweepHdf5(const SweepTable& table, const std::string& path);

}  // namespace pincer::tasks
