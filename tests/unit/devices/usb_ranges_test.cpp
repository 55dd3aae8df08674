// The first and the last value of every field of the USB protocol, in counts of the wire (docs/usb-protocol.md): both
// are read, one count beyond either is refused.
#include <gtest/gtest.h>

#include <limits>
#include <utility>
#include <vector>

#include "pincer/devices/usb/messages.h"

namespace pincer::devices::usb {
namespace {

template <typename Message, std::optional<Message> (*in)(const Frame&)>
bool reads(const Frame& frame) {
  return in(frame).has_value();
}
constexpr auto kReadsIdentity = reads<Identity, identityIn>;
constexpr auto kReadsArmCommand = reads<ArmCommand, armCommandIn>;
constexpr auto kReadsArmState = reads<ArmState, armStateIn>;
constexpr auto kReadsDisplayCommand = reads<DisplayCommand, displayCommandIn>;
constexpr auto kReadsDisplayState = reads<DisplayState, displayStateIn>;
constexpr auto kReadsStatus = reads<Status, statusIn>;
constexpr auto kReadsArmCapabilities = reads<ArmCapabilities, armCapabilitiesIn>;
constexpr auto kReadsDisplayCapabilities = reads<TactileCapabilities, displayCapabilitiesIn>;
constexpr auto kReadsCalibration = reads<CalibrationEntry, calibrationIn>;

struct Field {
  const char* name;
  std::size_t at, size;      // in the payload [bytes]
  std::int64_t first, last;  // counts
  std::size_t in_a_row = 1;  // so many of the kind, one behind the other
  bool has_sign = false;
};

Frame withCount(Frame frame, const Field& field, std::size_t k, std::int64_t count) {
  for (std::size_t i = 0; i < field.size; ++i)
    frame.payload[field.at + k * field.size + i] =
        static_cast<std::uint8_t>(static_cast<std::uint64_t>(count) >> 8 * i);
  return frame;
}

// Counts that the bytes of the field can hold.
std::pair<std::int64_t, std::int64_t> holds(const Field& field) {
  const std::int64_t all = std::int64_t{1} << 8 * field.size;
  return field.has_sign ? std::pair{-all / 2, all / 2 - 1} : std::pair{std::int64_t{0}, all - 1};
}

void expectEnds(const char* message, const Frame& sound, bool (*is_read)(const Frame&),
                std::initializer_list<Field> fields) {
  ASSERT_TRUE(is_read(sound)) << message;
  for (const Field& field : fields) {
    const auto [least, most] = holds(field);
    for (std::size_t k = 0; k < field.in_a_row; ++k) {
      SCOPED_TRACE(std::string(message) + ", " + field.name + " " + std::to_string(k));
      EXPECT_TRUE(is_read(withCount(sound, field, k, field.first)));
      EXPECT_TRUE(is_read(withCount(sound, field, k, field.last)));
      if (field.first > least) {
        EXPECT_FALSE(is_read(withCount(sound, field, k, field.first - 1)));
      }
      if (field.last < most) {
        EXPECT_FALSE(is_read(withCount(sound, field, k, field.last + 1)));
      }
    }
  }
}

TEST(UsbRanges, OfCommandsEndWhereTheProtocolSays) {
  expectEnds("arm command", toFrame(ArmCommand{}), kReadsArmCommand,
             {{"force [uN]", 0, 4, -100'000'000, 100'000'000, 3, true},
              {"deadline [0.1 ms]", 12, 2, 1, 1000},
              {"arming", 14, 2, 0, 65535},
              {"signal", 16, 1, 0, 3},
              {"unused", 17, 1, 0, 0, 29}});
  expectEnds("display command", toFrame(DisplayCommand{}), kReadsDisplayCommand,
             {{"place [nm]", 0, 4, -100'000'000, 100'000'000, 2, true},
              {"parked", 8, 1, 0, 1},
              {"signal", 9, 1, 0, 3},
              {"deadline [0.1 ms]", 10, 2, 1, 10000},
              {"unused", 12, 1, 0, 0, 34}});
}

TEST(UsbRanges, OfStatesEndWhereTheProtocolSays) {
  ArmState moving;
  moving.v_DF = Vec3::Zero();
  moving.q_DF = Quat::Identity();
  moving.switches = std::uint16_t{0};
  expectEnds("arm state", toFrame(moving), kReadsArmState,
             {{"reserved", 1, 1, 0, 0},
              {"position [nm]", 2, 4, -2'000'000'000, 2'000'000'000, 3, true},
              {"velocity [um/s]", 14, 4, -50'000'000, 50'000'000, 3, true},
              {"gimbal w [1/16384]", 26, 2, 16221, 16384, 1, true},     // alone: 0.99 < |w| <= 1
              {"gimbal x y z [1/16384]", 28, 2, -2322, 2322, 3, true},  // beside w = 1: length < 1.01
              {"switches", 34, 2, 0, 65535},
              {"unused", 42, 1, 0, 0, 4}});
  expectEnds("arm state, bare", toFrame(ArmState{}), kReadsArmState,
             {{"velocity that isn't there", 14, 4, 0, 0, 3, true},
              {"gimbal that isn't there", 26, 2, 0, 0, 4, true},
              {"switches that aren't there", 34, 2, 0, 0}});
  expectEnds("display state", toFrame(DisplayState{false, false, Vec2::Zero(), 0}), kReadsDisplayState,
             {{"flags", 0, 1, 0, 7},
              {"reserved", 1, 1, 0, 0},
              {"place [nm]", 2, 4, -100'000'000, 100'000'000, 2, true},
              {"unused", 14, 1, 0, 0, 32}});
  expectEnds("display state, bare", toFrame(DisplayState{}), kReadsDisplayState,
             {{"place that isn't there", 2, 4, 0, 0, 2, true}});
  expectEnds("status", toFrame(Status{DeviceState::kReady, 0, 0, 0}), kReadsStatus,
             {{"state", 0, 1, 2, 4}, {"faults", 1, 4, 0, 15}, {"unused", 13, 1, 0, 0, 33}});
}

TEST(UsbRanges, OfWhatADeviceTellsOfItselfEndWhereTheProtocolSays) {
  expectEnds("arm", toFrame(Identity{DeviceKind::kArm, 1, 1000, "model", "serial"}), kReadsIdentity,
             {{"kind", 0, 1, 1, 2},
              {"reserved", 1, 1, 0, 0},
              {"rate [Hz]", 4, 2, 1, 8000},
              {"linkage", 34, 1, 0, 1},
              {"tip's mass [0.1 g]", 35, 2, 0, 65000},
              {"tip's friction [0.001 N s/m]", 37, 2, 0, 65000},
              {"unused", 39, 1, 0, 0, 7}});
  expectEnds("display", toFrame(Identity{DeviceKind::kDisplay, 1, 500, "model", "serial"}), kReadsIdentity,
             {{"linkage", 34, 1, 0, 0}, {"mass and friction, which it has none of", 35, 2, 0, 0, 2}});
  ArmCapabilities arm;
  arm.peak_force = 100, arm.continuous_force = 1e-6, arm.resolution = 1e-5, arm.stiffness_limit = 1000;
  arm.workspace_min_D = Vec3::Constant(-2), arm.workspace_max_D = Vec3::Constant(2);
  arm.peak_torque = Vec3::Ones();
  expectEnds("arm's capabilities", toFrame(arm), kReadsArmCapabilities,
             {{"peak and continuous force [uN]", 0, 4, 1, 100'000'000, 2},
              {"resolution [nm]", 8, 4, 1, 2'000'000'000},
              {"stiffness limit [N/m]", 12, 4, 1, 1'000'000},
              {"lower corner [nm], below the upper one", 16, 4, -2'000'000'000, 1'999'999'999, 3, true},
              {"upper corner [nm], above the lower one", 28, 4, -1'999'999'999, 2'000'000'000, 3, true},
              {"torque [0.1 mN m]", 40, 2, 1, 65000, 3}});
  arm.peak_torque.reset();
  expectEnds("arm's capabilities, torque not told", toFrame(arm), kReadsArmCapabilities,
             {{"torque of one joint alone", 40, 2, 0, 0, 3}});
  expectEnds("display's capabilities", toFrame(TactileCapabilities{1e-5, 0.1, 500, Vec2(0.01, 0.01)}),
             kReadsDisplayCapabilities,
             {{"resolution [nm]", 0, 4, 1, 100'000'000},
              {"speed [um/s]", 4, 4, 1, 50'000'000},
              {"rate [Hz]", 8, 4, 1, 8000},
              {"reach [nm]", 12, 4, 0, 100'000'000, 2, true},
              {"unused", 20, 1, 0, 0, 26}});
}

TEST(UsbRanges, OfCalibrationValuesEndWhereTheProtocolSays) {
  const Field unused{"unused", 30, 1, 0, 0, 16};
  expectEnds("calibration", toFrame(CalibrationEntry{2, 5, "x", 1}, FrameType::kCalibration), kReadsCalibration,
             {{"index", 0, 1, 0, 4}, {"count", 1, 1, 3, 255}, unused});
  expectEnds("write", toFrame(CalibrationEntry{2, 0, "x", 1}, FrameType::kWriteCalibration), kReadsCalibration,
             {{"index", 0, 1, 0, 255}, {"count", 1, 1, 0, 0}, unused});
  expectEnds("read", toFrame(CalibrationEntry{2, 0, "", 0}, FrameType::kReadCalibration), kReadsCalibration,
             {{"index", 0, 1, 0, 255}, {"count", 1, 1, 0, 0}, {"name and value", 2, 1, 0, 0, 28}, unused});
}

TEST(UsbRanges, WhatIsBeyondThemIsSentAsTheirEnd) {
  const Vec3 far = Vec3::Constant(1e9);
  const Vec2 far_on_pad = Vec2::Constant(1e9);
  const auto force = armCommandIn(toFrame(ArmCommand{-far, 1e9}));
  ASSERT_TRUE(force);
  EXPECT_NEAR((force->f_D + Vec3::Constant(100)).norm(), 0, 1e-9);
  EXPECT_NEAR(force->deadline, 0.1, 1e-12);
  ArmState arm;
  arm.p_DF = far, arm.v_DF = far;
  const auto state = armStateIn(toFrame(arm));
  ASSERT_TRUE(state && state->v_DF);
  EXPECT_NEAR((state->p_DF - Vec3::Constant(2)).norm(), 0, 1e-12);
  EXPECT_NEAR((*state->v_DF - Vec3::Constant(50)).norm(), 0, 1e-9);
  const auto place = displayCommandIn(toFrame(DisplayCommand{far_on_pad, false, 1e9}));
  ASSERT_TRUE(place);
  EXPECT_NEAR((place->place_L - Vec2::Constant(0.1)).norm(), 0, 1e-12);
  EXPECT_NEAR(place->deadline, 1, 1e-12);
  const auto tactor = displayStateIn(toFrame(DisplayState{true, false, far_on_pad, 0}));
  ASSERT_TRUE(tactor && tactor->place_L);
  EXPECT_NEAR((*tactor->place_L - Vec2::Constant(0.1)).norm(), 0, 1e-12);
}

TEST(UsbRanges, WhatADeviceTellsBeyondThemIsSentAsTheirEnd) {
  const auto tip = identityIn(toFrame(Identity{DeviceKind::kArm, 1, 1000, "m", "s", Linkage::kPremium, 1e9, 1e9}));
  ASSERT_TRUE(tip && tip->tip_mass);
  EXPECT_NEAR(*tip->tip_mass, 6.5, 1e-9);
  EXPECT_NEAR(tip->tip_damping, 65, 1e-9);
  ArmCapabilities arm;
  arm.peak_force = arm.continuous_force = arm.resolution = arm.stiffness_limit = 1e12;
  arm.workspace_max_D = Vec3::Constant(1e9), arm.workspace_min_D = -arm.workspace_max_D;
  arm.peak_torque = Vec3::Constant(1e9);
  const auto can = armCapabilitiesIn(toFrame(arm));
  ASSERT_TRUE(can && can->peak_torque);
  EXPECT_NEAR(can->peak_force, 100, 1e-9);
  EXPECT_NEAR(can->continuous_force, 100, 1e-9);
  EXPECT_NEAR(can->resolution, 2, 1e-9);
  EXPECT_NEAR(can->stiffness_limit, 1e6, 1e-9);
  EXPECT_NEAR((can->workspace_min_D + Vec3::Constant(2)).norm(), 0, 1e-9);
  EXPECT_NEAR((can->workspace_max_D - Vec3::Constant(2)).norm(), 0, 1e-9);
  EXPECT_NEAR((*can->peak_torque - Vec3::Constant(6.5)).norm(), 0, 1e-9);
  const auto shows = displayCapabilitiesIn(toFrame(TactileCapabilities{1e9, 1e9, 1e9, Vec2::Constant(1e9)}));
  ASSERT_TRUE(shows);
  EXPECT_NEAR(shows->resolution, 0.1, 1e-9);
  EXPECT_NEAR(shows->speed, 50, 1e-9);
  EXPECT_NEAR(shows->rate, 8000, 1e-9);
  EXPECT_NEAR((shows->reach - Vec2::Constant(0.1)).norm(), 0, 1e-9);
}

}  // namespace
}  // namespace pincer::devices::usb
