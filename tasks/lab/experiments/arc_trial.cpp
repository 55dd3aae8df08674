#include "pincer/tasks/lab/experiments/arc_trial.h"

#include <cmath>

#include "pincer/contact/math.h"

namespace pincer::tasks {
namespace {

constexpr double kFreesTactor = 0.010;  // so far up the finger frees a frozen tactor [m]

FingerTrialSetup askedIn(const ArcTrialSetup& setup) {
  FingerTrialSetup asked = setup.asked;
  asked.intervals = static_cast<int>(setup.intervals.size());
  return asked;
}

// The finger points away from the operator, its pad down, and its tip is up by `pitch`.
Quat pointingAway(double pitch) {
  Mat3 R_WF;
  R_WF << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return quatFromRotationVector(pitch * Vec3::UnitX()) * Quat(R_WF);
}

}  // namespace

// D: x right, y up, z towards the operator.
Pose arcArmBase(double path_radius) {
  Mat3 R;
  R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return {Quat(R), Vec3(0, 0, path_radius)};
}

FingerPlace arcPlace(const ArcTrialSetup& setup) {
  FingerPlace place;
  place.X_WD = arcArmBase(setup.path_radius);
  place.start_W = (setup.path_radius + 0.01) * Vec3(0, math::sin(setup.start_angle), math::cos(setup.start_angle));
  place.finger_radius = setup.finger_radius;
  return place;
}

ArcTrial::ArcTrial(const ArcTrialSetup& setup, WornFinger& finger, StudySink& sink)
    : FingerTrial(askedIn(setup), finger, sink), setup_(setup) {
  const FingerWear& wear = finger.wear();
  model_.X_WD = movedBase(arcArmBase(setup.path_radius), wear.base);
  model_.finger_radius = setup.finger_radius;
  model_.stiffness = setup.stiffness;
  model_.gate = devices::within(model_.gate, wear.arm);
  if (wear.oldest_sample) model_.gate.watchdog_time = *wear.oldest_sample;
  if (wear.has_motors) {
    model_.passivity.on = true;
    model_.passivity.arms = {{wear.arm.tip_mass.value_or(grasp::ArmPort{}.mass), wear.arm.tip_damping}};
    state_.passivity = grasp::PassivityState(1);
  }
  devices::arm(state_.gate);
  finger.setTransmission(shown().transmission);
}

FingerOutputs ArcTrial::step(const FingerInputs& inputs, double now, double dt) {
  out_ = planarTick(model_, shown().shown, state_, inputs.arm, now, dt);
  freezeFrontEnd();
  return {out_.f_D, out_.tactile};
}

FingerTrial::Felt ArcTrial::felt() const { return {out_.contact.phi <= 0, out_.contact.phi, state_.v_WF.norm()}; }

void ArcTrial::startInterval(int) {
  finger().setTransmission(shown().transmission);
  state_.force_tracker = state_.tactile_tracker = {};
}

// Holds the place wanted, which the display's FIFO delays: so the place displayed
// freezes at the same place, that much later.
void ArcTrial::freezeFrontEnd() {
  if (setup_.freeze_share >= 1) return;
  const double reach = shown().shown.largest_place, place = out_.tactile.place_L.x();
  if (out_.contact.phi > kFreesTactor) side_ = 0;
  if (side_ == 0) frozen_ = false;
  if (side_ == 0 && out_.contact.phi <= 0) side_ = place < 0 ? -1 : 1;
  const double held = side_ * reach * (1 - 2 * setup_.freeze_share);
  frozen_ = frozen_ || (side_ != 0 && side_ * (place - held) <= 0);
  if (frozen_) out_.tactile.place_L.x() = held;
}

Vec3 ArcTrial::proxy_W() const {
  if (out_.contact.phi > 0) return state_.p_WF;
  const Vec3 n_W(0, out_.contact.n_B.x(), out_.contact.n_B.y());
  return Vec3(state_.p_WF.x(), out_.contact.p_BS.x(), out_.contact.p_BS.y()) + setup_.finger_radius * n_W;
}

void ArcTrial::fill(SampleRecord& sample) const {
  FingerRecord& finger = sample.fingers[0];
  const Vec3 n_W(0, out_.contact.n_B.x(), out_.contact.n_B.y());
  const Vec3 p_WP(0, out_.contact.p_BS.x(), out_.contact.p_BS.y());
  finger.p_WF = {state_.p_WF.x(), state_.p_WF.y(), state_.p_WF.z()};
  const Vec3 on_surface_W = p_WP + setup_.finger_radius * n_W;
  finger.p_WP = {on_surface_W.x(), on_surface_W.y(), on_surface_W.z()};
  finger.f_contact_W = {out_.f_W.x(), out_.f_W.y(), out_.f_W.z()};
  finger.normal_force = out_.normal_force;
  finger.gap = out_.contact.phi;
  fillFinger(finger);
}

const grasp::GraspModel& ArcTrial::pictured() {
  if (picture_) return *picture_;
  engine::WorldBuilder world{engine::WorldOptions{}};
  for (std::size_t i = 0; i < setup_.intervals.size(); ++i)
    world.addBody({i == 0 ? "first" : "second", setup_.intervals[i].picture.shape, false, 0, {}});
  grasp::FingerModel finger;
  finger.name = "index";
  finger.radius = setup_.finger_radius;
  return picture_.emplace(grasp::buildGrasp(std::move(world), {finger}));
}

void ArcTrial::fill(Snapshot& snapshot) const {
  for (std::size_t i = 0; i < snapshot.X_WB.size(); ++i) snapshot.X_WB[i] = setup_.intervals[i].picture.X_WB;
  snapshot.hidden_body = snapshot.X_WB.size() > 1 ? 1 - interval() : -1;
  FingerSnapshot& finger = snapshot.fingers[0];
  finger.p_WF = state_.p_WF;
  finger.p_WP = proxy_W();
  finger.q_WF = pointingAway(state_.pitch);
  finger.f_user_W = out_.f_W;
  finger.normal_force = out_.normal_force;
  finger.touching = out_.contact.phi <= 0;
  fillMount(finger);
  snapshot.contact_count = finger.touching ? 1 : 0;
  if (!finger.touching) return;
  const Vec3 n_W(0, out_.contact.n_B.x(), out_.contact.n_B.y());
  snapshot.contacts[0] = {0, interval(), -1, proxy_W() - setup_.finger_radius * n_W, n_W, out_.f_W, 0, false};
}

}  // namespace pincer::tasks
