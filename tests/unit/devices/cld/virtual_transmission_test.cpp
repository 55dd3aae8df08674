#include "pincer/devices/cld/virtual_transmission.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/constants.h"

namespace pincer::devices {
namespace {

// Travel of what is shown while a slow sine of `amplitude` is wanted.
double travelThrough(const VirtualTransmission& t, double amplitude) {
  TransmissionState state;
  double low = 1, high = -1;
  for (int i = 0; i < 4000; ++i) {
    const double z = transmitted(t, amplitude * std::sin(2 * tests::kPi * i / 1000.0), state);
    if (i < 2000) continue;
    low = std::min(low, z), high = std::max(high, z);
  }
  return high - low;
}

TEST(VirtualTransmission, PassesEverythingUnchangedByDefault) {
  TransmissionState state;
  for (int i = 0; i < 2000; ++i) EXPECT_EQ(transmitted({}, 1e-3 * std::sin(0.1 * i), state), 1e-3 * std::sin(0.1 * i));
}

TEST(VirtualTransmission, TakesItsBacklashFromEveryReversal) {
  for (const double b : {0.0, 0.5e-3, 2e-3}) EXPECT_NEAR(travelThrough({.backlash = b}, 4e-3), 8e-3 - b, 1e-12) << b;
  EXPECT_EQ(travelThrough({.backlash = 2e-3}, 0.99e-3), 0) << "a sine within the play must not move it";
}

TEST(VirtualTransmission, DelaysByExactlyItsCells) {
  for (const int n : {0, 1, 7, 61, kMaxDelayCells}) {
    TransmissionState state;
    const VirtualTransmission t{.delay = n};
    for (int i = 0; i < 2000; ++i)
      EXPECT_EQ(transmitted(t, i, state), std::max(0, i - n)) << "delay " << n << ", call " << i;
  }
}

TEST(VirtualTransmission, FrozenKeepsWhatItShowedAndGoesOnWhereItWouldBe) {
  TransmissionState state, free;
  const VirtualTransmission t{.backlash = 1e-3, .delay = 5};
  for (int i = 0; i < 100; ++i) transmitted(t, 1e-4 * i, state), transmitted(t, 1e-4 * i, free);
  const double before = state.shown;
  for (int i = 100; i < 200; ++i) {
    EXPECT_EQ(transmitted({.backlash = 1e-3, .delay = 5, .frozen = true}, 1e-4 * i, state), before);
    transmitted(t, 1e-4 * i, free);
  }
  EXPECT_EQ(transmitted(t, 0.02, state), transmitted(t, 0.02, free));
}

TEST(VirtualTransmission, IgnoresWhatIsNotANumber) {
  TransmissionState state;
  transmitted({}, 1e-3, state);
  EXPECT_EQ(transmitted({}, tests::kNan, state), 1e-3);
  EXPECT_EQ(transmitted({}, 2e-3, state), 2e-3);
}

TEST(VirtualTransmission, NamesWhatIsOutOfRange) {
  EXPECT_FALSE(problemWith(VirtualTransmission{.backlash = 2e-3, .delay = 61}));
  EXPECT_NE(problemWith(VirtualTransmission{.backlash = -1}).value().find("backlash = -1"), std::string::npos);
  EXPECT_NE(problemWith(VirtualTransmission{.backlash = tests::kNan}).value().find("backlash"), std::string::npos);
  EXPECT_NE(problemWith(VirtualTransmission{.delay = -1}).value().find("delay = -1"), std::string::npos);
  EXPECT_NE(problemWith(VirtualTransmission{.delay = 513}).value().find("delay = 513"), std::string::npos);
}

TEST(VirtualTransmission, AllocatesNothing) {
  if (!tests::allocationsAreCounted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  TransmissionState state;
  const auto before = tests::allocationCount();
  for (int i = 0; i < 100; ++i) transmitted({.backlash = 1e-3, .delay = 60}, 1e-4 * i, state);
  EXPECT_EQ(tests::allocationCount(), before);
}

}  // namespace
}  // namespace pincer::devices
