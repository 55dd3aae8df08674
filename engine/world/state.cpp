#include "pincer/engine/state.h"

#include <fmt/format.h>

#include <bit>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/motion/free_motion.h"
#include "pincer/engine/world/joints.h"
#include "pincer/engine/world/tree_motion.h"

namespace pincer::engine {
namespace {

class Fnv1a {
 public:
  void add(std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte) {
      hash_ = (hash_ ^ ((bits >> (8 * byte)) & 0xff)) * 1099511628211ull;
    }
  }
  void add(double x) { add(std::bit_cast<std::uint64_t>(x)); }
  void add(const Vec3& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  }
  void add(const Quat& q) {
    for (int i = 0; i < 4; ++i) add(q.coeffs()[i]);
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037ull;
};

void add(Fnv1a& hash, const ContactMemory& c) {
  hash.add(c.id);
  for (const ContactVector* v : {&c.r, &c.offset_C}) {
    for (const double x : *v) hash.add(x);
  }
  for (const Vec3& v : {c.t1_W, c.n_W, c.arm_a_W, c.arm_b_W}) hash.add(v);
  hash.add(static_cast<std::uint64_t>(c.active) | static_cast<std::uint64_t>(c.sliding) << 1 |
           static_cast<std::uint64_t>(c.closing) << 2 | static_cast<std::uint64_t>(c.anchored) << 3 |
           static_cast<std::uint64_t>(c.open_ticks) << 4 | static_cast<std::uint64_t>(c.settling) << 8);
}

bool isFinite(const BodyStart& s) {
  return s.X_WB.p.allFinite() && s.X_WB.q.coeffs().allFinite() && s.v_W.allFinite() && s.w_W.allFinite();
}

}  // namespace

WorldState makeState(const WorldModel& model, const std::vector<BodyStart>& starts, const std::vector<Vec3>& points) {
  if (starts.size() != model.bodies.size() || points.size() != model.points.size()) {
    throw InputError(fmt::format("{} body starts and {} points given for a world of {} bodies and {} points.",
                                 starts.size(), points.size(), model.bodies.size(), model.points.size()));
  }
  WorldState state;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const BodyModel& body = model.bodies[i];
    if (!isFinite(starts[i])) throw InputError(fmt::format("body \"{}\": its start isn't finite.", body.name));
    PINCER_DEMAND(isUnit(starts[i].X_WB.q), "makeState: the starts' quaternions have length 1; normalise them");
    BodyState s;
    s.X_WI = starts[i].X_WB * body.X_BI;
    s.X_WI.q.normalize();
    s.v_W = starts[i].v_W;
    if (body.driven) state.driven_w_W.push_back(starts[i].w_W);
    if (body.dynamic) s.L_W = s.X_WI.q * body.moments.cwiseProduct(s.X_WI.q.conjugate() * starts[i].w_W);
    state.bodies.push_back(s);
  }
  for (const Vec3& p : points) {
    if (!p.allFinite()) throw InputError("a driven point's start isn't finite.");
    PointState s;
    s.p_W = s.p_target_W = p;
    state.points.push_back(s);
  }
  for (const JointModel& joint : model.joints) {
    const Vec2 gap = jointGap(state, joint);
    if (!(gap.maxCoeff() > kLargestJointGap)) continue;
    throw InputError(fmt::format(
        "the joint of body \"{}\": at the start its two sides are {:g} m and {:g} rad apart, more than {:g}. Start the "
        "bodies where the joint holds them.",
        model.bodies[joint.a].name, gap[0], gap[1], kLargestJointGap));
  }
  readTrees(model, state);
  state.contacts.resize(static_cast<std::size_t>(model.options.max_contacts));
  return state;
}

void growContacts(int contacts, WorldModel& model, WorldState& state) {
  if (contacts < model.options.max_contacts || contacts > kMostContacts) {
    throw InputError(fmt::format(
        "growContacts: {} contacts; there is room for {}, and {} at most can be had. Ask for a number between them.",
        contacts, model.options.max_contacts, kMostContacts));
  }
  model.options.max_contacts = contacts;
  state.contacts.resize(static_cast<std::size_t>(contacts));
}

Pose bodyPose(const WorldModel& model, const WorldState& state, int body) {
  PINCER_ASSERT(isIndex(body, state.bodies.size()));
  return state.bodies[body].X_WI * model.bodies[body].X_IB;
}

Vec3 bodyAngularVelocity(const WorldModel& model, const WorldState& state, int body) {
  if (model.bodies[body].driven) return state.driven_w_W[model.bodies[body].motion];
  if (!model.bodies[body].dynamic) return Vec3::Zero();
  return angularVelocity(model.bodies[body].rotation, state.bodies[body].X_WI.q, state.bodies[body].L_W);
}

double kineticEnergy(const WorldModel& model, const WorldState& state) {
  PINCER_DEMAND(state.bodies.size() == model.bodies.size(), "the state is one of this model");
  double energy = 0;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (!model.bodies[i].dynamic) continue;
    const BodyState& s = state.bodies[i];
    energy += 0.5 * (model.bodies[i].mass * s.v_W.squaredNorm() +
                     s.L_W.dot(bodyAngularVelocity(model, state, static_cast<int>(i))));
  }
  if (!model.trees.empty()) energy += armatureEnergy(model, state);
  return energy;
}

double potentialEnergy(const WorldModel& model, const WorldState& state) {
  return potentialEnergy(model, state, model.options.gravity_W);
}

double potentialEnergy(const WorldModel& model, const WorldState& state, const Vec3& gravity_W) {
  PINCER_DEMAND(state.bodies.size() == model.bodies.size(), "the state is one of this model");
  double energy = 0;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    energy -= model.bodies[i].mass * gravity_W.dot(state.bodies[i].X_WI.p);
  }
  if (!model.trees.empty()) energy += springEnergy(model, state);
  return energy;
}

std::uint64_t hashOf(const WorldState& state) {
  PINCER_ASSERT(state.contact_count >= 0 && static_cast<std::size_t>(state.contact_count) <= state.contacts.size());
  Fnv1a hash;
  hash.add(state.time);
  hash.add(static_cast<std::uint64_t>(state.tick));
  hash.add(state.h_last);
  hash.add(static_cast<std::uint64_t>(state.parts));
  for (const BodyState& b : state.bodies) {
    hash.add(b.X_WI.q);
    for (const Vec3& v : {b.X_WI.p, b.v_W, b.L_W}) hash.add(v);
  }
  for (const Vec3& w_W : state.driven_w_W) hash.add(w_W);
  for (const PointState& p : state.points) {
    for (const Vec3& v : {p.p_W, p.v_W, p.p_target_W, p.v_target_W}) hash.add(v);
    hash.add(static_cast<std::uint64_t>(p.touching));
    if (p.twist != 0 || p.twist_rate != 0) {  // of fingers that twist
      hash.add(p.twist);
      hash.add(p.twist_rate);
    }
    if (p.turn_W.isZero(0) && p.turn_rate_W.isZero(0)) continue;  // of fingers that don't turn past their devices
    hash.add(p.turn_W);
    hash.add(p.turn_rate_W);
  }
  for (const auto* numbers : {&state.tree_q, &state.tree_v}) {
    for (const double x : *numbers) hash.add(x);
  }
  for (const BrakeMemory memory : state.brakes) hash.add(static_cast<std::uint64_t>(memory));
  for (std::size_t d = 0; d < state.drives.size(); ++d) {
    hash.add(state.controls[d].value);
    hash.add(state.controls[d].rate);
    hash.add(static_cast<std::uint64_t>(state.drives[d]) << 1 | static_cast<std::uint64_t>(state.controls[d].moves));
  }
  for (int i = 0; i < state.contact_count; ++i) add(hash, state.contacts[i]);
  return hash.value();
}

}  // namespace pincer::engine
