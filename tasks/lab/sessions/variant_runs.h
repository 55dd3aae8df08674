// variant_runs: the experiments of the manipulation tasks that `pincer run findings`
// judges, each a session in a file of its own.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "pincer/tasks/lab/findings/findings.h"

namespace pincer::tasks {

// Runs what isn't there yet of every wanted variant's experiments, first the primary analysis, then one experiment of
// each control after the other, and judges those that are whole. Sessions: VARIANT-K.db in `directory`, without
// samples; complete ones stay as they are, unfinished ones are gone on with. `progress` in thousandths of experiments,
// from any thread, one at a time. Where no variant is wanted nothing runs. Throws InputError for options out of range,
// and for a session of another design or of other participants.
FindingsResult runVariants(const FindingsOptions& options, const std::string& directory,
                           const std::atomic<bool>& interrupted,
                           const std::function<void(std::int64_t done, std::int64_t total)>& progress);

}  // namespace pincer::tasks
