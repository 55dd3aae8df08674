// bids_export: a session as a behavioural data set in the Brain Imaging Data Structure (BIDS 1.9,
// https://bids-specification.readthedocs.io, "Behavioral experiments with no neural recordings").
//
//   dataset_description.json, README.md, participants.tsv + .json, sub-<NN>/beh/sub-<NN>_task-<task>_beh.tsv + .json
//
// One row per trial, in the order of doing; a column's unit is in its name and in the sidecar; what is absent is "n/a".
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

// Returns the paths of the files. `directory` is made if missing. Throws InputError.
std::vector<std::string> exportBids(const SessionReader& session, const std::string& directory);

}  // namespace pincer::tasks
