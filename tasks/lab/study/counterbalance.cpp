#include "pincer/tasks/lab/study/counterbalance.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {

std::vector<Order> carryOverSquare(int n) {
  PINCER_ASSERT(n >= 1);
  Order first(static_cast<std::size_t>(n));
  for (int place = 0; place < n; ++place)
    first[static_cast<std::size_t>(place)] = place % 2 ? (place + 1) / 2 : (n - place / 2) % n;
  std::vector<Order> rows;
  for (int k = 0; k < n; ++k) {
    rows.push_back(first);
    for (int& condition : rows.back()) condition = (condition + k) % n;
  }
  if (n % 2 == 0 || n == 1) return rows;
  for (int k = 0; k < n; ++k) {
    Order mirrored = rows[static_cast<std::size_t>(k)];
    std::reverse(mirrored.begin(), mirrored.end());
    rows.push_back(std::move(mirrored));
  }
  return rows;
}

std::vector<Order> reducedLatinSquare(int n) {
  PINCER_ASSERT(n >= 1);
  std::vector<Order> rows(static_cast<std::size_t>(n), Order(static_cast<std::size_t>(n)));
  for (int k = 0; k < n; ++k) {
    for (int place = 0; place < n; ++place)
      rows[static_cast<std::size_t>(k)][static_cast<std::size_t>(place)] = (k + place) % n;
  }
  return rows;
}

}  // namespace pincer::tasks
