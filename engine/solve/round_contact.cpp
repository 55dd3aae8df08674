#include "pincer/engine/solve/round_contact.h"

#include <cmath>

#include "pincer/engine/solve/local_contact.h"
#include "pincer/engine/solve/mobility.h"

namespace pincer::engine {
namespace {

void crossProduct(const double* a, const double* b, double* out) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

// Takes over the side if its rows are linear R^T and turn (n x R)^T. cross: n x t1, n x t2
bool takeSide(const ContactSide& side, const double (&cross)[2][3], int place, RoundContact& c) {
  const double linear = dot3(c.R[kNormalRow], side.A[kNormalRow]), turn = dot3(cross[0], side.A[0] + 3);
  double error = 0;
  for (int k = 0; k < kTorsionRow; ++k) {
    for (int j = 0; j < 3; ++j) {
      error += std::abs(side.A[k][j] - linear * c.R[k][j]);
      error += std::abs(k == kNormalRow ? side.A[k][3 + j] : side.A[k][3 + j] - turn * cross[k][j]);
    }
  }
  c.linear[place] = linear;
  c.turn[place] = turn;
  c.mover[place] = side.mover;
  return error <= kBlockRoundOff * (std::abs(linear) + std::abs(turn));
}

bool makeRound(std::span<const ContactSide> sides, RoundContact& c) {
  if (sides.size() != 2) return false;
  const int first = sides[0].mover >= 0 ? 0 : 1, second = 1 - first;
  const ContactSide& moving = sides[static_cast<std::size_t>(first)];
  if (moving.mover < 0) return false;
  const double* const n = moving.A[kNormalRow];
  // its line misses the centre: so do most that aren't round
  if (dot3(n + 3, n + 3) > kBlockRoundOff * dot3(n, n)) return false;
  const double inverse = 1 / std::sqrt(dot3(moving.A[kNormalRow], moving.A[kNormalRow]));
  for (int k = 0; k < kTorsionRow; ++k) {
    for (int j = 0; j < 3; ++j) c.R[k][j] = inverse * moving.A[k][j];
  }
  double cross[2][3];
  for (int k = 0; k < 2; ++k) crossProduct(c.R[kNormalRow], c.R[k], cross[k]);
  if (!takeSide(moving, cross, first, c)) return false;
  c.linear[second] = c.turn[second] = 0;
  c.mover[second] = moving.mover;
  const ContactSide& other = sides[static_cast<std::size_t>(second)];
  if (other.mover >= 0 && !takeSide(other, cross, second, c)) return false;
  const double W_nn = c.linear[0] * c.linear[0] + c.linear[1] * c.linear[1];
  c.inverse_W_nn = 1 / W_nn;
  c.inverse_W_tt = 1 / (W_nn + (c.turn[0] * c.turn[0] + c.turn[1] * c.turn[1]));
  return std::isfinite(c.inverse_W_nn);
}

}  // namespace

void findRoundContacts(std::vector<RoundContact>& round, ContactProblem& problem) {
  int others = 0;
  for (int i = 0; i < problem.contactCount(); ++i) {
    const auto place = static_cast<std::size_t>(i);
    if (problem.rows(i) == kTorsionRow && makeRound(problem.sidesOf(i), round[place])) continue;
    round[place].inverse_W_tt = 0;
    if (2 * ++others >= problem.contactCount()) return;
  }
  problem.round = {round.data(), problem.mu.size()};
}

}  // namespace pincer::engine
