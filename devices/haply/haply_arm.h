// haply_arm: one Inverse3 of a HaplyHost as an arm. The tick reads and writes two triple
// buffers; all texts are the host's thread's.
//
// A figure that no page of the maker tells, and nobody here has measured, is absent (mass and damping of the tip)
// or careful: 2 N at peak until the arm's calibration says how soon it goes idle by itself
// (docs/devices/haply.md), 300 N/m for some 2 ms of delay.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "pincer/devices/arm/arm.h"
#include "pincer/devices/haply/haply_frames.h"
#include "pincer/devices/haply/haply_session.h"
#include "pincer/devices/triple_buffer.h"

namespace pincer::devices::haply {

inline constexpr std::int64_t kWishLife = 4 * kMillisecond;  // an older force is zero
inline constexpr double kCarefulPeak = 2, kPeak = 5;         // before and after idle_after was measured [N], ours
inline constexpr double kMostPeak = 8.5;                     // whatever a file says: the gate's [N]
inline constexpr double kSoonIdle = 0.1;    // an arm that goes idle by itself so soon may push kPeak [s]
inline constexpr double kContinuous = 1.4;  // [N]

struct HaplyArmSettings {
  std::string id, grip;
  HaplyFrame frame;
  double peak_force = kCarefulPeak, continuous_force = kContinuous;  // [N]
};

class HaplyArm final : public Arm {
 public:
  // `wake` makes the host's thread look at once; from any thread, never blocks.
  HaplyArm(HaplyArmSettings settings, std::function<void()> wake);

  std::string identity() const override { return "Haply Inverse3 " + settings_.id; }
  const ArmCapabilities& capabilities() const override { return capabilities_; }
  DeviceState state() const override { return state_.load(std::memory_order_acquire); }
  ArmSample sample() override;
  void commandForce(const Vec3& f_D) override;
  void arm() override;
  void stop() noexcept override;
  void setEpoch(std::int64_t ns) { epoch_ns_ = ns; }
  const HaplyArmSettings& settings() const { return settings_; }

  // The host's thread.
  void bring(HaplySession& session, std::size_t index, std::int64_t now);  // what the servo wants, to the session
  void publish(const ArmReading& reading, DeviceState state);
  bool stopped() const { return stopped_.load(std::memory_order_acquire); }

 private:
  struct Wish {
    Vec3 f_D = Vec3::Zero();
    std::int64_t ns = 0;
  };

  HaplyArmSettings settings_;
  HaplyMap map_;
  std::function<void()> wake_;
  ArmCapabilities capabilities_;
  std::atomic<DeviceState> state_{DeviceState::kConnecting};
  std::atomic<bool> stopped_{true};
  std::atomic<std::uint32_t> armings_{0};
  std::uint32_t armings_seen_ = 0;
  std::atomic<std::int64_t> epoch_ns_{0};
  TripleBuffer<ArmReading> readings_;
  TripleBuffer<Wish> wishes_;
};

}  // namespace pincer::devices::haply
