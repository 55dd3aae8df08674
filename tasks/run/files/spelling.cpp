#include "pincer/tasks/run/files/spelling.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <vector>

namespace pincer::tasks {

// distance(i + 1, j + 1) is that of the first i letters of `a` and the first j
// of `b`; row and column 0 are out of reach.
int editDistance(std::string_view a, std::string_view b) {
  const std::size_t columns = b.size() + 2;
  std::vector<int> table((a.size() + 2) * columns, static_cast<int>(a.size() + b.size()));
  const auto distance = [&](std::size_t i, std::size_t j) -> int& { return table[i * columns + j]; };
  for (std::size_t i = 0; i <= a.size(); ++i) distance(i + 1, 1) = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) distance(1, j + 1) = static_cast<int>(j);
  std::array<std::size_t, 256> last_in_a{};  // the last place of each letter so far, from 1; 0: none
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t last_in_b = 0;  // of a's letter
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t k = last_in_a[static_cast<unsigned char>(b[j - 1])], l = last_in_b;
      const bool same = a[i - 1] == b[j - 1];
      if (same) last_in_b = j;
      const int swapped = distance(k, l) + static_cast<int>((i - k - 1) + 1 + (j - l - 1));
      distance(i + 1, j + 1) =
          std::min({distance(i, j) + (same ? 0 : 1), distance(i + 1, j) + 1, distance(i, j + 1) + 1, swapped});
    }
    last_in_a[static_cast<unsigned char>(a[i - 1])] = i;
  }
  return distance(a.size() + 1, b.size() + 1);
}

// a longer one is no slip of the hand, and the table of distances grows with its square
constexpr std::size_t kLongestWord = 64;

std::string_view closestWord(std::string_view word, std::span<const std::string_view> candidates) {
  int best = std::clamp(static_cast<int>(word.size()) / 3, 1, 3) + 1;
  std::string_view closest;
  for (const std::string_view candidate : candidates) {
    const std::size_t apart = std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size());
    // the distance is at least this
    if (apart >= static_cast<std::size_t>(best) || word.size() > kLongestWord) continue;
    const int distance = editDistance(word, candidate);
    if (distance < best) {
      best = distance;
      closest = candidate;
    }
  }
  return closest;
}

std::string suggestion(std::string_view word, std::span<const std::string_view> candidates) {
  const std::string_view closest = closestWord(word, candidates);
  if (!closest.empty()) return fmt::format(" Did you mean \"{}\"?", closest);
  if (candidates.empty()) return " None is known here.";
  constexpr std::size_t kMost = 30;  // names in a scene may be thousands
  const auto shown = candidates.first(std::min(kMost, candidates.size()));
  const std::string more =
      shown.size() < candidates.size() ? fmt::format(" and {} more", candidates.size() - shown.size()) : "";
  return fmt::format(" Known here: {}{}.", fmt::join(shown, ", "), more);
}

}  // namespace pincer::tasks
