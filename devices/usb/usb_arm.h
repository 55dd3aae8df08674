// usb_arm: an arm that speaks the protocol of docs/usb-protocol.md.
//
// Force needs three yeses: the gate's (the caller), this arm's (armed since it was plugged in and since the last
// stop), and the device's (an arming count that it hasn't refused). Every command dies in the device after its
// deadline, so a computer that stops is zero force.
#pragma once
#include "pincer/devices/arm/arm.h"
#include "pincer/devices/usb/stream_link.h"

namespace pincer::devices::usb {

inline constexpr double kForceDeadline = 4e-3;  // unless set otherwise [s]

class UsbArm final : public Arm, public StreamLink<ArmWire> {
 public:
  using StreamLink::StreamLink;

  std::string identity() const override { return nameOfDevice(); }
  const ArmCapabilities& capabilities() const override { return toldCapabilities(); }
  DeviceState state() const override { return linkState(); }
  // From the servo thread, as commandForce and arm. Invalid while unplugged, and once the
  // device went limp on its own after arm().
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
  void checkCommand(ArmCommand& command) override;
  bool takeStop() override { return stop_.exchange(false, std::memory_order_acq_rel); }

  std::atomic<bool> armed_{false}, stop_{false};
  // Servo thread only.
  double deadline_ = kForceDeadline;
  std::uint16_t arming_ = 0;
  Signal signal_ = Signal::kNone;
};

}  // namespace pincer::devices::usb
