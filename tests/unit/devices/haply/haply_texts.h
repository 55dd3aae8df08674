// haply_texts: messages of Haply's service as its pages and the sources of its
// known clients give them; fixed test data.
#pragma once
#include <string>

namespace pincer::tests {

// The first message of a connection (WebSocket Protocol, 3.5).
inline const std::string kHaplyInventory =
    R"({"session_id":7,"inverse3":[{"device_id":"049D","config":{"type":"inverse3","port":"COM12","device_info":{"major_version":7,"minor_version":4,"id":"049D",)"
    R"("device_type":4,"uuid":"..."},"extended_device_id":"...","extended_firmware_version":"...","gravity_compensation":{"enabled":true,"scaling_factor":1.0},)"
    R"("handedness":"right","streaming_mode":"USB","torque_scaling":{"enabled":true},"home_return":{"enabled":false},"preset":"defaults","basis":{"permutation":)"
    R"("XYZ"},"mount":{"position":{"x":0,"y":0,"z":0},"rotation":{"w":1,"x":0,"y":0,"z":0},"scale":{"x":1,"y":1,"z":1}},"filters":{"force_gate":{"gain":0.3},)"
    R"("damping":{"scalar":0.0}}},"state":{"cursor_position":{"x":0.0,"y":-0.12,"z":0.15},"cursor_velocity":{"x":0,"y":0,"z":0},"angular_position":{"a0":0,"a1":0,)"
    R"("a2":0},"angular_velocity":{"a0":0,"a1":0,"a2":0},"body_orientation":{"w":1,"x":0,"y":0,"z":0},"current_cursor_force":{"x":0,"y":0,"z":0},)"
    R"("current_cursor_position":{"x":0,"y":0,"z":0},"current_angular_torques":{"a0":0,"a1":0,"a2":0},"current_angular_position":{"a0":0,"a1":0,"a2":0},)"
    R"("control_domain":"cartesian","control_mode":"idle","transform":{}},"status":{"calibrated":true,"in_use":false,"power_supply":true,"ready":true,)"
    R"("started":true}}],"verse_grip":[],"wireless_verse_grip":[{"device_id":"1605","config":{"type":"wireless_verse_grip"},"state":{"orientation":{"w":1,"x":0,)"
    R"("y":0,"z":0},"buttons":{"a":false,"b":false,"c":false},"battery_level":0.87},"status":{"connected":true,"awake":true,"ready":true}}]})";

// Of Events & Monitoring.
inline const std::string kHaplySafetyEvent =
    R"({"name":"device-safety-triggered","category":"device","level":"warning","data":{"device_family":"inverse","device_id":"049D",)"
    R"("safety_type":"fod_stage_changed"},"message":"FOD stage changed: guard -> hard"})";

// Control Commands: the first message of a session, and every later one.
inline const std::string kHaplyFirstMessage =
    R"({"session":{"configure":{"profile":{"name":"org.pincer:5f3a09c1"}},"force_render_full_state":{}},"inverse3":[{"device_id":"049D","configure":{"preset":)"
    R"({"preset":"defaults"},"damping":{"scalar":0.0}},"commands":{"set_cursor_force":{"vector":{"x":0.0,"y":0.0,"z":0.0}}}}]})";
inline const std::string kHaplyForces =
    R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"vector":{"x":0.0,"y":0.0,"z":1.5}}}},)"
    R"({"device_id":"04BA","commands":{"set_cursor_force":{"vector":{"x":-0.2,"y":0.0,"z":0.0}}}}]})";

}  // namespace pincer::tests
