// Whose turn it is: each place's once per period, whatever the ticks are, and few at a time.
#include "pincer/contact/surface/turns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "pincer/tests/support/random_numbers.h"

namespace pincer::contact {
namespace {

constexpr double kPeriod = 2.5e-4;  // [m]
constexpr std::int32_t kPlaces = 200;

// Ticks of all lengths up to a period, of which some stand still, at the beginning of the way and after 10 km of it.
TEST(SurfaceTurns, EachPlaceHasOneTurnPerPeriod) {
  for (const double begin : {0.0, 1e4}) {
    tests::RandomNumbers random(1);
    std::vector<double> last(kPlaces, begin);
    std::vector<int> turns(kPlaces, 0);
    double gone = begin;
    while (gone < begin + 100 * kPeriod) {
      const double to = gone + kPeriod * std::max(0.0, random.uniform(-0.2, 0.9));
      const Turns now(gone, to, kPeriod);
      for (std::int32_t place = 0; place < kPlaces; ++place) {
        const auto i = static_cast<std::size_t>(place);
        const bool is_turn = now.isOf(place);
        ASSERT_FALSE(is_turn && to == gone);
        if (is_turn) ++turns[i];
        // a turn every period, seen at the end of a tick of less than one
        ASSERT_LE(to - last[i], 2 * kPeriod) << place;
        if (is_turn) last[i] = to;
      }
      gone = to;
    }
    const double periods = (gone - begin) / kPeriod;
    for (const int n : turns) ASSERT_NEAR(n, periods, 1);
  }
}

TEST(SurfaceTurns, NoTurnComesBeforeItIsToldFor) {
  constexpr double kRoundedDown = 2e-6 * kPeriod;
  tests::RandomNumbers random(2);
  std::vector<double> told(kPlaces, 0);
  double gone = 3;
  for (int i = 0; i < 2000; ++i) {
    const double to = gone + kPeriod * random.uniform(0, 0.4);
    const Turns now(gone, to, kPeriod);
    for (std::int32_t place = 0; place < kPlaces; ++place) {
      double& next = told[static_cast<std::size_t>(place)];
      ASSERT_EQ(now.isOf(place), gone + now.wayToFirst(place) + kRoundedDown <= to) << place;
      const bool was_told = next > 0, is_over = to >= next + kRoundedDown;
      ASSERT_FALSE(was_told && to < next && now.isOf(place)) << place;
      ASSERT_TRUE(!(was_told && next > gone && is_over) || now.isOf(place)) << place;
      next = to + now.wayToNext(place);
    }
    gone = to;
  }
}

// Of places that follow each other, as those of one part of a tree do.
TEST(SurfaceTurns, TheyDoNotBunch) {
  constexpr int kTicks = 10;  // per period
  for (int i = 0; i < 100; ++i) {
    const Turns now(i * kPeriod / kTicks, (i + 1) * kPeriod / kTicks, kPeriod);
    int count = 0;
    for (std::int32_t place = 1000; place < 1000 + kPlaces; ++place) count += now.isOf(place);
    // multiples of the golden ratio: of random phases one in three is further off
    ASSERT_NEAR(count, kPlaces / kTicks, 3);
  }
}

TEST(SurfaceTurns, AfterAWholePeriodAndWithoutOneItIsEveryones) {
  for (std::int32_t place = 0; place < kPlaces; ++place) {
    ASSERT_TRUE(Turns(0.1, 0.1 + kPeriod, kPeriod).isOf(place));
    ASSERT_TRUE(Turns(0.1, 0.1, 0).isOf(place));
    ASSERT_EQ(Turns(0.1, 0.2, kPeriod).wayToNext(place), 0);
  }
}

}  // namespace
}  // namespace pincer::contact
