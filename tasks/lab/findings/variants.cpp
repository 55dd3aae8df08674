#include "pincer/tasks/lab/findings/findings.h"

namespace pincer::tasks {
namespace {

constexpr double kDeaf = 10;                  // SD of a tactor's felt place: nothing [m]
constexpr double kSpeedRule = 0.032 / 0.074;  // slowest over fastest finger speed that Doxon (2014) measured

}  // namespace

const std::vector<FindingsVariant>& findingsVariants() {
  using Study = ManipulationStudy;
  static const std::vector<FindingsVariant> variants = {
      {"primary", "rational participants, the same speed in both conditions", [](Study&) {}},
      {"simple", "the simple strategy in place of the rational one",
       [](Study& s) { s.people.strategy = Strategy::kSimple; }},
      {"speed-rule", "secondary analysis: with the CLD people move at 32/74 of their speed",
       [](Study& s) { s.people.cld_speed = kSpeedRule; }},
      {"infinite-noise", "control: tactor places are felt with infinite noise; no effect may remain",
       [](Study& s) { s.people.limits.tactor_sd = kDeaf; }},
      {"frozen-tactor", "control: the tactors stand still in both conditions; no effect may remain",
       [](Study& s) { s.frozen_tactor = true; }},
      {"slip-cue-only",
       "control: of a tactor people feel only that it runs while they hold something, and then grip harder",
       [](Study& s) { s.people.limits.tactor_use = TactorUse::kSlip; }},
      {"slow-without-information", "control: infinite noise, and with the CLD people move at 32/74 of their speed",
       [](Study& s) {
         s.people.limits.tactor_sd = kDeaf;
         s.people.cld_speed = kSpeedRule;
       }},
      {"tactor-noise-half", "sensitivity: tactor noise halved", [](Study& s) { s.people.limits.tactor_sd *= 0.5; }},
      {"tactor-noise-double", "sensitivity: tactor noise doubled", [](Study& s) { s.people.limits.tactor_sd *= 2; }},
      {"placement-half", "sensitivity: placement errors halved",
       [](Study& s) {
         s.people.limits.placement_sd *= 0.5;
         s.people.limits.placement_between_sd *= 0.5;
       }},
      {"placement-wider", "sensitivity: placement errors half as large again",
       [](Study& s) {
         s.people.limits.placement_sd *= 1.5;
         s.people.limits.placement_between_sd *= 1.5;
       }},
  };
  return variants;
}

}  // namespace pincer::tasks
