// devices calibrate A,B --touch: where the second Inverse3 stands beside the
// first, from handles that are held together.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <vector>

#include "pincer/contact/error.h"
#include "pincer/contact/math.h"
#include "pincer/devices/haply/haply_host.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/devices_calibrate.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/lab/experiments/pickup_object.h"
#include "pincer/tasks/lab/experiments/pickup_scene.h"
#include "pincer/tasks/run/servo/hand_devices_parts.h"
#include "pincer/tasks/run/servo/haply_calibration.h"
#include "pincer/tasks/run/servo/touch_calibration.h"

namespace pincer::tasks {
namespace {

using devices::haply::HaplyHost;

constexpr std::size_t kTouches = 12;  // places; chosen: half more than the fit needs (kFewestTouches)
constexpr double kTogether = 1e-3;    // both handles within so much [m]
constexpr double kStill = 0.3;        // for so long [s]
constexpr int kFewestSamples = 30;    // in that time
constexpr double kFarther = 0.015;    // from every place before [m]
constexpr double kNextWithin = 120;   // for the next place [s]

double secondsNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Takes a place whenever both handles rest where they haven't rested before: both hands are busy holding them.
class TouchTaker {
 public:
  TouchTaker(const Pose& X_WA, const Pose& X_WB) : X_WA_(X_WA), X_WB_(X_WB) {}

  // True if there is one more. `time` [s] by any clock: on a busy machine samples come late.
  bool take(const Vec3& p_A, const Vec3& p_B, double time) {
    const HandleTouch now{X_WA_ * p_A, X_WB_ * p_B};
    const bool moves =
        samples_ == 0 || (now.a_W - first_.a_W).norm() > kTogether || (now.b_W - first_.b_W).norm() > kTogether;
    if (moves) {
      first_ = now;
      sum_ = {Vec3::Zero(), Vec3::Zero()};
      since_ = time;
      samples_ = 0;
    }
    sum_.a_W += now.a_W;
    sum_.b_W += now.b_W;
    if (++samples_ < kFewestSamples || time - since_ < kStill || !isNew(now)) return false;
    touches_.push_back({sum_.a_W / samples_, sum_.b_W / samples_});
    return true;
  }
  const std::vector<HandleTouch>& touches() const { return touches_; }

 private:
  bool isNew(const HandleTouch& now) const {
    return std::none_of(touches_.begin(), touches_.end(),
                        [&](const HandleTouch& t) { return (t.a_W - now.a_W).norm() < kFarther; });
  }
  Pose X_WA_, X_WB_;
  HandleTouch first_, sum_;
  double since_ = 0;
  int samples_ = 0;
  std::vector<HandleTouch> touches_;
};

std::vector<std::string> idsIn(const std::string& serials) {
  const std::size_t comma = serials.find(',');
  if (comma == std::string::npos)
    refuseUsage("--touch is of two Inverse3: pincer devices calibrate INDEX,THUMB --devices haply --touch");
  return {serials.substr(0, comma), serials.substr(comma + 1)};
}

DeviceCalibration calibrationOf(const std::string& id, const std::vector<std::string>& files) {
  for (const std::string& path : files) {
    if (DeviceCalibration calibration = readCalibration(path); calibration.serial == id) return calibration;
  }
  return uncalibratedHaply(id);
}

std::vector<HandleTouch> takeTouches(HaplyHost& host, const Pose& X_WA, const Pose& X_WB) {
  TouchTaker taker(X_WA, X_WB);
  double last = secondsNow();
  while (taker.touches().size() < kTouches) {
    if (interruptFlag()) return {};
    const double time = secondsNow();
    if (time - last > kNextWithin)
      throw DeviceError(fmt::format("No new place came within {:.0f} s: only {} of {}.", kNextWithin,
                                    taker.touches().size(), kTouches));
    const devices::ArmSample a = host.arm(0).sample(), b = host.arm(1).sample();
    if (!a.valid || !b.valid) throw DeviceError("An Inverse3 is lost. " + host.complaint());
    if (taker.take(a.p_DF, b.p_DF, time)) {
      print("Place {} of {}. Go on to another, at least {:.0f} mm away.\n", taker.touches().size(), kTouches,
            1e3 * kFarther);
      std::fflush(stdout);
      last = time;
    }
    waitUntil([] { return false; }, 1e-3);
  }
  return taker.touches();
}

void keepBase(const TouchFinding& found, DeviceCalibration& calibration) {
  calibration.values["base_x"] = found.base.offset_W.x();
  calibration.values["base_y"] = found.base.offset_W.y();
  calibration.values["base_z"] = found.base.offset_W.z();
  calibration.values["base_turn"] = found.base.turn;
}

int touchWith(HaplyHost& host, const CalibrateArguments& arguments, const ArmBase& base_of_A,
              DeviceCalibration& calibration) {
  host.waitReady(10);
  const SpherePickupOptions options;
  const HandScene scene = makePickupScene(options, makePickupObject(options), PickupTrialSpec{});
  const Pose& X_WD = scene.model.mounts[0].X_WD;
  const Pose X_WA{quatFromRotationVector({0, 0, base_of_A.turn}) * X_WD.q, X_WD.p + base_of_A.offset_W};
  print(
      "Hold the two knobs together, still, at {} places all over the workspace. At each turn the pair differently: "
      "side by side, one\n"
      "above the other, one before the other. Forces are off.\n",
      kTouches);
  std::fflush(stdout);
  const std::vector<HandleTouch> touches = takeTouches(host, X_WA, scene.model.mounts[1].X_WD);
  if (interruptFlag()) return kExitInterrupted;
  const TouchFinding found = findBase(touches, scene.model.mounts[1].X_WD.p);
  print("knobs {:.1f} mm apart; the places fit within {:.2f} mm (rms), the worst, {}, within {:.2f} mm\n",
        1e3 * found.distance, 1e3 * found.residual, found.worst + 1, 1e3 * found.worst_error);
  print("sure of the offset within {:.2f} mm, of the turn within {:.2f} degrees\n", 1e3 * found.sure_offset,
        found.sure_turn / kDegree);
  keepBase(found, calibration);
  for (const char* name : {"base_x", "base_y", "base_z", "base_turn"})
    print("{:<20} {:.6f}\n", name, calibration.values[name]);
  if (const std::string odd = touchOddity(found); !odd.empty()) {
    print("{}\n", odd);
    return kExitDevice;
  }
  if (!arguments.save.empty()) writeCalibration(calibration, arguments.save);
  return kExitOk;
}

}  // namespace

int calibrateByTouch(const CalibrateArguments& arguments) {
  if (arguments.devices != "haply" || arguments.here || !arguments.align.empty() || !arguments.undrift.empty() ||
      !arguments.set.empty() || !arguments.load.empty())
    refuseUsage(
        "--touch stands alone: pincer devices calibrate INDEX,THUMB --devices haply --touch --calibration "
        "A.json,B.json --save B.json");
  const std::vector<std::string> ids = idsIn(arguments.serial);
  const DeviceCalibration first = calibrationOf(ids[0], arguments.calibrations);
  DeviceCalibration second = calibrationOf(ids[1], arguments.calibrations);
  const auto place = devices::haply::servicePlaceOf(arguments.service);
  if (!place)
    refuseUsage(
        fmt::format("--service {}: it isn't HOST:PORT or HOST:PORT:EVENTS on this computer", arguments.service));
  return withDeviceErrors([&] {
    HaplyHost host({.service = *place, .arms = {haplyArmOf(first, ""), haplyArmOf(second, "")}});
    return touchWith(host, arguments, armBaseIn(first), second);
  });
}

}  // namespace pincer::tasks
