#include "pincer/tasks/lab/experiments/sphere_pickup.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/tasks/lab/experiments/study_parameters.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {
namespace {

void checkConditions(const SpherePickupOptions& o) {
  if (o.conditions.empty()) throw InputError("sphere-pickup: conditions is empty. Give force, cld+force, or both.");
  for (auto first = o.conditions.begin(); first != o.conditions.end(); ++first) {
    if (std::find(first + 1, o.conditions.end(), *first) == o.conditions.end()) continue;
    throw InputError(
        fmt::format("sphere-pickup: condition \"{}\" is given twice. Name each condition once.", nameOf(*first)));
  }
}

// Every friction `repetitions` times, shuffled (Fisher, Yates).
std::vector<double> shuffledFrictions(const SpherePickupOptions& options, std::uint64_t seed) {
  std::vector<double> frictions;
  for (int i = 0; i < options.repetitions; ++i)
    frictions.insert(frictions.end(), options.frictions.begin(), options.frictions.end());
  Random random(seed);
  for (std::size_t i = frictions.size(); i > 1; --i) std::swap(frictions[i - 1], frictions[random.below(i)]);
  return frictions;
}

std::vector<PickupCondition> conditionOrder(const SpherePickupOptions& options, std::int64_t participant) {
  auto order = options.conditions;
  if (participant % 2 == 1) std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace

std::string nameOf(PickupCondition condition) { return condition == PickupCondition::kForce ? "force" : "cld+force"; }

PickupCondition pickupConditionOf(const std::string& name) {
  for (const auto condition : {PickupCondition::kForce, PickupCondition::kCldForce}) {
    if (name == nameOf(condition)) return condition;
  }
  throw InputError(fmt::format("sphere-pickup: condition \"{}\" is unknown. It is one of force, cld+force.", name));
}

void validate(const SpherePickupOptions& options) {
  const RangeCheck check("sphere-pickup", "sphere_pickup");
  visitParameters(options, check);
  if (options.object) visitParameters(*options.object, RangeCheck("sphere-pickup: object", "sphere_pickup.object"));
  check("participants", options.participants, Parameter{"", {1, 1000, false, "The published study had 12."}});
  if (options.frictions.empty())
    throw ParameterError("sphere_pickup.frictions",
                         "sphere-pickup: frictions is empty. Give at least one static friction, for example 0.6.");
  checkConditions(options);
}

std::uint64_t participantSeed(const SpherePickupOptions& options, std::int64_t participant) {
  return seedFor(options.seed, static_cast<std::uint64_t>(participant));
}

std::vector<PickupTrialSpec> pickupTrials(const SpherePickupOptions& options) {
  validate(options);
  std::vector<PickupTrialSpec> trials;
  for (std::int64_t participant = 0; participant < options.participants; ++participant) {
    const std::uint64_t seed = participantSeed(options, participant);
    std::int64_t index = 0;
    for (const PickupCondition condition : conditionOrder(options, participant)) {
      const std::uint64_t block_seed = seedFor(seed, 1 + static_cast<std::uint64_t>(condition));
      for (const double mu : shuffledFrictions(options, block_seed)) {
        const auto trial = static_cast<std::int64_t>(trials.size());
        const std::uint64_t trial_seed = seedFor(block_seed, static_cast<std::uint64_t>(index));
        trials.push_back({trial, participant, index++, condition, mu, options.dynamic_ratio * mu, trial_seed});
      }
    }
  }
  return trials;
}

}  // namespace pincer::tasks
