#include "pincer/tasks/share/columns.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace pincer::tasks {
namespace {

// Codes of 16 bits: 0 to the largest from a column's least to its greatest number; the one above: no number.
constexpr int kLargestCode = 65534;
constexpr std::uint16_t kAbsent = 65535;

struct Scale {
  float low = 0, step = 0;
};

bool isThere(double value) { return std::isfinite(static_cast<float>(value)); }

Scale scaleOf(std::span<const double> values) {
  double low = INFINITY, high = -INFINITY;
  for (const double value : values) {
    if (!isThere(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) return {NAN, 0};
  return {static_cast<float>(low), static_cast<float>((high - low) / kLargestCode)};
}

std::uint16_t codeOf(double value, const Scale& scale) {
  if (!isThere(value)) return kAbsent;
  const double code = (value - static_cast<double>(scale.low)) / static_cast<double>(scale.step);
  return static_cast<std::uint16_t>(std::clamp(code + 0.5, 0.0, static_cast<double>(kLargestCode)));
}

// The bytes of little-endian words, plane by plane: the lowest of all words first.
template <class Word>
void appendPlanes(std::string& bytes, const std::vector<Word>& words) {
  for (std::size_t plane = 0; plane < sizeof(Word); ++plane) {
    for (const Word word : words) bytes.push_back(static_cast<char>(word >> (8 * plane) & 0xff));
  }
}

void appendFloat(std::string& bytes, float value) {
  appendPlanes(bytes, std::vector<std::uint32_t>{std::bit_cast<std::uint32_t>(value)});
}

}  // namespace

void appendColumn(std::string& bytes, std::span<const double> values) {
  Scale scale = scaleOf(values);
  bool some_absent = false;
  for (const double value : values) some_absent |= !isThere(value);
  if (some_absent && std::isfinite(scale.low) && !(scale.step > 0)) scale.step = 1;  // one value, and absent ones
  appendFloat(bytes, scale.low);
  appendFloat(bytes, scale.step);
  if (!(scale.step > 0)) return;
  std::vector<std::uint16_t> words;
  words.reserve(values.size());
  std::uint16_t before = 0;
  for (const double value : values) {
    const std::uint16_t code = codeOf(value, scale);
    words.push_back(static_cast<std::uint16_t>(code - before));
    before = code;
  }
  appendPlanes(bytes, words);
}

void appendIndices(std::string& bytes, std::span<const std::uint32_t> indices) {
  std::vector<std::uint32_t> words;
  words.reserve(indices.size());
  std::uint32_t before = 0;
  for (const std::uint32_t index : indices) {
    words.push_back(index - before);
    before = index;
  }
  appendPlanes(bytes, words);
}

}  // namespace pincer::tasks
