// union_find: which of n things belong together, after pairs of them have been joined.
//
// The representative of a set is its smallest member, so the result doesn't depend on the order of joining.
// Source: R. E. Tarjan, J. ACM 22(2), 1975; path halving, no ranks (log n per operation).
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "pincer/contact/assert.h"

namespace pincer::contact {

class UnionFind {
 public:
  explicit UnionFind(std::size_t n) {
    parent_.reserve(n);
    for (std::size_t i = 0; i < n; ++i) parent_.push_back(static_cast<std::int32_t>(i));
  }

  std::int32_t find(std::int32_t i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = find(a);
    b = find(b);
    if (a > b) std::swap(a, b);
    parent(b) = a;
  }
  int sets() {
    int n = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) n += parent_[i] == static_cast<std::int32_t>(i);
    return n;
  }

 private:
  std::int32_t& parent(std::int32_t i) {
    PINCER_ASSERT(i >= 0 && static_cast<std::size_t>(i) < parent_.size());
    return parent_[static_cast<std::size_t>(i)];
  }
  std::vector<std::int32_t> parent_;
};

}  // namespace pincer::contact
