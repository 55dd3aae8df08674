#include "pincer/devices/emulate/changed_json.h"

#include <array>
#include <string_view>

namespace pincer::devices::emulate {

std::string changedJson(std::string text, std::size_t most, std::mt19937_64& random) {
  // Pieces that matter to a reader: structure, a number beyond doubles, NUL, half a character.
  constexpr std::array<std::string_view, 17> kPieces{"{",       "}",   "[",     "]",       "\"",  ",",
                                                     "9",       "e99", "null",  "true",    ":1,", "\\u0000",
                                                     "\\u00e9", "-",   "1e400", "\\ud800", "\xff"};
  constexpr std::size_t kLongest = 30;  // bytes of an inserted piece
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (std::size_t left = 1 + below(most); left > 0 && !text.empty(); --left) {
    const std::size_t at = below(text.size());
    switch (below(4)) {
      case 0:
        text[at] = static_cast<char>(random());
        break;
      case 1:
        text.insert(at, kPieces[below(kPieces.size())]);
        break;
      case 2:
        text.insert(at, text.substr(below(text.size()), 1 + below(kLongest)));
        break;
      default:
        text.erase(at, 1 + below(kLongest));
    }
  }
  return text;
}

}  // namespace pincer::devices::emulate
