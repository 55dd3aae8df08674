#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

#include "pincer/contact/io/printable.h"
#include "pincer/devices/gate/force_gate.h"
#include "pincer/devices/haply/haply_host.h"
#include "pincer/devices/haply/silence.h"
#include "pincer/devices/usb/usb_host.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/devices_commands.h"
#include "pincer/tasks/app/device_options.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/servo/arm_check.h"
#include "pincer/tasks/run/servo/hand_devices_parts.h"
#include "pincer/tasks/run/servo/servo.h"
#include "pincer/tasks/run/servo/servo_text.h"

namespace pincer::tasks {
namespace {

using devices::usb::LinkCounts;
using devices::usb::UsbArm;
using devices::usb::UsbDisplay;
using devices::usb::UsbHost;

struct DevicesTestArguments {
  std::string serial;
  double seconds = 3, force = 0;
  double watchdog_ms = 5;
  DeviceRunOptions arms;  // of falcon and haply
  bool silence = false;
};

// Streams and commands for a while: no force, tactors on a slow circle.
class DeviceTest final : public ServoCycle {
 public:
  DeviceTest(UsbHost& host, std::vector<UsbArm*> arms, std::vector<UsbDisplay*> displays, double seconds)
      : host_(host), arms_(std::move(arms)), displays_(std::move(displays)), seconds_(seconds) {
    for (UsbArm* arm : arms_) before_.push_back(arm->counts());
    for (UsbDisplay* display : displays_) before_.push_back(display->counts());
  }
  bool tick(double now) override {
    const std::int64_t epoch = devices::usb::monotonicNs() - static_cast<std::int64_t>(1e9 * now);
    if (ticks_ == 0 || epoch < epoch_) host_.setEpoch(epoch_ = epoch);
    for (UsbArm* arm : arms_) arm->commandForce(Vec3::Zero());
    for (UsbDisplay* display : displays_) {
      const double angle = 2 * 3.14159265358979 * 0.5 * now;
      display->command({false, 0.6 * Vec2(display->capabilities().reach.x() * math::cos(angle),
                                          display->capabilities().reach.y() * math::sin(angle))});
    }
    ++ticks_;
    return now < seconds_;
  }
  void cutForces() noexcept override {
    for (UsbArm* arm : arms_) arm->stop();
  }
  // One line per device; whether all of them are well.
  bool report() {
    bool well = true;
    for (std::size_t i = 0; i < arms_.size(); ++i) well &= line(*arms_[i], before_[i]);
    for (std::size_t i = 0; i < displays_.size(); ++i) well &= line(*displays_[i], before_[arms_.size() + i]);
    return well;
  }

 private:
  template <typename Device>
  bool line(Device& device, const LinkCounts& before) {
    const LinkCounts now = device.counts();
    const std::int64_t bad = now.bad - before.bad, lost = now.lost - before.lost,
                       answers = now.answers - before.answers;
    const bool well = device.linkState() == devices::DeviceState::kReady && bad == 0 && lost == 0 && answers > 0;
    print("{:<10} {:<26} {} frames, {} lost, {} unsound, {} of {} commands answered, last round trip {:.2f} ms\n",
          devices::nameOf(device.linkState()), device.identity(), now.accepted - before.accepted, lost, bad, answers,
          ticks_, 1e-6 * static_cast<double>(now.round_trip_ns));
    const std::string faults = devices::usb::describeFaults(device.status().faults);
    if (!faults.empty()) print("  it reports: {}\n", faults);
    return well;
  }

  UsbHost& host_;
  std::vector<UsbArm*> arms_;
  std::vector<UsbDisplay*> displays_;
  double seconds_;
  std::vector<LinkCounts> before_;
  std::int64_t epoch_ = 0, ticks_ = 0;
};

// Arms on USB as the ones of a hand.
class ArmsOnUsb final : public HandDevices {
 public:
  ArmsOnUsb(UsbHost& host, std::vector<UsbArm*> arms, double watchdog) : host_(host), arms_(std::move(arms)) {
    for (UsbArm* arm : arms_) arm->setDeadline(kArmDeadline * watchdog);
  }
  devices::Arm& arm(int finger) override { return *arms_[static_cast<std::size_t>(finger)]; }
  devices::TactileDisplay* display(int) override { return nullptr; }
  void setEpoch(std::int64_t ns) override { host_.setEpoch(ns); }
  std::vector<std::string> describe() override { return {}; }

 private:
  UsbHost& host_;
  std::vector<UsbArm*> arms_;
};

// A hand that wears no arms, for a display that needs none.
class NoArms final : public HandDevices {
 public:
  devices::Arm& arm(int) override { throw DeviceError("no arm is worn"); }
  devices::TactileDisplay* display(int) override { return nullptr; }
  void setEpoch(std::int64_t) override {}
  std::vector<std::string> describe() override { return {}; }
};

template <typename Device>
std::vector<Device*> withSerial(const std::vector<Device*>& all, const std::string& serial) {
  std::vector<Device*> some;
  for (Device* device : all) {
    if ((serial.empty() || device->deviceIdentity().serial == serial) &&
        device->linkState() == devices::DeviceState::kReady)
      some.push_back(device);
  }
  return some;
}

void sayIdle(const char* what, const devices::haply::SilenceFinding& found) {
  print("{}: {} {:.0f} ms; it moved {:.0f} mm meanwhile\n", what, found.went_idle ? "idle after" : "NOT idle within",
        1e3 * found.seconds, 1e3 * found.moved);
}

// When does an Inverse3 let go by itself? The answer decides how hard a session may push.
int testSilence(const DevicesTestArguments& arguments) {
  const auto place = devices::haply::servicePlaceOf(arguments.arms.which.service);
  if (!place || arguments.arms.devices != "haply" || arguments.serial.empty())
    refuseUsage("--silence is of one Inverse3: pincer devices test ID --devices haply --silence");
  if (!operatorArms(arguments.arms,
                    "The arm is going to push by itself, and nobody answers for its end. Nobody may hold it."))
    return kExitOk;
  const auto check = devices::haply::checkService(*place, 1);
  if (!check.problem.empty()) throw DeviceError(check.problem);
  try {
    using devices::haply::Ending;
    const auto silent = measureSilence(*place, arguments.serial, check.version, Ending::kSilence, interruptFlag());
    sayIdle("after the last command", silent);
    const auto closed = measureSilence(*place, arguments.serial, check.version, Ending::kClose, interruptFlag());
    sayIdle("after a closed connection", closed);
    if (interruptFlag()) return kExitInterrupted;
    if (!silent.went_idle || !closed.went_idle) {
      print("A program that is killed leaves its force on for longer than that. Sessions keep to {:g} N.\n",
            devices::haply::kCarefulPeak);
      return kExitDevice;
    }
    print("For its calibration: pincer devices calibrate {} --devices haply --set idle_after={:.3f}\n",
          arguments.serial, std::max(silent.seconds, closed.seconds));
  } catch (const std::runtime_error& error) {
    throw DeviceError(error.what());
  }
  return kExitOk;
}

// Arms by themselves: rest, a small push, ages of samples, a verdict each.
int checkArms(HandDevices& devices, int arms, const DevicesTestArguments& arguments, const ServoOptions& servo) {
  const ArmCheckOptions check{.force = std::min(std::abs(arguments.force), 0.5), .watchdog = servo.watchdog};
  if (check.force > 0 &&
      !operatorArms(arguments.arms, "The arm is going to move 15 mm by itself. Nobody may wear or hold it."))
    return kExitOk;
  ArmCheck cycle(devices, arms, check);
  const ServoReport report = runServo(servo, cycle, interruptFlag());
  cycle.cutForces();
  print("{}\n", servoText(report, 1 / servo.rate));
  bool fit = true;
  for (const ArmFindings& found : cycle.findings()) {
    print("{}\n", armCheckText(found));
    const auto odd = oddities(found, check);
    for (const std::string& sentence : odd) print("  {}\n", printableMessage(sentence));
    print("Verdict: {}\n", odd.empty() ? "fit for a session" : "not fit for a session yet");
    fit &= odd.empty();
  }
  if (report.interrupted) return kExitInterrupted;
  return fit ? kExitOk : kExitDevice;
}

// Falcon or Inverse3: one arm.
int testArm(const DevicesTestArguments& arguments) {
  DeviceRunOptions options = arguments.arms;
  options.which.fingers = 1;
  options.which.needs_displays = false;
  options.which.pressure.clear();
  options.watchdog_ms = arguments.watchdog_ms;
  if (!arguments.serial.empty()) options.which.arms = {arguments.serial};
  ServoOptions servo;
  const auto devices = openDevices(options, servo);
  constexpr double kHoming = 20;  // by the operator's hand [s]
  if (!waitUntil([&] { return devices->arm(0).state() == devices::DeviceState::kReady || interruptFlag(); }, kHoming))
    throw DeviceError(devices->arm(0).identity() +
                      " didn't become ready. Push a Falcon's grip all the way in and out once; calibrate an Inverse3.");
  return checkArms(*devices, 1, arguments, servo);
}

// Each thimble presses for a second at a third of its highest level, the others don't.
int testPressure(const DevicesTestArguments& arguments) {
  if (!operatorArms(arguments.arms, "The TouchDIVER is going to press index finger and thumb gently, a second each."))
    return kExitOk;
  DeviceOptions options = arguments.arms.which;
  const auto hand = openPressedHand(std::make_unique<NoArms>(), options);
  for (const std::string& line : hand->describe()) print("{}\n", line);
  const double third = options.full_pressure / 3;
  for (int finger = 0; finger < 2 && hand->complaint().empty() && !interruptFlag(); ++finger) {
    print("{} now\n", finger == 0 ? "index finger" : "thumb");
    std::fflush(stdout);
    const auto pressed = [&] {
      hand->pressure(finger)->press(third);
      return interruptFlag() || !hand->complaint().empty();
    };
    waitUntil(pressed, 1);
    hand->pressure(finger)->stop();
  }
  if (interruptFlag()) return kExitInterrupted;
  const std::string complaint = hand->complaint();
  print("Verdict: {}\n",
        complaint.empty() ? "the Middleware took all of it; whether it was felt is for you to say" : complaint);
  return complaint.empty() ? kExitOk : kExitDevice;
}

int testDevices(const DevicesTestArguments& arguments) {
  if (arguments.silence) return testSilence(arguments);
  if (arguments.arms.devices == "weart") return testPressure(arguments);
  if (arguments.arms.devices != "usb") return testArm(arguments);
  const std::atomic<bool>& interrupted = interruptFlag();
  const auto usb = startUsb();
  UsbHost& host = *usb;
  host.waitFor(16, 16, 1);  // whatever answers within a second
  const auto arms = withSerial(host.arms(), arguments.serial);
  const auto displays = withSerial(host.displays(), arguments.serial);
  for (const std::string& problem : host.problems()) print("{}\n", printableMessage(problem));
  if (arms.empty() && displays.empty()) {
    throw DeviceError(
        arguments.serial.empty()
            ? "No device is ready on USB. See what is there: pincer devices list"
            : fmt::format("No device {} is ready on USB. See what is there: pincer devices list", arguments.serial));
  }
  DeviceTest test(host, arms, displays, arguments.seconds);
  const ServoOptions servo{.clock = ServoClock::kReal, .watchdog = 1e-3 * arguments.watchdog_ms};
  const ServoReport report = runServo(servo, test, interrupted);
  test.cutForces();
  print("{}\n", servoText(report, 1 / servo.rate));
  const bool well = test.report();
  if (report.interrupted) return kExitInterrupted;
  if (arms.empty()) return well ? kExitOk : kExitDevice;
  ArmsOnUsb hand(host, arms, servo.watchdog);
  const int verdict = checkArms(hand, static_cast<int>(arms.size()), arguments, servo);
  return verdict == kExitOk && !well ? kExitDevice : verdict;
}

}  // namespace

void addDevicesTest(CLI::App& devices, int& exit_code) {
  auto arguments = std::make_shared<DevicesTestArguments>();
  arguments->arms.devices = "usb";
  arguments->arms.which.pressure = "127.0.0.1:13031";
  CLI::App* command =
      devices.add_subcommand("test", "Streams, rests, pushes a little; counts what goes wrong, and gives a verdict");
  command->add_option("serial", arguments->serial, "Of the device (default: all)");
  command->add_option("--seconds", arguments->seconds, "How long [s]")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command
      ->add_option("--force", arguments->force,
                   "Pulls the arm to and fro, through the gate, so hard at most [N]; nobody may wear it")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  command->add_option("--watchdog", arguments->watchdog_ms, "So long may the program stall before forces are cut [ms]")
      ->check(CLI::Range(2.0, 100.0))
      ->capture_default_str();
  command->add_option("--devices", arguments->arms.devices, "Which kind; of falcon and haply one arm at a time")
      ->check(CLI::IsMember({"usb", "falcon", "haply", "weart"}))
      ->capture_default_str();
  command
      ->add_option("--service", arguments->arms.which.service,
                   "Where Haply's service is: HOST:PORT, or HOST:PORT:EVENTS")
      ->capture_default_str();
  command->add_option("--pressure", arguments->arms.which.pressure, "Where WEART's Middleware is: HOST:PORT")
      ->default_str("127.0.0.1:13031");
  command->add_option("--firmware", arguments->arms.which.firmware, "The Falcon's image, out of its maker's driver");
  command->add_flag("--silence", arguments->silence,
                    "Of haply: when does the arm let go by itself, once commands end?");
  command->add_flag("--yes", arguments->arms.yes, "Push without asking; nobody may wear or hold the arm");
  command->footer(
      "\nThe tactors move; without --force the arms don't.\n\nExample:\n  pincer devices test --seconds 10");
  command->callback([arguments, &exit_code] { exit_code = testDevices(*arguments); });
}

}  // namespace pincer::tasks
