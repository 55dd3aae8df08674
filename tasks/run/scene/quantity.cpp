#include "pincer/tasks/run/quantity.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace pincer::tasks {

std::string hashText(const engine::WorldState& state) { return fmt::format("{:016x}", engine::hashOf(state)); }

namespace {

using M = const Moment&;
using I = std::size_t;

Pose bodyPose(M m, I i) { return engine::bodyPose(m.model.world, m.state.world, static_cast<int>(i)); }
Vec3 spin(M m, I i) { return engine::bodyAngularVelocity(m.model.world, m.state.world, static_cast<int>(i)); }
const engine::BodyState& body(M m, I i) { return m.state.world.bodies[i]; }
const engine::PointState& proxy(M m, I i) { return m.state.world.points[i]; }
const grasp::FingerReport& felt(M m, I i) { return m.fingers[i]; }
Vec2 place(M m, I i) { return grasp::placeOnPad(m.model.fingers[i], felt(m, i).touch); }

// Quantities: name in scenes, SI unit, how it is measured. Here of the whole world.
constexpr std::array kWorld = {
    QuantityKind{"energy", "J",
                 [](M m, I) {
                   return engine::kineticEnergy(m.model.world, m.state.world) +
                          engine::potentialEnergy(m.model.world, m.state.world);
                 }},
    QuantityKind{"kinetic_energy", "J", [](M m, I) { return engine::kineticEnergy(m.model.world, m.state.world); }},
    QuantityKind{"potential_energy", "J", [](M m, I) { return engine::potentialEnergy(m.model.world, m.state.world); }},
};

// Of a body.
constexpr std::array kBody = {
    QuantityKind{"p_x", "m", [](M m, I i) { return bodyPose(m, i).p.x(); }},
    QuantityKind{"p_y", "m", [](M m, I i) { return bodyPose(m, i).p.y(); }},
    QuantityKind{"p_z", "m", [](M m, I i) { return bodyPose(m, i).p.z(); }},
    QuantityKind{"q_w", "-", [](M m, I i) { return bodyPose(m, i).q.w(); }},
    QuantityKind{"q_x", "-", [](M m, I i) { return bodyPose(m, i).q.x(); }},
    QuantityKind{"q_y", "-", [](M m, I i) { return bodyPose(m, i).q.y(); }},
    QuantityKind{"q_z", "-", [](M m, I i) { return bodyPose(m, i).q.z(); }},
    QuantityKind{"rotation", "rad", [](M m, I i) { return angleBetween(m.starts[i].X_WB.q, bodyPose(m, i).q); }},
    QuantityKind{"v_x", "m/s", [](M m, I i) { return body(m, i).v_W.x(); }},
    QuantityKind{"v_y", "m/s", [](M m, I i) { return body(m, i).v_W.y(); }},
    QuantityKind{"v_z", "m/s", [](M m, I i) { return body(m, i).v_W.z(); }},
    QuantityKind{"speed", "m/s", [](M m, I i) { return body(m, i).v_W.norm(); }},
    QuantityKind{"w_x", "rad/s", [](M m, I i) { return spin(m, i).x(); }},
    QuantityKind{"w_y", "rad/s", [](M m, I i) { return spin(m, i).y(); }},
    QuantityKind{"w_z", "rad/s", [](M m, I i) { return spin(m, i).z(); }},
    QuantityKind{"L_x", "kg m^2/s", [](M m, I i) { return body(m, i).L_W.x(); }},
    QuantityKind{"L_y", "kg m^2/s", [](M m, I i) { return body(m, i).L_W.y(); }},
    QuantityKind{"L_z", "kg m^2/s", [](M m, I i) { return body(m, i).L_W.z(); }},
};

// Of a finger.
constexpr std::array kFinger = {
    QuantityKind{"p_x", "m", [](M m, I i) { return proxy(m, i).p_W.x(); }},
    QuantityKind{"p_y", "m", [](M m, I i) { return proxy(m, i).p_W.y(); }},
    QuantityKind{"p_z", "m", [](M m, I i) { return proxy(m, i).p_W.z(); }},
    QuantityKind{"target_x", "m", [](M m, I i) { return proxy(m, i).p_target_W.x(); }},
    QuantityKind{"target_y", "m", [](M m, I i) { return proxy(m, i).p_target_W.y(); }},
    QuantityKind{"target_z", "m", [](M m, I i) { return proxy(m, i).p_target_W.z(); }},
    QuantityKind{"v_x", "m/s", [](M m, I i) { return proxy(m, i).v_W.x(); }},
    QuantityKind{"v_y", "m/s", [](M m, I i) { return proxy(m, i).v_W.y(); }},
    QuantityKind{"v_z", "m/s", [](M m, I i) { return proxy(m, i).v_W.z(); }},
    QuantityKind{"f_x", "N", [](M m, I i) { return felt(m, i).f_contact_W.x(); }},
    QuantityKind{"f_y", "N", [](M m, I i) { return felt(m, i).f_contact_W.y(); }},
    QuantityKind{"f_z", "N", [](M m, I i) { return felt(m, i).f_contact_W.z(); }},
    QuantityKind{"f_user_x", "N", [](M m, I i) { return felt(m, i).f_user_W.x(); }},
    QuantityKind{"f_user_y", "N", [](M m, I i) { return felt(m, i).f_user_W.y(); }},
    QuantityKind{"f_user_z", "N", [](M m, I i) { return felt(m, i).f_user_W.z(); }},
    QuantityKind{"normal_force", "N", [](M m, I i) { return felt(m, i).normal_force; }},
    QuantityKind{"tangential_force", "N", [](M m, I i) { return felt(m, i).tangential_force; }},
    QuantityKind{"touching", "-", [](M m, I i) { return felt(m, i).touching ? 1.0 : 0.0; }},
    QuantityKind{"sliding", "-", [](M m, I i) { return felt(m, i).sliding ? 1.0 : 0.0; }},
    QuantityKind{"gap", "m", [](M m, I i) { return felt(m, i).gap; }},
    QuantityKind{"turn", "rad", [](M m, I i) { return proxy(m, i).turn_W.norm(); }},
    QuantityKind{"pressure", "N",
                 [](M m, I i) {
                   double sum = 0;
                   for (const grasp::Taxel& taxel : felt(m, i).pressure) sum += taxel.normal;
                   return sum;
                 }},
    QuantityKind{"place_distal", "m", [](M m, I i) { return place(m, i).x(); }},
    QuantityKind{"place_radial", "m", [](M m, I i) { return place(m, i).y(); }},
};

}  // namespace

std::span<const QuantityKind> worldQuantities() { return kWorld; }
std::span<const QuantityKind> bodyQuantities() { return kBody; }
std::span<const QuantityKind> fingerQuantities() { return kFinger; }

}  // namespace pincer::tasks
