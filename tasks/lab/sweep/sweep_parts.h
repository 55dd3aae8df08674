// sweep_parts: how jobs are put together. Internal to sweeps.
#pragma once
#include <cstdint>
#include <exception>
#include <string>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/sweep/sweep.h"
#include "pincer/tasks/run/files/json_writer.h"

namespace pincer::tasks {

// Without measures yet.
SweepTable tableOf(const std::string& what, const SweepGrid& grid);

// Throws InputError for one that is there already.
void addMeasure(SweepTable& table, const std::string& label, bool plotted);

// Parameters and points of a definition, as members of the object that is open;
// and the fingerprint of pincer's sources.
void writeGrid(const SweepTable& table, JsonWriter& json);

// Puts a file that a library wrote under another name in place of `path`, flushed to the disk:
// a PartFile that was released can't flush.
void placeWritten(const std::string& written, const std::string& path);

// Of a study with these participants.
std::string studyDefinition(const SweepTable& table, const std::string& task, int participants, std::uint64_t seed);

// Throws what `read` says of the first point if it says something of every one: the sweep itself is wrong then.
template <class Read>
void refuseUnreadable(const SweepTable& table, const Read& read) {
  std::exception_ptr first;
  for (const std::vector<double>& point : table.points) {
    try {
      read(point);
      return;
    } catch (const InputError&) {
      if (!first) first = std::current_exception();
    }
  }
  if (first) std::rethrow_exception(first);
}

}  // namespace pincer::tasks
