// pickup_session: the shortest session of the manipulation study that has trials.
#pragma once
#include "pincer/tasks/lab/sessions/manipulation_session.h"

namespace pincer::tests {

// One simulated person, one condition, one friction, no training: `repetitions` pickups of at most `timeout` [s].
inline tasks::ManipulationSessionOptions pickupSession(int repetitions, double timeout) {
  tasks::ManipulationSessionOptions options;
  options.study.participants = 1;
  options.study.tasks = {tasks::HandTask::kPickup};
  options.study.training.pickups = 0;
  options.study.conditions = {tasks::publishedHandConditions()[1]};
  options.study.pickup.frictions = {0.9};
  options.study.pickup.repetitions = repetitions;
  options.study.pickup.timeout = timeout;
  return options;
}

}  // namespace pincer::tests
