// page_reader: the data of a page (tasks/share/columns.h, web_page.h) read in order.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pincer::tests {

class PageReader {
 public:
  explicit PageReader(std::string bytes) : bytes_(std::move(bytes)) {}

  float number() {
    float value = 0;
    std::memcpy(&value, take(4), 4);  // little-endian, as are all machines that pincer runs on
    return value;
  }

  std::vector<double> column(std::size_t count) {
    const double low = static_cast<double>(number()), step = static_cast<double>(number());
    std::vector<double> values(count, low);
    if (!(step > 0)) return values;
    const auto* planes = reinterpret_cast<const unsigned char*>(take(2 * count));
    std::uint32_t code = 0;
    for (std::size_t i = 0; i < count; ++i) {
      code = (code + planes[i] + 256u * planes[count + i]) & 0xffff;
      values[i] = code == 0xffff ? NAN : low + step * code;
    }
    return values;
  }

  std::vector<std::uint32_t> indices(std::size_t count) {
    const auto* planes = reinterpret_cast<const unsigned char*>(take(4 * count));
    std::vector<std::uint32_t> values;
    std::uint32_t index = 0;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t plane = 0; plane < 4; ++plane)
        index += static_cast<std::uint32_t>(planes[plane * count + i]) << (8 * plane);
      values.push_back(index);
    }
    return values;
  }

  bool atEnd() const { return at_ == bytes_.size(); }

 private:
  const char* take(std::size_t count) {
    if (bytes_.size() - at_ < count) throw std::runtime_error("the page's data ends too early");
    at_ += count;
    return bytes_.data() + at_ - count;
  }

  std::string bytes_;
  std::size_t at_ = 0;
};

}  // namespace pincer::tests
