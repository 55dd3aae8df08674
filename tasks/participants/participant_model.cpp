#include "tasks/participants/participant_model.h"

#include <fmt/format.h>

namespace pincer::tasks {
namespace {

constexpr double kSpeechless = 1e3;  // a tactor that moves by less than this says nothing: all of them do [m]

std::uint64_t fnv1a(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

}  // namespace

const char* nameOf(Strategy strategy) { return strategy == Strategy::kRational ? "rational" : "simple"; }

std::string describe(const ParticipantModel& model) {
  std::string json = fmt::format("{{\"strategy\": \"{}\", \"feels_tactor\": {}", nameOf(model.strategy), model.feels_tactor);
  forEachParameter(model,
                   [&](const char* name, double value, double, double, const char*) { json += fmt::format(", \"{}\": {}", name, value); });
  return json + "}";
}

std::string hashOf(const ParticipantModel& model) { return fmt::format("{:016x}", fnv1a(describe(model))); }

std::unique_ptr<Participant> makeParticipant(const ParticipantModel& model, HandTask task, std::uint64_t seed, bool with_cld) {
  HandRanges hands = model.hands;
  SensingLimits limits = model.limits;
  if (with_cld) {
    hands.speed_min *= model.cld_speed;
    hands.speed_max *= model.cld_speed;
  }
  if (!model.feels_tactor) limits.tactor_moves = kSpeechless;
  const bool rational = model.strategy == Strategy::kRational;
  if (task == HandTask::kPickup) return std::make_unique<ScriptedPickup>(seed, model.pickup, limits, hands, rational);
  return std::make_unique<ScriptedAlignment>(seed, !rational, model.alignment, limits, hands);
}

}  // namespace pincer::tasks
