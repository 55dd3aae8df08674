#include "pincer/tasks/lab/participants/shape_explorer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pincer::tasks {
namespace {

constexpr double kFeltPush = 0.3;    // while following, a weaker push means that the finger has left the surface [N]
constexpr double kSinkSpeed = 0.05;  // then the aim goes in [m/s]
constexpr double kRoundOff = 1e-12;  // keeps a variance of 0 positive [m^2]
constexpr double kLeast = 1e-12;     // a likelihood: no reading rules a solid out for ever
constexpr double kGiveWay = 20;  // else the aim goes to where the finger would feel the wanted push, at this rate [1/s]
constexpr double kLeastReach = 0.02;    // nearer the middle the angle goes no faster [m]
constexpr double kLeastProgress = 0.1;  // of the finger's speed: however steep the surface, the sweep goes on
// a push further than this from the sweep's plane (as a cosine) doesn't say where the surface goes
constexpr double kLeastInPlane = 0.1;
constexpr double kSmallestSize = 0.3;    // of a solid against what is imagined: smaller none is believed [-]
constexpr double kLeastForeAft = 0.1;    // of a normal: the angle of one that points aside tells nothing
constexpr double kTellsNothing = 0.01;   // chance that a reading of the tactor is of something else (choice)
constexpr double kStep = 1e-3;           // of the differences, in the imagined solid's own size [m]
constexpr std::uint64_t kTiltShare = 1;  // part of a person's seed
constexpr int kSweepsOfRound = 6;

double angleBetweenUnits(const Vec3& a, const Vec3& b) { return math::atan2(a.cross(b).norm(), a.dot(b)); }

// Of the contact on the finger, distal positive, where the surface's normal is `n_W`.
double foreAftAngle(const Vec3& n_W) { return math::atan2(-n_W.y(), n_W.z()); }

double square(double x) { return x * x; }

double within(double angle) { return angle - 2 * std::numbers::pi * std::round(angle / (2 * std::numbers::pi)); }

}  // namespace

ShapeExplorer::ShapeExplorer(std::uint64_t seed, const ShapeLimits& limits, const HandRanges& ranges)
    : limits_(limits),
      body_(drawBody(ranges, seed)),
      tilt_share_(Random(seedFor(seed, kTiltShare)).uniform(limits.tilt_min, limits.tilt_max)),
      solids_(lyingSolids()),
      random_(seed),
      beliefs_(solids_.size()) {}

void ShapeExplorer::begin(const ShapeCues& cues) {
  cues_ = cues;
  random_ = Random(cues.seed);
  misplacement_W_ = limits_.common.placement_sd * random_.normal3();
  felt_tilt_error_ = limits_.common.orientation_sd * random_.normal();
  SolidBelief fresh;
  fresh.covariance.diagonal() << Vec3::Constant(square(limits_.common.placement_sd)), square(limits_.size_sd);
  for (std::size_t k = 0; k < solids_.size(); ++k) {
    beliefs_[k] = fresh;
    beliefs_[k].log_likelihood = -math::log(solids_[k].ways);
  }
  sweeps_ = 0;
  from_ = angle_ = 0;
  reach_ = limits_.distance;
  first_place_.reset();
  tactor_moves_ = false;
  enter(Phase::kListen);
}

// Sides as far as the ends are felt; away, and less towards the body, where the display's wires bend away.
const ShapeExplorer::Sweep& ShapeExplorer::sweep() const {
  static const std::array<Sweep, kSweepsOfRound> kSweeps{{{Vec3::UnitX(), -1.4},
                                                          {Vec3::UnitX(), 1.4},
                                                          {Vec3::UnitX(), 0},
                                                          {Vec3::UnitY(), 1.2},
                                                          {Vec3::UnitY(), -0.9},
                                                          {Vec3::UnitY(), 0}}};
  return kSweeps[static_cast<std::size_t>(sweeps_ % kSweepsOfRound)];
}

double ShapeExplorer::direction() const { return sweep().target < from_ ? -1 : 1; }

Vec3 ShapeExplorer::ray() const { return math::cos(angle_) * Vec3::UnitZ() + math::sin(angle_) * sweep().side; }

Vec3 ShapeExplorer::along() const {
  return direction() * (math::cos(angle_) * sweep().side - math::sin(angle_) * Vec3::UnitZ());
}

double ShapeExplorer::tilt() const { return sweep().side.y() > 0 ? -tilt_share_ * angle_ : 0; }

Quat ShapeExplorer::held() const {
  Mat3 R;
  R << Vec3::UnitY(), -Vec3::UnitX(), Vec3::UnitZ();
  const auto [sine, cosine] = math::sinCos(0.5 * tilt());
  return Quat(cosine, sine, 0, 0) * Quat(R);
}

OneFingerAction ShapeExplorer::act(const FingerPercept& finger, double time, Cue cue) {
  const double dt = time - now_;
  now_ = time;
  OneFingerAction action;
  if (finger.tactile.valid && finger.tactile.place_L) {
    if (!first_place_) first_place_ = finger.tactile.place_L->x();
    tactor_moves_ =
        tactor_moves_ || std::abs(finger.tactile.place_L->x() - *first_place_) > limits_.common.tactor_moves;
  }
  if (phase_ == Phase::kListen && cue == Cue::kStart) enter(Phase::kApproach);
  if (phase_ == Phase::kApproach) {
    reach_ -= limits_.approach_speed * dt;
    if (finger.f_D.norm() > kFeltPush || reach_ < 0) enter(Phase::kFollow);
  } else if (phase_ == Phase::kFollow) {
    follow(finger, dt);
    action.interval_over = phase_ == Phase::kAnswer;
  } else if (phase_ == Phase::kAnswer) {
    reach_ = std::min(limits_.distance, reach_ + limits_.approach_speed * dt);
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
  if (direction() * (sweep().target - angle_) <= 0) endSweep();
}

void ShapeExplorer::endSweep() {
  const bool at_middle = sweep().target == 0;
  from_ = at_middle ? 0 : angle_;
  ++sweeps_;
  if (!at_middle) return;
  angle_ = 0;
  if (sweeps_ >= limits_.most_rounds * kSweepsOfRound || sureness() > limits_.sure) enter(Phase::kAnswer);
}

// Along the surface, and to the depth at which it pushes as hard as is wanted. `p_W` from the
// middle, `n_W` where the push goes, unit.
void ShapeExplorer::keepTo(const Vec3& p_W, const Vec3& n_W, double dt) {
  const Vec3 across = ray().cross(along()).cross(n_W);
  const Vec3 onwards = across.norm() > kLeastInPlane ? Vec3(across.normalized()) : along();
  const double deeper = limits_.press / body_.hands[0].stiffness - n_W.dot(p_W - reach_ * ray());
  moveAim(body_.speed * dt * onwards - kGiveWay * dt * deeper * n_W, kLeastProgress * body_.speed * dt);
}

// By a step in the sweep's plane, at least by so much along the sweep [m].
void ShapeExplorer::moveAim(const Vec3& step_W, double least) {
  const double outwards = step_W.dot(ray());
  angle_ += direction() * std::max(least, step_W.dot(along())) / std::max(kLeastReach, reach_);
  reach_ = std::max(0.0, reach_ + outwards);
}

void ShapeExplorer::read(const FingerPercept& finger, const Vec3& p_W) {
  Reading reading;
  reading.p_W = p_W - cues_.middle_W + misplacement_W_ + limits_.place_sd * random_.normal3();
  reading.push_W = drawRotation(limits_.common.direction_sd, random_) * (cues_.q_WD * finger.f_D).normalized();
  readTactor(finger, reading);
  for (std::size_t k = 0; k < solids_.size(); ++k) believe(beliefs_[k], solids_[k].solid, reading);
}

// Absent where the tactor has stood still since the trial began.
void ShapeExplorer::readTactor(const FingerPercept& finger, Reading& reading) {
  if (!tactor_moves_ || !finger.tactile.valid || !finger.tactile.place_L) return;
  const double sd = limits_.common.tactor_sd / limits_.common.tactor_bias;
  reading.shown = (finger.tactile.place_L->x() + sd * random_.normal()) / cues_.tip_radius;  // felt place over the gain
  reading.shown_sd = math::hypot(sd / cues_.tip_radius, limits_.common.orientation_sd);
  reading.tilt = tilt() + felt_tilt_error_;
}

// Place of the tactor for a contact with this normal, over the finger's radius.
double ShapeExplorer::tactorAngleFor(const Vec3& n_W, double tilt) const {
  const double most = cues_.tactor_reach / cues_.tip_radius;
  return std::clamp(within(foreAftAngle(n_W) - tilt), -most, most);
}

ShapeExplorer::Meeting ShapeExplorer::meet(const SolidBelief& belief, const KnownSolid& solid, const Vec3& p_W) const {
  Meeting m;
  m.at = (p_W - belief.misplacement_W) / belief.size;
  m.nearest = solid.nearest(m.at);
  m.n = solid.outward(m.at);
  m.off = belief.size * (m.at - m.nearest).norm() - cues_.tip_radius;
  return m;
}

// The misplacement is the same in all readings of a trial: taken for noise of each
// it would make them tell more than they do.
void ShapeExplorer::believe(SolidBelief& b, const KnownSolid& solid, const Reading& reading) const {
  const Meeting m = meet(b, solid, reading.p_W);
  Gain H;
  H << m.n, m.n.dot(m.nearest);
  const Gain spread = b.covariance * H;
  const double S = H.dot(spread) + square(limits_.place_sd);
  b.log_likelihood -= 0.5 * (m.off * m.off / S + math::log(S));
  b.log_likelihood += math::log(likelihoodOf(reading, b, solid, m));
  b.misplacement_W += spread.head<3>() * (m.off / S);
  b.size = std::max(kSmallestSize, b.size + spread[3] * m.off / S);
  b.covariance -= spread * spread.transpose() / S;
  if (reading.shown) believeTactor(b, solid, reading);
}

// Near an edge, or on a small round solid, a slightly other place has another direction: that
// much the tactor tells of the place instead.
void ShapeExplorer::believeTactor(SolidBelief& b, const KnownSolid& solid, const Reading& reading) const {
  const Meeting m = meet(b, solid, reading.p_W);
  Vec3 slope;
  for (int i = 0; i < 3; ++i) {
    const Vec3 step = kStep * Vec3::Unit(i);
    const Vec3 ahead = solid.outward(m.at + step), behind = solid.outward(m.at - step);
    slope[i] = (tactorAngleFor(ahead, reading.tilt) - tactorAngleFor(behind, reading.tilt)) / (2 * kStep);
  }
  Gain H;  // of m and c: q / c = (p - m) / c
  H << -slope / b.size, -slope.dot(m.at) / b.size;
  const double fore_aft = std::max(kLeastForeAft, math::hypot(m.n.y(), m.n.z()));
  const double y = *reading.shown - tactorAngleFor(m.n, reading.tilt), variance = square(reading.shown_sd / fore_aft);
  const Gain spread = b.covariance * H;
  const double S = H.dot(spread) + variance;
  const double density = math::exp(-0.5 * y * y / S) / std::sqrt(2 * std::numbers::pi * S);
  const double elsewhere = kTellsNothing / (2 * std::numbers::pi), told = (1 - kTellsNothing) * density;
  b.log_likelihood += math::log(told + elsewhere);
  const double trust = told / (told + elsewhere);
  b.misplacement_W += trust * y / S * spread.head<3>();
  b.size = std::max(kSmallestSize, b.size + trust * y / S * spread[3]);
  b.covariance -= trust / S * spread * spread.transpose();
}

// Of the felt push: where the finger is on the solid is known as badly as it was felt, and near an edge another place
// has another direction. The mean over six places spread as the place is once the finger is known to touch.
double ShapeExplorer::likelihoodOf(const Reading& reading, const SolidBelief& b, const KnownSolid& solid,
                                   const Meeting& m) const {
  Eigen::Matrix<double, 3, kUnknowns> J;
  J << Mat3::Identity(), m.at;
  const Mat3 spread = J * b.covariance * J.transpose() + square(limits_.place_sd) * Mat3::Identity();
  const Vec3 gain = spread * m.n / m.n.dot(spread * m.n);
  const Vec3 touching = m.at - gain * (m.off / b.size);
  const Mat3 left = spread - gain * (spread * m.n).transpose() + kRoundOff * Mat3::Identity();
  const Mat3 root = std::sqrt(3.0) / b.size * Mat3(left.llt().matrixL());
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      const Vec3 n = solid.outward(touching + sign * root.col(i));
      sum += math::exp(-0.5 * square(angleBetweenUnits(reading.push_W, n) / limits_.common.direction_sd));
    }
  }
  return sum / 6 + kLeast;
}

std::array<double, kSolids> ShapeExplorer::chances() const {
  double best = beliefs_[0].log_likelihood;
  for (const SolidBelief& b : beliefs_) best = std::max(best, b.log_likelihood);
  std::array<double, kSolids> chances{};
  double sum = 0;
  for (std::size_t k = 0; k < beliefs_.size(); ++k) {
    const double weight = math::exp(beliefs_[k].log_likelihood - best);
    chances[static_cast<std::size_t>(solids_[k].name)] += weight;
    sum += weight;
  }
  for (double& chance : chances) chance /= sum;
  return chances;
}

int ShapeExplorer::answer() const {
  const auto all = chances();
  return static_cast<int>(std::max_element(all.begin(), all.end()) - all.begin());
}

double ShapeExplorer::sureness() const {
  const auto all = chances();
  return *std::max_element(all.begin(), all.end());
}

}  // namespace pincer::tasks
