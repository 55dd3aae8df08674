#include "pincer/tasks/judge/bench/path_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

bool isFinite(const contact::SurfaceContacts& contacts) {
  for (int i = 0; i < contacts.count; ++i) {
    const contact::SurfaceContact& c = contacts.points[static_cast<std::size_t>(i)];
    if (!c.p_BS.allFinite() || !c.n_B.allFinite() || !std::isfinite(c.phi)) return false;
  }
  return contacts.count >= 1;
}

void countCost(const contact::QueryCost& cost, PathFigures& f) {
  ++f.queries;
  ++f.by_iterations[static_cast<std::size_t>(std::clamp(cost.iterations, 0, kMostIterations))];
  f.longest_walk = std::max(f.longest_walk, cost.longest_walk);
  f.most_crossings = std::max(f.most_crossings, cost.crossings);
  f.reseeded += cost.reseeds > 0;
}

// Sum of the contacts' normals, each as long as it is deep.
Vec3 pushOf(const contact::SurfaceContacts& contacts) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < contacts.count; ++i) {
    const contact::SurfaceContact& c = contacts.points[static_cast<std::size_t>(i)];
    sum += std::max(-c.phi, 0.0) * c.n_B;
  }
  return sum;
}

struct Felt {
  Vec3 n = Vec3::UnitZ();
  Vec3 push = Vec3::Zero();  // [m]
  double phi = 1;            // of the main contact [m]
};

void countTurn(const Felt& before, const Felt& now, double step, double turn_limit, PathFigures& f) {
  constexpr double kRoundOff = 1e-8;  // [m] two contacts solved to 1e-9 m may differ by this on the finger
  f.largest_push = std::max(f.largest_push, ((now.push - before.push).norm() - kRoundOff) / step);
  if (before.phi >= 0 || now.phi >= 0) return;
  const double angle = math::atan2(before.n.cross(now.n).norm(), before.n.dot(now.n));
  const double place = std::max(0.0, kBenchFinger * angle - kRoundOff) / step;
  const double h = kBenchFinger + std::min(before.phi, now.phi);
  const double turn = place * std::max(h, 0.0) / kBenchFinger;
  f.largest_turn = std::max(f.largest_turn, turn);
  f.largest_place = std::max(f.largest_place, place);
  f.largest_degrees = std::max(f.largest_degrees, place / kBenchFinger * 180 / M_PI * 1e-6);
  f.jumps += turn > turn_limit;
}

}  // namespace

double PathFigures::meanIterations() const {
  double sum = 0;
  for (std::size_t i = 0; i < by_iterations.size(); ++i)
    sum += static_cast<double>(i) * static_cast<double>(by_iterations[i]);
  return sum > 0 ? sum / static_cast<double>(queries) : std::numeric_limits<double>::quiet_NaN();
}

int PathFigures::iterationsQuantile(double q) const {
  PINCER_ASSERT(0 <= q && q <= 1);
  const double rank = std::max(1.0, std::ceil(q * static_cast<double>(queries)));
  double seen = 0;
  for (std::size_t i = 0; i < by_iterations.size(); ++i) {
    seen += static_cast<double>(by_iterations[i]);
    if (seen >= rank) return static_cast<int>(i);
  }
  return kMostIterations;
}

Vec3 feltDirection(const contact::SurfaceContacts& contacts) {
  const Vec3 sum = pushOf(contacts);
  const double length = sum.norm();
  return length > 0 ? Vec3(sum / length) : contacts.main().n_B;
}

PathFigures walkPath(const contact::SmoothMesh& mesh, const FingerPath& path, double turn_limit,
                     MeasureContext& context) {
  PathFigures f;
  BenchFinger finger;
  Felt before;
  for (std::size_t i = 0; i < path.centres.size() && !context.interrupted(); ++i) {
    const bool fresh = i % static_cast<std::size_t>(path.restart_every) == 0;
    if (fresh) finger.tracker = {};
    const contact::SurfaceContacts contacts = finger.on(mesh, path.centres[i]);
    const Felt now{feltDirection(contacts), pushOf(contacts), contacts.main().phi};
    f.held += (finger.tracker.status & contact::kQueryHeldDirection) != 0;
    f.not_finite += !isFinite(contacts);
    if (!fresh) {
      countCost(contacts.cost, f);
      countTurn(before, now, (path.centres[i] - path.centres[i - 1]).norm(), turn_limit, f);
    }
    before = now;
    context.progress(0.5 + 0.5 * static_cast<double>(i) / static_cast<double>(path.centres.size()));
  }
  return f;
}

}  // namespace pincer::tasks
