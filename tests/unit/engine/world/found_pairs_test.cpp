// Shapes that stand still are found without a search, and nothing else is.
#include "pincer/engine/world/found_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace pincer::engine {
namespace {

struct Searcher {
  FoundPairs pairs{8};
  int searches = 0;

  // The count of searches is the gap that is found.
  double gapOf(std::uint64_t pair, const PairPlace& place) {
    const auto find = [this](contact::PairPoints& points) {
      points.count = 1;
      points.points[0].phi = ++searches;
    };
    return pairs.pointsOf(pair, place, find).points[0].phi;
  }
};

double nextUp(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }

TEST(FoundPairs, WhatStandsStillIsSearchedForOnce) {
  Searcher searcher;
  const PairPlace place{Pose{}, Pose{}, 1e-3, {Vec3::UnitZ()}};
  EXPECT_EQ(searcher.gapOf(5, place), 1);
  EXPECT_EQ(searcher.gapOf(5, place), 1);
  EXPECT_EQ(searcher.searches, 1);
}

TEST(FoundPairs, WhatMovesByABitIsSearchedForAgain) {
  const PairPlace place{Pose{}, Pose{}, 1e-3, {Vec3::UnitZ()}};
  const std::function<double&(PairPlace&)> numbers[] = {
      [](PairPlace& p) -> double& { return p.X_WA.p.x(); },   [](PairPlace& p) -> double& { return p.X_WA.p.z(); },
      [](PairPlace& p) -> double& { return p.X_WA.q.w(); },   [](PairPlace& p) -> double& { return p.X_WA.q.z(); },
      [](PairPlace& p) -> double& { return p.X_WB.p.y(); },   [](PairPlace& p) -> double& { return p.X_WB.q.x(); },
      [](PairPlace& p) -> double& { return p.X_WB.q.y(); },   [](PairPlace& p) -> double& { return p.margin; },
      [](PairPlace& p) -> double& { return p.last.n_W.x(); }, [](PairPlace& p) -> double& { return p.last.n_W.z(); }};
  for (const auto& number : numbers) {
    Searcher searcher;
    PairPlace moved = place;
    number(moved) = nextUp(number(moved));
    EXPECT_EQ(searcher.gapOf(5, place), 1);
    EXPECT_EQ(searcher.gapOf(5, moved), 2);
    EXPECT_EQ(searcher.gapOf(5, place), 3);
  }
}

TEST(FoundPairs, WhatHadOtherPointsIsSearchedForAgain) {
  for (std::size_t k = 0; k < contact::kMaxPairPoints; ++k) {
    Searcher searcher;
    PairPlace place{Pose{}, Pose{}, 1e-3, {Vec3::UnitZ(), {1, 2, 3, 4, 5, 6, 7, 8}, 8}};
    EXPECT_EQ(searcher.gapOf(5, place), 1);
    place.last.features[k] += 10;
    EXPECT_EQ(searcher.gapOf(5, place), 2) << k;
  }
}

// Zeros of both signs are equal as numbers, and may lead to other bits.
TEST(FoundPairs, AZeroOfTheOtherSignIsSearchedForAgain) {
  Searcher searcher;
  PairPlace place{Pose{}, Pose{}, 1e-3, {Vec3::UnitZ()}};
  searcher.gapOf(5, place);
  place.X_WA.p.x() = -0.0;
  EXPECT_EQ(searcher.gapOf(5, place), 2);
}

TEST(FoundPairs, PairsThatShareAPlaceDontTakeEachOthersPoints) {
  Searcher searcher;
  const PairPlace place{Pose{}, Pose{}, 1e-3, {Vec3::UnitZ()}};
  for (std::uint64_t pair = 0; pair < 100; ++pair) EXPECT_EQ(searcher.gapOf(pair << 32, place), pair + 1.0);
}

// A wall of 200 bricks searched for some of its pairs in every tick, at rest: they shared places.
TEST(FoundPairs, PairsOfAWallAtRestAreSearchedForOnce) {
  Searcher searcher{FoundPairs(3200)};
  const PairPlace place{Pose{}, Pose{}, 1e-3, {Vec3::UnitZ()}};
  for (int tick = 0; tick < 2; ++tick) {
    for (std::uint64_t a = 1; a <= 200; ++a) {
      for (std::uint64_t b = a + 19; b <= a + 21; ++b) searcher.gapOf(a << 47 | b << 32, place);
    }
  }
  EXPECT_EQ(searcher.searches, 600);
}

TEST(FoundPairs, NoMemoryStillAnswers) {
  Searcher searcher{FoundPairs(0)};
  const PairPlace place{Pose{}, Pose{}, 1e-3, {Vec3::UnitZ()}};
  EXPECT_EQ(searcher.gapOf(1, place), 1);
  EXPECT_EQ(searcher.gapOf(2, place), 2);
  EXPECT_EQ(searcher.gapOf(2, place), 2);
}

}  // namespace
}  // namespace pincer::engine
