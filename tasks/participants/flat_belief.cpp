#include "tasks/participants/flat_belief.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pincer::tasks {
namespace {

constexpr double kCopyAngleSd = 0.03;    // noise on a copied hypothesis [rad]
constexpr double kCopyPlaceSd = 0.3e-3;  // [m]

double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }
double squareOver(double x, double sd) { return (x / sd) * (x / sd); }

}  // namespace

CutCircle cutCircle(const FlatModel& model, double theta, const Vec2& c) {
  const double cs = std::cos(theta), sn = std::sin(theta);
  const double x = cs * c.x() + sn * c.y(), y = cs * c.y() - sn * c.x();  // x along the flat's normal
  const double d = model.flat_distance, half = std::sqrt(model.radius * model.radius - d * d);
  const double rho = c.norm();
  if (rho == 0 || x * model.radius < d * rho) return {rho - model.radius, std::atan2(c.y(), c.x())};  // the round part
  if (std::abs(y) <= half) return {x - d, theta};
  const Vec2 from_edge(x - d, y - std::copysign(half, y));
  return {from_edge.norm(), theta + std::atan2(from_edge.y(), from_edge.x())};
}

void FlatBelief::begin(const FlatModel& model, Random& random) {
  model_ = model;
  hypotheses_.resize(kHypotheses);
  copies_.resize(kHypotheses);
  logs_.resize(kHypotheses);
  for (Hypothesis& h : hypotheses_) {
    h.theta = random.uniform(-std::numbers::pi, std::numbers::pi);
    h.a = model.placement_sd * random.normal2();
    h.b = model.placement_between_sd * random.normal2();
    h.weight = 1.0 / static_cast<double>(kHypotheses);
  }
}

double FlatBelief::logLikelihood(const Hypothesis& h, const std::array<FlatPercept, 2>& pinch) const {
  double sum = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const FlatPercept& p = pinch[i];
    const Vec2 c = p.p_felt + h.a + (i == 0 ? -0.5 : 0.5) * h.b;
    const CutCircle at = cutCircle(model_, h.theta, c);
    sum += squareOver(at.distance - model_.tip_radius + p.pressed, model_.span_sd);
    if (p.push) sum += squareOver(wrapped(*p.push - at.normal), model_.push_sd);
    if (p.place) sum += squareOver(wrapped(*p.place - p.pad) - model_.place_gain * wrapped(at.normal - p.pad), model_.place_sd);
  }
  return -0.5 * sum;
}

void FlatBelief::observe(const std::array<FlatPercept, 2>& pinch, Random& random) {
  for (std::size_t k = 0; k < kHypotheses; ++k) logs_[k] = logLikelihood(hypotheses_[k], pinch);
  const double best = *std::max_element(logs_.begin(), logs_.end());
  double sum = 0, squares = 0;
  for (std::size_t k = 0; k < kHypotheses; ++k) sum += hypotheses_[k].weight *= std::exp(logs_[k] - best);
  for (Hypothesis& h : hypotheses_) {
    h.weight /= sum;
    squares += h.weight * h.weight;
  }
  if (squares * static_cast<double>(kHypotheses) > 2) resample(random);
}

void FlatBelief::resample(Random& random) {
  const double step = 1.0 / static_cast<double>(kHypotheses);
  double at = step * random.uniform(), passed = hypotheses_[0].weight;
  std::size_t source = 0;
  for (Hypothesis& copy : copies_) {
    while (at > passed && source + 1 < kHypotheses) passed += hypotheses_[++source].weight;
    copy = hypotheses_[source];
    copy.theta += kCopyAngleSd * random.normal();
    copy.a += kCopyPlaceSd * random.normal2();
    copy.b += kCopyPlaceSd * random.normal2();
    copy.weight = step;
    at += step;
  }
  hypotheses_.swap(copies_);
}

void FlatBelief::turned(double angle, double sd, Random& random) {
  for (Hypothesis& h : hypotheses_) h.theta += angle + sd * random.normal();
}

Vec2 FlatBelief::resultant() const {
  Vec2 sum = Vec2::Zero();
  for (const Hypothesis& h : hypotheses_) sum += h.weight * Vec2(std::cos(h.theta), std::sin(h.theta));
  return sum;
}

double FlatBelief::direction() const {
  const Vec2 r = resultant();
  return std::atan2(r.y(), r.x());
}

double FlatBelief::spread() const { return std::sqrt(-2 * std::log(std::clamp(resultant().norm(), 1e-9, 1.0))); }

Vec2 FlatBelief::axis() const {
  Vec2 mean = Vec2::Zero();
  for (const Hypothesis& h : hypotheses_) mean -= h.weight * h.a;
  return mean;
}

}  // namespace pincer::tasks
