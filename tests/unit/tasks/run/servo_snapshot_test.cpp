#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "pincer/devices/triple_buffer.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/servo/paced_cycle.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tasks/run/tick/snapshot.h"
#include "pincer/tests/support/allocation_guard.h"

namespace pincer::tasks {
namespace {

struct Numbered {
  long number = 0;
  std::array<long, 64> copies{};
};

// Whatever the two threads do: what the reader sees is whole, and never older than what it has seen.
TEST(TripleBuffer, HandsOverWholeValuesInOrder) {
  devices::TripleBuffer<Numbered> buffer;
  constexpr long kCount = 200000;
  std::thread writer([&] {
    for (long i = 1; i <= kCount; ++i) {
      buffer.writable().number = i;
      buffer.writable().copies.fill(i);
      buffer.publish();
    }
  });
  long last = 0;
  while (last < kCount) {
    if (!buffer.update()) continue;
    const Numbered& seen = buffer.current();
    ASSERT_GT(seen.number, last);
    for (const long copy : seen.copies) ASSERT_EQ(copy, seen.number);
    last = seen.number;
  }
  writer.join();
}

TEST(Snapshot, HoldsWhatTheTickKnowsAndAllocatesNothing) {
  Simulation simulation(readBuiltinScene("pickup"));
  SnapshotChannel channel(Snapshot::sizedFor(simulation.model()));
  for (int i = 0; i < 1500; ++i) simulation.tick();
  const auto report = simulation.tick();
  const auto before = tests::allocationCount();
  captureGrasp(simulation.model(), simulation.state(), simulation.scratch(), report, channel.writable());
  channel.publish();
  EXPECT_EQ(tests::allocationCount(), before);
  ASSERT_TRUE(channel.update());
  const Snapshot& seen = channel.current();
  EXPECT_EQ(seen.tick, 1501);
  EXPECT_EQ(seen.X_WB[1].p, simulation.bodyPose(1).p);
  Vec3 held = Vec3::Zero();
  for (int i = 0; i < seen.contact_count; ++i) {
    const ContactSnapshot& contact = seen.contacts[static_cast<std::size_t>(i)];
    if (contact.finger >= 0) held -= contact.f_W;
  }
  const Vec3 of_fingers = simulation.fingers()[0].f_contact_W + simulation.fingers()[1].f_contact_W;
  EXPECT_LT((held + of_fingers).norm(), 1e-12);  // the same numbers, summed in the same order but for one
}

class CountingCycle final : public ServoCycle {
 public:
  bool tick(double now) override {
    last = now;
    return ++ticks < 100;
  }
  void cutForces() noexcept override {}
  int ticks = 0;
  double last = -1;
};

TEST(PacedCycle, PausesTakesSingleTicksAndSlowsDown) {
  CountingCycle inner;
  PaceControl control;
  PacedCycle paced(inner, control, 1000);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(paced.tick(1e-3 * i));
  EXPECT_EQ(inner.ticks, 10);
  control.paused = true;
  control.single_ticks = 2;
  for (int i = 10; i < 20; ++i) paced.tick(1e-3 * i);
  EXPECT_EQ(inner.ticks, 12);
  EXPECT_EQ(inner.last, 11e-3);  // its own time goes on where it stood
  control.paused = false;
  control.speed = 0.25;
  for (int i = 20; i < 60; ++i) paced.tick(1e-3 * i);
  EXPECT_EQ(inner.ticks, 22);
  control.speed = 1;
  control.linger = true;
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(paced.tick(1));
  EXPECT_EQ(inner.ticks, 100);  // over, and still there to be looked at
  control.stop = true;
  EXPECT_FALSE(paced.tick(2));
}

}  // namespace
}  // namespace pincer::tasks
