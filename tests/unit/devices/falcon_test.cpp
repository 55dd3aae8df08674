// A Novint Falcon's geometry and packets.
#include <gtest/gtest.h>

#include "pincer/devices/falcon/falcon_kinematics.h"
#include "pincer/devices/falcon/falcon_packet.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/random_numbers.h"

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
  const Vec3 P(std::cos(phi) * p.x() + std::sin(phi) * p.y() - g.r,
               -std::sin(phi) * p.x() + std::cos(phi) * p.y() - g.s, p.z());
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
  EXPECT_EQ(answerIn(packetOf({{9999, -9999, 0}, false, 0}))->counts, (std::array<int, 3>{4096, -4096, 0}))
      << "bounded";
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

}  // namespace
}  // namespace pincer::devices::falcon
