// sweep_store: the cases of a sweep as they are finished, in a file that survives a
// kill at any moment: DIR/sweep.db, SQLite.
//
//   sweep   one row: definition, shard, what made it          parameter, measure   names
//   result  one row per finished case: "case" (from 0), the parameters' values, the measures', state_hash, error
//
// Every case is one transaction, synchronised to the disk. When all cases of the shard are there the file is written
// anew in the order of the cases; so equal results are equal bytes, whatever was killed, resumed or merged on the way.
#pragma once
#include <memory>
#include <string>

#include "pincer/tasks/lab/sweep/sweep.h"

namespace pincer::tasks {

class SweepStore {
 public:
  // Opens DIR/sweep.db, which is made where it is missing, and fills in the results that it holds.
  // With something there but without `resume` it throws InputError; so it does where another sweep or
  // shard is there, or another program writes it.
  SweepStore(const std::string& directory, SweepJob& job, const SweepShard& shard, bool resume);
  ~SweepStore();
  SweepStore(const SweepStore&) = delete;
  SweepStore& operator=(const SweepStore&) = delete;

  void add(std::size_t point, const CaseResult& result);  // durable when this returns
  void finish(const SweepTable& table);                   // all of the shard is done: the file in order

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

// A sweep as its file has it.
struct StoredSweep {
  std::string directory, definition;
  SweepShard shard;
  SweepTable table;
};
// Throws InputError.
StoredSweep readSweep(const std::string& directory);

// Writes DIR/sweep.db with all results of `table` that are done, in order, in place of one that is there.
void writeSweepStore(const std::string& directory, const std::string& definition, const SweepShard& shard,
                     const SweepTable& table);

// The whole of shards, each in its directory, in any order. Throws InputError that names what is missing,
// there twice, unfinished, or of another sweep.
StoredSweep mergeSweeps(const std::vector<std::string>& directories);

}  // namespace pincer::tasks
