// Columns come back: by a decoder that shares no code with the encoder.
#include "pincer/tasks/share/columns.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "pincer/tests/unit/share/page_reader.h"

namespace pincer::tasks {
namespace {

using tests::PageReader;

// Within half a step of the range, and a float's rounding of the lowest value and
// of the step (65534 steps of it at most).
double boundOf(const std::vector<double>& values) {
  double low = INFINITY, high = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) return 0;
  constexpr double kFloat = 6e-8;
  return 0.5 * (high - low) / 65534 + kFloat * (std::abs(low) + (high - low)) + 1e-12 * std::abs(high);
}

RC_GTEST_PROP(Column, ComesBackWithinHalfAStep, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(0, 200);
  const double size = std::pow(10.0, *rc::gen::inRange(-9, 9)), middle = size * *rc::gen::inRange(-1000, 1000);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const int draw = *rc::gen::inRange(-1000000, 1000000);
    values.push_back(draw % 7 == 0 ? NAN : middle + 1e-6 * size * draw);
  }
  std::string bytes;
  appendColumn(bytes, values);
  PageReader reader(bytes);
  const std::vector<double> back = reader.column(count);
  RC_ASSERT(reader.atEnd());
  for (std::size_t i = 0; i < count; ++i) {
    RC_ASSERT(std::isnan(back[i]) == std::isnan(values[i]));
    if (!std::isnan(values[i])) RC_ASSERT(std::abs(back[i] - values[i]) <= boundOf(values));
  }
}

TEST(Column, OfOneValueIsThatValueAndTwoFloats) {
  std::string bytes;
  appendColumn(bytes, std::vector<double>(1000, 0.25));
  EXPECT_EQ(bytes.size(), 8u);
  EXPECT_EQ(PageReader(bytes).column(1000), std::vector<double>(1000, 0.25));
}

TEST(Column, OfOneValueThatIsThereAtTimesKeepsBoth) {
  std::string bytes;
  appendColumn(bytes, std::vector<double>{0.25, NAN, 0.25});
  const std::vector<double> back = PageReader(bytes).column(3);
  EXPECT_EQ(back[0], 0.25);
  EXPECT_TRUE(std::isnan(back[1]));
  EXPECT_EQ(back[2], 0.25);
}

TEST(Column, OfNothingIsAbsent) {
  std::string bytes;
  appendColumn(bytes, std::vector<double>{NAN, INFINITY, 1e300});  // the last one isn't finite as a float
  for (const double value : PageReader(bytes).column(3)) EXPECT_TRUE(std::isnan(value));
}

RC_GTEST_PROP(Column, IndicesComeBack, (const std::vector<std::uint32_t>& indices)) {
  std::string bytes;
  appendIndices(bytes, indices);
  PageReader reader(bytes);
  RC_ASSERT(reader.indices(indices.size()) == indices);
  RC_ASSERT(reader.atEnd());
}

}  // namespace
}  // namespace pincer::tasks
