#include "pincer/engine/world/stick_bias.h"

#include <span>

#include "pincer/engine/solve/linear.h"
#include "pincer/engine/world/joints.h"

namespace pincer::engine {
namespace {

constexpr double kFitted = 1e-12;  // of the largest bias: round-off
constexpr double kRidge = 1e-12;   // relative: motions that no contact sees get none

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

struct StuckSet {
  Vec3 centre = Vec3::Zero();  // mean of p_W [m]
  double spread = 0;           // sum of squared distances from it [m^2]
  int count = 0;
  bool flat = true;
};

StuckSet stuckOf(std::span<const Contact> pair) {
  StuckSet set;
  const Contact* first = nullptr;
  for (const Contact& c : pair) {
    if (!c.stuck) continue;
    if (!first) first = &c;
    set.flat = set.flat && c.n_W().dot(first->n_W()) > kSamePlane;
    set.centre += c.p_W;
    ++set.count;
  }
  set.centre /= std::max(set.count, 1);
  for (const Contact& c : pair) {
    if (c.stuck) set.spread += (c.p_W - set.centre).squaredNorm();
  }
  return set;
}

// The row of J that gives component k of contact c's velocity from xi, torsion in m/s.
Vec6 rowOf(const Contact& c, const Vec3& centre, int k) {
  Vec6 row = Vec6::Zero();
  if (k >= kTorsionRow) {
    row.tail<3>() = radiusOf(c, k) * axisOf(c, k);
    return row;
  }
  row.head<3>() = c.R_WC.col(k);
  row.tail<3>() = (c.p_W - centre).cross(c.R_WC.col(k));
  return row;
}

double unitOf(const Contact& c, int k) { return k >= kTorsionRow ? radiusOf(c, k) : 1; }

// False if the equations can't be solved (something isn't finite).
bool fitMotion(std::span<const Contact> pair, const StuckSet& set, Vec6& xi) {
  Mat6 A = Mat6::Zero();
  xi.setZero();
  for (const Contact& c : pair) {
    if (!c.stuck) continue;
    for (int k = 0; k < rowsOf(c.material); ++k) {
      const double weight = k == kNormalRow ? kNormalWeight * kNormalWeight : 1;
      const Vec6 row = rowOf(c, set.centre, k);
      for (int j = 0; j < 6; ++j) {
        for (int i = j; i < 6; ++i) A(i, j) += weight * row[i] * row[j];
        xi[j] -= weight * unitOf(c, k) * c.bias_C[k] * row[j];
      }
    }
  }
  for (int j = 0; j < 6; ++j) A(j, j) += kRidge * (j < 3 ? set.count : set.spread);
  return solveByLdlt(A.data(), 6, xi.data());
}

void alignPair(std::span<Contact> pair, int first, double h, double offset_rate, WorldScratch& scratch) {
  const StuckSet set = stuckOf(pair);
  Vec6 xi;
  if (set.count < 2 || set.flat || !fitMotion(pair, set, xi)) return;
  double largest = 0;
  for (const Contact& c : pair) {
    if (c.stuck) largest = std::max(largest, c.bias_C.cwiseAbs().maxCoeff());
  }
  for (Contact& c : pair) {
    const int row = scratch.first_row[first++];
    if (!c.stuck) continue;
    for (int k = 0; k < rowsOf(c.material); ++k) {
      if (k == kNormalRow) continue;
      if (!(unitOf(c, k) > 0)) continue;  // rolling without torsion
      const double bias = -rowOf(c, set.centre, k).dot(xi) / unitOf(c, k);
      if (std::abs(bias - c.bias_C[k]) <= kFitted * largest) continue;  // so that what rests does so to the bit
      scratch.q[row + k] += unitOf(c, k) * (bias - c.bias_C[k]);
      c.bias_C[k] = bias;
      c.offset_C[k] = bias / offset_rate - 0.5 * h * c.v_start_C[k];
    }
  }
}

// Rows of a point that ask for something: all of a contact that stuck; the normal
// of one that slid, or landed in an overlap.
bool asks(const Contact& c, int k) {
  if (k != kNormalRow) return c.stuck;
  return c.bias_C[kNormalRow] < 0 || (c.memory && c.memory->active && !c.closing);
}

// True if a point sticks at one of its contacts with a body, and touches it in another plane.
bool isHeldManyfold(std::span<const Contact> contacts) {
  const Contact* first = nullptr;
  bool sticks = false, flat = true;
  for (const Contact& c : contacts) {
    if (!asks(c, kNormalRow)) continue;
    if (!first) first = &c;
    sticks = sticks || c.stuck;
    flat = flat && c.n_W().dot(first->n_W()) > kSamePlane;
  }
  return sticks && !flat;
}

// A point has no turn to give: V alone, and gaps that contradict each other's offsets give way too.
bool fitMotion(std::span<const Contact> contacts, Vec3& V) {
  Mat3 A = Mat3::Zero();
  V.setZero();
  for (const Contact& c : contacts) {
    for (int k = 0; k < kPointRows; ++k) {
      if (!asks(c, k)) continue;
      const double weight = k == kNormalRow ? kNormalWeight * kNormalWeight : 1;
      const Vec3 row = c.R_WC.col(k);
      A += weight * row * row.transpose();
      V -= weight * c.bias_C[k] * row;
    }
  }
  return solveByLdlt(A.data(), 3, V.data());
}

void alignPoint(std::span<Contact> contacts, int first, double h, double offset_rate, WorldScratch& scratch) {
  Vec3 V;
  if (!isHeldManyfold(contacts) || !fitMotion(contacts, V)) return;
  double largest = 0;
  for (const Contact& c : contacts) {
    if (asks(c, kNormalRow)) largest = std::max(largest, c.bias_C.head<3>().cwiseAbs().maxCoeff());
  }
  for (Contact& c : contacts) {
    const int row = scratch.first_row[first++];
    for (int k = 0; k < kPointRows; ++k) {
      const double bias = -c.R_WC.col(k).dot(V);
      if (!asks(c, k) || std::abs(bias - c.bias_C[k]) <= kFitted * largest) continue;
      scratch.q[row + k] += bias - c.bias_C[k];
      c.bias_C[k] = bias;
      if (k != kNormalRow) c.offset_C[k] = bias / offset_rate - 0.5 * h * c.v_start_C[k];
    }
  }
}

bool isOfPoint(const Contact& c) { return c.a.kind == SideKind::kPoint || c.b.kind == SideKind::kPoint; }

bool isFree(const WorldModel& model, const Side& side) {
  if (side.kind != SideKind::kBody) return false;
  const BodyModel& body = model.bodies[static_cast<std::size_t>(side.index)];
  return body.dynamic && !isJoined(body);
}

}  // namespace

void alignStickBiases(const WorldModel& model, double h, double offset_rate, WorldScratch& scratch) {
  if (!(offset_rate > 0)) return;
  const std::span<Contact> contacts = scratch.contacts;
  for (std::size_t first = 0; first < contacts.size();) {
    std::size_t end = first + 1;
    while (end < contacts.size() && isOfSameTwo(contacts[first], contacts[end])) ++end;
    if (end > first + 1 && contacts[first].same_as < 0) {
      const std::span<Contact> pair = contacts.subspan(first, end - first);
      if (!isOfPoint(pair.front()))
        alignPair(pair, static_cast<int>(first), h, offset_rate, scratch);
      else if (!isFree(model, pair.front().a) && !isFree(model, pair.front().b))
        alignPoint(pair, static_cast<int>(first), h, offset_rate, scratch);
    }
    first = end;
  }
}

}  // namespace pincer::engine
