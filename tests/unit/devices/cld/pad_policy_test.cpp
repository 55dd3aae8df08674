#include "pincer/devices/cld/pad_policy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::devices {
namespace {

using tests::kNan;

const PadPolicy kPolicy;

// Where the policy settles: a second at 1 kHz is ten times the longest glide on a pad.
Vec2 settled(const PadInput& in, PadState state = {}) {
  TactileCommand command;
  for (int i = 0; i < 1000; ++i) command = padCommand(kPolicy, in, 1e-3, state);
  return command.place_L;
}

PadInput touching(std::initializer_list<PadContact> contacts) {
  PadInput in;
  for (const PadContact& c : contacts) in.contacts[in.contact_count++] = c;
  return in;
}

TEST(PadPolicy, IsCentredWithoutAnObject) {
  EXPECT_EQ(settled({}, {Vec2(0.005, 0.002), PadMode::kContact}), Vec2(0, 0));
}

TEST(PadPolicy, ShowsTheContactPlace) {
  EXPECT_EQ(settled(touching({{Vec2(0.004, -0.003), 0.7}})), Vec2(0.004, -0.003));
}

TEST(PadPolicy, ShowsTheMeanOfSeveralContactsWeightedByForce) {
  const Vec2 place = settled(touching({{Vec2(0.004, 0), 3}, {Vec2(0, 0.008), 1}}));
  EXPECT_LE((place - Vec2(0.003, 0.002)).norm(), 1e-17);  // an ulp
}

TEST(PadPolicy, WaitsWhereContactWillBegin) {
  PadInput in;
  in.nearest = NearestPoint{Vec2(0.002, 0.006), 0.0299};
  EXPECT_EQ(settled(in), Vec2(0.002, 0.006));
  in.nearest->distance = 0.0301;
  EXPECT_EQ(settled(in), Vec2(0, 0));
}

TEST(PadPolicy, PrefersContactToTheNearestPoint) {
  PadInput in = touching({{Vec2(0.004, 0), 1}});
  in.nearest = NearestPoint{Vec2(-0.004, 0), 0};
  EXPECT_EQ(settled(in), Vec2(0.004, 0));
}

TEST(PadPolicy, ParkedIsCentredWhateverHappens) {
  PadInput in = touching({{Vec2(0.004, 0), 1}});
  in.parked = true;
  PadState state;
  EXPECT_TRUE(padCommand(kPolicy, in, 1e-3, state).parked);
  EXPECT_EQ(state.mode, PadMode::kParked);
  EXPECT_EQ(settled(in), Vec2(0, 0));
}

TEST(PadPolicy, DisregardsContactsWithoutMeaning) {
  const PadInput in = touching({{Vec2(kNan, 0), 1}, {Vec2(0.001, 0), kNan}, {Vec2(0.002, 0), 0}, {Vec2(0.003, 0), -1}});
  PadState state;
  EXPECT_EQ(padCommand(kPolicy, in, 1e-3, state).place_L, Vec2(0, 0));
  EXPECT_EQ(state.mode, PadMode::kCentre);
  PadInput near;
  near.nearest = NearestPoint{Vec2(0, kNan), 0.01};
  EXPECT_EQ(settled(near), Vec2(0, 0));
  near.nearest = NearestPoint{Vec2(0.001, 0), kNan};
  EXPECT_EQ(settled(near), Vec2(0, 0));
  EXPECT_EQ(settled(touching({{Vec2(0.001, 0), 1e308}, {Vec2(0.003, 0), 1e308}})), Vec2(0.002, 0));
}

TEST(PadPolicy, GlidesFromOneModeToTheNext) {
  tests::RandomNumbers draw(1);
  PadState state;
  for (int i = 0; i < 100000; ++i) {
    PadInput in = touching({{Vec2{draw.uniform(-0.01, 0.01), draw.uniform(-0.01, 0.01)}, draw.uniform(-1, 1)}});
    if (draw.below(2) == 0) in.nearest = NearestPoint{Vec2(draw.uniform(-0.01, 0.01), 0), draw.uniform(0, 0.06)};
    in.parked = draw.below(10) == 0;
    const Vec2 before = state.place_L;
    const Vec2 after = padCommand(kPolicy, in, 1e-3, state).place_L;
    ASSERT_LE((after - before).norm(), kPolicy.speed * 1e-3 * (1 + 1e-12));  // rounding of one subtraction
  }
}

}  // namespace
}  // namespace pincer::devices
