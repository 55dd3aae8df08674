// firmware: what runs inside an emulated device that speaks docs/usb-protocol.md: packets in, packets out, time from
// outside. The plant behind it is the simulated arm or display of devices/.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pincer/devices/arm/sim_arm.h"
#include "pincer/devices/cld/sim_cld.h"
#include "pincer/devices/usb/frame_order.h"
#include "pincer/devices/usb/messages.h"
#include "pincer/tests/emulation/usb_gadget.h"

namespace pincer::emulation {

namespace usb = devices::usb;

class Firmware : public UsbGadget {
 public:
  explicit Firmware(usb::Identity identity);

  std::string descriptors() const override;
  void received(std::span<const std::uint8_t> packet) override;
  void advance(double dt) override;
  std::size_t take(Packet& packet) override;
  void powerUp() override;

  const usb::Identity& identity() const { return identity_; }
  // By index; kept while it is without power.
  std::vector<std::pair<std::string, double>>& calibration() { return calibration_; }
  void setState(devices::DeviceState state, std::uint32_t faults = 0);
  // For tests: a device that is silent, or whose clock runs fast.
  void setSilent(bool silent) { silent_ = silent; }
  void setClockRate(double rate) { clock_rate_ = rate; }
  std::int64_t badFrames() const { return status_.bad_frames; }
  std::int64_t missedDeadlines() const { return status_.missed_deadlines; }
  std::int64_t commands() const { return commands_; }

 protected:
  virtual usb::Frame capabilities() const = 0;
  virtual usb::Frame state() = 0;
  virtual bool command(const usb::Frame& frame) = 0;  // false: refused
  virtual void stop() = 0;
  virtual void advancePlant(double dt) = 0;

  double time_ = 0;            // since power-up [s]
  std::uint32_t answers_ = 0;  // sequence of the last command taken
  usb::Status status_;

 private:
  void identify();
  bool answerCalibration(const usb::Frame& frame);
  void reply(usb::Frame frame);
  void stream();

  usb::Identity identity_;
  std::vector<std::pair<std::string, double>> calibration_;
  usb::FrameOrder order_;
  std::deque<usb::FrameBytes> replies_;
  std::uint32_t sequence_ = 0;
  double last_state_ = 0, last_status_ = 0, clock_rate_ = 1;  // [s]
  std::int64_t commands_ = 0;
  bool silent_ = false;
};

class ArmFirmware final : public Firmware {
 public:
  explicit ArmFirmware(const std::string& serial);
  void powerUp() override;
  devices::SimArm& plant() { return plant_; }
  bool limp() const { return limp_; }
  // That the arm tells of its joints from now on [N m].
  void tellPeakTorque(const Vec3& torque) { told_torque_ = torque; }
  Vec3 force() const { return force_; }  // being commanded to the motors [N]
  // True if `p_DF` is a position that was sent among the last ones.
  bool hasSent(const Vec3& p_DF) const;
  usb::Signal takeSignal();

 private:
  usb::Frame capabilities() const override;
  usb::Frame state() override;
  bool command(const usb::Frame& frame) override;
  void stop() override;
  void advancePlant(double dt) override;
  void setForce(const Vec3& f_D);

  devices::SimArm plant_;
  Vec3 force_ = Vec3::Zero();
  bool limp_ = true;
  std::uint16_t arming_ = 0, refused_ = 0;
  double dies_at_ = 0;  // [s]
  usb::Signal signal_ = usb::Signal::kNone;
  std::deque<Vec3> sent_;
  std::optional<Vec3> told_torque_;
};

class DisplayFirmware final : public Firmware {
 public:
  explicit DisplayFirmware(const std::string& serial);
  void powerUp() override;
  devices::SimCld& plant() { return plant_; }
  bool parked() const { return parked_; }

 private:
  usb::Frame capabilities() const override;
  usb::Frame state() override;
  bool command(const usb::Frame& frame) override;
  void stop() override { park(); }
  void advancePlant(double dt) override;
  void park();

  devices::SimCld plant_;
  bool parked_ = true;
  double dies_at_ = 0;  // [s]
};

}  // namespace pincer::emulation
