// A Novint Falcon that isn't there: its FTDI chip, its loader, its firmware and its three motors.
#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <functional>
#include <stdexcept>
#include <thread>

#include "devices/falcon/falcon_arm.h"
#include "tests/support/constants.h"
#include "tests/support/random_numbers.h"

namespace pincer::devices::falcon {
namespace {

Vec3 drawPlace(tests::RandomNumbers& draw) {
  return {draw.uniform(-0.04, 0.04), draw.uniform(-0.04, 0.04), kCentre + draw.uniform(-0.035, 0.035)};
}

TEST(FalconKinematics, ForwardUndoesInverseOverTheWorkspace) {
  tests::RandomNumbers draw(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = drawPlace(draw);
    const auto angles = inverse(p);
    ASSERT_TRUE(angles) << p.transpose();
    const auto back = forward(*angles);
    ASSERT_TRUE(back) << p.transpose();
    EXPECT_NEAR((*back - p).norm(), 0, 1e-9);  // where Newton's method stops
  }
}

// The shin is as long as it is: the leg's joints, placed by their angles, are a shin apart.
TEST(FalconKinematics, LegsCloseAtTheGrip) {
  const Geometry g;
  const Vec3 p(0.01, -0.02, 0.13);
  const Vec3 angles = *inverse(p);
  const double phi = 105 * 3.14159265358979 / 180;
  const Vec3 P(std::cos(phi) * p.x() + std::sin(phi) * p.y() - g.r, -std::sin(phi) * p.x() + std::cos(phi) * p.y() - g.s, p.z());
  const double t = angles[0];
  const double in_plane = std::hypot(P.x() + g.c - g.a * std::cos(t), P.z() - g.a * std::sin(t)) - g.d - g.e;
  EXPECT_NEAR(std::hypot(in_plane, P.y() + g.f), g.b, 1e-12);
  EXPECT_GT(std::cos(t), 0) << "the knee bends outward";
}

TEST(FalconKinematics, JacobianIsTheDerivativeOfTheForwardKinematics) {
  tests::RandomNumbers draw(2);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = drawPlace(draw);
    const Vec3 angles = *inverse(p);
    const auto J = jacobian(p, angles);
    ASSERT_TRUE(J);
    for (int k = 0; k < 3; ++k) {
      const Vec3 h = 1e-5 * Vec3::Unit(k);
      const Vec3 slope = (*forward(angles + h, p) - *forward(angles - h, p)) / 2e-5;
      EXPECT_NEAR((slope - J->col(k)).norm(), 0, 2e-4) << "1 nm of the forward kinematics over 20 urad";
    }
  }
}

TEST(FalconKinematics, SaysWhatItCantReach) {
  EXPECT_FALSE(inverse(Vec3(0, 0, 0.5)));
  EXPECT_FALSE(inverse(Vec3(0, 0.3, 0.12)));
  EXPECT_FALSE(forward(Vec3(0.6, 0.6, tests::kNan)));
}

TEST(FalconKinematics, AnEncodersCountIsATwentyEighthOfADegree) {
  EXPECT_NEAR(angleOf(0), 35 * 3.14159265358979 / 180, 1e-9);
  EXPECT_NEAR((angleOf(1000) - angleOf(0)) * 180 / 3.14159265358979, 36.43, 0.01);
  EXPECT_EQ(countOf(angleOf(-321)), -321);
}

// libnifalcon's documentation: 1447 arrives as "JFKP" negated; here both ways by hand.
TEST(FalconPacket, NumbersAreNibblesFromTheLeastOn) {
  const Packet packet = packetOf({{1447, -1, 0}, true, 4});
  EXPECT_EQ(std::string(packet.begin(), packet.end()), "<HKFAPPPPAAAAFA>");
  const auto answer = answerIn(packet);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->counts, (std::array<int, 3>{1447, -1, 0}));
  EXPECT_EQ(answerIn(packetOf({{9999, -9999, 0}, false, 0}))->counts, (std::array<int, 3>{4096, -4096, 0})) << "bounded";
}

TEST(FalconPacket, IsFoundInWhateverPiecesAndRefusedWhenGarbled) {
  AnswerReader reader;
  const std::string text = "xx<AAAABAAACAAAAA>";
  std::vector<std::uint8_t> bytes(text.begin(), text.end());
  EXPECT_FALSE(reader.read(std::span(bytes).first(9)));
  std::vector<std::uint8_t> rest{'x', 'x'};
  rest.insert(rest.end(), bytes.begin() + 9, bytes.end());
  const auto answer = reader.read(rest);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->counts, (std::array<int, 3>{0, 1, 2}));
  const std::string wrong = "xx<AAAAzAAACAAAAA><AAAA<AAAAAAAAAAAAAA!";
  std::vector<std::uint8_t> garbled(wrong.begin(), wrong.end());
  EXPECT_FALSE(reader.read(garbled));
  EXPECT_EQ(reader.garbled(), 3);
}

TEST(FalconPacket, FuzzedBytesNeverGiveNumbersOutOfRange) {
  tests::RandomNumbers draw(3);
  AnswerReader reader;
  std::array<std::uint8_t, 64> bytes{};
  for (int i = 0; i < 20000; ++i) {
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(draw.below(20) == 0 ? '<' : 'A' + draw.below(17));
    if (const auto answer = reader.read(std::span(bytes).first(static_cast<std::size_t>(draw.below(65))))) {
      for (const int count : answer->counts) ASSERT_LE(std::abs(count), 32768);
    }
  }
}

// What the chip and the microcontroller do, as libnifalcon finds them.
class EmulatedFalcon final : public FalconPort {
 public:
  explicit EmulatedFalcon(std::size_t image_size) : image_size_(image_size) {}

  bool control(std::uint8_t request, std::uint16_t value) override {
    if (request == 3) baud_ = value;
    if (request == 3 && value == 2 && loaded_ == image_size_) runs_ = true;
    if (request == 0) answers_.clear();
    return true;
  }
  bool write(std::span<const std::uint8_t> bytes) override {
    if (unplugged) return false;
    if (baud_ == 0x4138) {
      if (bytes.size() == 3 && bytes[1] == 0x43) say({0x0a, 0x44, 0x2c, 0x0d});
    } else if (baud_ == 0x15 && !ready_) {
      ready_ = bytes[0] == 0x41;
      say({0x41});
    } else if (baud_ == 0x15) {
      echo(bytes);
    } else if (runs_) {
      orders(bytes);
    }
    return true;
  }
  int read(std::span<std::uint8_t> bytes, int) override {
    if (unplugged) return -1;
    bytes[0] = 0x01, bytes[1] = 0x60;  // modem status
    if (answers_.empty()) return 2;
    const auto answer = answers_.front();
    answers_.pop_front();
    std::copy(answer.begin(), answer.end(), bytes.begin() + 2);
    return static_cast<int>(answer.size()) + 2;
  }

  std::atomic<bool> unplugged{false};
  bool spoils_image = false;
  std::atomic<int> torque0{0};
  std::atomic<int> counts_{-150};

 private:
  void say(std::vector<std::uint8_t> bytes) { answers_.push_back(std::move(bytes)); }
  void echo(std::span<const std::uint8_t> bytes) {
    std::vector<std::uint8_t> back(bytes.begin(), bytes.end());
    if (spoils_image) back[0] ^= 1;
    loaded_ += bytes.size();
    // In two pieces, as it may come.
    const auto half = static_cast<std::ptrdiff_t>(back.size() / 2);
    if (half > 0) say({back.begin(), back.begin() + half});
    say({back.begin() + half, back.end()});
  }
  void orders(std::span<const std::uint8_t> bytes) {
    Packet packet;
    std::copy_n(bytes.begin(), packet.size(), packet.begin());
    const auto order = answerIn(packet);
    torque0 = order->counts[0];
    const bool homing = (packet[13] - 'A') & 1;
    Packet answer = packetOf({{counts_, counts_, counts_}, false, 0});
    if (homing) answer[13] = static_cast<std::uint8_t>('A' + 0x70);
    say({answer.begin(), answer.end()});
  }

  std::size_t image_size_, loaded_ = 0;
  int baud_ = 0;
  bool ready_ = false, runs_ = false;
  std::deque<std::vector<std::uint8_t>> answers_;
};

const std::vector<std::uint8_t> kImage(1000, 0x5a);

bool soon(const std::function<bool()>& condition) {
  for (int i = 0; i < 20000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return condition();
}

TEST(FalconSession, LoadsTheUsersImageAndThenSpeaksWithIt) {
  EmulatedFalcon falcon(kImage.size());
  FalconSession session(falcon);
  EXPECT_EQ(session.start(kImage), "");
  const auto answer = session.exchange({{100, 0, 0}, false, 0});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->counts[0], -150);
  EXPECT_EQ(falcon.torque0, 100);
  EXPECT_EQ(session.start({}), "") << "an image that runs isn't asked for again";
}

TEST(FalconSession, SaysWhatIsMissingOrWrong) {
  EmulatedFalcon falcon(kImage.size());
  FalconSession session(falcon);
  EXPECT_NE(session.start({}).find("--firmware"), std::string::npos);
  falcon.spoils_image = true;
  EXPECT_NE(session.start(kImage).find("didn't take"), std::string::npos);
  falcon.unplugged = true;
  EXPECT_NE(session.start(kImage).find("greeting"), std::string::npos);
}

TEST(FalconArm, HomesRendersForceAndDropsItWhenNobodyAsksAnyMore) {
  auto port = std::make_unique<EmulatedFalcon>(kImage.size());
  EmulatedFalcon& falcon = *port;
  FalconArm arm(std::move(port), kImage);
  ASSERT_TRUE(soon([&] { return arm.state() == DeviceState::kReady && arm.sample().valid; }));
  const ArmSample sample = arm.sample();
  EXPECT_NEAR(sample.p_DF.x(), 0, 1e-3) << "equal angles: on the axis";
  EXPECT_NEAR((*inverse(sample.p_DF + Vec3(0, 0, kCentre)))[0], angleOf(-150), 1e-6);
  arm.commandForce(Vec3(0, 0, 2));
  EXPECT_FALSE(soon([&, n = 0]() mutable { return falcon.torque0 != 0 || ++n > 20; }) && falcon.torque0 != 0) << "not armed";
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
  falcon.unplugged = true;
  ASSERT_TRUE(soon([&] { return arm.state() == DeviceState::kFaulted; }));
  EXPECT_FALSE(arm.sample().valid);
}

TEST(FalconArm, WithoutItsImageIsRefusedWithTheRemedy) {
  EXPECT_THROW(FalconArm(std::make_unique<EmulatedFalcon>(kImage.size()), {}), std::runtime_error);
}

}  // namespace
}  // namespace pincer::devices::falcon
