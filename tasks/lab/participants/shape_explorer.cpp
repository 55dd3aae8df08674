#include "pincer/tasks/lab/participants/shape_explorer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pincer::tasks {
namespace {

constexpr double kFeltPush = 0.3;       // while following, a weaker push means that the finger has left the surface [N]
constexpr double kSinkSpeed = 0.05;     // then the aim goes in [m/s]
constexpr double kRoundOff = 1e-12;     // keeps a variance of 0 positive [m^2]
constexpr double kLeast = 1e-12;        // a likelihood: no reading rules a solid out for ever
constexpr double kGiveWay = 20;         // else the aim goes to where the finger would feel the wanted push, at this rate [1/s]
constexpr double kLeastReach = 0.02;    // nearer the middle the angle goes no faster [m]
constexpr double kLeastProgress = 0.1;  // of the finger's speed: however steep the surface, the pass goes on
constexpr double kLeastInPlane = 0.1;   // a push further than this from the pass's plane (as a cosine) doesn't say where the surface goes

double angleBetweenUnits(const Vec3& a, const Vec3& b) { return math::atan2(a.cross(b).norm(), a.dot(b)); }

// Turned by a random small angle about both axes across.
Vec3 blurred(const Vec3& direction, double sd, Random& random) {
  const Quat q = drawRotation(sd, random);
  return q * direction;
}

}  // namespace

ShapeExplorer::ShapeExplorer(std::uint64_t seed, const ShapeLimits& limits, const HandRanges& ranges)
    : limits_(limits), body_(drawBody(ranges, seed)), solids_(knownSolids()), random_(seed) {}

void ShapeExplorer::begin(const ShapeCues& cues) {
  cues_ = cues;
  random_ = Random(cues.seed);
  misplacement_W_ = limits_.common.placement_sd * random_.normal3();
  q_felt_true_ = drawRotation(limits_.common.orientation_sd, random_);
  const double variance = limits_.common.placement_sd * limits_.common.placement_sd;
  beliefs_.fill({0, Vec3::Zero(), variance * Mat3::Identity()});
  passes_ = 0;
  angle_ = 0;
  reach_ = limits_.distance;
  first_place_.reset();
  tactor_moves_ = false;
  enter(Phase::kListen);
}

const ShapeExplorer::Pass& ShapeExplorer::pass() const {
  static const std::array<Pass, 3> kPasses{{{Vec3::UnitX(), Vec3::UnitY(), 2 * std::numbers::pi},
                                            {Vec3::UnitX(), Vec3::UnitZ(), std::numbers::pi},
                                            {-Vec3::UnitY(), Vec3::UnitZ(), std::numbers::pi}}};
  return kPasses[static_cast<std::size_t>(passes_) % kPasses.size()];
}

Vec3 ShapeExplorer::ray() const {
  if (phase_ == Phase::kAnswer) return turn_from_;
  if (phase_ == Phase::kTurn) {
    const Vec3 across = (pass().from - pass().from.dot(turn_from_) * turn_from_).normalized();
    return math::cos(angle_) * turn_from_ + math::sin(angle_) * across;
  }
  return math::cos(angle_) * pass().from + math::sin(angle_) * pass().towards;
}

Vec3 ShapeExplorer::along() const {
  if (phase_ == Phase::kTurn || phase_ == Phase::kAnswer) return ray().cross(Vec3::UnitZ()).normalized();  // turns are level
  return -math::sin(angle_) * pass().from + math::cos(angle_) * pass().towards;
}

// F: -z towards the middle, x along the pass.
Quat ShapeExplorer::held() const {
  const Vec3 z = ray(), x = along();
  Mat3 R;
  R << x, z.cross(x), z;
  return Quat(R);
}

OneFingerAction ShapeExplorer::act(const FingerPercept& finger, double time, Cue cue) {
  const double dt = time - now_;
  now_ = time;
  OneFingerAction action;
  if (finger.tactile.valid && finger.tactile.place_L) {
    if (!first_place_) first_place_ = *finger.tactile.place_L;
    tactor_moves_ = tactor_moves_ || (*finger.tactile.place_L - *first_place_).norm() > limits_.common.tactor_moves;
  }
  if (phase_ == Phase::kListen && cue == Cue::kStart) enter(Phase::kApproach);
  if (phase_ == Phase::kApproach) {
    reach_ -= limits_.approach_speed * dt;
    if (finger.f_D.norm() > kFeltPush || reach_ < 0) enter(Phase::kFollow);
  } else if (phase_ == Phase::kFollow) {
    follow(finger, dt);
  } else if (phase_ == Phase::kLeave) {
    reach_ = std::min(limits_.distance, reach_ + limits_.approach_speed * dt);
    if (reach_ >= limits_.distance) {
      turn_from_ = ray();
      ++passes_;
      angle_ = 0;
      const bool done = passes_ >= limits_.most_passes || (passes_ >= 3 && sureness() > limits_.sure);
      action.interval_over = done;
      enter(done ? Phase::kAnswer : Phase::kTurn);
    }
  } else if (phase_ == Phase::kTurn) {
    angle_ += limits_.approach_speed * dt / limits_.distance;
    if (angle_ >= angleBetweenUnits(turn_from_, pass().from)) {
      angle_ = 0;
      enter(Phase::kApproach);
    }
  } else if (phase_ == Phase::kAnswer) {
    action.answered = now_ - entered_ >= limits_.common.reaction_time;
  }
  action.q_WF = held();
  action.pull = body_.hands[0];
  action.pull.p_D = cues_.q_WD.conjugate() * (cues_.middle_W + reach_ * ray() - cues_.p_WD);
  return action;
}

void ShapeExplorer::enter(Phase phase) {
  phase_ = phase;
  entered_ = read_at_ = now_;
}

void ShapeExplorer::follow(const FingerPercept& finger, double dt) {
  const Vec3 p_W = cues_.p_WD + cues_.q_WD * finger.arm.p_DF;
  const Vec3 f_W = cues_.q_WD * finger.f_D;
  const double push = f_W.norm();
  if (push < kFeltPush) {
    moveAim(body_.speed * dt * along() - kSinkSpeed * dt * ray(), 0);
  } else {
    keepTo(p_W - cues_.middle_W, f_W / push, dt);
  }
  if (push > limits_.common.force_floor && now_ - read_at_ >= limits_.common.reading_time) {
    read_at_ = now_;
    read(finger, p_W);
  }
  if (angle_ < pass().angle) return;
  enter(Phase::kLeave);
}

// Along the surface, and to the depth at which it pushes as hard as is wanted. `p_W` from the middle, `n_W` where the push goes, unit.
void ShapeExplorer::keepTo(const Vec3& p_W, const Vec3& n_W, double dt) {
  const Vec3 across = ray().cross(along()).cross(n_W);
  const Vec3 onwards = across.norm() > kLeastInPlane ? Vec3(across.normalized()) : along();
  const double deeper = limits_.press / body_.hands[0].stiffness - n_W.dot(p_W - reach_ * ray());
  moveAim(body_.speed * dt * onwards - kGiveWay * dt * deeper * n_W, kLeastProgress * body_.speed * dt);
}

// By a step in the pass's plane, at least by so much along the pass [m].
void ShapeExplorer::moveAim(const Vec3& step_W, double least) {
  const double outwards = step_W.dot(ray());
  angle_ += std::max(least, step_W.dot(along())) / std::max(kLeastReach, reach_);
  reach_ = std::max(0.0, reach_ + outwards);
}

void ShapeExplorer::read(const FingerPercept& finger, const Vec3& p_W) {
  const Vec3 felt_W = p_W - cues_.middle_W + misplacement_W_ + limits_.place_sd * random_.normal3();
  const double sd_push = limits_.common.direction_sd;
  Vec3 n_W = blurred((cues_.q_WD * finger.f_D).normalized(), sd_push, random_);
  double sd_n = sd_push;
  if (const auto shown = directionOfTactor(finger, held())) {
    const double sd_place = limits_.common.tactor_sd / limits_.common.tactor_bias;
    const double sd_shown = math::hypot(sd_place / cues_.tip_radius, limits_.common.orientation_sd);
    const double w_push = 1 / (sd_push * sd_push), w_shown = 1 / (sd_shown * sd_shown);
    n_W = (w_push * n_W + w_shown * *shown).normalized();
    sd_n = 1 / std::sqrt(w_push + w_shown);
  }
  for (std::size_t k = 0; k < solids_.size(); ++k) believe(beliefs_[k], solids_[k], felt_W, n_W, sd_n);
}

// The misplacement is the same in all readings of a trial: taken for noise of each it would make them tell more than they do.
void ShapeExplorer::believe(SolidBelief& b, const KnownSolid& solid, const Vec3& felt_W, const Vec3& n_W, double sd_n) const {
  const Vec3 q_W = felt_W - b.misplacement_W, outward_W = solid.outward(q_W);
  const double off = (q_W - solid.nearest(q_W)).norm() - cues_.tip_radius;
  const Vec3 spread_W = b.covariance * outward_W;
  const double S = outward_W.dot(spread_W) + limits_.place_sd * limits_.place_sd;
  b.log_likelihood -= 0.5 * (off * off / S + math::log(S));
  b.log_likelihood += math::log(likelihoodOf(n_W, sd_n, solid, q_W, outward_W, off, b.covariance));
  b.misplacement_W += spread_W * (off / S);
  b.covariance -= spread_W * spread_W.transpose() / S;
}

// Of a felt direction: where the finger is on the solid is known as badly as it was felt, and near an edge another place has another direction. The
// mean over six places spread as the place is once the finger is known to touch.
double ShapeExplorer::likelihoodOf(const Vec3& n_W, double sd_n, const KnownSolid& solid, const Vec3& q_W, const Vec3& outward_W,
                                   double off, const Mat3& covariance) const {
  const Mat3 spread = covariance + limits_.place_sd * limits_.place_sd * Mat3::Identity();
  const Vec3 gain = spread * outward_W / outward_W.dot(spread * outward_W);
  const Vec3 touching_W = q_W - gain * off;
  const Mat3 left = spread - gain * (spread * outward_W).transpose() + kRoundOff * Mat3::Identity();
  const Mat3 root = std::sqrt(3.0) * Mat3(left.llt().matrixL());
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      const double angle = angleBetweenUnits(n_W, solid.outward(touching_W + sign * root.col(i))) / sd_n;
      sum += math::exp(-0.5 * angle * angle);
    }
  }
  return sum / 6 + kLeast;
}

// Out of the surface, from where the contact is on the pad. Absent where the tactor has stood still since the trial began, or may be at its stop.
std::optional<Vec3> ShapeExplorer::directionOfTactor(const FingerPercept& finger, const Quat& q_WF) {
  if (!tactor_moves_ || !finger.tactile.valid || !finger.tactile.place_L) return std::nullopt;
  const double sd = limits_.common.tactor_sd / limits_.common.tactor_bias;
  const Vec2 place = *finger.tactile.place_L + sd * random_.normal2();  // felt place over the gain
  if (place.norm() > cues_.tactor_reach - sd) return std::nullopt;
  const double a = place.norm() / cues_.tip_radius;
  Vec3 to_contact_F(0, 0, -1);
  if (a > 0) {
    const Vec2 along = place.normalized();
    // L: first axis x of F; second axis pad normal x distal = -z x x = -y of F
    to_contact_F = Vec3(math::sin(a) * along.x(), -math::sin(a) * along.y(), -math::cos(a));
  }
  return Vec3(-(q_felt_true_ * (q_WF * to_contact_F)));
}

int ShapeExplorer::answer() const {
  const auto lessLikely = [](const SolidBelief& a, const SolidBelief& b) { return a.log_likelihood < b.log_likelihood; };
  return static_cast<int>(std::max_element(beliefs_.begin(), beliefs_.end(), lessLikely) - beliefs_.begin());
}

double ShapeExplorer::sureness() const {
  const double best = beliefs_[static_cast<std::size_t>(answer())].log_likelihood;
  double sum = 0;
  for (const SolidBelief& b : beliefs_) sum += math::exp(b.log_likelihood - best);
  return 1 / sum;
}

}  // namespace pincer::tasks
