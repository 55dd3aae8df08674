#include "pincer/tasks/play/play_session.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/elementary.h"

namespace pincer::tasks {
namespace {

constexpr int kBall = 1;                           // place of the ball among the bodies, after the dish or floor
constexpr double kBallRadius = 0.02, kTip = 8e-3;  // [m]
constexpr double kStiffness = 400;                 // of the fingers of pickup [N/m]
constexpr double kCloseSpeed = 0.1;                // of the fingers [m/s]
// Of the hand's middle, which goes towards the pointer the faster, the farther off it is. A ball of 75 g that starts
// with the hand weighs a quarter more meanwhile. [m/s, 1/s, m/s^2]
constexpr double kTopSpeed = 0.2, kFollow = 10, kMostAcceleration = 2.5;
constexpr double kOpen = 0.09;                   // between the fingertips of an open hand [m]
constexpr double kLowest = 9e-3, kReach = 0.12;  // where the hand's middle may be: z at least, and from the origin [m]
constexpr double kPull = 60, kMostPull = 5;      // of the pointer's spring [N/m, N]
constexpr double kHeight = 0.1;                  // of the ball of the pinch [m]

engine::BodyStart at(double z) { return {{Quat::Identity(), Vec3(0, 0, z)}, Vec3::Zero(), Vec3::Zero()}; }

grasp::FingerModel finger(const char* name) {
  grasp::FingerModel finger;
  finger.name = name;
  finger.radius = kTip;
  return finger;
}

grasp::GraspModel pickupModel() {
  const engine::Material skin{0.6, 0.51, 0, 3.3e-3};
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"dish", contact::Dish{0.15}, false, 0, {0.6, 0.51}});
  builder.addBody({"ball", contact::Sphere{kBallRadius}, true, 0.075, skin});
  std::vector<grasp::FingerModel> fingers = {finger("thumb"), finger("index")};
  for (grasp::FingerModel& one : fingers) {
    one.coupling.stiffness = Vec3::Constant(kStiffness);
    one.coupling.twist_stiffness = 0.3, one.coupling.twist_damping = 1e-3;
  }
  return grasp::buildGrasp(std::move(builder), std::move(fingers));
}

grasp::GraspModel pinchModel() {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {0.5, 0.5}});
  builder.addBody({"ball", contact::Sphere{kBallRadius}, true, 0.1, {0.5, 0.5}});
  std::vector<grasp::FingerModel> fingers = {finger("left"), finger("right")};
  for (grasp::FingerModel& one : fingers) {
    one.coupling.mass = 0.05;
    one.coupling.stiffness = one.coupling.damping = Vec3::Zero();
    one.coupling.locked << false, true, true;
  }
  return grasp::buildGrasp(std::move(builder), std::move(fingers));
}

bool isPickup(const std::string& scene) {
  if (scene == "pickup") return true;
  if (scene == "pinch") return false;
  throw InputError(fmt::format("no scene \"{}\" to play; there are pickup and pinch", scene));
}

Vec3 shortened(const Vec3& v, double longest) { return v * std::min(1.0, longest / std::max(v.norm(), 1e-12)); }

double side(int finger) { return finger == 0 ? -1 : 1; }

Vec3 startOf(bool is_pickup, int finger) {
  return is_pickup ? Vec3(side(finger) * kOpen / 2, 0, 0.04) : Vec3(side(finger) * (kBallRadius + kTip), 0, kHeight);
}

}  // namespace

PlaySession::PlaySession(const std::string& scene)
    : is_pickup_(isPickup(scene)),
      model_(is_pickup_ ? pickupModel() : pinchModel()),
      state_(grasp::makeState(model_, {at(0), at(is_pickup_ ? kBallRadius : kHeight)},
                              {startOf(is_pickup_, 0), startOf(is_pickup_, 1)})),
      scratch_(grasp::makeScratch(model_)),
      inputs_(2),
      forces_(2),
      middle_W_(0, 0, startOf(is_pickup_, 0).z()),
      gap_(kOpen) {
  for (int i = 0; i < 2; ++i) inputs_[static_cast<std::size_t>(i)].p_WF = startOf(is_pickup_, i);
}

void PlaySession::tick(const PlayWish& wish) {
  is_pickup_ ? closeFingers(wish) : pullBall(wish);
  const auto report = grasp::step(model_, state_, *scratch_, inputs_, {}, {.forces = forces_});
  flagged_ += (report.status & engine::kSolverNotConverged) != 0;
}

// The hand follows the pointer as fast as a hand does, and presses no harder than the grip.
void PlaySession::closeFingers(const PlayWish& wish) {
  Vec3 wanted_W = wish.p_W.cwiseMin(kReach).cwiseMax(-kReach);
  wanted_W.z() = std::max(wanted_W.z(), kLowest);
  const Vec3 v_wanted_W = shortened(kFollow * (wanted_W - middle_W_), kTopSpeed);
  v_middle_W_ += shortened(v_wanted_W - v_middle_W_, kMostAcceleration * kTick);
  middle_W_ += kTick * v_middle_W_;
  const double apart = (fingertip(1) - fingertip(0)).x(), step = kCloseSpeed * kTick;
  gap_ = wish.squeezes ? std::max({gap_ - step, apart - 2 * std::clamp(wish.grip, 0.1, 10.0) / kStiffness, 0.0})
                       : std::min(gap_ + step, kOpen);
  for (int i = 0; i < 2; ++i) {
    grasp::FingerInput& input = inputs_[static_cast<std::size_t>(i)];
    const Vec3 p_WF = middle_W_ + Vec3(side(i) * gap_ / 2, 0, 0);
    input.v_WF = (p_WF - input.p_WF) / kTick;
    input.p_WF = p_WF;
  }
}

void PlaySession::pullBall(const PlayWish& wish) {
  const double grip = std::clamp(wish.grip, 0.1, 10.0);
  for (int i = 0; i < 2; ++i) inputs_[static_cast<std::size_t>(i)].f_W = Vec3(-side(i) * grip, 0, 0);
  pull_W_ = wish.squeezes ? shortened(kPull * (wish.p_W - bodyPose(kBall).p), kMostPull) : Vec3::Zero();
  forces_[kBall].f_W = pull_W_;
}

Pose PlaySession::bodyPose(int body) const { return engine::bodyPose(model_.world, state_.world, body); }

Vec3 PlaySession::fingertip(int finger) const { return state_.world.points[static_cast<std::size_t>(finger)].p_W; }

std::uint64_t hashOfScript(const std::string& scene, int ticks) {
  PlaySession session(scene);
  const Vec3 start_W = scene == "pickup" ? Vec3(0, 0, 0.02) : Vec3(0, 0, kHeight);
  for (int i = 0; i < ticks; ++i) {
    const double t = PlaySession::kTick * i, lift = std::clamp(t - 1, 0.0, 1.0);
    const double shake = 0.01 * lift * math::sin(20 * t);
    session.tick({start_W + Vec3(shake, 0.5 * shake, 0.05 * lift), t > 0.2, 2});
  }
  return session.hash();
}

}  // namespace pincer::tasks
