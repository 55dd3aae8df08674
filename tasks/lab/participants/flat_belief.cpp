#include "pincer/tasks/lab/participants/flat_belief.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pincer/tasks/lab/participants/weighing.h"

namespace pincer::tasks {
namespace {

constexpr double kCopyAngleSd = 0.03;  // noise on a copied hypothesis [rad]
// of the prior's variance: in the means drawn; the rest in each hypothesis's covariance
constexpr double kDrawnShare = 0.7;

Vec2 along(double angle) {
  const auto [sin, cos] = math::sinCos(angle);
  return {cos, sin};
}

double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

}  // namespace

CutCircle cutCircle(const FlatModel& model, double theta, const Vec2& c) {
  const auto [sn, cs] = math::sinCos(theta);
  const double x = cs * c.x() + sn * c.y(), y = cs * c.y() - sn * c.x();  // x along the flat's normal
  const double d = model.flat_distance, half = std::sqrt(model.radius * model.radius - d * d);
  const double rho = c.norm();
  if (rho == 0 || x * model.radius < d * rho)
    return {rho - model.radius, math::atan2(c.y(), c.x()), 1 / std::max(rho, 1e-6)};  // the round part
  if (std::abs(y) <= half) return {x - d, theta, 0};
  const Vec2 from_edge(x - d, y - std::copysign(half, y));
  const double distance = from_edge.norm();
  return {distance, theta + math::atan2(from_edge.y(), from_edge.x()), 1 / std::max(distance, 1e-6)};
}

void FlatBelief::begin(const FlatModel& model, Random& random) {
  model_ = model;
  hypotheses_.resize(kHypotheses);
  copies_.resize(kHypotheses);
  logs_.resize(kHypotheses);
  const Vec2 sd(model.placement_sd, model.placement_between_sd);
  const Vec4 variance(sd[0] * sd[0], sd[0] * sd[0], sd[1] * sd[1], sd[1] * sd[1]);
  for (std::size_t k = 0; k < kHypotheses; ++k) {
    Hypothesis& h = hypotheses_[k];
    h.theta = 2 * std::numbers::pi * (static_cast<double>(k) / static_cast<double>(kHypotheses) - 0.5);
    h.x.head<2>() = std::sqrt(kDrawnShare) * sd[0] * random.normal2();
    h.x.tail<2>() = std::sqrt(kDrawnShare) * sd[1] * random.normal2();
    h.P = ((1 - kDrawnShare) * variance).asDiagonal();
    h.weight = 1.0 / static_cast<double>(kHypotheses);
  }
}

namespace {

// One scalar reading of x ~ N(mean, P): innovation e = reading - expected, its slope along
// x, its noise. Returns its log likelihood.
template <class Mean, class Covariance>
double kalmanUpdate(Mean& mean, Covariance& P, double e, const Mean& slope, double sd) {
  const Mean P_slope = P * slope;
  const double variance = slope.dot(P_slope) + sd * sd;
  mean += P_slope * (e / variance);
  P.noalias() -= P_slope * (P_slope / variance).transpose();
  return -0.5 * (e * e / variance + math::log(variance));
}

}  // namespace

// `half` is -1/2 for the first finger and 1/2 for the second. The distance first: it says best where the finger is.
double FlatBelief::update(Hypothesis& h, const FlatPercept& p, double half) const {
  const auto centre = [&] { return Vec2(p.p_felt + h.x.head<2>() + half * h.x.tail<2>()); };
  const auto slope = [&](const Vec2& d) { return Vec4(d.x(), d.y(), half * d.x(), half * d.y()); };
  CutCircle at = cutCircle(model_, h.theta, centre());
  const Vec2 n = along(at.normal);
  double log = kalmanUpdate(h.x, h.P, model_.tip_radius - p.pressed - at.distance, slope(n), model_.span_sd);
  if (!p.push && !p.place) return log;
  at = cutCircle(model_, h.theta, centre());
  const Vec2 outward = along(at.normal);
  const Vec4 turning = slope(at.bend * Vec2(-outward.y(), outward.x()));
  double turned = 0;  // of the normal, by what the push has just taught
  if (p.push) {
    const Vec4 before = h.x;
    log += kalmanUpdate(h.x, h.P, wrapped(*p.push - at.normal), turning, model_.push_sd);
    turned = turning.dot(h.x - before);
  }
  if (p.place) {
    const double expected = model_.place_gain * wrapped(at.normal + turned - p.pad);
    log += kalmanUpdate(h.x, h.P, wrapped(*p.place - p.pad - expected), Vec4(model_.place_gain * turning),
                        model_.place_sd);
  }
  return log;
}

double FlatBelief::update(Hypothesis& h, const std::array<FlatPercept, 2>& pinch) const {
  const double first = update(h, pinch[0], -0.5);
  return first + update(h, pinch[1], 0.5);
}

void FlatBelief::observe(const std::array<FlatPercept, 2>& pinch, Random& random) {
  for (std::size_t k = 0; k < kHypotheses; ++k) logs_[k] = update(hypotheses_[k], pinch);
  if (weigh(hypotheses_, logs_) >= kEnoughShare) return;
  resample(hypotheses_, copies_, random, [&](Hypothesis& copy) { copy.theta += kCopyAngleSd * random.normal(); });
}

void FlatBelief::turned(double angle, double sd, Random& random) {
  for (Hypothesis& h : hypotheses_) h.theta += angle + sd * random.normal();
}

Vec2 FlatBelief::resultant() const {
  Vec2 sum = Vec2::Zero();
  for (const Hypothesis& h : hypotheses_) sum += h.weight * along(h.theta);
  return sum;
}

double FlatBelief::direction() const {
  const Vec2 r = resultant();
  return math::atan2(r.y(), r.x());
}

double FlatBelief::spread() const { return std::sqrt(-2 * math::log(std::clamp(resultant().norm(), 1e-9, 1.0))); }

Vec2 FlatBelief::axis() const {
  Vec2 mean = Vec2::Zero();
  for (const Hypothesis& h : hypotheses_) mean -= h.weight * h.x.head<2>();
  return mean;
}

}  // namespace pincer::tasks
