#include "pincer/tasks/app/usage.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {
namespace {

template <class Number>
bool reads(const std::string& text, Number& value) {
  const char *begin = text.data() + (text.starts_with('+') ? 1 : 0), *end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  return error == std::errc() && stop == end && begin != end;
}

}  // namespace

void refuseUsage(std::string message) {
  while (message.ends_with('.')) message.pop_back();  // what reports it ends the sentence
  throw CLI::ValidationError(message);
}

CLI::Validator within(const NumberRule& rule) {
  const auto problem = [rule](std::string& text) -> std::string {
    double value = 0;
    if (!reads(text, value)) return fmt::format("\"{}\" isn't a number", printable(text));
    std::string said = isWithin(value, rule) ? "" : fmt::format("{} {}", text, outOfRange(rule));
    while (said.ends_with('.')) said.pop_back();
    return said;
  };
  return CLI::Validator(problem, fmt::format("in {}", rangeText(rule)));
}

CLI::Validator wholeWithin(std::int64_t low, std::int64_t high) {
  const auto problem = [low, high](std::string& text) -> std::string {
    std::int64_t value = 0;
    if (!reads(text, value))
      return fmt::format("\"{}\" isn't a whole number within [{}, {}]", printable(text), low, high);
    return value >= low && value <= high ? "" : fmt::format("{} is out of range [{}, {}]", text, low, high);
  };
  return CLI::Validator(problem, fmt::format("whole in [{}, {}]", low, high));
}

}  // namespace pincer::tasks
