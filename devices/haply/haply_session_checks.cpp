// A session's belief in the service's answers: everything here ends in a sample, or in a doubt.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "pincer/devices/haply/haply_session.h"

namespace pincer::devices::haply {
namespace {

constexpr std::int64_t kEchoMemory = 20 * kMillisecond;    // so long may the echo follow a force that was
constexpr std::int64_t kIdleMayLast = 20 * kMillisecond;   // after the first force
constexpr std::int64_t kFrozenAfter = 500 * kMillisecond;  // a place that is equal to the bit
constexpr double kFrozenForce = 0.5;                       // although the force changed by this [N]
constexpr double kEchoOver = 0.2, kEchoOverShare = 0.05;   // the echo may be above what was sent by [N], and of it [-]
constexpr double kAttenuated = 0.8;                        // an echo below this share of what was sent is counted
constexpr double kDeaf = 0.1;                              // below this share the arm does nothing of what is sent
constexpr std::int64_t kDeafMayLast = 250 * kMillisecond;  // a filter damps what changes sign for less; chosen
constexpr std::int64_t kConfigureMayLast = 500 * kMillisecond;  // until the arm's settings are those asked for

// Names of events that put a session in doubt: safety, and a lost device.
constexpr std::array<std::string_view, 4> kSafetyTypes{"ebrake_triggered", "stall_detected", "stability_ceiling",
                                                       "fod_stage_changed"};
constexpr std::array<std::string_view, 4> kLosses{"device-disconnected", "device-busy", "device-calibration-failed",
                                                  "device-sleep"};

template <typename Names>
bool isIn(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

bool HaplySession::identifies(const ServiceMessage& message) {
  for (const ArmPlan& plan : options_.arms) {
    const DeviceReport* arm = message.find(plan.arm);
    if (arm == nullptr || arm->family != DeviceFamily::kInverse3) {
      refuse(
          fmt::format("Haply's service has no Inverse3 {}. Plug it in, switch it on; see what is there: pincer devices "
                      "list --devices "
                      "haply",
                      plan.arm));
      return false;
    }
    if (arm->in_use.value_or(false)) {
      refuse(fmt::format(
          "Inverse3 {} is in use by another session of Haply's service. Close that program, or Haply Hub's demo.",
          plan.arm));
      return false;
    }
    const DeviceReport* grip = plan.grip.empty() ? nullptr : message.find(plan.grip);
    if (!plan.grip.empty() && (grip == nullptr || grip->family == DeviceFamily::kInverse3)) {
      refuse(fmt::format("Haply's service has no VerseGrip {}. Wake it by a press of its button, or leave --grips out.",
                         plan.grip));
      return false;
    }
  }
  return true;
}

void HaplySession::takeInventory(const ServiceMessage& message, std::int64_t now) {
  if (!identifies(message)) return;
  began_ = now;
  phase_ = SessionPhase::kConfiguring;
  for (std::size_t i = 0; i < options_.arms.size(); ++i) {
    const DeviceReport& arm = *message.find(options_.arms[i].arm);
    if (arm.calibrated == false) {
      phase_ = SessionPhase::kHoming;
    } else {
      checkFlags(arm);
    }
  }
}

void HaplySession::checkFlags(const DeviceReport& report) {
  const auto lost = [&](const std::optional<bool>& flag, const char* what, const char* remedy) {
    if (flag == false) doubt(fmt::format("Inverse3 {} {}. {}", report.id.view(), what, remedy));
  };
  lost(report.power, "has no power supply", "Plug it in: USB alone gives no force.");
  lost(report.calibrated, "isn't calibrated", "Hold the grip's magnet to the mark until its light is white.");
  lost(report.ready, "isn't ready", "Look at its light: red no data, magenta not calibrated, cyan stopped for safety.");
  lost(report.started, "isn't started", "Restart Haply's service.");
}

void HaplySession::takeState(const ServiceMessage& message, const UnderWay& question, std::int64_t now) {
  bool homing = false;
  for (std::size_t i = 0; i < options_.arms.size(); ++i) {
    const DeviceReport* report = message.find(options_.arms[i].arm);
    if (report == nullptr)
      return doubt(fmt::format("Inverse3 {} is gone. Check its cable and its power supply.", options_.arms[i].arm));
    homing |= report->calibrated == false;
    if (phase_ == SessionPhase::kHoming) continue;
    takeArm(i, *report, question, now);
    takeGrip(i, message);
  }
  if (phase_ == SessionPhase::kHoming && !homing) phase_ = SessionPhase::kConfiguring, began_ = now;
  const auto end = arms_.begin() + static_cast<std::ptrdiff_t>(options_.arms.size());
  const bool known = std::all_of(arms_.begin(), end, [](const ArmState& arm) { return arm.config.has_value(); });
  if (phase_ == SessionPhase::kConfiguring && known) phase_ = SessionPhase::kSettling, began_ = now;
}

void HaplySession::takeArm(std::size_t i, const DeviceReport& report, const UnderWay& question, std::int64_t now) {
  ArmState& arm = arms_[i];
  checkFlags(report);
  if (report.transformed)
    doubt(fmt::format(
        "Inverse3 {} has a transform that isn't the identity: another session, or Haply Hub, set it. Reset it there.",
        report.id.view()));
  if (question.full) checkConfig(arm, report, now);
  if (report.f_H) checkForce(arm, report);
  if (report.p_H) checkPlace(arm, report, now);
  arm.echo = report.f_H;
  arm.echo_ns = before_answered_;
  const bool believed = report.p_H && before_answered_ >= 0 && !doubted_ && phase_ != SessionPhase::kRefused;
  arm.reading.valid = believed;
  if (!believed) return;
  arm.reading.ns = before_answered_;
  arm.reading.p_H = *report.p_H;
  arm.reading.v_H = report.mode.view() == "idle" ? std::nullopt : report.v_H;
}

void HaplySession::takeGrip(std::size_t i, const ServiceMessage& message) {
  if (options_.arms[i].grip.empty()) return;
  const DeviceReport* grip = message.find(options_.arms[i].grip);
  const bool awake = grip != nullptr && grip->q_H && grip->awake != false && grip->connected != false;
  if (!awake) {
    ++counts_.grip_asleep;
    return;
  }
  arms_[i].reading.q_H = grip->q_H;
  arms_[i].reading.buttons = grip->buttons;
}

// All times are those of the message before the answered one: a service that was away for
// a while isn't one that pushes on its own.
void HaplySession::checkForce(ArmState& arm, const DeviceReport& report) {
  const std::int64_t then = before_answered_;
  double most = 0;
  for (std::size_t k = 0; k < arm.sizes.size(); ++k) {
    if (then - arm.sent_at[k] <= kEchoMemory) most = std::max(most, arm.sizes[k]);
  }
  const double echo = report.f_H->norm();
  if (echo > most * (1 + kEchoOverShare) + kEchoOver) {
    doubt(
        fmt::format("Inverse3 {} renders {:.2f} N, but {:.2f} N at most were asked for: another session commands it, "
                    "or its force scale "
                    "was changed. Close other programs.",
                    report.id.view(), echo, most));
  }
  const bool steady = arm.pushing_since >= 0 && then - arm.pushing_since > kEchoMemory && arm.test == Echo::kGood;
  if (steady && echo < kAttenuated * most - kEchoOver) ++counts_.attenuated;
  const bool answers = most < kEchoForce || echo >= kDeaf * most;  // motors needn't show less than the test of arming
  arm.deaf_since = !steady || answers ? -1 : arm.deaf_since < 0 ? then : arm.deaf_since;
  if (arm.deaf_since >= 0 && then - arm.deaf_since > kDeafMayLast)
    doubt(
        fmt::format("Inverse3 {} renders nothing of the {:.2f} N that it is sent: an arm that is deaf to a force may "
                    "be deaf to a zero. Switch it off and on, look at its light; its force gate may swallow what "
                    "changes sign: --force-gate GAIN.",
                    report.id.view(), most));
  if (arm.pushing_since >= 0 && then - arm.pushing_since > kIdleMayLast && report.mode.view() == "idle")
    doubt(fmt::format("Inverse3 {} stays idle although forces are sent. Switch it off and on.", report.id.view()));
}

void HaplySession::checkPlace(ArmState& arm, const DeviceReport& report, std::int64_t now) {
  const Vec3 f_H = forceNow(arm);
  if (*report.p_H != arm.reading.p_H) {
    arm.still_since = now;
    arm.f_when_still = f_H;
    arm.pushed_when_still = false;
  }
  const bool pushed = (f_H - arm.f_when_still).norm() > kFrozenForce;
  if (pushed && !arm.pushed_when_still) arm.still_since = now;  // a rest before that is a rest
  arm.pushed_when_still |= pushed;
  if (arm.pushed_when_still && now - arm.still_since > kFrozenAfter)
    doubt(
        fmt::format("Inverse3 {} tells the same place to the bit although its force changed: its encoders seem to be "
                    "frozen. Switch it "
                    "off and on.",
                    report.id.view()));
}

// The odd setting, as a sentence; empty: all is as the session wants it. Services before 3.5 tell less.
std::string HaplySession::oddIn(const DeviceConfig& config, const Label& id) const {
  const auto odd = [&](const char* what, std::string_view is, std::string_view wanted) {
    return fmt::format("Inverse3 {}: its {} is {}, not {}. Haply Hub, or another session, set it: reset it there.",
                       id.view(), what, is.empty() ? "not told" : is, wanted);
  };
  const bool tells = options_.version.minor >= 5;
  const auto wrong = [&](const Label& is, std::string_view wanted) {
    return is.view() != wanted && (tells || !is.view().empty());
  };
  if (wrong(config.preset, "defaults")) return odd("preset", config.preset.view(), "defaults");
  if (wrong(config.basis, "XYZ")) return odd("basis", config.basis.view(), "XYZ");
  if (config.mounted) return odd("mount", "turned or moved", "the identity");
  if (config.damping ? *config.damping != 0 : tells) return odd("damping", config.damping ? "on" : "", "0");
  return "";
}

// At first the settings have half a second to become the wanted ones; from then on they have to stay as they are.
void HaplySession::checkConfig(ArmState& arm, const DeviceReport& report, std::int64_t now) {
  const bool tells = options_.version.minor >= 5;
  if (phase_ == SessionPhase::kConfiguring) {
    if (!report.config && tells && now - began_ <= kConfigureMayLast) return;
    const DeviceConfig config = report.config.value_or(DeviceConfig{});
    const std::string odd = oddIn(config, report.id);
    if (odd.empty()) {
      arm.config = config;
    } else if (now - began_ > kConfigureMayLast) {
      refuse(odd);
    }
  } else if (arm.config && report.config.value_or(DeviceConfig{}) != *arm.config) {
    doubt(fmt::format(
        "The settings of Inverse3 {} changed during the session. Haply Hub or another session did it: close it.",
        report.id.view()));
  }
}

void HaplySession::heard(std::string_view text, std::int64_t) {
  ServiceEvent event;
  const ReadError error = readEvent(text, event);
  if (error != ReadError::kNone)
    return doubt(fmt::format("An event of Haply's service can't be read: {}. Restart it.", describe(error)));
  const auto end = options_.arms.end();
  const bool ours = !event.device || std::find_if(options_.arms.begin(), end, [&](const ArmPlan& plan) {
                                       return plan.arm == event.device->view();
                                     }) != end;
  const bool loss = isIn(kLosses, event.name.view());
  const bool safety = event.level >= EventLevel::kWarning && isIn(kSafetyTypes, event.safety.view());
  if (!ours || !(loss || safety || event.level >= EventLevel::kError)) return;
  doubt(fmt::format("Haply's service reports {}{}{}: {}. Look at the device's light, clear the cause.",
                    event.name.view(), event.safety.view().empty() ? "" : " ", event.safety.view(),
                    event.words.data()));
}

}  // namespace pincer::devices::haply
