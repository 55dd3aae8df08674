#include "pincer/engine/world/found_pairs.h"

#include <bit>
#include <cstring>

namespace pincer::engine {

FoundPairs::FoundPairs(int pairs) {
  if (pairs > 0) bits_ = static_cast<int>(std::bit_width(static_cast<unsigned>(pairs) / kRow));
  entries_.resize(kRow << bits_);
  pairs_.resize(entries_.size(), kNone);
}

bool FoundPairs::isSame(const PairPlace::Numbers& a, const PairPlace::Numbers& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

std::size_t FoundPairs::placeOf(std::uint64_t pair) const {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15;  // 2^64 over the golden ratio: Knuth, vol. 3, section 6.4
  const std::uint64_t spread = pair * kGolden;
  const std::size_t row = bits_ == 0 ? 0 : kRow * static_cast<std::size_t>(spread >> (64 - bits_));
  for (std::size_t n = row; n < row + kRow; ++n) {
    if (pairs_[n] == pair) return n;
  }
  for (std::size_t n = row; n < row + kRow; ++n) {
    if (pairs_[n] == kNone) return n;
  }
  return row + static_cast<std::size_t>(spread >> 32) % kRow;
}

}  // namespace pincer::engine
