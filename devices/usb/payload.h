// payload: writing and reading the fields of a payload one after the other. Reading checks as it
// goes and remembers whether all was well.
#pragma once
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "pincer/devices/math.h"
#include "pincer/devices/usb/byte_order.h"
#include "pincer/devices/usb/frame.h"

namespace pincer::devices::usb {

class PayloadWriter {
 public:
  explicit PayloadWriter(Payload& bytes) : bytes_(bytes) {}

  template <std::integral T>
  PayloadWriter& put(T value) {
    store(bytes_, at_, value);
    at_ += sizeof(T);
    return *this;
  }
  // `value` in steps of `step`, rounded; what isn't within +-`most` is put as that bound, what is no number as 0.
  template <std::integral T>
  PayloadWriter& putScaled(double value, double step, double most) {
    const double bounded = std::isnan(value) ? 0.0 : std::fmax(-most, std::fmin(most, value));
    return put(static_cast<T>(std::llround(bounded / step)));
  }
  template <int N>
  PayloadWriter& putVector(const Eigen::Matrix<double, N, 1>& v, double step, double most) {
    for (int i = 0; i < N; ++i) putScaled<std::int32_t>(v[i], step, most);
    return *this;
  }
  PayloadWriter& putText(std::string_view text, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      bytes_[at_ + i] = i < text.size() ? static_cast<std::uint8_t>(text[i]) : std::uint8_t{0};
    at_ += size;
    return *this;
  }
  PayloadWriter& putDouble(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return put(bits);
  }

 private:
  Payload& bytes_;
  std::size_t at_ = 0;
};

class PayloadReader {
 public:
  explicit PayloadReader(const Payload& bytes) : bytes_(bytes) {}

  template <std::integral T>
  T take() {
    const T value = load<T>(bytes_, at_);
    at_ += sizeof(T);
    return value;
  }
  template <std::integral T>
  double takeScaled(double step, double least, double most) {
    const double value = static_cast<double>(take<T>()) * step;
    require(value >= least - 0.5 * step && value <= most + 0.5 * step);
    return value;
  }
  template <int N>
  Eigen::Matrix<double, N, 1> takeVector(double step, double most) {
    Eigen::Matrix<double, N, 1> v;
    for (int i = 0; i < N; ++i) v[i] = takeScaled<std::int32_t>(step, -most, most);
    return v;
  }
  // Printable ASCII, padded with zeros to `size`.
  std::string takeText(std::size_t size) {
    std::string text;
    bool ended = false;
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint8_t c = bytes_[at_ + i];
      if (c == 0) ended = true;
      require(c == 0 || (!ended && c >= 0x20 && c < 0x7f));
      if (!ended) text.push_back(static_cast<char>(c));
    }
    at_ += size;
    return text;
  }
  double takeDouble() {
    const auto bits = take<std::uint64_t>();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    require(std::isfinite(value));
    return value;
  }
  void require(bool ok) { ok_ = ok_ && ok; }
  // True if everything was in range, and the rest of the payload is zero.
  bool complete() {
    for (; at_ < bytes_.size(); ++at_) require(bytes_[at_] == 0);
    return ok_;
  }

 private:
  const Payload& bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace pincer::devices::usb
