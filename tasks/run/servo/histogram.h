// histogram: how often a time took how long, in bins that grow by 1 / 8 octave: 9 % wide,
// from 1 ns to 18 s. Adding allocates nothing.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "pincer/contact/assert.h"
#include "pincer/contact/elementary.h"

namespace pincer::tasks {

class Histogram {
 public:
  void add(double seconds) {
    ++bins_[static_cast<std::size_t>(binOf(seconds))];
    ++count_;
    largest_ = std::max(largest_, seconds);
  }
  void add(const Histogram& other) {
    for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += other.bins_[i];
    count_ += other.count_;
    largest_ = std::max(largest_, other.largest_);
  }
  std::int64_t count() const { return count_; }
  double largest() const { return largest_; }  // [s]

  // Upper edge of the bin in which the share `q` (0 .. 1) is reached [s]; 0 when empty. From 1 ns to 18 s at most 9
  // % above the true quantile (nearest rank).
  double quantile(double q) const {
    PINCER_ASSERT(0 <= q && q <= 1);
    const auto wanted = static_cast<std::int64_t>(std::ceil(q * static_cast<double>(count_)));
    std::int64_t seen = 0;
    for (int i = 0; i < kBins; ++i) {
      seen += bins_[static_cast<std::size_t>(i)];
      if (seen >= wanted && seen > 0) return std::min(largest_, 1e-9 * math::exp2((i + 1) / 8.0));
    }
    return 0;
  }

 private:
  static constexpr int kBins = 8 * 34;  // 8 per octave from 1 ns, 34 octaves: to 17 s, 9 % apart
  static int binOf(double seconds) {
    if (!(seconds > 1e-9)) return 0;
    return static_cast<int>(std::min(kBins - 1.0, 8 * math::log2(seconds * 1e9)));
  }
  std::array<std::int64_t, kBins> bins_{};
  std::int64_t count_ = 0;
  double largest_ = 0;
};

}  // namespace pincer::tasks
