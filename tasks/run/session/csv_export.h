// csv_export: a session as plain tables: session.csv, trial.csv, sample.csv, event.csv, response.csv, reading.csv,
// hands.csv, input.csv, with units in the column names (columns.h).
//
// Each file appears whole or not at all and replaces an older one of its name. `filter` thins sample.csv only.
// Throws InputError (path, cause, remedy).
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

// Returns the paths of the files. `directory` is made if missing.
std::vector<std::string> exportCsv(const SessionReader& session, const std::string& directory,
                                   const SampleFilter& filter = {});

}  // namespace pincer::tasks
