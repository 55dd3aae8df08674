// usage: what is wrong with the command line itself, and not with a file or device that it names: exit code 2.
#pragma once
#include <cstdint>
#include <string>

#include "pincer/contact/error.h"

namespace CLI {
class Validator;
}

namespace pincer::tasks {

struct NumberRule;

// Throws what the program reports as a mistake of usage; `message` is a sentence.
[[noreturn]] void refuseUsage(std::string message);

// Runs `read`, which makes something of options; what it says against them is a mistake of usage.
template <class Read>
auto asUsage(const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    refuseUsage(error.what());
  }
}

// For ->check(): a finite number within the rule's range, whole if `whole`. (CLI11's own ranges let NaN pass.)
CLI::Validator within(const NumberRule& rule);
CLI::Validator wholeWithin(std::int64_t low, std::int64_t high);

}  // namespace pincer::tasks
