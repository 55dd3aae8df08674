// demand: the ways in which a fuzz target says that a promise was broken.
#pragma once
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "pincer/contact/error.h"

namespace pincer::fuzz {

// Ends the program with the promise on standard error.
inline void demand(bool kept, std::string_view promise) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %.*s\n", static_cast<int>(promise.size()), promise.data());
  std::abort();
}

// True if a message may go to a terminal as it is: some words, and no control characters but line ends.
inline bool isForPeople(std::string_view message) {
  const auto is_control = [](unsigned char c) { return (c < ' ' && c != '\n') || c == 0x7f; };
  return message.size() > 10 && std::none_of(message.begin(), message.end(), is_control);
}

// True if `read` came to its end, false if it refused by InputError; other exceptions pass and end the program.
template <class Read>
bool readsOrRefuses(Read read) {
  try {
    read();
    return true;
  } catch (const InputError& refusal) {
    if (!isForPeople(refusal.what())) std::fprintf(stderr, "%s\n", refusal.what());
    demand(isForPeople(refusal.what()), "a refusal is a sentence that a terminal can show");
    return false;
  }
}

}  // namespace pincer::fuzz
