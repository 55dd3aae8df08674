#include "pincer/tasks/run/scene/expectation_text.h"

#include <fmt/format.h>

#include <cmath>

namespace pincer::tasks {
namespace {

std::string whenText(const Expectation& expected) {
  return expected.tick == Expectation::kAlways ? "always" : fmt::format("at {:g} s", expected.time);
}

std::string boundText(const Expectation& expected) {
  if (expected.hash) return expected.hash->empty() ? "not taken yet (pincer test --update-hashes)" : *expected.hash;
  const std::string slack = expected.tolerance > 0 ? fmt::format(" +- {:.3g}", expected.tolerance) : "";
  return fmt::format("{} {:.10g}{} {}", kRelationNames[static_cast<std::size_t>(expected.relation)], expected.value,
                     slack, expected.quantity.kind->unit);
}

std::string measuredText(const Expectation& expected, const Outcome& outcome) {
  if (!outcome.reached) return "not reached: the run ended before";
  if (expected.hash) return fmt::format("measured {}", outcome.hash);
  const std::string off = expected.relation == Relation::kEqual
                              ? fmt::format(", off by {:.3g}", std::abs(outcome.measured - expected.value))
                              : "";
  const std::string when =
      expected.tick == Expectation::kAlways ? fmt::format(" (worst, at {:g} s)", outcome.worst_time) : "";
  return fmt::format("measured {:.10g}{}{}", outcome.measured, off, when);
}

}  // namespace

std::string outcomeText(const Expectation& expected, const Outcome& outcome) {
  return fmt::format("{} {} {}: {}", expected.quantity.name, whenText(expected), boundText(expected),
                     measuredText(expected, outcome));
}

}  // namespace pincer::tasks
