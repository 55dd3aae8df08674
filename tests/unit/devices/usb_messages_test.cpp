#include <gtest/gtest.h>

#include "pincer/devices/usb/byte_order.h"
#include "pincer/devices/usb/messages.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::devices::usb {
namespace {

ArmState fullState() {
  ArmState m;
  m.valid = true;
  m.limp = false;
  m.p_DF = Vec3(0.1, -0.2, 0.3);
  m.v_DF = Vec3(0.5, 0, -0.25);
  m.q_DF = Quat(0.5, 0.5, -0.5, 0.5);
  m.switches = std::uint16_t{5};
  m.arming = 3;
  m.answers = 77;
  return m;
}

TEST(UsbMessages, AnArmStateComesBackToTheStepOfTheWire) {
  const auto m = armStateIn(toFrame(fullState()));
  ASSERT_TRUE(m);
  EXPECT_TRUE(m->valid);
  EXPECT_FALSE(m->limp);
  EXPECT_NEAR((m->p_DF - Vec3(0.1, -0.2, 0.3)).norm(), 0, 1e-9);
  EXPECT_NEAR((*m->v_DF - Vec3(0.5, 0, -0.25)).norm(), 0, 1e-6);
  EXPECT_NEAR(m->q_DF->angularDistance(Quat(0.5, 0.5, -0.5, 0.5)), 0, 1e-4);
  EXPECT_EQ(*m->switches, 5);
  EXPECT_EQ(m->arming, 3);
  EXPECT_EQ(m->answers, 77u);
}

TEST(UsbMessages, WhatADeviceDoesntMeasureStaysAbsent) {
  ArmState m;
  m.valid = true;
  const auto back = armStateIn(toFrame(m));
  ASSERT_TRUE(back);
  EXPECT_FALSE(back->v_DF || back->q_DF || back->switches);
  EXPECT_TRUE(back->limp);
  const auto place = displayStateIn(toFrame(DisplayState{}));
  ASSERT_TRUE(place);
  EXPECT_FALSE(place->place_L);
}

TEST(UsbMessages, CommandsComeBack) {
  const auto force = armCommandIn(toFrame(ArmCommand{Vec3(8.5, -1.4, 0.001), 0.004, 9, Signal::kStart}));
  ASSERT_TRUE(force);
  EXPECT_NEAR((force->f_D - Vec3(8.5, -1.4, 0.001)).norm(), 0, 1e-9);
  EXPECT_NEAR(force->deadline, 0.004, 1e-12);
  EXPECT_EQ(force->arming, 9);
  EXPECT_EQ(force->signal, Signal::kStart);
  const auto place = displayCommandIn(toFrame(DisplayCommand{Vec2(0.012, -0.01), true, 0.1, Signal::kEnd}));
  ASSERT_TRUE(place);
  EXPECT_NEAR((place->place_L - Vec2(0.012, -0.01)).norm(), 0, 1e-9);
  EXPECT_TRUE(place->parked);
}

TEST(UsbMessages, NothingThatIsNoNumberGetsOnTheWire) {
  const auto m = armCommandIn(toFrame(ArmCommand{Vec3(tests::kNan, 1e300, -1e300), 0.004, 1, Signal::kNone}));
  ASSERT_TRUE(m);
  EXPECT_EQ(m->f_D, Vec3(0, 100, -100));
}

TEST(UsbMessages, IdentityStatusAndCapabilitiesComeBack) {
  const Identity identity{DeviceKind::kDisplay, 7, 500, "pincer CLD", "0042"};
  EXPECT_EQ(identityIn(toFrame(identity)), identity);
  const auto told =
      identityIn(toFrame(Identity{DeviceKind::kArm, 1, 1000, "arm", "A1", Linkage::kPremium, 0.072, 0.05}));
  ASSERT_TRUE(told && told->tip_mass);
  EXPECT_NEAR(*told->tip_mass, 0.072, 1e-12);
  EXPECT_NEAR(told->tip_damping, 0.05, 1e-12);
  EXPECT_FALSE(identityIn(toFrame(Identity{DeviceKind::kArm, 1, 1000, "arm", "A1"}))->tip_mass) << "absent, never zero";
  const auto status = statusIn(toFrame(Status{DeviceState::kFaulted, kEmergencyStop | kSupplyFault, 3, 4}));
  ASSERT_TRUE(status);
  EXPECT_EQ(describeFaults(status->faults), "supply, emergency stop");
  EXPECT_EQ(describeFaults(kOverTemperature | kSensorFault), "over-temperature, sensor");
  EXPECT_EQ(status->missed_deadlines, 4u);
  ArmCapabilities arm;
  arm.peak_force = 8.5, arm.continuous_force = 1.4, arm.resolution = 3e-5, arm.stiffness_limit = 3500;
  arm.peak_torque = Vec3(1.8275, 1.8275, 1.445);
  arm.workspace_min_D = Vec3(-0.1, -0.06, -0.06), arm.workspace_max_D = Vec3(0.1, 0.1, 0.05);
  const auto back = armCapabilitiesIn(toFrame(arm));
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->peak_force, 8.5, 1e-9);
  EXPECT_NEAR((back->workspace_max_D - arm.workspace_max_D).norm(), 0, 1e-12);
  ASSERT_TRUE(back->peak_torque);
  EXPECT_NEAR((*back->peak_torque - *arm.peak_torque).norm(), 0, 1e-12);
  arm.peak_torque.reset();
  EXPECT_FALSE(armCapabilitiesIn(toFrame(arm))->peak_torque) << "absent, never zero";
  arm.peak_torque = Vec3(1, 0, 1);
  EXPECT_FALSE(armCapabilitiesIn(toFrame(arm))) << "one joint without torque is no arm";
  const auto display = displayCapabilitiesIn(toFrame(TactileCapabilities{53e-6, 0.1, 500, Vec2(0.012, 0.01)}));
  ASSERT_TRUE(display);
  EXPECT_NEAR(display->resolution, 53e-6, 1e-12);
}

TEST(UsbMessages, CalibrationEntriesComeBack) {
  const auto entry = calibrationIn(toFrame(CalibrationEntry{2, 5, "base_x", -0.25}, FrameType::kCalibration));
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->name, "base_x");
  EXPECT_EQ(entry->value, -0.25);
  EXPECT_TRUE(calibrationIn(toFrame(CalibrationEntry{2, 0, "", 0}, FrameType::kReadCalibration)));
  EXPECT_TRUE(calibrationIn(toFrame(CalibrationEntry{2, 0, "base_x", 1}, FrameType::kWriteCalibration)));
  EXPECT_FALSE(calibrationIn(toFrame(CalibrationEntry{5, 5, "base_x", 1}, FrameType::kCalibration)))
      << "index beyond the count";
  EXPECT_FALSE(calibrationIn(toFrame(CalibrationEntry{0, 1, "", 1}, FrameType::kCalibration))) << "no name";
  EXPECT_FALSE(calibrationIn(toFrame(CalibrationEntry{0, 1, "x", tests::kNan}, FrameType::kCalibration)));
  EXPECT_FALSE(calibrationIn(toFrame(Identity{DeviceKind::kArm, 1, 1, "m", "s"})));
}

// `frame` with bytes of its payload replaced.
Frame poked(Frame frame, std::size_t at, std::initializer_list<int> bytes) {
  for (const int byte : bytes) frame.payload[at++] = static_cast<std::uint8_t>(byte);
  return frame;
}

TEST(UsbMessages, RefuseEveryFieldOutOfRange) {
  const Frame arm = toFrame(fullState());
  ArmState bare = fullState();
  bare.v_DF.reset(), bare.q_DF.reset(), bare.switches.reset();
  const Frame plain = toFrame(bare);
  const auto refused = [](const Frame& f) { return !armStateIn(f); };
  EXPECT_TRUE(refused(poked(arm, 0, {0x20}))) << "an unknown flag";
  EXPECT_TRUE(refused(poked(arm, 1, {1}))) << "a reserved byte";
  EXPECT_TRUE(refused(poked(arm, 2, {0, 0, 0, 0x78}))) << "a position of 2.01 m";
  EXPECT_TRUE(refused(poked(arm, 14, {0, 0, 0, 0x7f}))) << "a speed of 2130 m/s";
  EXPECT_TRUE(refused(poked(arm, 26, {0, 0}))) << "a quaternion that isn't one";
  EXPECT_TRUE(refused(poked(arm, 26, {0xff, 0x7f}))) << "beyond 1";
  EXPECT_TRUE(refused(poked(plain, 14, {1}))) << "a speed that isn't there";
  EXPECT_TRUE(refused(poked(plain, 26, {1}))) << "a gimbal that isn't there";
  EXPECT_TRUE(refused(poked(plain, 34, {1}))) << "switches that aren't there";
  EXPECT_TRUE(refused(poked(arm, 45, {1}))) << "bytes behind the message";
  const Frame force = toFrame(ArmCommand{Vec3(1, 2, 3), 0.004, 1, Signal::kNone});
  EXPECT_FALSE(armCommandIn(poked(force, 0, {0, 0, 0, 0x7f})));
  EXPECT_FALSE(armCommandIn(poked(force, 12, {0, 0}))) << "a deadline of 0";
  EXPECT_FALSE(armCommandIn(poked(force, 12, {0xff, 0xff}))) << "a deadline of 6.5 s";
  EXPECT_FALSE(armCommandIn(poked(force, 16, {4}))) << "an unknown signal";
  const Frame place = toFrame(DisplayCommand{Vec2(0.01, 0), false, 0.1, Signal::kNone});
  EXPECT_FALSE(displayCommandIn(poked(place, 3, {0x7f})));
  EXPECT_FALSE(displayCommandIn(poked(place, 8, {2}))) << "neither parked nor not";
  EXPECT_FALSE(displayCommandIn(poked(place, 9, {9})));
  EXPECT_FALSE(displayCommandIn(poked(place, 10, {0, 0})));
  const Frame tactor = toFrame(DisplayState{true, false, Vec2(0.01, 0), 3});
  EXPECT_FALSE(displayStateIn(poked(tactor, 0, {8})));
  EXPECT_FALSE(displayStateIn(poked(tactor, 0, {1}))) << "a place that isn't there";
  const Frame identity = toFrame(Identity{DeviceKind::kArm, 1, 1000, "model", "serial"});
  EXPECT_FALSE(identityIn(poked(identity, 0, {3}))) << "an unknown kind";
  EXPECT_FALSE(identityIn(poked(identity, 35, {0xff, 0xff}))) << "a tip of 6.6 kg";
  EXPECT_FALSE(identityIn(poked(identity, 37, {0xff, 0xff}))) << "a friction of 65.5 N s/m";
  EXPECT_FALSE(identityIn(poked(toFrame(Identity{DeviceKind::kDisplay, 1, 500, "model", "serial"}), 35, {1})))
      << "a display with a tip";
  EXPECT_FALSE(identityIn(poked(identity, 4, {0, 0}))) << "a rate of 0";
  EXPECT_FALSE(identityIn(poked(identity, 6, {0}))) << "text behind its end";
  EXPECT_FALSE(identityIn(poked(identity, 7, {0x07}))) << "an unprintable character";
  EXPECT_FALSE(identityIn(toFrame(Identity{DeviceKind::kArm, 1, 1000, "", "serial"})));
  const Frame status = toFrame(Status{DeviceState::kReady, 0, 0, 0});
  EXPECT_FALSE(statusIn(poked(status, 0, {0}))) << "a device that streams isn't closed";
  EXPECT_FALSE(statusIn(poked(status, 1, {16}))) << "an unknown fault";
  ArmCapabilities inside_out;
  inside_out.peak_force = inside_out.continuous_force = 1, inside_out.resolution = 1e-5, inside_out.stiffness_limit = 1;
  EXPECT_FALSE(armCapabilitiesIn(toFrame(inside_out))) << "a workspace without a volume";
  EXPECT_FALSE(displayCapabilitiesIn(toFrame(TactileCapabilities{53e-6, 0.1, 500, Vec2::Zero()})));
}

TEST(UsbMessages, AMessageIsReadOnlyFromItsOwnType) {
  const std::array<Frame, 8> all{toFrame(Identity{DeviceKind::kArm, 1, 1, "m", "s"}),
                                 toFrame(ArmCommand{}),
                                 toFrame(ArmState{}),
                                 toFrame(DisplayCommand{}),
                                 toFrame(DisplayState{}),
                                 toFrame(Status{DeviceState::kReady, 0, 0, 0}),
                                 toFrame(ArmCapabilities{}),
                                 toFrame(TactileCapabilities{})};
  for (const Frame& f : all) {
    EXPECT_TRUE(f.type == FrameType::kIdentity || !identityIn(f));
    EXPECT_TRUE(f.type == FrameType::kArmCommand || !armCommandIn(f));
    EXPECT_TRUE(f.type == FrameType::kArmState || !armStateIn(f));
    EXPECT_TRUE(f.type == FrameType::kDisplayCommand || !displayCommandIn(f));
    EXPECT_TRUE(f.type == FrameType::kDisplayState || !displayStateIn(f));
    EXPECT_TRUE(f.type == FrameType::kStatus || !statusIn(f));
    EXPECT_TRUE(f.type == FrameType::kArmCapabilities || !armCapabilitiesIn(f));
    EXPECT_TRUE(f.type == FrameType::kDisplayCapabilities || !displayCapabilitiesIn(f));
  }
}

// Whatever bytes come in a payload: what is accepted is finite, in range, and comes back to the same bytes.
TEST(UsbMessages, FuzzedPayloadsAreRefusedOrInRange) {
  tests::RandomNumbers draw(3);
  const std::array<Frame, 4> seeds{toFrame(fullState()), toFrame(ArmCommand{Vec3(1, 2, 3), 0.004, 1, Signal::kNone}),
                                   toFrame(DisplayState{true, false, Vec2(0.01, 0), 3}),
                                   toFrame(CalibrationEntry{0, 2, "base", 1.5}, FrameType::kCalibration)};
  int accepted = 0;
  for (int i = 0; i < 200000; ++i) {
    Frame frame = seeds[static_cast<std::size_t>(draw.below(4))];
    for (int k = 1 + draw.below(3); k > 0; --k)
      frame.payload[static_cast<std::size_t>(draw.below(46))] = static_cast<std::uint8_t>(draw.below(256));
    if (const auto m = armStateIn(frame)) {
      ++accepted;
      ASSERT_LE(m->p_DF.cwiseAbs().maxCoeff(), 2.0 + 1e-9);
      ASSERT_TRUE(!m->q_DF || std::abs(m->q_DF->norm() - 1) < 1e-12);
    }
    if (const auto m = armCommandIn(frame)) {
      ++accepted;
      ASSERT_LE(m->f_D.cwiseAbs().maxCoeff(), 100 + 1e-6);
      ASSERT_EQ(toFrame(*m).payload, frame.payload);
    }
    if (const auto m = displayStateIn(frame)) {
      ++accepted;
      ASSERT_EQ(toFrame(*m).payload, frame.payload);
    }
    if (const auto m = calibrationIn(frame)) {
      ++accepted;
      ASSERT_TRUE(std::isfinite(m->value));
    }
  }
  EXPECT_GT(accepted, 1000) << "the fuzz reaches the accepting side too";
}

// Where each value stands in the payload: docs/usb-protocol.md.
TEST(UsbMessages, EachRangeIsLookedAtOnBothSides) {
  const auto with = [](Frame frame, std::size_t at, auto value) {
    store(frame.payload, at, value);
    return frame;
  };
  const Frame identity = toFrame(Identity{DeviceKind::kArm, 1, 1000, "arm", "A1"});
  ASSERT_TRUE(identityIn(identity));
  for (const int rate : {0, 8001})
    EXPECT_FALSE(identityIn(with(identity, 4, static_cast<std::uint16_t>(rate)))) << rate;
  EXPECT_FALSE(identityIn(with(identity, 6, std::uint32_t{0}))) << "no model";
  EXPECT_FALSE(identityIn(with(identity, 22, std::uint16_t{0}))) << "no serial number";
  const Frame status = toFrame(Status{DeviceState::kReady, 0, 0, 0});
  ASSERT_TRUE(statusIn(status));
  for (const int state : {0, 1, 5, 255})
    EXPECT_FALSE(statusIn(with(status, 0, static_cast<std::uint8_t>(state)))) << state;
  ArmCapabilities can;
  can.peak_force = 8;
  can.continuous_force = 1;
  can.resolution = 1e-5;
  can.stiffness_limit = 1000;
  can.workspace_max_D.setOnes();
  ASSERT_TRUE(armCapabilitiesIn(toFrame(can)));
  EXPECT_FALSE(armCapabilitiesIn(with(toFrame(can), 4, std::uint32_t{9'000'000}))) << "more for ever than at the peak";
  EXPECT_FALSE(armCapabilitiesIn(with(toFrame(can), 28, std::int32_t{0}))) << "a workspace without width";
  const Frame display = toFrame(TactileCapabilities{1e-5, 0.1, 500, Vec2(0.01, 0)});
  ASSERT_TRUE(displayCapabilitiesIn(display)) << "a display of one axis";
  EXPECT_FALSE(displayCapabilitiesIn(with(display, 12, std::int32_t{-1})));
  EXPECT_FALSE(displayCapabilitiesIn(with(display, 12, std::int32_t{0}))) << "of none";
  Frame asks = toFrame(CalibrationEntry{2, 0, "", 0}, FrameType::kReadCalibration);
  ASSERT_TRUE(calibrationIn(asks));
  EXPECT_FALSE(calibrationIn(with(asks, 22, std::uint64_t{1} << 62))) << "whoever reads sends no value";
  Frame state = toFrame(fullState());
  for (std::size_t at = 26; at < 34; at += 2) store(state.payload, at, std::int16_t{0});
  EXPECT_FALSE(armStateIn(state)) << "a gimbal of length 0";
}

TEST(UsbMessages, KindsHaveNames) {
  EXPECT_EQ(nameOf(DeviceKind::kArm), "arm");
  EXPECT_EQ(nameOf(DeviceKind::kDisplay), "display");
}

}  // namespace
}  // namespace pincer::devices::usb
