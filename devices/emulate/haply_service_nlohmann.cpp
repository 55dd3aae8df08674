#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "pincer/devices/emulate/haply_service.h"

namespace pincer::devices::emulate {

using nlohmann::json;

namespace {

void add(std::string& text, const Vec3& v) {
  fmt::format_to(std::back_inserter(text), R"({{"x":{},"y":{},"z":{}}})", v.x(), v.y(), v.z());
}

void add(std::string& text, const Quat& q) {
  fmt::format_to(std::back_inserter(text), R"({{"w":{},"x":{},"y":{},"z":{}}})", q.w(), q.x(), q.y(), q.z());
}

const char* truth(bool value) { return value ? "true" : "false"; }

// Fields that a driver must read over: no joint is turned, nor the body.
constexpr const char* kAngles = R"({"a0":0,"a1":0,"a2":0})";
constexpr const char* kUpright = R"({"w":1,"x":0,"y":0,"z":0})";

}  // namespace

// Written by hand: a tree of values per answer took longer than all else of a round trip.
struct HaplyService::Texts {
  static void config(HaplyService& service, const HaplyPlant& plant, std::string& text) {
    const auto out = std::back_inserter(text);
    fmt::format_to(out, R"({{"type":"{}","port":"/dev/ttyACM0","handedness":"right")", plant.settings().type);
    if (service.settings_.minor >= 5) {
      fmt::format_to(
          out,
          R"(,"device_info":{{"major_version":7,"minor_version":4,"id":"{}","device_type":4,"uuid":"..."}},)"
          R"("gravity_compensation":{{"enabled":true,"scaling_factor":1.0}},"streaming_mode":"USB","torque_scaling":{{"enabled":true}},)"
          R"("home_return":{{"enabled":false}},"preset":"{}","basis":{{"permutation":"XYZ"}},"mount":{{"position":{{"x":0,"y":0,"z":0}},)"
          R"("rotation":{},"scale":{{"x":1,"y":1,"z":1}}}},"filters":{{"force_gate":{{"gain":{}}},"damping":{{"scalar":{}}}}})",
          plant.settings().id, service.fault_ == HaplyFault::kSettingsChanged ? "arm_front" : service.settings_.preset,
          kUpright, service.settings_.gate_gain, service.settings_.damping);
    }
    text += '}';
  }
  static void state(HaplyService& service, std::size_t i, std::string& text) {
    HaplyPlant& plant = *service.plants_[i];
    const HaplyFault fault = service.fault_;
    const Vec3 echo = fault == HaplyFault::kEchoDoubled  ? Vec3(2 * plant.force_H())
                      : fault == HaplyFault::kEchoStrong ? Vec3(0.5, 0, 0)
                                                         : plant.force_H();
    const bool idle = plant.idle() || fault == HaplyFault::kStaysIdle;
    text += R"({"cursor_position":)";
    add(text, fault == HaplyFault::kPlaceFrozen ? service.frozen_H_[i] : plant.place_H());
    text += R"(,"cursor_velocity":)";
    add(text, plant.velocity_H());
    fmt::format_to(std::back_inserter(text), R"(,"angular_position":{0},"angular_velocity":{0},"body_orientation":{1})",
                   kAngles, kUpright);
    if (service.settings_.tells_force) text += R"(,"current_cursor_force":)", add(text, echo);
    fmt::format_to(
        std::back_inserter(text),
        R"(,"current_cursor_position":{{"x":0,"y":0,"z":0}},"current_angular_torques":{0},"current_angular_position":{0},)"
        R"("control_domain":"cartesian","control_mode":"{1}","transform":{2}}})",
        kAngles, idle ? "idle" : "force",
        fault == HaplyFault::kTransformed ? R"({"scale":{"x":2,"y":2,"z":2}})" : "{}");
  }
  static bool isCommandedByOthers(const HaplyService& service, int session) {
    return std::any_of(service.sessions_.begin(), service.sessions_.end(),
                       [&](const auto& other) { return other.first != session && other.second.commanded; });
  }
  static void status(const HaplyService& service, int session, std::string& text) {
    fmt::format_to(std::back_inserter(text),
                   R"({{"calibrated":{},"in_use":{},"power_supply":{},"ready":{},"started":true}})",
                   truth(service.fault_ != HaplyFault::kCalibrationLost), truth(isCommandedByOthers(service, session)),
                   truth(service.fault_ != HaplyFault::kPowerLost), truth(service.fault_ != HaplyFault::kNotReady));
  }
  static void arm(HaplyService& service, std::size_t i, int session, bool full, std::string& text) {
    fmt::format_to(std::back_inserter(text), R"({{"device_id":"{}","state":)", service.plants_[i]->settings().id);
    state(service, i, text);
    text += R"(,"status":)";
    status(service, session, text);
    if (full) text += R"(,"config":)", config(service, *service.plants_[i], text);
    text += '}';
  }
  static void grip(HaplyService& service, std::size_t i, bool full, std::string& text) {
    HaplyPlant& plant = *service.plants_[i];
    fmt::format_to(std::back_inserter(text), R"({{"device_id":"{}","state":{{"orientation":)", plant.settings().grip);
    if (service.fault_ == HaplyFault::kGripZero) {
      text += R"({"w":0,"x":0,"y":0,"z":0})";
    } else {
      add(text, plant.grip_H());
    }
    const bool wired = service.settings_.wired_grips;
    text +=
        wired ? R"(,"button":false,"hall":0})" : R"(,"buttons":{"a":false,"b":false,"c":false},"battery_level":0.87})";
    fmt::format_to(std::back_inserter(text), R"(,"status":{{"connected":true,"awake":{},"ready":true}})",
                   truth(service.fault_ != HaplyFault::kGripAsleep));
    if (full)
      fmt::format_to(std::back_inserter(text), R"(,"config":{{"type":"{}"}})",
                     wired ? "verse_grip" : "wireless_verse_grip");
    text += '}';
  }
  static std::string all(HaplyService& service, int session, bool full, bool first) {
    std::string text = "{";
    text.reserve(4096);
    if (first && service.settings_.minor >= 5) fmt::format_to(std::back_inserter(text), R"("session_id":{},)", session);
    text += R"("inverse3":[)";
    const char* comma = "";
    const bool tells = service.settings_.tells_others || !isCommandedByOthers(service, session);
    for (std::size_t i = service.fault_ == HaplyFault::kDeviceGone ? 1 : 0; tells && i < service.plants_.size();
         ++i, comma = ",") {
      text += comma;
      arm(service, i, session, full, text);
    }
    text += service.settings_.wired_grips ? R"(],"wireless_verse_grip":[],"verse_grip":[)"
                                          : R"(],"verse_grip":[],"wireless_verse_grip":[)";
    for (std::size_t i = 0; i < service.plants_.size(); ++i) {
      if (i > 0) text += ',';
      grip(service, i, full, text);
    }
    return text + "]}";
  }
  static void configure(HaplyService& service, const json& wanted) {
    HaplyServiceSettings& now = service.settings_;
    if (!now.takes_configuration) return;
    if (wanted.contains("preset")) now.preset = wanted["preset"].value("preset", now.preset);
    if (wanted.contains("force_gate")) now.gate_gain = wanted["force_gate"].value("gain", now.gate_gain);
    if (wanted.contains("damping")) now.damping = wanted["damping"].value("scalar", now.damping);
  }
  // Sums the forces of one message for a device, as the service does.
  static void obey(HaplyService& service, const json& device, Session& session) {
    const auto id = device.find("device_id");
    const auto commands = device.find("commands");
    if (device.contains("configure")) configure(service, device["configure"]);
    if (id == device.end() || commands == device.end() || !commands->contains("set_cursor_force")) return;
    const json& force = (*commands)["set_cursor_force"];
    Vec3 f_H = Vec3::Zero();
    const auto take = [&](const char* key) {
      if (force.contains(key))
        f_H += Vec3(force[key].value("x", 0.0), force[key].value("y", 0.0), force[key].value("z", 0.0));
    };
    if (service.settings_.vector) take("vector");
    if (service.settings_.values) take("values");
    if (service.fault_ == HaplyFault::kDeafToForces) f_H.setZero();
    const double share = std::min(1.0, service.settings_.gate_gain / service.settings_.gate_neutral);
    for (auto& plant : service.plants_) {
      if (plant->settings().id == *id)
        plant->command(service.settings_.force_scale * f_H, share), session.commanded = true;
    }
  }
};

HaplyService::HaplyService(const HaplyServiceSettings& settings)
    : settings_(settings), frozen_H_(settings.arms.size(), Vec3::Zero()) {
  for (const HaplyPlantSettings& arm : settings.arms) plants_.push_back(std::make_unique<HaplyPlant>(arm));
}

HaplyService::~HaplyService() = default;

int HaplyService::connected(std::string& inventory) {
  const int number = ++last_session_;
  sessions_[number] = {};
  inventory = spoilt(fault_, Texts::all(*this, number, true, true));
  return number;
}

void HaplyService::disconnected(int session) {
  const auto found = sessions_.find(session);
  if (found == sessions_.end()) return;
  if (found->second.commanded) {
    for (auto& plant : plants_) plant->sessionEnded();
  }
  sessions_.erase(found);
}

std::vector<std::string> HaplyService::answer(int number, std::string_view message) {
  const json text = json::parse(message, nullptr, false);
  const auto found = sessions_.find(number);
  if (text.is_discarded() || !text.is_object() || found == sessions_.end()) return {};
  ++messages_;
  Session& session = found->second;
  const auto devices = text.find("inverse3");
  if (devices != text.end()) {
    for (const json& device : *devices) Texts::obey(*this, device, session);
  }
  const bool full = text.contains("session") && text["session"].contains("force_render_full_state");
  // A full state is rendered at once: its settings are those after this message.
  std::string now = Texts::all(*this, number, full, false);
  std::string told = settings_.one_message_old && !full && !session.last.empty() ? session.last : now;
  if (!full) session.last = std::move(now);
  told = spoilt(fault_, std::move(told));
  if (fault_ == HaplyFault::kNever) return {};
  if (fault_ == HaplyFault::kTwice) return {told, told};
  return {told};
}

void HaplyService::setFault(HaplyFault fault) {
  fault_ = fault;
  for (std::size_t i = 0; i < plants_.size(); ++i) frozen_H_[i] = plants_[i]->place_H();
  if (const std::string event = eventOf(fault, settings_.arms[0].id); !event.empty()) events_.push_back(event);
}

std::vector<std::string> HaplyService::takeEvents() { return std::exchange(events_, {}); }

std::string HaplyService::get(std::string_view target) const {
  if (target == "/version") return fmt::format(R"({{"ok":true,"data":{{"version":"3.{}.1"}}}})", settings_.minor);
  if (target == "/settings/devices/force_scale") return fmt::format("{}", settings_.force_scale);
  if (target != "/devices") return "";
  json devices = json::array();
  for (const auto& plant : plants_)
    devices.push_back({{"device_id", plant->settings().id}, {"type", plant->settings().type}});
  return json{{"ok", true}, {"data", devices}}.dump();
}

void HaplyService::advance(double dt) {
  for (auto& plant : plants_) plant->advance(dt);
}

}  // namespace pincer::devices::emulate
