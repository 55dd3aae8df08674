#include "pincer/tasks/run/files/spelling.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace pincer::tasks {

int editDistance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i) + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

constexpr std::size_t kLongestWord = 64;  // a longer one is no slip of the hand, and the table of distances grows with its square

std::string_view closestWord(std::string_view word, std::span<const std::string_view> candidates) {
  int best = std::clamp(static_cast<int>(word.size()) / 3, 1, 3) + 1;
  std::string_view closest;
  for (const std::string_view candidate : candidates) {
    const std::size_t apart = std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size());
    if (apart >= static_cast<std::size_t>(best) || word.size() > kLongestWord) continue;  // the distance is at least this
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
  constexpr std::size_t kMost = 30;  // names in a scene may be thousands
  const auto shown = candidates.first(std::min(kMost, candidates.size()));
  const std::string more = shown.size() < candidates.size() ? fmt::format(" and {} more", candidates.size() - shown.size()) : "";
  return fmt::format(" Known here: {}{}.", fmt::join(shown, ", "), more);
}

}  // namespace pincer::tasks
