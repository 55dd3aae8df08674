// choices: a fuzzer's bytes as a source of decisions. When they are used up, every decision is
// the first one, so that what is drawn ends.
#pragma once
#include <cstddef>
#include <cstdint>

#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {

class Choices {
 public:
  explicit Choices(Bytes bytes) : bytes_(bytes) {}

  bool empty() const { return at_ == bytes_.size(); }
  std::uint8_t byte() { return empty() ? 0 : bytes_[at_++]; }
  // In [0, n); n >= 1.
  std::size_t below(std::size_t n) {
    std::size_t value = byte();
    if (n > 256) value = 256 * value + byte();
    return value % n;
  }
  // The next bytes, as many as there are.
  Bytes take(std::size_t n) {
    const Bytes taken = bytes_.subspan(at_, n < bytes_.size() - at_ ? n : bytes_.size() - at_);
    at_ += taken.size();
    return taken;
  }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
};

}  // namespace pincer::fuzz
