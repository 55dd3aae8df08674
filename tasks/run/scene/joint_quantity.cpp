// Quantities of joints, drives, frames, and of what touches between two bodies.
#include <array>

#include "pincer/tasks/run/quantity.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

using M = const Moment&;
using I = std::size_t;

const engine::WorldScratch& world(M m) { return grasp::worldOf(m.scratch); }

double position(M m, I i) { return engine::jointPosition(m.model.world, m.state.world, static_cast<int>(i)); }
double velocity(M m, I i) { return engine::jointVelocity(m.model.world, m.state.world, static_cast<int>(i)); }
engine::JointReport joint(M m, I i) { return engine::jointAt(m.model.world, world(m), static_cast<int>(i)); }
engine::JointLoad load(M m, I i) {
  return engine::jointLoadAt(m.model.world, m.state.world, world(m), static_cast<int>(i));
}
// The share of the load along or about the joint's axis.
double force(M m, I i) {
  const engine::JointLoad all = load(m, i);
  return m.model.world.joints[static_cast<I>(m.model.world.joint_places[i].joint)].kind == engine::JointKind::kSlider
             ? all.f_J.z()
             : all.moment_J.z();
}
engine::DriveReport drive(M m, I i) { return engine::driveAt(world(m), static_cast<int>(i)); }

// Pose of a frame, and the velocity of its origin.
struct FrameMoment {
  Pose X_WF;
  Vec3 v_W, w_W;
};
FrameMoment frame(M m, I i) {
  const BodyFrame& f = m.frames[i];
  const Pose X_WB = engine::bodyPose(m.model.world, m.state.world, f.body);
  const engine::BodyState& body = m.state.world.bodies[static_cast<I>(f.body)];
  const Vec3 w_W = engine::bodyAngularVelocity(m.model.world, m.state.world, f.body);
  const Pose X_WF = X_WB * f.X_BF;
  return {X_WF, body.v_W + w_W.cross(X_WF.p - body.X_WI.p), w_W};
}

// Contact forces between two bodies: on the first, summed.
struct PairMoment {
  Vec3 f_W = Vec3::Zero();
  double normal_force = 0;
  bool touches = false, slides = false;
};
PairMoment pair(M m, I i) {
  const I bodies = m.model.world.bodies.size();
  const int a = static_cast<int>(i / bodies), b = static_cast<int>(i % bodies);
  PairMoment sum;
  for (int k = 0; k < engine::contactCount(world(m)); ++k) {
    const engine::ContactReport c = engine::contactAt(world(m), k);
    const bool first_touches = c.other_body == a && c.body == b;
    if (!c.pushes || !(first_touches || (c.other_body == b && c.body == a))) continue;
    sum.f_W += first_touches ? c.f_W : Vec3(-c.f_W);
    sum.normal_force += c.f_W.dot(c.n_W);
    sum.touches = true;
    sum.slides = sum.slides || c.sliding;
  }
  return sum;
}

// Quantities: name in scenes, SI unit, how it is measured. Here of a joint.
constexpr std::array kJoint = {
    QuantityKind{"position", "rad or m", position},
    QuantityKind{"velocity", "rad/s or m/s", velocity},
    QuantityKind{"stop_force", "N m or N", [](M m, I i) { return joint(m, i).stop_force; }},
    QuantityKind{"friction_force", "N m or N", [](M m, I i) { return joint(m, i).friction_force; }},
    QuantityKind{"force", "N m or N", force},
    QuantityKind{"load_x", "N", [](M m, I i) { return load(m, i).f_J.x(); }},
    QuantityKind{"load_y", "N", [](M m, I i) { return load(m, i).f_J.y(); }},
    QuantityKind{"load_z", "N", [](M m, I i) { return load(m, i).f_J.z(); }},
    QuantityKind{"moment_x", "N m", [](M m, I i) { return load(m, i).moment_J.x(); }},
    QuantityKind{"moment_y", "N m", [](M m, I i) { return load(m, i).moment_J.y(); }},
    QuantityKind{"moment_z", "N m", [](M m, I i) { return load(m, i).moment_J.z(); }},
};

// Of a drive.
constexpr std::array kDrive = {
    QuantityKind{"force", "N m or N", [](M m, I i) { return drive(m, i).force; }},
    QuantityKind{"saturated", "-", [](M m, I i) { return drive(m, i).saturated ? 1.0 : 0.0; }},
};

// Of a frame, in W.
constexpr std::array kFrame = {
    QuantityKind{"p_x", "m", [](M m, I i) { return frame(m, i).X_WF.p.x(); }},
    QuantityKind{"p_y", "m", [](M m, I i) { return frame(m, i).X_WF.p.y(); }},
    QuantityKind{"p_z", "m", [](M m, I i) { return frame(m, i).X_WF.p.z(); }},
    QuantityKind{"q_w", "-", [](M m, I i) { return frame(m, i).X_WF.q.w(); }},
    QuantityKind{"q_x", "-", [](M m, I i) { return frame(m, i).X_WF.q.x(); }},
    QuantityKind{"q_y", "-", [](M m, I i) { return frame(m, i).X_WF.q.y(); }},
    QuantityKind{"q_z", "-", [](M m, I i) { return frame(m, i).X_WF.q.z(); }},
    QuantityKind{"v_x", "m/s", [](M m, I i) { return frame(m, i).v_W.x(); }},
    QuantityKind{"v_y", "m/s", [](M m, I i) { return frame(m, i).v_W.y(); }},
    QuantityKind{"v_z", "m/s", [](M m, I i) { return frame(m, i).v_W.z(); }},
    QuantityKind{"w_x", "rad/s", [](M m, I i) { return frame(m, i).w_W.x(); }},
    QuantityKind{"w_y", "rad/s", [](M m, I i) { return frame(m, i).w_W.y(); }},
    QuantityKind{"w_z", "rad/s", [](M m, I i) { return frame(m, i).w_W.z(); }},
};

// Of two bodies: force on the first.
constexpr std::array kPair = {
    QuantityKind{"f_x", "N", [](M m, I i) { return pair(m, i).f_W.x(); }},
    QuantityKind{"f_y", "N", [](M m, I i) { return pair(m, i).f_W.y(); }},
    QuantityKind{"f_z", "N", [](M m, I i) { return pair(m, i).f_W.z(); }},
    QuantityKind{"normal_force", "N", [](M m, I i) { return pair(m, i).normal_force; }},
    QuantityKind{"touching", "-", [](M m, I i) { return pair(m, i).touches ? 1.0 : 0.0; }},
    QuantityKind{"sliding", "-", [](M m, I i) { return pair(m, i).slides ? 1.0 : 0.0; }},
};

constexpr std::string_view kOr = " or ";  // between the unit of what turns and that of what slides

template <std::size_t N>
constexpr std::array<QuantityKind, N> inOneUnit(std::array<QuantityKind, N> kinds, bool slides) {
  for (QuantityKind& kind : kinds) {
    const std::size_t at = kind.unit.find(kOr);
    if (at == std::string_view::npos) continue;
    kind.unit = slides ? kind.unit.substr(at + kOr.size()) : kind.unit.substr(0, at);
  }
  return kinds;
}
constexpr auto kTurningJoint = inOneUnit(kJoint, false), kSlidingJoint = inOneUnit(kJoint, true);
constexpr auto kTurningDrive = inOneUnit(kDrive, false), kSlidingDrive = inOneUnit(kDrive, true);

// The row of `kinds` that `kind` is in `all`, or nullptr.
template <std::size_t N>
const QuantityKind* sameOf(const QuantityKind& kind, const std::array<QuantityKind, N>& all,
                           const std::array<QuantityKind, N>& kinds) {
  for (std::size_t i = 0; i < N; ++i)
    if (&all[i] == &kind) return &kinds[i];
  return nullptr;
}

}  // namespace

const QuantityKind& inUnitOf(bool slides, const QuantityKind& kind) {
  const QuantityKind* of_joint = sameOf(kind, kJoint, slides ? kSlidingJoint : kTurningJoint);
  const QuantityKind* of_drive = sameOf(kind, kDrive, slides ? kSlidingDrive : kTurningDrive);
  return of_joint ? *of_joint : of_drive ? *of_drive : kind;
}

std::span<const QuantityKind> jointQuantities() { return kJoint; }
std::span<const QuantityKind> driveQuantities() { return kDrive; }
std::span<const QuantityKind> frameQuantities() { return kFrame; }
std::span<const QuantityKind> pairQuantities() { return kPair; }

}  // namespace pincer::tasks
