#include "pincer/grasp/baseline.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/colliders.h"
#include "pincer/grasp/baseline/nearest_outside.h"
#include "pincer/grasp/tick/finger_contacts.h"
#include "pincer/grasp/tick/finger_tick.h"
#include "pincer/grasp/tick/followed_shapes.h"

namespace pincer::grasp {
namespace {

constexpr double kSmoothedSlip = 1e-3;  // below it the penalty's friction grows with speed [m/s]
constexpr double kLookAround = 1e-3;    // surfaces further than the proxy moves, plus this, don't matter [m]
constexpr int kMoves = 4;               // of the proxy per tick, each with the surfaces seen anew
constexpr double kResting = 1e-6;       // a proxy this near to a surface rests on it [m]

// A surface near the finger, in W.
struct NearSurface {
  int body = 0, collider = 0;
  Vec3 p_W, n_W;  // where, and the normal of the force
  Vec3 facet_W;   // the normal of what is really there: the same but for force shading
  double phi = 0;
};

struct NearSurfaces {
  std::array<NearSurface, kMostPlanes> all;
  int count = 0;

  void add(const NearSurface& s) {
    if (count < kMostPlanes) all[static_cast<std::size_t>(count++)] = s;
  }
  const NearSurface* nearest() const {
    const auto end = all.begin() + count;
    const auto least = std::min_element(all.begin(), end, [](const auto& a, const auto& b) { return a.phi < b.phi; });
    return count > 0 ? &*least : nullptr;
  }
};

class BaselineFinger {
 public:
  BaselineFinger(const GraspModel& model, FingerMethod method, GraspState& state, BaselineState& memory,
                 GraspScratch& scratch, const FingerInput& input, int finger)
      : model_(model),
        state_(state),
        scratch_(scratch),
        input_(input),
        index_(finger),
        finger_(model.fingers[static_cast<std::size_t>(finger)]),
        method_(method),
        memory_(memory),
        k_(finger_.coupling.stiffness.x()) {}

  FingerReport run() {
    PINCER_ASSERT(isUnitIfFinite(input_.q_WF));
    if (method_ == FingerMethod::kPenalty) {
      penalty();
    } else {
      godObject();
    }
    finish();
    memory_.p_WF = input_.p_WF;
    return report_;
  }

 private:
  // Everything within `margin` of the finger at `p_W`.
  NearSurfaces look(const Vec3& p_W, double margin, bool afresh) {
    NearSurfaces near;
    FingerFollower follower(state_.followed, index_, scratch_.spare_tracker);
    for (int i = 0; i < static_cast<int>(model_.world.colliders.size()); ++i)
      lookAt(i, p_W, margin, afresh ? nullptr : &follower, near);
    return near;
  }

  // Without `follower` as if for the first time.
  void lookAt(int collider, const Vec3& p_W, double margin, FingerFollower* follower, NearSurfaces& near) {
    const engine::ColliderModel& c = model_.world.colliders[static_cast<std::size_t>(collider)];
    if (engine::isOnlySeen(c.bits)) return;
    const Pose X_WS = engine::poseOf(c, engine::bodyPose(model_.world, state_.world, c.body));
    const Vec3 p_SC = X_WS.q.conjugate() * (p_W - X_WS.p);
    const contact::Shape& shape = feltShape(model_, collider);
    if (contact::lowerBoundOfGap(shape, p_SC, finger_.radius) > margin) return;
    const bool is_followed = follower && (finger_.shape || std::holds_alternative<contact::Mesh>(shape));
    contact::FingerTracker& tracker = is_followed ? follower->of(collider) : scratch_.spare_tracker;
    if (!is_followed) tracker = {};
    const contact::FingerContacts found =
        fingerOnShape(finger_, shape, X_WS, {input_.q_WF, p_W}, margin, tracker, scratch_.world.patches);
    if (is_followed) follower->noteGap(found.main().phi);
    for (int i = 0; i < found.count; ++i) {
      const contact::SurfaceContact& s = found.points[static_cast<std::size_t>(i)];
      if (s.phi > margin) continue;
      const Vec3 to_centre =
          finger_.shape ? s.n_B : Vec3(signOf(s.phi + finger_.radius) * (p_SC - s.p_BS).normalized());
      near.add({c.body, collider, X_WS * s.p_BS, X_WS.q * s.n_B, X_WS.q * to_centre, s.phi});
    }
  }

  const engine::Material& materialOf(const NearSurface& s) const {
    return model_.world.colliders[static_cast<std::size_t>(s.collider)].material;
  }

  Vec3 surfaceVelocity(const NearSurface& s) const {
    const engine::BodyState& body = state_.world.bodies[static_cast<std::size_t>(s.body)];
    return body.v_W + engine::bodyAngularVelocity(model_.world, state_.world, s.body).cross(s.p_W - body.X_WI.p);
  }

  void penalty() {
    const NearSurfaces near = look(input_.p_WF, 0, true);
    const double d = finger_.coupling.damping.x();
    for (int i = 0; i < near.count; ++i) {
      const NearSurface& s = near.all[static_cast<std::size_t>(i)];
      const Vec3 v = input_.v_WF - surfaceVelocity(s), v_t = v - v.dot(s.n_W) * s.n_W;
      const double f_n = std::max(-k_ * s.phi - d * v.dot(s.n_W), 0.0), speed = v_t.norm();
      const double mu = materialOf(s).mu_d;
      Vec3 f = f_n * s.n_W;
      if (speed > 0) f -= mu * f_n * std::min(1.0, speed / kSmoothedSlip) / speed * v_t;
      push(s, f, f_n);
      report_.sliding = report_.sliding || speed > kSmoothedSlip;
    }
  }

  Vec3 proxyInWorld() const {
    if (!memory_.has_proxy) return input_.p_WF;
    return memory_.body < 0 ? memory_.p_P : engine::bodyPose(model_.world, state_.world, memory_.body) * memory_.p_P;
  }

  // The same but for shading, and for what had begun to slip.
  Vec3 goalOnCircle(const Vec3& proxy_W, const NearSurface& resting) {
    const Vec3 way = input_.p_WF - proxy_W;
    const double pressed = -way.dot(resting.facet_W);
    if (pressed <= 0) return input_.p_WF;
    const Vec3 along = way + pressed * resting.facet_W;
    const engine::Material& material = materialOf(resting);
    const double length = along.norm();
    report_.sliding = length > (memory_.slips ? material.mu_d : material.mu_s) * pressed;
    const double kept = report_.sliding ? std::max(0.0, 1 - material.mu_d * pressed / length) : 0;
    return proxy_W + kept * along - pressed * resting.facet_W;
  }

  // Where the proxy is to go: the device, or what friction and shading leave of the way to it.
  Vec3 goalFor(const Vec3& proxy_W, const NearSurface* resting) {
    const Vec3 way = input_.p_WF - proxy_W;
    if (method_ == FingerMethod::kGodObject || !resting || resting->phi > kResting) return input_.p_WF;
    if (method_ == FingerMethod::kFrictionCone) return goalOnCircle(proxy_W, *resting);
    const double pressed = -way.dot(resting->n_W);
    if (pressed <= 0) return input_.p_WF;
    const Vec3 along = way + pressed * resting->n_W;
    const engine::Material& material = materialOf(*resting);
    const double length = along.norm(), held = material.mu_s * pressed;
    report_.sliding = length > held;
    const double kept = report_.sliding ? 1 - material.mu_d * pressed / length : 0;
    return proxy_W + kept * along - pressed * resting->facet_W;
  }

  void godObject() {
    Vec3 proxy_W = proxyInWorld();
    NearSurfaces near = look(proxy_W, (input_.p_WF - proxy_W).norm() + kLookAround, false);
    const Vec3 goal = goalFor(proxy_W, near.nearest());
    NearestOutside placed{goal, {}};
    for (int move = 0; move < kMoves; ++move) {
      std::array<OuterSide, kMostPlanes> planes;
      for (int i = 0; i < near.count; ++i) {
        const NearSurface& s = near.all[static_cast<std::size_t>(i)];
        planes[static_cast<std::size_t>(i)] = {s.facet_W, s.facet_W.dot(proxy_W) - s.phi};
      }
      placed = nearestOutside({planes.data(), static_cast<std::size_t>(near.count)}, goal);
      const bool arrived = (placed.x - proxy_W).norm() < 1e-9;
      proxy_W = placed.x;
      if (arrived) break;
      near = look(proxy_W, (goal - proxy_W).norm() + kLookAround, false);
    }
    takeForce(proxy_W, near, placed);
  }

  // The spring's force, shared by the surfaces that hold the proxy.
  void takeForce(const Vec3& proxy_W, const NearSurfaces& near, const NearestOutside& placed) {
    double sum = 0, most = 0;
    int main = -1;
    for (int i = 0; i < near.count; ++i) {
      const double lambda = placed.lambda[static_cast<std::size_t>(i)];
      sum += lambda;
      if (lambda > most) main = i;
      most = std::max(most, lambda);
    }
    memory_ = {true, report_.sliding, -1, proxy_W, memory_.p_WF};
    if (main < 0) return;
    const Vec3 f_W = k_ * (proxy_W - input_.p_WF);
    for (int i = 0; i < near.count; ++i) {
      const NearSurface& s = near.all[static_cast<std::size_t>(i)];
      const double share = placed.lambda[static_cast<std::size_t>(i)] / sum;
      if (share > 0) push(s, share * f_W, share * f_W.dot(s.n_W));
    }
    PINCER_ASSERT(sum > 0);
    memory_.body = near.all[static_cast<std::size_t>(main)].body;
    memory_.p_P = engine::bodyPose(model_.world, state_.world, memory_.body).inverse() * proxy_W;
  }

  // Force `f_W` on the user at surface `s`; the body gets the opposite, as an outer force during the coming tick.
  void push(const NearSurface& s, const Vec3& f_W, double f_n) {
    const engine::BodyModel& body = model_.world.bodies[static_cast<std::size_t>(s.body)];
    report_.f_contact_W += f_W;
    report_.normal_force += f_n;
    report_.p_WC += f_n * s.p_W;
    if (report_.body < 0 || f_n > largest_) {
      report_.body = s.body;
      report_.n_W = s.n_W;
    }
    largest_ = std::max(largest_, f_n);
    if (!body.dynamic) return;
    engine::BodyState& b = state_.world.bodies[static_cast<std::size_t>(s.body)];
    const double h = model_.world.options.h;
    b.v_W -= h * body.inverse_mass * f_W;
    b.L_W -= h * (s.p_W - b.X_WI.p).cross(f_W);
  }

  void finish() {
    report_.f_user_W = report_.f_contact_W;
    report_.touching = report_.normal_force > 0;
    report_.gap = kInfinity;
    if (!report_.touching) return;
    report_.p_WC /= report_.normal_force;
    report_.tangential_force = (report_.f_contact_W - report_.f_contact_W.dot(report_.n_W) * report_.n_W).norm();
    report_.touch = {true, input_.q_WF, -report_.n_W, -report_.n_W};
  }

  const GraspModel& model_;
  GraspState& state_;
  GraspScratch& scratch_;
  const FingerInput& input_;
  const int index_;
  const FingerModel& finger_;
  const FingerMethod method_;
  BaselineState& memory_;
  const double k_;
  FingerReport report_;
  double largest_ = 0;
};

// Contacts of the fingers that are proxies; the others act by their forces alone.
class ProxyContacts final : public engine::ContactSource {
 public:
  ProxyContacts(const GraspModel& model, std::span<const FingerMethod> methods, GraspState& state,
                GraspScratch& scratch, std::span<const FingerInput> inputs)
      : model_(model), methods_(methods), state_(state), scratch_(scratch), inputs_(inputs) {}
  void addContacts(engine::WorldScratch&) override {
    for (std::size_t i = 0; i < methods_.size(); ++i) {
      if (methods_[i] == FingerMethod::kProxy) findFingerContacts(model_, static_cast<int>(i), state_, scratch_);
    }
    engine::mark(scratch_.world, engine::Stage::kFingerContacts);
  }
  bool repeatsItself() const override { return keepOrientations(inputs_, scratch_); }

 private:
  const GraspModel& model_;
  std::span<const FingerMethod> methods_;
  GraspState& state_;
  GraspScratch& scratch_;
  std::span<const FingerInput> inputs_;
};

}  // namespace

BaselineFingers::BaselineFingers(std::vector<FingerMethod> methods)
    : methods_(std::move(methods)), memories_(methods_.size()), reports_(methods_.size()) {}

GraspReport BaselineFingers::step(const GraspModel& model, GraspState& state, GraspScratch& scratch,
                                  std::span<const FingerInput> inputs, std::span<const engine::MotionInput> motions,
                                  std::span<const engine::DriveInput> controls) {
  setInputs(model, state, inputs, scratch);
  for (std::size_t i = 0; i < methods_.size(); ++i) {
    if (methods_[i] == FingerMethod::kProxy) continue;
    reports_[i] =
        BaselineFinger(model, methods_[i], state, memories_[i], scratch, inputs[i], static_cast<int>(i)).run();
  }
  ProxyContacts contacts(model, methods_, state, scratch, inputs);
  const engine::StepReport report =
      engine::step(model.world, state.world, scratch.world, {scratch.inputs, motions, {}, controls}, &contacts);
  if (report.asleep) return {report, scratch.fingers};
  for (std::size_t i = 0; i < methods_.size(); ++i) {
    const int finger = static_cast<int>(i);
    if (methods_[i] == FingerMethod::kProxy) {
      reportFinger(model, state, finger, firstOf(contactsFrom(scratch, finger), finger), scratch);
    } else {
      scratch.fingers[i] = reports_[i];
    }
    rememberFinger(model, inputs[i], finger, state, scratch);
  }
  engine::mark(scratch.world, engine::Stage::kFingerReport);
  return {report, scratch.fingers};
}

}  // namespace pincer::grasp
