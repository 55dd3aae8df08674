#include "pincer/devices/gate/watchdog.h"

#include <gtest/gtest.h>

#include <thread>

namespace pincer::devices {
namespace {

constexpr std::int64_t kMs = 1000000;

TEST(Watchdog, ExpiresOnceWhenTheLoopIsSilentForLongerThanItsLimit) {
  Watchdog dog(3 * kMs);
  dog.arm(100 * kMs);
  EXPECT_FALSE(dog.check(103 * kMs));
  EXPECT_FALSE(dog.expired());
  EXPECT_TRUE(dog.check(103 * kMs + 1));
  EXPECT_TRUE(dog.expired());
  EXPECT_FALSE(dog.check(110 * kMs)) << "the zero force was commanded already";
}

TEST(Watchdog, StaysCalmWhileItIsFed) {
  Watchdog dog(3 * kMs);
  dog.arm(0);
  for (std::int64_t t = 0; t < 10000 * kMs; t += kMs) {
    dog.feed(t);
    ASSERT_FALSE(dog.check(t + 3 * kMs));
  }
}

TEST(Watchdog, FoodDoesNotClearTheLatchButArmingDoes) {
  Watchdog dog(3 * kMs);
  dog.arm(0);
  ASSERT_TRUE(dog.check(4 * kMs));
  dog.feed(5 * kMs);
  EXPECT_TRUE(dog.expired());
  dog.arm(6 * kMs);
  EXPECT_FALSE(dog.expired());
  EXPECT_FALSE(dog.check(7 * kMs));
  EXPECT_TRUE(dog.check(10 * kMs));
}

TEST(Watchdog, ExpectsNothingBeforeItIsArmedOrWhileItRests) {
  Watchdog dog(3 * kMs);
  EXPECT_FALSE(dog.check(1000 * kMs));
  dog.arm(1000 * kMs);
  dog.rest();
  EXPECT_FALSE(dog.check(2000 * kMs));
  EXPECT_FALSE(dog.expired());
}

// Detection within 5 ms: the limit plus one interval between checks, whatever the phase between loop and watchdog.
TEST(Watchdog, FindsAStallWithinTheLimitAndOneCheck) {
  for (std::int64_t phase = 0; phase < kMs; phase += kMs / 16) {
    Watchdog dog(3 * kMs);
    dog.arm(0);
    dog.feed(7 * kMs);  // the last tick before the stall
    std::int64_t found = 0;
    for (std::int64_t t = 7 * kMs + phase; found == 0; t += 3 * kMs / 4) {
      if (dog.check(t)) found = t;
    }
    EXPECT_LE(found - 7 * kMs, 5 * kMs);
  }
}

// One thread feeds a clock that runs, another checks with the time it last saw: no check may
// come true. (Also run under ThreadSanitizer.)
TEST(Watchdog, TwoThreadsAgree) {
  Watchdog dog(3);
  dog.arm(0);
  std::atomic<std::int64_t> now{0};
  std::thread checker([&] {
    while (now.load() < 200000) EXPECT_FALSE(dog.check(now.load()));
  });
  for (std::int64_t t = 1; t <= 200000; ++t) {
    dog.feed(t);  // food before the clock: a checker that sees time t has food of time t
    now.store(t);
  }
  checker.join();
  EXPECT_FALSE(dog.expired());
}

}  // namespace
}  // namespace pincer::devices
