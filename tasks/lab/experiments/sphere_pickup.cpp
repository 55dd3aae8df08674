#include "pincer/tasks/lab/experiments/sphere_pickup.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/tasks/lab/experiments/study.h"
#include "pincer/tasks/lab/experiments/study_parameters.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {
namespace {

// Every friction `repetitions` times, shuffled (Fisher, Yates).
std::vector<double> shuffledFrictions(const SpherePickupOptions& options, std::uint64_t seed) {
  std::vector<double> frictions;
  for (int i = 0; i < options.repetitions; ++i)
    frictions.insert(frictions.end(), options.frictions.begin(), options.frictions.end());
  Random random(seed);
  for (std::size_t i = frictions.size(); i > 1; --i) std::swap(frictions[i - 1], frictions[random.below(i)]);
  return frictions;
}

std::vector<HandCondition> conditionOrder(const SpherePickupOptions& options, std::int64_t participant) {
  auto order = options.conditions;
  if (participant % 2 == 1) std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace

void validate(const SpherePickupOptions& options) {
  const RangeCheck check("sphere-pickup", "sphere_pickup");
  visitParameters(options, check);
  if (options.object) visitParameters(*options.object, RangeCheck("sphere-pickup: object", "sphere_pickup.object"));
  check("participants", options.participants, Parameter{"", {1, 1000, false, "The published study had 12."}});
  if (options.frictions.empty())
    throw ParameterError("sphere_pickup.frictions",
                         "sphere-pickup: frictions is empty. Give at least one static friction, for example 0.6.");
  requireNamed(options.conditions, "sphere-pickup");
  for (const HandCondition& condition : options.conditions) {
    const SpherePickupOptions changed = inCondition(options, condition);
    visitParameters(condition, RangeCheck("sphere-pickup: condition " + condition.name, "conditions"));
    visitParameters(changed, RangeCheck("sphere-pickup: condition " + condition.name, "conditions"));
  }
}

std::uint64_t participantSeed(const SpherePickupOptions& options, std::int64_t participant) {
  return seedFor(options.seed, static_cast<std::uint64_t>(participant));
}

std::vector<PickupTrialSpec> pickupTrialsOf(const SpherePickupOptions& options, std::int64_t participant) {
  validate(options);
  std::vector<PickupTrialSpec> trials;
  const std::uint64_t seed = participantSeed(options, participant);
  for (const HandCondition& condition : conditionOrder(options, participant)) {
    const std::uint64_t block_seed = seedFor(seed, 1 + seedPartOf(condition));
    for (const double mu : shuffledFrictions(options, block_seed)) {
      const auto index = static_cast<std::int64_t>(trials.size());
      const std::uint64_t trial_seed = seedFor(block_seed, static_cast<std::uint64_t>(index));
      trials.push_back({index, participant, index, condition, mu, options.dynamic_ratio * mu, trial_seed});
    }
  }
  return trials;
}

std::vector<PickupTrialSpec> pickupTrials(const SpherePickupOptions& options) {
  validate(options);
  std::vector<PickupTrialSpec> trials;
  for (std::int64_t participant = 0; participant < options.participants; ++participant) {
    for (PickupTrialSpec& spec : pickupTrialsOf(options, participant)) {
      spec.trial = static_cast<std::int64_t>(trials.size());
      trials.push_back(std::move(spec));
    }
  }
  return trials;
}

}  // namespace pincer::tasks
