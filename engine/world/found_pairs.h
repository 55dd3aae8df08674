// found_pairs: what two shapes touched at when they were looked at last, for as long as both are where they were then,
// to the bit: what stands still is found without a search. A function's values by its arguments, no more: the answers
// are the same bits with it and without.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "pincer/contact/pair_query.h"

namespace pincer::engine {

// The arguments of contact::collideShapes that change from tick to tick.
struct PairPlace {
  Pose X_WA, X_WB;
  double margin = 0;  // [m]
  contact::LastPoints last{};

  using Numbers = std::array<double, 23>;
  Numbers numbers() const {
    const Quat &a = X_WA.q, &b = X_WB.q;
    const Vec3 &p = X_WA.p, &o = X_WB.p, &n = last.n_W;
    Numbers all{p.x(), p.y(), p.z(), a.w(), a.x(), a.y(), a.z(), o.x(), o.y(),
                o.z(), b.w(), b.x(), b.y(), b.z(), n.x(), n.y(), n.z(), margin};
    static_assert(sizeof last.features == 4 * sizeof(double));
    std::memcpy(&all[18], last.features.data(), sizeof last.features);
    all[22] = last.carrying + 0x1p8 * last.count;
    return all;
  }
};

class FoundPairs {
 public:
  // Memory for some `pairs`; where more than four share a row, some forget each other. None for 0.
  explicit FoundPairs(int pairs);

  // Points of the shapes whose contacts are numbered `pair` (contactId without its feature); find(points) where these
  // aren't known. Valid until the next call.
  template <class Find>
  const contact::PairPoints& pointsOf(std::uint64_t pair, const PairPlace& place, Find find) {
    const std::size_t n = placeOf(pair);
    Entry& entry = entries_[n];
    const PairPlace::Numbers numbers = place.numbers();
    if (pairs_[n] == pair && isSame(entry.numbers, numbers)) return entry.points;
    pairs_[n] = pair;
    entry.numbers = numbers;
    find(entry.points);
    return entry.points;
  }

 private:
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};
  static constexpr std::size_t kRow = 4;  // places for a pair: of one, a third of the pairs of a wall would share it
  struct Entry {
    PairPlace::Numbers numbers;
    contact::PairPoints points;
  };

  static bool isSame(const PairPlace::Numbers& a, const PairPlace::Numbers& b);  // by their bits
  // Where the pair is, or is to be: in its row, in the first place that is free, or in one that its number names.
  std::size_t placeOf(std::uint64_t pair) const;

  std::vector<std::uint64_t> pairs_;  // of `entries_`, apart from them: a row is one line of the cache
  std::vector<Entry> entries_;
  int bits_ = 0;  // 2^bits_ rows
};

}  // namespace pincer::engine
