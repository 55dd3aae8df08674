// verdicts: what a run of the program may do whatever it was given, and what it may not.
//
//   It ends by itself, with a documented exit code; if asked to stop, it does.      It never aborts.
//   A refusal (exit codes 2, 3, 4) is a text on standard error that begins with "pincer: ", names what
//   was refused, and says in a sentence of its own what to do. No text holds control characters but line
//   ends.         Nothing half-made is left behind.
#pragma once
#include <optional>
#include <string>

#include "pincer/tests/campaign/row.h"

namespace pincer::campaign {

struct Finding {
  Verdict verdict = Verdict::kWrong;
  std::string why;
};

std::optional<Finding> verdictOn(const Launch& launch, const Ended& ended, const Expect& expect);

// The files and folders below `folder`.
std::set<std::string> filesIn(const fs::path& folder);

// A file of the run's folder that nobody asked for: a part of an output; anything that wasn't there
// `before` a usage error. Empty if there is none, and if it is a journal that may stay beside its database.
std::string strayIn(const Launch& launch, const Ended& ended, const std::set<std::string>& before,
                    const Expect& expect);

// The first control character that a terminal would obey, as text; empty if there is none. `text` is UTF-8.
std::string controlCharacterIn(const std::string& text);

}  // namespace pincer::campaign
