// falcon_arm: a Novint Falcon as an arm. Its maker's firmware must be loaded into it after
// every power-up; the user supplies that image.
//
// A thread of its own writes torques and reads encoders, over and over, about once a millisecond. A force that is older
// than `kForceLife` becomes zero there: the Falcon itself has no deadline. So a program that is stopped as a whole
// leaves the last torque on: keep a hand at the power switch (docs/devices/setup.md).
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "pincer/devices/arm/arm.h"
#include "pincer/devices/falcon/falcon_kinematics.h"
#include "pincer/devices/falcon/falcon_packet.h"
#include "pincer/devices/triple_buffer.h"

namespace pincer::devices::falcon {

inline constexpr std::int64_t kForceLife = 4'000'000;  // [ns]

// The FTDI chip in the Falcon: what it is told by control transfers, and bytes.
class FalconPort {
 public:
  virtual ~FalconPort() = default;
  virtual std::string place() const = 0;  // where it is plugged in, as "1-2"
  // A vendor request without data; false if it failed.
  virtual bool control(std::uint8_t request, std::uint16_t value) = 0;
  virtual bool write(std::span<const std::uint8_t> bytes) = 0;
  // One USB packet with its two status bytes; how many bytes came, -1 for an error, at most `timeout_ms` later.
  virtual int read(std::span<std::uint8_t> bytes, int timeout_ms) = 0;
};

struct FalconPlace {
  std::string port;    // bus-port, as "1-2" or "1-2.3" behind a hub
  std::string serial;  // of its FTDI chip; empty where there is none, or no right to read it
};

// Every Falcon on USB, in the order of the ports; and the one at a port. Both throw std::runtime_error with a sentence
// and the remedy. Implemented by falcon_port_libusb.cpp.
std::vector<FalconPlace> listFalcons();
std::unique_ptr<FalconPort> openFalconPort(const std::string& port);

// The conversation with a Falcon, without a thread.
class FalconSession {
 public:
  explicit FalconSession(FalconPort& port) : port_(port) {}

  // Loads the image, unless one runs already. Empty, or a sentence about what went wrong.
  std::string start(std::span<const std::uint8_t> firmware);
  // Torques out, encoders in. Absent: no sound answer came.
  std::optional<Answer> exchange(const Orders& orders);

 private:
  int hear(std::span<std::uint8_t> bytes);
  bool hears(std::span<const std::uint8_t> words);
  bool runs();
  bool enterLoader();
  bool load(std::span<const std::uint8_t> firmware);
  bool enterNormalMode();

  FalconPort& port_;
  AnswerReader reader_;
};

class FalconArm final : public Arm {
 public:
  // Loads the firmware and starts the thread. Throws std::runtime_error with a sentence and the remedy.
  FalconArm(std::unique_ptr<FalconPort> port, std::vector<std::uint8_t> firmware);
  ~FalconArm() override;

  std::string identity() const override { return "Novint Falcon at " + port_->place(); }
  const ArmCapabilities& capabilities() const override { return capabilities_; }
  DeviceState state() const override { return state_.load(std::memory_order_acquire); }
  ArmSample sample() override;
  void commandForce(const Vec3& f_D) override;
  void arm() override { stopped_.store(false, std::memory_order_release); }
  void stop() noexcept override { stopped_.store(true, std::memory_order_release); }
  void setEpoch(std::int64_t ns) { epoch_ns_ = ns; }

 private:
  struct Reading {
    Vec3 p_DF = Vec3::Zero();
    Mat3 J = Mat3::Identity();
    std::uint8_t buttons = 0;
    bool valid = false;
    std::int64_t ns = 0;
  };
  struct Wish {
    Vec3 f_D = Vec3::Zero();
    std::int64_t ns = 0;
  };

  void run();
  Orders ordersNow(const Reading& last, bool homed);
  bool read(const Answer& answer, Reading& reading) const;

  std::unique_ptr<FalconPort> port_;
  FalconSession session_;
  ArmCapabilities capabilities_;
  std::atomic<DeviceState> state_{DeviceState::kConnecting};
  std::atomic<bool> stopped_{true}, end_{false};
  std::atomic<std::int64_t> epoch_ns_{0};
  TripleBuffer<Reading> readings_;
  TripleBuffer<Wish> wishes_;
  std::thread thread_;
};

}  // namespace pincer::devices::falcon
