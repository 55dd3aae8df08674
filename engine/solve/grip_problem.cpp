#include "pincer/engine/solve/grip_problem.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/grip_sums.h"
#include "pincer/engine/solve/lanes.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/squeeze.h"
#include "pincer/engine/solve/stuck_steps.h"
#include "pincer/engine/solve/triple.h"

namespace pincer::engine {
namespace {

constexpr int kGripLanes = 2 * kMostGripContacts;  // each face begins at an even one

using GripLanes = double[kGripLanes];

class Grip {
 public:
  Grip(const GripProblem& grip, const ContactProblem& problem, const double* r)
      : grip_(grip), n_(grip.contacts), root_mass_(grip.root_inverse_mass), speed_(referenceSpeed(problem)) {
    F_ = grip.F;
    for (int p = 0; p < grip.points; ++p) {
      for (int k = 0; k < 3; ++k) E_[p][k] = grip.point_root[static_cast<std::size_t>(p)][k];
    }
    read(problem, r);
    weigh();
  }

  // u and the error of r.
  ContactError error() {
    respond(r_);
    setVelocities<true>(u_);
    PairResidual sum;
    for (int i = 0; i < lanes_; i += 2) addResidual(i, sum);
    WorstResidual worst;
    for (int l = 0; l < 2; ++l) worst.add(sum.worst2[l], sum.check[l], sum.response[l]);
    return worst.relativeTo(speed_);
  }

  void holdWhatPushes() {
    for (int i = 0; i < lanes_; i += 2) {
      pairAt(holds_ + i) = pairAt(r_[kNormalRow] + i) > 0 ? DoublePair{1, 1} : DoublePair{0, 0};
    }
  }
  // As in stuck_contacts.cpp.
  bool allStayAsTheyAre() const {
    PairFlags all = kBoth;
    for (int i = 0; i < lanes_; i += 2) {
      const DoublePair w = pairAt(w_ + i), mu = pairAt(mu_ + i), hold = pairAt(holds_ + i);
      const DoublePair x = w * pairAt(r_[0] + i) - pairAt(u_[0] + i), y = w * pairAt(r_[1] + i) - pairAt(u_[1] + i),
                       n = w * pairAt(r_[kNormalRow] + i) - pairAt(u_[kNormalRow] + i), rim = mu * n;
      const auto sticks = (n > 0) & (x * x + y * y <= rim * rim), is_open = n <= 0;
      all &= (hold > 0) ? sticks : (is_open | (pairAt(counts_ + i) == 0));
    }
    return areTrue(all);
  }
  bool holdsWith(double share) const {
    PairFlags all = kBoth;
    for (int i = 0; i < lanes_; i += 2) {
      const DoublePair x = pairAt(r_[0] + i), y = pairAt(r_[1] + i), n = pairAt(r_[kNormalRow] + i),
                       rim = share * pairAt(mu_ + i) * n;
      all &= (pairAt(holds_ + i) == 0) | ((n > 0) & (x * x + y * y <= rim * rim));
    }
    return areTrue(all);
  }
  bool maySqueeze() const {
    DoublePair largest = {};
    for (int i = 0; i < lanes_; i += 2) {
      const DoublePair response = pairAt(w_ + i) * pairAt(r_[kNormalRow] + i);
      largest = response > largest ? response : largest;
    }
    return kPointRows * std::max(largest[0], largest[1]) > kLargestSqueeze * speed_;
  }

  // A step from r and u. False if there is none.
  bool step() {
    alignas(16) GripLanes change[kPointRows];
    for (int i = 0; i < lanes_; i += 2) {
      const DoublePair hold = pairAt(holds_ + i);
      times<kPointRows>([&](auto k) { pairAt(change[k] + i) = -pairAt(u_[k] + i) * hold; });
    }
    respond(change);
    if (!factorise()) return false;
    solve();
    solve();
    setVelocities<false>(change);
    for (int i = 0; i < lanes_; i += 2) {
      const DoublePair hold = pairAt(holds_ + i);
      times<kPointRows>([&](auto k) { pairAt(r_[k] + i) += pairAt(change[k] + i) * hold; });
    }
    return true;
  }

  void write(double* r, double* u) const {
    for (int n = 0; n < n_; ++n) {
      for (int k = 0; k < kPointRows; ++k) {
        r[kPointRows * n + k] = r_[k][lane_[n]];
        u[kPointRows * n + k] = u_[k][lane_[n]];
      }
    }
  }
  double speed() const { return speed_; }

 private:
  // Contacts with the same axes and the same point; lanes [first, end).
  struct Face {
    Matrix3 R;  // s R
    int point, first, end;
  };

  const GripContact& contact(int n) const { return grip_.contact[static_cast<std::size_t>(n)]; }

  // Face by face, two contacts at a time: numbers that are stored one by one and read as pairs at once cost a wait.
  void read(const ContactProblem& problem, const double* r) {
    for (int n = 0; n < n_;) {
      Face& face = faces_[face_count_++];
      int end = n + 1;
      while (end < n_ && isSameFace(contact(n), contact(end))) ++end;
      face.point = contact(n).point;
      face.first = lanes_;
      face.R = *contact(n).R_WC;
      for (; n < end; n += 2) readPair(problem, r, n, n + 1 < end, face.R);
      n = end;
      face.end = lanes_;
      times<3>([&](auto k) { times<3>([&](auto i) { face.R.column[k][i] *= contact(end - 1).sign; }); });
    }
  }
  // The other lane counts as none if there is no second contact.
  void readPair(const ContactProblem& problem, const double* r, int n, bool are_two, const Matrix3& R) {
    const int i = lanes_, m = n + are_two;
    const double second = are_two ? 1 : 0;
    const auto pairOf = [&](double x, double y) { return DoublePair{x, second * y}; };
    const double *const q_n = problem.q.data() + kPointRows * n, *const q_m = problem.q.data() + kPointRows * m;
    const double *const r_n = r + kPointRows * n, *const r_m = r + kPointRows * m;
    const Vec3 &arm_n = *contact(n).arm_W, &arm_m = *contact(m).arm_W;
    DoublePair arm[3];
    times<3>([&](auto k) {
      pairAt(arm_W_[k] + i) = arm[k] = pairOf(arm_n[k], arm_m[k]);
      pairAt(q_[k] + i) = pairOf(q_n[k], q_m[k]);
      pairAt(r_[k] + i) = pairOf(r_n[k], r_m[k]);
    });
    times<3>([&](auto k) {
      pairAt(arm_C_[k] + i) = (R.column[k][0] * arm[0] + R.column[k][1] * arm[1]) + R.column[k][2] * arm[2];
    });
    pairAt(mu_ + i) = pairOf(problem.friction(n), problem.friction(m));
    pairAt(counts_ + i) = DoublePair{1, second};
    lane_[n] = i;
    lane_[m] = i + are_two;
    lanes_ += 2;
  }
  static bool isSameFace(const GripContact& x, const GripContact& y) {
    const double *const R = x.R_WC->data(), *const S = y.R_WC->data();
    bool is_same = x.point == y.point && x.sign == y.sign;
    for (int k = 0; k < 3 && is_same; ++k) is_same = R[k] == S[k] && R[6 + k] == S[6 + k];
    return is_same;  // the axis between follows from the two
  }
  // Largest natural maps and responses, and the sum of all that must be finite, of two columns of lanes.
  struct PairResidual {
    DoublePair worst2 = {}, response = {}, check = {};
  };
  // Where r and u say that it sticks, as nearly all do, the natural map is u~ itself.
  void addResidual(int i, PairResidual& sum) const {
    const DoublePair w = pairAt(w_ + i), mu = pairAt(mu_ + i), counts = pairAt(counts_ + i);
    const DoublePair u[kPointRows] = {pairAt(u_[0] + i), pairAt(u_[1] + i), pairAt(u_[2] + i)};
    const DoublePair slip2 = u[0] * u[0] + u[1] * u[1], response = w * pairAt(r_[kNormalRow] + i);
    const DoublePair shifted = u[kNormalRow] + mu * DoublePair{std::sqrt(slip2[0]), std::sqrt(slip2[1])};
    const DoublePair x = w * pairAt(r_[0] + i) - u[0], y = w * pairAt(r_[1] + i) - u[1], n = response - shifted,
                     rim = mu * n;
    DoublePair error2 = slip2 + shifted * shifted;
    if (!areTrue(((n > 0) & (x * x + y * y <= rim * rim)) | (counts == 0))) {
      for (int l = 0; l < 2; ++l) {
        const double r_l[kPointRows] = {r_[0][i + l], r_[1][i + l], r_[2][i + l]},
                     u_l[kPointRows] = {u[0][l], u[1][l], u[2][l]};
        error2[l] = naturalMap2(r_l, u_l, kPointRows, mu[l], w[l]);
      }
    }
    error2 *= counts;
    sum.worst2 = error2 > sum.worst2 ? error2 : sum.worst2;
    sum.response = response > sum.response ? response : sum.response;
    sum.check += error2 + u[kNormalRow];
  }
  using PairFlags = decltype(DoublePair{} > DoublePair{});
  static constexpr PairFlags kBoth = {-1, -1};
  static bool areTrue(const PairFlags& flags) { return (flags[0] & flags[1]) != 0; }

  // The mean of W_ii's diagonal: of its three rows the trace, whatever their axes.
  void weigh() {
    Symmetric3 inverse_inertia{};
    times<3>([&](auto k) { inverse_inertia.add(squareOf({{F_.column[k][0], F_.column[k][1], F_.column[k][2]}}), 1); });
    const Symmetric3 J = inverse_inertia.turning();
    double of_point[kMostGripPoints];
    for (int p = 0; p < grip_.points; ++p) of_point[p] = dot(E_[p], E_[p]);
    for (int f = 0; f < face_count_; ++f) {
      const Face& face = faces_[f];
      const double linear = kPointRows * root_mass_ * root_mass_ + (face.point >= 0 ? of_point[face.point] : 0);
      for (int i = face.first; i < face.end; i += 2) {
        const DoublePair x = pairAt(arm_W_[0] + i), y = pairAt(arm_W_[1] + i), z = pairAt(arm_W_[2] + i);
        const DoublePair turn = (J.s[0] * x * x + J.s[1] * y * y + J.s[2] * z * z) +
                                2.0 * (J.s[3] * x * y + J.s[4] * x * z + J.s[5] * y * z);
        pairAt(w_ + i) = (linear + turn) / double{kPointRows};
      }
    }
  }

  // y = A^T r
  void respond(const GripLanes (&r)[kPointRows]) {
    Triple force{}, moment{};
    for (int p = 0; p < grip_.points; ++p) y_point_[p] = {};
    for (int f = 0; f < face_count_; ++f) {
      const Face& face = faces_[f];
      DoublePair sum[kPointRows] = {}, turn[kPointRows] = {};
      for (int i = face.first; i < face.end; i += 2) {
        times<kPointRows>([&](auto k) {
          constexpr int j = (k + 1) % 3, l = (k + 2) % 3;
          sum[k] += pairAt(r[k] + i);
          turn[k] += pairAt(arm_C_[j] + i) * pairAt(r[l] + i) - pairAt(arm_C_[l] + i) * pairAt(r[j] + i);
        });
      }
      const Triple f_W = face.R * Triple{{sumOf(sum[0]), sumOf(sum[1]), sumOf(sum[2])}};
      const Triple m_W = face.R * Triple{{sumOf(turn[0]), sumOf(turn[1]), sumOf(turn[2])}};
      times<3>([&](auto k) {
        force[k] += f_W[k];
        moment[k] += m_W[k];
        if (face.point >= 0) y_point_[face.point][k] -= E_[face.point][k] * f_W[k];
      });
    }
    times<3>([&](auto k) { y_linear_[k] = root_mass_ * force[k]; });
    y_angular_ = F_.transposeTimes(moment);
  }

  // u = A y, plus q
  template <bool with_q>
  void setVelocities(GripLanes (&u)[kPointRows]) const {
    const Triple turn_W = F_ * y_angular_;
    for (int f = 0; f < face_count_; ++f) {
      const Face& face = faces_[f];
      Triple way_W;
      times<3>([&](auto k) {
        way_W[k] = root_mass_ * y_linear_[k];
        if (face.point >= 0) way_W[k] -= E_[face.point][k] * y_point_[face.point][k];
      });
      const Triple way = face.R.transposeTimes(way_W), w = face.R.transposeTimes(turn_W);
      for (int i = face.first; i < face.end; i += 2) {
        times<kPointRows>([&](auto k) {
          constexpr int j = (k + 1) % 3, l = (k + 2) % 3;
          const DoublePair velocity = way[k] + (w[j] * pairAt(arm_C_[l] + i) - w[l] * pairAt(arm_C_[j] + i));
          pairAt(u[k] + i) = with_q ? pairAt(q_[k] + i) + velocity : velocity;
        });
      }
    }
  }

  void addArms(const Face& face, GripArms& arms) const {
    DoublePair n = {}, sum[3] = {}, squares[6] = {};
    for (int i = face.first; i < face.end; i += 2) {
      const DoublePair hold = pairAt(holds_ + i), x = pairAt(arm_W_[0] + i), y = pairAt(arm_W_[1] + i),
                       z = pairAt(arm_W_[2] + i);
      const DoublePair held[3] = {hold * x, hold * y, hold * z};
      n += hold;
      times<3>([&](auto k) { sum[k] += held[k]; });
      squares[0] += held[0] * x;
      squares[1] += held[1] * y;
      squares[2] += held[2] * z;
      squares[3] += held[0] * y;
      squares[4] += held[0] * z;
      squares[5] += held[1] * z;
    }
    arms.n += sumOf(n);
    times<3>([&](auto k) { arms.sum[k] += sumOf(sum[k]); });
    times<6>([&](auto k) { arms.squares.s[k] += sumOf(squares[k]); });
  }

  double largestDiagonal() const {
    double n = 0, largest = 0;
    Symmetric3 squares{};
    for (int p = 0; p <= grip_.points; ++p) {
      n += arms_[p].n;
      squares.add(arms_[p].squares, 1);
      for (int k = 0; k < 3 && p < grip_.points; ++k) largest = std::max(largest, arms_[p].n * E_[p][k] * E_[p][k]);
    }
    const Symmetric3 turning = squares.turning().within(F_);
    return std::max({largest, n * root_mass_ * root_mass_, turning.s[0], turning.s[1], turning.s[2]});
  }

  // N of the contacts that hold.
  bool factorise() {
    for (int p = 0; p <= grip_.points; ++p) arms_[p] = {};
    for (int f = 0; f < face_count_; ++f)
      addArms(faces_[f], arms_[faces_[f].point >= 0 ? faces_[f].point : grip_.points]);
    const double ridge = kStuckRidge * largestDiagonal();
    GripSums sums{};
    for (int p = 0; p < grip_.points; ++p) sums.addPoint(arms_[p], E_[p], ridge, inverse_P_[p]);
    sums.addStanding(arms_[grip_.points]);
    Triple N_ll, N_la[3];
    times<3>([&](auto k) {
      N_ll[k] = ridge + root_mass_ * root_mass_ * sums.ll[k];
      const Triple row = F_.transposeTimes(sums.la[k]);
      times<3>([&](auto j) { N_la[k][j] = root_mass_ * row[j]; });
    });
    Symmetric3 N_aa = sums.aa.within(F_);
    times<3>([&](auto k) { N_aa.s[k] += ridge; });
    return factor_.factorise(N_ll, N_la, N_aa);
  }

  // y becomes N^-1 y.
  void solve() {
    Triple moment{};
    for (int p = 0; p < grip_.points; ++p) {
      const Triple& a = arms_[p].sum;
      Triple z;
      times<3>([&](auto k) {
        z[k] = E_[p][k] * inverse_P_[p][k] * y_point_[p][k];
        y_linear_[k] += arms_[p].n * root_mass_ * z[k];
      });
      addCross(a, z, moment);
    }
    const Triple turn = F_.transposeTimes(moment);
    times<3>([&](auto k) { y_angular_[k] += turn[k]; });
    factor_.solve(y_linear_, y_angular_);
    const Triple turn_W = F_ * y_angular_;
    for (int p = 0; p < grip_.points; ++p) {
      Triple way{};
      addCross(turn_W, arms_[p].sum, way);
      times<3>([&](auto k) {
        const double moved = arms_[p].n * root_mass_ * y_linear_[k] + way[k];
        y_point_[p][k] = inverse_P_[p][k] * (y_point_[p][k] + E_[p][k] * moved);
      });
    }
  }

  const GripProblem& grip_;
  const int n_;
  const double root_mass_, speed_;
  Matrix3 F_;
  Triple E_[kMostGripPoints];
  int face_count_ = 0, lanes_ = 0, lane_[kMostGripContacts];
  Face faces_[kMostGripContacts];
  alignas(16) GripLanes arm_W_[3], arm_C_[3], q_[kPointRows], r_[kPointRows], u_[kPointRows], mu_, w_, holds_,
      counts_;  // counts_: 1 of a contact, 0 of the lane that fills a pair up
  Triple y_linear_, y_angular_, y_point_[kMostGripPoints];
  GripArms arms_[kMostGripPoints + 1];  // per point; behind them of contacts without one
  Triple inverse_P_[kMostGripPoints];
  BodyFactor factor_;
};

}  // namespace

bool solveGripProblem(const GripProblem& grip, const ContactProblem& problem, const SolverOptions& options,
                      SolverScratch& scratch, double* r, double* u, SolveResult& result) {
  PINCER_ASSERT(grip.contacts == problem.contactCount() && problem.rowCount() == kPointRows * grip.contacts);
  Grip held(grip, problem, r);
  const ContactError start = held.error();
  result = {SolveMethod::kWarmStart, 0, start.residual, start.speed, start.residual, true};
  bool is_solved = isGoodStart(problem, options, start, held.speed());
  if (!is_solved) {
    const std::int64_t operations_left = scratch.operations_left;
    result.method = SolveMethod::kNewton;
    is_solved = holdNearest(problem, options, held, scratch, result);
    if (!is_solved) scratch.operations_left = operations_left;
  }
  if (is_solved) held.write(r, u);
  return is_solved;
}

}  // namespace pincer::engine
