#include "pincer/tasks/lab/participants/participant_model.h"

#include <fmt/format.h>

namespace pincer::tasks {
namespace {

std::uint64_t fnv1a(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

}  // namespace

const char* nameOf(Strategy strategy) { return strategy == Strategy::kRational ? "rational" : "simple"; }

const char* nameOf(TactorUse use) {
  constexpr const char* kNames[] = {"place", "slip", "nothing"};  // by TactorUse
  return kNames[static_cast<std::size_t>(use)];
}

std::string describe(const ParticipantModel& model) {
  std::string json = fmt::format("{{\"strategy\": \"{}\", \"tactor_use\": \"{}\"", nameOf(model.strategy),
                                 nameOf(model.limits.tactor_use));
  forEachParameter(model, [&](const char* name, double value, double, double, const char*) {
    json += fmt::format(", \"{}\": {}", name, value);
  });
  return json + "}";
}

std::string hashOf(const ParticipantModel& model) { return fmt::format("{:016x}", fnv1a(describe(model))); }

std::unique_ptr<Participant> makeParticipant(const ParticipantModel& model, HandTask task, std::uint64_t seed,
                                             bool with_cld) {
  HandRanges hands = model.hands;
  if (with_cld) {
    hands.speed_min *= model.cld_speed;
    hands.speed_max *= model.cld_speed;
  }
  const bool rational = model.strategy == Strategy::kRational;
  if (task == HandTask::kPickup)
    return std::make_unique<ScriptedPickup>(seed, model.pickup, model.limits, hands, rational);
  return std::make_unique<ScriptedAlignment>(seed, !rational, model.alignment, model.limits, hands);
}

}  // namespace pincer::tasks
