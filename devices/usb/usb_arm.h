// usb_arm: an arm that speaks the protocol of docs/usb-protocol.md.
//
// Force needs three yeses: the gate's (the caller), this arm's (armed since it was plugged in and since the last stop), and the device's (an
// arming count that it hasn't refused). Every command dies in the device after its deadline, so a computer that stops is zero force.
#pragma once
#include "devices/arm/arm.h"
#include "devices/usb/device_link.h"
#include "devices/usb/mailbox.h"
#include "devices/usb/waker.h"

namespace pincer::devices::usb {

inline constexpr double kForceDeadline = 4e-3;  // unless set otherwise [s]

class UsbArm final : public Arm, public DeviceLink {
 public:
  UsbArm(Identity identity, Waker& waker) : DeviceLink(std::move(identity)), waker_(waker) {}

  std::string identity() const override;
  const ArmCapabilities& capabilities() const override { return capabilities_; }  // sound from the first time that state() is kReady
  DeviceState state() const override { return linkState(); }
  // From the servo thread, as commandForce and arm. Invalid while unplugged, and once the device went limp on its own after arm().
  ArmSample sample() override;
  void commandForce(const Vec3& f_D) override;
  void arm() override;
  void stop() noexcept override;
  // After which the arm goes limp by itself; before streaming [s], (0, 0.1].
  void setDeadline(double deadline) { deadline_ = deadline; }
  // A tone for the next command.
  void signal(Signal signal) { signal_ = signal; }

  void attach(std::int64_t now, std::uint32_t sequence) override;
  void detach() override;

 private:
  struct Reading {
    ArmState state;
    std::int64_t sent_ns = 0;
  };

  bool takeState(const Frame& frame, std::int64_t sent) override;
  bool takeCapabilities(const Frame& frame) override;
  bool takeCommand(Frame& frame) override;
  bool takeStop() override { return stop_.exchange(false, std::memory_order_acq_rel); }

  Waker& waker_;
  ArmCapabilities capabilities_;
  bool has_capabilities_ = false;
  Mailbox<Reading> readings_;     // USB thread -> servo
  Mailbox<ArmCommand> commands_;  // servo -> USB thread
  std::atomic<bool> armed_{false}, stop_{false};
  double deadline_ = kForceDeadline;
  std::uint16_t arming_ = 0;  // servo thread only
  Signal signal_ = Signal::kNone;
};

}  // namespace pincer::devices::usb
