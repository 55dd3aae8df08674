#include "pincer/engine/world/wedge.h"

#include <algorithm>
#include <cmath>

#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/point_problem.h"
#include "pincer/engine/solve/residual.h"

namespace pincer::engine {
namespace {

// of 2 sin(alpha) S: far below what presses a point in, far above round-off of a squeeze
constexpr double kPressedIn = 0.1;
constexpr double kLoose = 0.5;  // of tan(alpha): what is let go comes out without much of a squeeze

// w r_n of the problem's speeds: 1 / sin(alpha) where the groove opens by 0.1 degrees
constexpr double kWedgedSqueeze = 1e3;

bool isPressedPoint(const Contact& c) {
  const bool is_point = c.a.kind == SideKind::kPoint || c.b.kind == SideKind::kPoint;
  return is_point && c.memory && c.memory->active;
}

Vec3 lastImpulse(const ContactMemory& m) {
  return m.r[0] * m.t1_W + m.r[1] * m.n_W.cross(m.t1_W) + m.r[kNormalRow] * m.n_W;
}

void loosen(Contact& x, Contact& y) {
  const Vec3 b = x.n_W() + y.n_W();
  const double sine = 0.5 * b.norm(), cosine = 0.5 * (x.n_W() - y.n_W()).norm();
  if (!(std::min(x.mu, y.mu) * cosine > sine)) return;
  const double squeeze = std::min(x.memory->r[kNormalRow], y.memory->r[kNormalRow]);
  const double out = (lastImpulse(*x.memory) + lastImpulse(*y.memory)).dot(b);  // times 2 sin(alpha)
  if (!(out < kPressedIn * 4 * sine * sine * squeeze)) return;
  const double mu = kLoose * sine / cosine;
  x.mu = std::min(x.mu, mu);
  y.mu = std::min(y.mu, mu);
}

// w r_n [m/s]
double responseOf(const ContactProblem& problem, int i, const double* r) {
  double w = 0;
  for (const ContactSide& side : problem.sidesOf(i)) {
    if (side.mover >= 0) w += dot6(side.A[kNormalRow], side.A[kNormalRow]);
  }
  return w * r[problem.firstRow(i) + kNormalRow];
}

}  // namespace

bool isWedged(const ContactProblem& problem, const double* r, const SolveResult& result) {
  if (!isPointProblem(problem)) return false;
  const double most = kWedgedSqueeze * referenceSpeed(problem);
  bool is_squeezed = false;
  for (int i = 0; i < problem.contactCount(); ++i) is_squeezed = is_squeezed || responseOf(problem, i, r) > most;
  return is_squeezed || !result.converged;
}

void loosenWedges(WorldScratch& scratch) {
  std::vector<Contact>& contacts = scratch.contacts;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (!isPressedPoint(contacts[i])) continue;
    for (std::size_t k = i + 1; k < contacts.size() && isOfSameTwo(contacts[k], contacts[i]); ++k) {
      if (isPressedPoint(contacts[k])) loosen(contacts[i], contacts[k]);
    }
  }
}

}  // namespace pincer::engine
