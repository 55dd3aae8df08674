#include <gtest/gtest.h>

#include <thread>

#include "pincer/tasks/run/session/ring.h"

namespace pincer::tasks {
namespace {

SampleRecord numbered(std::int64_t tick) {
  SampleRecord s;
  s.tick = tick;
  s.fingers[1].flags = static_cast<std::int32_t>(tick % 1000);  // the record's far end, to notice a torn copy
  return s;
}

TEST(SampleRing, RefusesACapacityThatIsNoPowerOfTwo) {
  EXPECT_THROW(SampleRing(0), InputError);
  EXPECT_THROW(SampleRing(1), InputError);
  EXPECT_THROW(SampleRing(1000), InputError);
  EXPECT_EQ(SampleRing(1024).capacity(), 1024u);
}

TEST(SampleRing, GivesBackInOrderAndCountsWhatDidNotFit) {
  SampleRing ring(4);
  for (int k = 0; k < 4; ++k) EXPECT_TRUE(ring.push(numbered(k)));
  EXPECT_TRUE(ring.full());
  EXPECT_FALSE(ring.push(numbered(4)));
  EXPECT_FALSE(ring.push(numbered(5)));
  EXPECT_EQ(ring.dropped(), 2u);
  std::int64_t expected = 0;
  EXPECT_EQ(ring.drain([&](const SampleRecord& s) { EXPECT_EQ(s.tick, expected++); }), 4u);
  EXPECT_FALSE(ring.full());
  EXPECT_EQ(ring.drain([](const SampleRecord&) { FAIL() << "the ring is empty"; }), 0u);
}

TEST(SampleRing, GoesOnBeyondItsCapacity) {
  SampleRing ring(2);
  std::int64_t taken = 0;
  for (int k = 0; k < 1001; ++k) {
    ASSERT_TRUE(ring.push(numbered(k)));
    ring.drain([&](const SampleRecord& s) { ASSERT_EQ(s.tick, taken++); });
  }
  EXPECT_EQ(taken, 1001);
}

// A throwing consumer keeps the samples that it had not finished.
TEST(SampleRing, KeepsASampleWhoseTakerThrew) {
  SampleRing ring(4);
  ring.push(numbered(0));
  ring.push(numbered(1));
  EXPECT_THROW(ring.drain([](const SampleRecord& s) {
    if (s.tick == 1) throw InputError("disk full");
  }),
               InputError);
  std::int64_t seen = -1;
  EXPECT_EQ(ring.drain([&](const SampleRecord& s) { seen = s.tick; }), 1u);
  EXPECT_EQ(seen, 1);
}

// Whatever the interleaving: what arrives is in order and whole, and pushed = taken + dropped.
TEST(SampleRing, LosesNothingSilentlyBetweenTwoThreads) {
  constexpr std::int64_t kPushes = 200'000;
  SampleRing ring(64);
  std::atomic<bool> over{false};
  std::int64_t last = -1, taken = 0, torn = 0, disordered = 0;
  std::thread consumer([&] {
    const auto take = [&](const SampleRecord& s) {
      torn += s.fingers[1].flags != s.tick % 1000;
      disordered += s.tick <= last;
      last = s.tick;
      ++taken;
    };
    while (!over.load()) {
      if (ring.drain(take) == 0) std::this_thread::yield();
    }
    ring.drain(take);
  });
  for (std::int64_t k = 0; k < kPushes; ++k) {
    if (ring.full()) std::this_thread::yield();  // else nearly all would be drops
    ring.push(numbered(k));
  }
  over = true;
  consumer.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(disordered, 0);
  EXPECT_GT(taken, kPushes / 100);
  EXPECT_EQ(taken + static_cast<std::int64_t>(ring.dropped()), kPushes);
}

}  // namespace
}  // namespace pincer::tasks
