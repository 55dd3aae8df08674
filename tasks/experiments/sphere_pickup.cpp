#include "tasks/experiments/sphere_pickup.h"

#include <fmt/format.h>

#include <algorithm>

#include "tasks/participants/random.h"

namespace pincer::tasks {
namespace {

void requireRange(const char* name, double value, double low, double high, const char* unit, const char* remedy) {
  if (value >= low && value <= high) return;  // also false for NaN
  throw InputError(fmt::format("sphere-pickup: {} = {} is out of range [{}, {}]{}. {}", name, value, low, high, unit, remedy));
}

void checkObject(const SpherePickupOptions& o) {
  requireRange("radius", o.radius, 0.005, 0.05, " m", "It is in metres; the usual sphere has 0.02.");
  if (o.object && o.object->size) {
    requireRange("size", *o.object->size, 0.005, 0.2, " m", "It is the object's largest dimension in metres; 0.06 suits a hand.");
  }
  requireRange("mass", o.mass, 0.001, 1, " kg", "It is in kilograms; the usual sphere has 0.075.");
  requireRange("dynamic_ratio", o.dynamic_ratio, 0.01, 1, "", "Dynamic friction is at most static friction; 0.85 is the usual ratio.");
  requireRange("torsion_radius", o.torsion_radius, 0, 0.02, " m", "It is in metres; a fingertip has 0.0033, a point contact 0.");
  requireRange("dish_radius", o.dish_radius, 0.1, 10, " m", "It is in metres; the usual dish has 0.15.");
  requireRange("dish_friction", o.dish_friction, 0, 5, "", "A friction coefficient; the usual dish has 0.5.");
}

void checkFrictions(const SpherePickupOptions& o) {
  if (o.frictions.empty()) throw InputError("sphere-pickup: frictions is empty. Give at least one static friction, for example 0.6.");
  for (const double mu : o.frictions) {
    requireRange("frictions", mu, 0.05, 5, "", "A static friction coefficient; skin on plastic has about 0.6.");
  }
}

void checkProtocol(const SpherePickupOptions& o) {
  requireRange("success_height", o.success_height, 0.005, 0.08, " m", "It is in metres, within the arms' reach; 0.05 is the usual height.");
  requireRange("hold_time", o.hold_time, 0, 10, " s", "It is in seconds; 1 is the usual time.");
  requireRange("timeout", o.timeout, 1, 600, " s", "It is in seconds; 60 is the usual time.");
  requireRange("repetitions", o.repetitions, 1, 1000, "", "Every friction is done so often in each condition; 5 is usual.");
  requireRange("participants", o.participants, 1, 1000, "", "The published study had 12.");
  if (o.conditions.empty()) throw InputError("sphere-pickup: conditions is empty. Give force, cld+force, or both.");
  for (auto first = o.conditions.begin(); first != o.conditions.end(); ++first) {
    if (std::find(first + 1, o.conditions.end(), *first) == o.conditions.end()) continue;
    throw InputError(fmt::format("sphere-pickup: condition \"{}\" is given twice. Name each condition once.", nameOf(*first)));
  }
}

void checkFingers(const SpherePickupOptions& o) {
  requireRange("finger_radius", o.finger_radius, 0.002, 0.02, " m", "It is in metres; a fingertip has 0.008.");
  requireRange("coupling_stiffness", o.coupling_stiffness, 50, 3500, " N/m", "More than 3500 the arm can't render stably; 1000 is usual.");
  requireRange("coupling_damping", o.coupling_damping, 0, 30, " N s/m", "More than 30 the arm can't render stably; 5 is usual.");
}

// Every friction `repetitions` times, shuffled (Fisher, Yates).
std::vector<double> shuffledFrictions(const SpherePickupOptions& options, std::uint64_t seed) {
  std::vector<double> frictions;
  for (int i = 0; i < options.repetitions; ++i) frictions.insert(frictions.end(), options.frictions.begin(), options.frictions.end());
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
  checkObject(options);
  checkFrictions(options);
  checkProtocol(options);
  checkFingers(options);
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
