// The driver against the emulated service over real sockets: forces come when asked
// for, and end whatever happens on the wire.
#include "pincer/devices/haply/haply_host.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "pincer/devices/emulate/haply_server.h"
#include "pincer/devices/haply/silence.h"
#include "pincer/devices/usb/usb_bus.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/error_of.h"

namespace pincer::devices::haply {
namespace {

using emulate::HaplyFault;
using emulate::HaplyServer;
using emulate::HaplyServiceSettings;

// Until it is true, a time that no busy machine needs.
bool comesTrue(const std::function<bool()>& condition) {
  for (int i = 0; i < 10000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return condition();
}

HaplyHostOptions bothArmsAt(const HaplyServer& server) {
  HaplyHostOptions options;
  options.service = *servicePlaceOf(server.place());
  options.arms = {{.id = "049D", .grip = "1605", .frame = {}}, {.id = "04BA", .grip = "1606", .frame = {}}};
  return options;
}

std::string refusalOf(const HaplyServer& server, const HaplyHostOptions& options) {
  (void)server;
  try {
    HaplyHost host(options);
    host.waitReady(10);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

// The strongest force that each arm of a service had. A wish lives for 4 ms: on a busy machine whoever looks at the
// force of now may look again and again at one that has ended.
class Strongest {
 public:
  // For HaplyServer, which it has to outlive.
  std::function<void(emulate::HaplyService&)> watch() {
    return [this](emulate::HaplyService& service) {
      const std::lock_guard lock(one_);
      for (std::size_t i = 0; i < service.arms(); ++i) {
        const Vec3 f_D = service.plant(i).force_D();
        if (f_D.norm() > f_D_[i].norm()) f_D_[i] = f_D;
      }
    };
  }
  Vec3 force_D(std::size_t arm) {
    const std::lock_guard lock(one_);
    return f_D_[arm];
  }
  bool pushed(std::size_t arm) { return force_D(arm).norm() > 0.99; }

 private:
  std::mutex one_;
  std::array<Vec3, 2> f_D_{Vec3::Zero(), Vec3::Zero()};
};

// Pushes with both arms as a servo does, until `condition`.
bool pushUntil(HaplyHost& host, const Vec3& f_D, const std::function<bool()>& condition) {
  return comesTrue([&] {
    for (std::size_t i = 0; i < host.arms(); ++i) host.arm(i).commandForce(f_D);
    return condition();
  });
}

void armBoth(HaplyHost& host) {
  for (std::size_t i = 0; i < host.arms(); ++i) host.arm(i).arm();
}

TEST(HaplyPort, TakesPlacesOnThisComputerOnly) {
  EXPECT_EQ(servicePlaceOf("127.0.0.1:10001")->port, 10001);
  EXPECT_EQ(servicePlaceOf("localhost:5:7")->events_port, 7);
  for (const char* text : {"", "10001", "192.168.0.3:10001", "localhost:", "localhost:0", "localhost:70000",
                           "localhost:1:", "localhost:1x"})
    EXPECT_FALSE(servicePlaceOf(text)) << text;
}

TEST(HaplyHost, MovesAndPushesTwoArms) {
  Strongest strongest;
  HaplyServer server({}, 0, 0, strongest.watch());
  HaplyHost host(bothArmsAt(server));
  host.waitReady(10);
  const ArmSample sample = host.arm(0).sample();
  ASSERT_TRUE(sample.valid && sample.q_DF && sample.v_DF);
  EXPECT_LT(sample.p_DF.norm(), 2e-3) << "at its reset place";
  const double age = 1e-9 * static_cast<double>(usb::monotonicNs()) - sample.time;
  EXPECT_GT(age, 0);
  armBoth(host);
  EXPECT_TRUE(pushUntil(host, Vec3(0, 0, 1), [&] { return strongest.pushed(0) && strongest.pushed(1); }))
      << host.complaint();
  EXPECT_LT((strongest.force_D(0) - Vec3(0, 0, 1)).norm(), 1e-5) << "in the arm's own frame";
  host.arm(0).stop();
  EXPECT_TRUE(pushUntil(host, Vec3(0, 0, 1), [&] { return server.force(0) == 0; }));
  EXPECT_TRUE(comesTrue([&] { return server.force(1) == 0; })) << "a force older than 4 ms ends by itself";
}

TEST(HaplyHost, AllocatesNothingInTheTick) {
  HaplyServer server;
  HaplyHost host(bothArmsAt(server));
  host.waitReady(10);
  armBoth(host);
  const std::int64_t before = pincer::tests::allocationCount();
  int valid = 0;
  for (int i = 0; i < 100; ++i) {
    for (std::size_t arm = 0; arm < host.arms(); ++arm) {
      valid += host.arm(arm).sample().valid ? 1 : 0;
      host.arm(arm).commandForce(Vec3(0, 0, 0.1));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  for (std::size_t arm = 0; arm < host.arms(); ++arm) host.arm(arm).stop();
  EXPECT_EQ(pincer::tests::allocationCount(), before);
  EXPECT_GT(valid, 0);
}

TEST(HaplyHost, LeavesAfterAnsweredZerosEvenWhereTheServiceKeepsForcesForEver) {
  HaplyServiceSettings settings;
  for (auto& arm : settings.arms) arm.dead_man = emulate::DeadMan::kKeepsForEver;
  Strongest strongest;
  HaplyServer server(settings, 0, 0, strongest.watch());
  {
    HaplyHost host(bothArmsAt(server));
    host.waitReady(10);
    armBoth(host);
    ASSERT_TRUE(pushUntil(host, Vec3(0, 0, 1), [&] { return strongest.pushed(0) && strongest.pushed(1); }))
        << host.complaint();
  }
  EXPECT_EQ(server.force(0), 0);
  EXPECT_EQ(server.force(1), 0);
  EXPECT_TRUE(comesTrue([&] { return server.connections() == 0; }));
}

// On the wire, while both arms push.
TEST(HaplyHost, EveryFaultOfTheWireEndsInZeroOrIsHarmless) {
  for (const HaplyFault fault : {HaplyFault::kPieces, HaplyFault::kFragments, HaplyFault::kPings}) {
    Strongest strongest;
    HaplyServer server({}, 0, 0, strongest.watch());
    HaplyHost host(bothArmsAt(server));
    host.waitReady(10);
    server.setFault(fault);
    armBoth(host);
    EXPECT_TRUE(pushUntil(host, Vec3(0, 0, 1), [&] { return strongest.pushed(0); }))
        << nameOf(fault) << host.complaint();
  }
  for (const HaplyFault fault :
       {HaplyFault::kNoUtf8, HaplyFault::kTooLong, HaplyFault::kHugeHeader, HaplyFault::kReset, HaplyFault::kHalfOpen,
        HaplyFault::kLate, HaplyFault::kNever, HaplyFault::kEventsClosed, HaplyFault::kStall}) {
    Strongest strongest;
    HaplyServer server({}, 0, 0, strongest.watch());
    server.setDelay(std::chrono::milliseconds(500));
    HaplyHost host(bothArmsAt(server));
    host.waitReady(10);
    armBoth(host);
    ASSERT_TRUE(pushUntil(host, Vec3(0, 0, 1), [&] { return strongest.pushed(0); }))
        << nameOf(fault) << host.complaint();
    server.setFault(fault);
    EXPECT_TRUE(pushUntil(host, Vec3(0, 0, 1), [&] { return !host.arm(0).sample().valid && server.force(0) == 0; }))
        << nameOf(fault);
    EXPECT_GT(host.complaint().size(), 40u) << nameOf(fault);
  }
}

TEST(HaplyHost, StreamsAgainAfterALossOnlyOnceUnarmed) {
  Strongest strongest;
  HaplyServer server({}, 0, 0, strongest.watch());
  HaplyHost host(bothArmsAt(server));
  host.waitReady(10);
  armBoth(host);
  server.setFault(HaplyFault::kReset);
  ASSERT_TRUE(comesTrue([&] { return host.arm(0).state() == DeviceState::kFaulted; }));
  server.setFault(HaplyFault::kNone);
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  EXPECT_EQ(host.arm(0).state(), DeviceState::kFaulted) << "armed: somebody may be in it";
  for (std::size_t i = 0; i < 2; ++i) host.arm(i).stop();
  ASSERT_TRUE(comesTrue(
      [&] { return host.arm(0).state() == DeviceState::kReady && host.arm(1).state() == DeviceState::kReady; }));
  EXPECT_TRUE(host.arm(0).sample().valid);
  armBoth(host);
  EXPECT_TRUE(pushUntil(host, Vec3(0, 0, 1), [&] { return strongest.pushed(0); })) << host.complaint();
}

TEST(HaplyHost, NamesWhyAServiceIsRefused) {
  HaplyHostOptions nobody;
  std::string scaled, old, other;
  {
    HaplyServer server({.force_scale = 0.5});
    nobody = bothArmsAt(server);
    scaled = refusalOf(server, nobody);
    HaplyServer before({.minor = 0});
    old = refusalOf(before, bothArmsAt(before));
    HaplyServer one;
    HaplyHostOptions third = bothArmsAt(one);
    third.arms[0].id = "04XX";
    other = refusalOf(one, third);
    EXPECT_NE(refusalOf(server, nobody).find("0.5"), std::string::npos);
    EXPECT_NE(refusalOf(one, nobody), "") << "no service of that scale";
  }
  EXPECT_NE(scaled.find("force_scale"), std::string::npos) << scaled;
  EXPECT_NE(old.find("3.0"), std::string::npos) << old;
  EXPECT_NE(other.find("04XX"), std::string::npos) << other;
  try {
    HaplyHost host(nobody);
    ADD_FAILURE() << "nobody is there";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("systemctl start"), std::string::npos) << error.what();
  }
}

// Descriptors and threads: each connection gives back what it took.
TEST(HaplyHost, LeavesNothingBehindWhenItEnds) {
  HaplyServer server;
  const auto descriptors = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator{});
  };
  std::ptrdiff_t before = 0;
  for (int i = 0; i < 5; ++i) {
    { HaplyHost host(bothArmsAt(server)); }
    ASSERT_TRUE(comesTrue([&] { return server.connections() == 0; }));
    if (i == 0) before = descriptors();
  }
  EXPECT_EQ(descriptors(), before);
}

// When the arm lets go isn't documented: all three ways are told apart.
TEST(HaplySilence, TellsWhenAnArmLetsGo) {
  const std::atomic<bool> never{false};
  const auto finding = [&](emulate::DeadMan dead_man, Ending ending) {
    HaplyServiceSettings settings;
    for (auto& arm : settings.arms) arm.dead_man = dead_man;
    HaplyServer server(settings);
    const SilenceFinding found = measureSilence(*servicePlaceOf(server.place()), "049D", {3, 5}, ending, never);
    EXPECT_EQ(server.force(0), 0) << "afterwards";
    return found;
  };
  const SilenceFinding idle = finding(emulate::DeadMan::kIdleAfter, Ending::kSilence);
  EXPECT_TRUE(idle.went_idle);
  EXPECT_GE(idle.seconds, 0.09) << "it is 0.1 s";
  EXPECT_FALSE(finding(emulate::DeadMan::kKeepsForEver, Ending::kSilence).went_idle);
  EXPECT_FALSE(finding(emulate::DeadMan::kKeepsForEver, Ending::kClose).went_idle);
  EXPECT_FALSE(finding(emulate::DeadMan::kZeroOnClose, Ending::kSilence).went_idle);
  EXPECT_TRUE(finding(emulate::DeadMan::kZeroOnClose, Ending::kClose).went_idle);
}

// Nor is it documented that a second session may look at an arm that is in use: then it
// can't be measured, and the push ends at once.
TEST(HaplySilence, EndsWhereASecondSessionIsToldNothing) {
  HaplyServiceSettings settings;
  settings.tells_others = false;
  for (auto& arm : settings.arms) arm.dead_man = emulate::DeadMan::kKeepsForEver;
  HaplyServer server(settings);
  const std::atomic<bool> never{false};
  const std::string error = tests::problemOf([&] {
    measureSilence(*servicePlaceOf(server.place()), "049D", {3, 5}, Ending::kSilence, never);
  });
  EXPECT_NE(error.find("tells a second session nothing"), std::string::npos) << error;
  EXPECT_EQ(server.force(0), 0);
}

TEST(HaplyMap, IsTheEmulatorsOwnMapping) {
  for (const double turn : {0.0, 0.4, -1.5707963267948966, 3.0}) {
    emulate::HaplyPlant plant({.centre_H = Vec3(0.01, -0.2, 0.1), .turn = turn});
    const HaplyMap map({.centre_H = Vec3(0.01, -0.2, 0.1), .mount_turn = turn, .q_align = Quat::Identity()});
    EXPECT_LT((map.place(plant.place_H()) - plant.arm().sample().p_DF).norm(), 1e-7);
    plant.command(map.force(Vec3(0.3, -0.5, 0.7)));
    EXPECT_LT((plant.force_D() - Vec3(0.3, -0.5, 0.7)).norm(), 1e-9);
    const Quat grip(0.5, 0.5, -0.5, 0.5);
    plant.arm().setGimbal(grip);
    plant.advance(1e-3);
    EXPECT_LT(map.turn(plant.grip_H()).angularDistance(grip), 1e-7);
  }
}

}  // namespace
}  // namespace pincer::devices::haply
