#include "pincer/tasks/lab/participants/place_belief.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pincer/tasks/lab/participants/weighing.h"

namespace pincer::tasks {
namespace {

constexpr double kAngleSoftness = 0.1;    // [rad]
constexpr double kGripSoftness = 0.15;    // [-]
constexpr double kCopyOffsetSd = 0.5e-3;  // noise on a copied hypothesis [m]
constexpr int kCandidates = 8;            // shifts that are weighed besides the mean
constexpr double kLeastChance = 0.02;     // of the chance that a model of the world is simply wrong

double gaussianShare(double z) { return 0.5 * math::erfc(-z / std::numbers::sqrt2); }

}  // namespace

void PlaceBelief::begin(const PlaceModel& model, Random& random) {
  model_ = model;
  hypotheses_.resize(kHypotheses);
  copies_.resize(kHypotheses);
  logs_.resize(kHypotheses);
  for (Hypothesis& h : hypotheses_) {
    h.o = model.placement_sd * random.normal2();
    h.mu = model.mu_min * math::exp(random.uniform() * math::log(model.mu_max / model.mu_min));
    h.weight = 1.0 / static_cast<double>(kHypotheses);
  }
}

double PlaceBelief::holds(const Hypothesis& h, const Vec2& shift, double grip) const {
  const double tilt = math::asin(std::min((h.o - shift).norm() / model_.lever, 1.0));
  const double opposed = gaussianShare((math::atan(h.mu) - tilt) / kAngleSoftness);
  const double firm = gaussianShare((2 * h.mu * grip / model_.weight - 1) / kGripSoftness);
  return std::clamp(opposed * firm, kLeastChance, 1 - kLeastChance);
}

double PlaceBelief::holds(const Vec2& shift, double grip) const {
  double sum = 0;
  for (const Hypothesis& h : hypotheses_) sum += h.weight * holds(h, shift, grip);
  return sum;
}

Vec2 PlaceBelief::offset() const {
  Vec2 mean = Vec2::Zero();
  for (const Hypothesis& h : hypotheses_) mean += h.weight * h.o;
  return mean;
}

Vec2 PlaceBelief::bestShift(double grip, double farthest, Random& random) const {
  Vec2 best = offset();
  double best_holds = holds(best, grip);
  for (int k = 0; k < kCandidates; ++k) {
    const Vec2& candidate = hypotheses_[random.below(kHypotheses)].o;
    const double value = candidate.norm() > farthest ? 0 : holds(candidate, grip);
    if (value <= best_holds) continue;
    best = candidate;
    best_holds = value;
  }
  return best;
}

template <class LogLikelihood>
void PlaceBelief::update(LogLikelihood logLikelihood, Random& random) {
  for (std::size_t k = 0; k < kHypotheses; ++k) logs_[k] = logLikelihood(hypotheses_[k]);
  if (weigh(hypotheses_, logs_) >= kEnoughShare) return;
  resample(hypotheses_, copies_, random, [&](Hypothesis& copy) { copy.o += kCopyOffsetSd * random.normal2(); });
}

void PlaceBelief::placeRead(const Vec2& place, Random& random) {
  const double precision = -0.5 / (model_.place_sd * model_.place_sd);
  update([&](const Hypothesis& h) { return precision * (place - model_.place_gain * h.o).squaredNorm(); }, random);
}

void PlaceBelief::pushRead(const Vec2& tilt, Random& random) {
  const double precision = -0.5 / (model_.push_sd * model_.push_sd);
  const auto expected = [&](const Hypothesis& h) {
    const double length = h.o.norm();
    const double beyond = math::asin(std::min(length / model_.lever, 1.0)) - math::atan(h.mu);
    return Vec2(length > 0 && beyond > 0 ? Vec2(-beyond / length * h.o) : Vec2::Zero());
  };
  update([&](const Hypothesis& h) { return precision * (tilt - expected(h)).squaredNorm(); }, random);
}

void PlaceBelief::failed(double grip, Random& random) {
  update([&](const Hypothesis& h) { return math::log(1 - holds(h, Vec2::Zero(), grip)); }, random);
}

void PlaceBelief::moved(const Vec2& shift) {
  for (Hypothesis& h : hypotheses_) h.o -= shift;
}

void PlaceBelief::letGo(Random& random) {
  for (Hypothesis& h : hypotheses_) h.o.x() += model_.rolls_sd * random.normal();
}

void PlaceBelief::heightFound(Random& random) {
  for (Hypothesis& h : hypotheses_) h.o.y() = model_.height_sd * random.normal();
}

}  // namespace pincer::tasks
