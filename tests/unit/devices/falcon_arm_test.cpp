// A Novint Falcon that isn't there: loading its firmware, homing, forces. Two threads meet
// in it. (Also run under ThreadSanitizer.)
#include "pincer/devices/falcon/falcon_arm.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>

#include "pincer/tests/support/emulated_falcon.h"

namespace pincer::devices::falcon {
namespace {

class EmulatedPort final : public FalconPort {
 public:
  explicit EmulatedPort(std::size_t image_size, std::string place = "1-2")
      : falcon(image_size), place_(std::move(place)) {}

  std::string place() const override { return place_; }
  bool control(std::uint8_t request, std::uint16_t value) override { return falcon.control(request, value); }
  bool write(std::span<const std::uint8_t> bytes) override {
    if (unplugged) return false;
    falcon.write(bytes);
    return true;
  }
  int read(std::span<std::uint8_t> bytes, int) override {
    return unplugged ? -1 : static_cast<int>(falcon.read(bytes));
  }

  tests::EmulatedFalcon falcon;
  std::atomic<bool> unplugged{false};

 private:
  std::string place_;
};

const std::vector<std::uint8_t> kImage(1000, 0x5a);

bool soon(const std::function<bool()>& condition) {
  for (int i = 0; i < 20000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return condition();
}

TEST(FalconSession, LoadsTheUsersImageAndThenSpeaksWithIt) {
  EmulatedPort port(kImage.size());
  FalconSession session(port);
  EXPECT_EQ(session.start(kImage), "");
  const auto answer = session.exchange({{100, 0, 0}, false, 0});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->counts[0], -150);
  EXPECT_EQ(port.falcon.torque0, 100);
  EXPECT_EQ(session.start({}), "") << "an image that runs isn't asked for again";
}

// A chip with nothing to say yet sends its status alone, and is greeted twice: loading gave up at either.
TEST(FalconSession, LoadsThroughPacketsThatHoldNothingButTheChipsStatus) {
  class Hesitant final : public FalconPort {
   public:
    std::string place() const override { return "1-2"; }
    bool control(std::uint8_t request, std::uint16_t value) override { return falcon.control(request, value); }
    bool write(std::span<const std::uint8_t> bytes) override {
      falcon.write(bytes);
      if (bytes.size() == 3 && bytes[1] == 0x43) falcon.write(bytes);  // an earlier greeting's answer is still to come
      return true;
    }
    int read(std::span<std::uint8_t> bytes, int) override {
      bytes[0] = 0x01, bytes[1] = 0x60;
      return ++reads % 4 != 0 ? 2 : static_cast<int>(falcon.read(bytes));
    }
    tests::EmulatedFalcon falcon{1000};
    int reads = 0;
  };
  Hesitant port;
  FalconSession session(port);
  EXPECT_EQ(session.start(kImage), "");
}

TEST(FalconSession, SaysWhatIsMissingOrWrong) {
  EmulatedPort port(kImage.size());
  FalconSession session(port);
  EXPECT_NE(session.start({}).find("--firmware"), std::string::npos);
  port.falcon.spoils_image = true;
  EXPECT_NE(session.start(kImage).find("didn't take"), std::string::npos);
  port.unplugged = true;
  EXPECT_NE(session.start(kImage).find("greeting"), std::string::npos);
}

TEST(FalconArm, HomesRendersForceAndDropsItWhenNobodyAsksAnyMore) {
  auto owned = std::make_unique<EmulatedPort>(kImage.size());
  EmulatedPort& port = *owned;
  tests::EmulatedFalcon& falcon = port.falcon;
  FalconArm arm(std::move(owned), kImage);
  ASSERT_TRUE(soon([&] { return arm.state() == DeviceState::kReady && arm.sample().valid; }));
  const ArmSample sample = arm.sample();
  EXPECT_NEAR(sample.p_DF.x(), 0, 1e-3) << "equal angles: on the axis";
  EXPECT_NEAR((*inverse(sample.p_DF + Vec3(0, 0, kCentre)))[0], angleOf(-150), 1e-6);
  arm.commandForce(Vec3(0, 0, 2));
  EXPECT_FALSE(soon([&, n = 0]() mutable { return falcon.torque0 != 0 || ++n > 20; }) && falcon.torque0 != 0)
      << "not armed";
  arm.arm();
  ASSERT_TRUE(soon([&] {
    arm.commandForce(Vec3(0, 0, 2));
    return falcon.torque0 != 0;
  }));
  ASSERT_TRUE(soon([&] { return falcon.torque0 == 0; })) << "a force older than 4 ms must end by itself";
  ASSERT_TRUE(soon([&] {
    arm.commandForce(Vec3(0, 0, 2));
    return falcon.torque0 != 0;
  }));
  arm.stop();
  ASSERT_TRUE(soon([&] {
    arm.commandForce(Vec3(0, 0, 2));
    return falcon.torque0 == 0;
  }));
  port.unplugged = true;
  ASSERT_TRUE(soon([&] { return arm.state() == DeviceState::kFaulted; }));
  EXPECT_FALSE(arm.sample().valid);
}

TEST(FalconArm, WithoutItsImageIsRefusedWithItsPlaceAndTheRemedy) {
  try {
    FalconArm arm(std::make_unique<EmulatedPort>(kImage.size(), "3-1.4"), {});
    FAIL() << "a Falcon without firmware was taken";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("3-1.4"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("--firmware"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace pincer::devices::falcon
