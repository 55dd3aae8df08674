#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "pincer/devices/emulate/haply_service.h"

namespace pincer::devices::emulate {

using nlohmann::json;

namespace {

json jsonOf(const Vec3& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

json jsonOf(const Quat& q) { return {{"w", q.w()}, {"x", q.x()}, {"y", q.y()}, {"z", q.z()}}; }

json anglesOf() { return {{"a0", 0}, {"a1", 0}, {"a2", 0}}; }

}  // namespace

struct HaplyService::Texts {
  static json config(HaplyService& service, HaplyPlant& plant) {
    json told = {{"type", plant.settings().type}, {"port", "/dev/ttyACM0"}, {"handedness", "right"}};
    if (service.settings_.minor < 5) return told;
    told["device_info"] = {{"major_version", 7}, {"minor_version", 4}, {"id", plant.settings().id}, {"device_type", 4}, {"uuid", "..."}};
    told["gravity_compensation"] = {{"enabled", true}, {"scaling_factor", 1.0}};
    told["streaming_mode"] = "USB";
    told["torque_scaling"] = {{"enabled", true}};
    told["home_return"] = {{"enabled", false}};
    told["preset"] = service.fault_ == HaplyFault::kSettingsChanged ? "arm_front" : "defaults";
    told["basis"] = {{"permutation", "XYZ"}};
    told["mount"] = {{"position", jsonOf(Vec3::Zero())}, {"rotation", jsonOf(Quat::Identity())}, {"scale", jsonOf(Vec3(1, 1, 1))}};
    told["filters"] = {{"force_gate", {{"gain", 0.3}}}, {"damping", {{"scalar", 0.0}}}};
    return told;
  }
  static json state(HaplyService& service, std::size_t i) {
    HaplyPlant& plant = *service.plants_[i];
    const HaplyFault fault = service.fault_;
    const Vec3 echo = fault == HaplyFault::kEchoDoubled  ? Vec3(2 * plant.force_H())
                      : fault == HaplyFault::kEchoStrong ? Vec3(0.5, 0, 0)
                                                         : plant.force_H();
    const bool idle = plant.idle() || fault == HaplyFault::kStaysIdle;
    json told = {{"cursor_position", jsonOf(fault == HaplyFault::kPlaceFrozen ? service.frozen_H_[i] : plant.place_H())},
                 {"cursor_velocity", jsonOf(plant.velocity_H())},
                 {"angular_position", anglesOf()},
                 {"angular_velocity", anglesOf()},
                 {"body_orientation", jsonOf(Quat::Identity())},
                 {"current_cursor_force", jsonOf(echo)},
                 {"current_cursor_position", jsonOf(Vec3::Zero())},
                 {"current_angular_torques", anglesOf()},
                 {"current_angular_position", anglesOf()},
                 {"control_domain", "cartesian"},
                 {"control_mode", idle ? "idle" : "force"},
                 {"transform", json::object()}};
    if (fault == HaplyFault::kTransformed) told["transform"] = {{"scale", jsonOf(Vec3(2, 2, 2))}};
    return told;
  }
  static json status(const HaplyService& service, int session) {
    bool in_use = false;
    for (const auto& [number, other] : service.sessions_) in_use |= number != session && other.commanded;
    return {{"calibrated", service.fault_ != HaplyFault::kCalibrationLost},
            {"in_use", in_use},
            {"power_supply", service.fault_ != HaplyFault::kPowerLost},
            {"ready", service.fault_ != HaplyFault::kNotReady},
            {"started", true}};
  }
  static json grip(HaplyService& service, std::size_t i, bool full) {
    HaplyPlant& plant = *service.plants_[i];
    const bool asleep = service.fault_ == HaplyFault::kGripAsleep;
    json told = {{"device_id", plant.settings().grip}};
    told["state"] = {
        {"orientation", jsonOf(plant.grip_H())}, {"buttons", {{"a", false}, {"b", false}, {"c", false}}}, {"battery_level", 0.87}};
    if (service.fault_ == HaplyFault::kGripZero) told["state"]["orientation"] = {{"w", 0}, {"x", 0}, {"y", 0}, {"z", 0}};
    told["status"] = {{"connected", true}, {"awake", !asleep}, {"ready", true}};
    if (full) told["config"] = {{"type", "wireless_verse_grip"}};
    return told;
  }
  static std::string all(HaplyService& service, int session, bool full, bool first) {
    json text = {{"inverse3", json::array()}, {"verse_grip", json::array()}, {"wireless_verse_grip", json::array()}};
    if (first && service.settings_.minor >= 5) text["session_id"] = session;
    for (std::size_t i = 0; i < service.plants_.size(); ++i) {
      if (i > 0 || service.fault_ != HaplyFault::kDeviceGone) {
        json arm = {{"device_id", service.plants_[i]->settings().id}, {"state", state(service, i)}, {"status", status(service, session)}};
        if (full) arm["config"] = config(service, *service.plants_[i]);
        text["inverse3"].push_back(std::move(arm));
      }
      text["wireless_verse_grip"].push_back(grip(service, i, full));
    }
    return text.dump();
  }
  // Sums the forces of one message for a device, as the service does.
  static void obey(HaplyService& service, const json& device, Session& session) {
    const auto id = device.find("device_id");
    const auto commands = device.find("commands");
    if (id == device.end() || commands == device.end() || !commands->contains("set_cursor_force")) return;
    const json& force = (*commands)["set_cursor_force"];
    Vec3 f_H = Vec3::Zero();
    const auto add = [&](const char* key) {
      if (force.contains(key)) f_H += Vec3(force[key].value("x", 0.0), force[key].value("y", 0.0), force[key].value("z", 0.0));
    };
    if (service.settings_.vector) add("vector");
    if (service.settings_.values) add("values");
    if (service.fault_ == HaplyFault::kDeafToForces) f_H.setZero();
    for (auto& plant : service.plants_) {
      if (plant->settings().id == *id) plant->command(service.settings_.force_scale * f_H), session.commanded = true;
    }
  }
};

HaplyService::HaplyService(const HaplyServiceSettings& settings) : settings_(settings), frozen_H_(settings.arms.size(), Vec3::Zero()) {
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
  for (const auto& plant : plants_) devices.push_back({{"device_id", plant->settings().id}, {"type", plant->settings().type}});
  return json{{"ok", true}, {"data", devices}}.dump();
}

void HaplyService::advance(double dt) {
  for (auto& plant : plants_) plant->advance(dt);
}

}  // namespace pincer::devices::emulate
