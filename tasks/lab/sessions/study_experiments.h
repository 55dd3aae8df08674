// study_experiments: the five experiments with one finger, by their names.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "pincer/tasks/lab/experiments/study.h"

namespace pincer::tasks {

bool isOneFingerTask(const std::string& task);

// The experiment that a session holds. `name` stands for the session in errors; `stride`: every
// stride-th tick is recorded. Throws InputError.
std::unique_ptr<Experiment> experimentOf(const SessionInfo& info, const std::string& name, const ServoOptions& servo,
                                         int stride);

// Which participant a session of a person has, from 0, as `participants_json` says; absent: it is of simulated ones.
std::string personJson(std::int64_t person);
std::optional<std::int64_t> personOf(const SessionInfo& info);

}  // namespace pincer::tasks
