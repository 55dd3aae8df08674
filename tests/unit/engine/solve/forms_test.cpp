// The two ways to the solver's linear equations, contact by contact and mover by mover, find the same
// motion; so do contacts in another order.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "pincer/engine/solve/contact_equations.h"
#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

using tests::OwnedContactProblem;
using tests::RandomScenes;
using tests::Solved;

const SolverOptions kExact{.accuracy = 0};

Solved solveWith(OwnedContactProblem& problem, int dense_contacts) {
  const ContactProblem view = problem.view();
  SolverScratch scratch(view.contactCount(), view.movers);
  scratch.dense_contacts = std::min(dense_contacts, scratch.dense_contacts);
  Solved s{Eigen::VectorXd::Zero(view.rowCount()), Eigen::VectorXd::Zero(view.rowCount()), {}};
  s.result = solveContacts(view, {}, scratch, {s.r.data(), s.r.size()}, {s.u.data(), s.u.size()});
  return s;
}

// Velocities are unique where friction is moderate and every contact has movers of its own; impulses as well.
TEST(EquationForms, FindTheSameGrasp) {
  RandomScenes random(31);
  int compared = 0;
  for (int n = 0; n < 100; ++n) {
    OwnedContactProblem p = random.grasp(random.integer(2, 8), 10, n % 2 == 0);
    const Solved contacts = solveWith(p, 100), movers = solveWith(p, 0);
    if (!contacts.result.converged || !movers.result.converged) continue;
    ++compared;
    EXPECT_LE((contacts.u - movers.u).norm(), 1e-7 * p.q.norm()) << n;  // both to 1e-10, times the condition of W
  }
  EXPECT_GE(compared, 95);  // all 100 today
}

// Of redundant contacts the shares are open, the velocities of the body aren't.
TEST(EquationForms, FindTheSameMotionOnRedundantContacts) {
  RandomScenes random(32);
  for (int n = 0; n < 50; ++n) {
    OwnedContactProblem p = random.ring(random.integer(4, 12), 1e-4);
    const Solved contacts = solveWith(p, 100), movers = solveWith(p, 0);
    ASSERT_TRUE(movers.result.converged);
    EXPECT_LE((contacts.u - movers.u).norm(), 1e-8 * p.q.norm()) << n;
  }
}

// A box of 0.2 kg slides on its four corners, which ask for what it can't do all at once: by the round-off
// of their gaps, 5e-17 m, of which a tick of 1 ms undoes a fifth. Each Newton step once moved some 4e-4 of
// its weight from corner to corner for that.
TEST(EquationForms, RoundOffOfGapsDoesntMoveTheLoadOfABox) {
  const auto loads = [](double noise) {
    tests::ContactScene scene;
    const int box = scene.addBody({0, 0, 0.01}, 0.2, 1e-4, {0.3, 0.1, -9.81e-3}, {0, 0, 1});
    for (const double x : {-0.02, 0.02}) {
      for (const double y : {-0.03, 0.03})
        scene.addContact(box, -1, {x, y, 0}, Vec3::UnitZ(), 0.5, 0, x * y > 0 ? noise : -noise);
    }
    OwnedContactProblem problem = scene.build();
    const Solved solved = solveWith(problem, 100);
    EXPECT_TRUE(solved.result.converged);
    return Eigen::Vector4d(solved.r[2], solved.r[5], solved.r[8], solved.r[11]);
  };
  const Eigen::Vector4d exact = loads(0);
  EXPECT_NEAR(exact.sum(), 0.2 * 9.81e-3, 1e-12);
  EXPECT_LT((loads(1e-14) - exact).cwiseAbs().maxCoeff(), 2e-5 * exact.sum());
}

// The problem with its contacts in the order of `places`.
OwnedContactProblem permuted(const OwnedContactProblem& p, const std::vector<std::size_t>& places) {
  OwnedContactProblem out;
  out.movers = p.movers;
  out.q.resize(p.q.size());
  for (const std::size_t c : places) {
    const int rows = p.first_row[c + 1] - p.first_row[c];
    out.q.segment(out.first_row.back(), rows) = p.q.segment(p.first_row[c], rows);
    out.first_row.push_back(out.first_row.back() + rows);
    out.mu.push_back(p.mu[c]);
    out.sides.push_back(p.sides[c]);
    for (ContactSide& side : out.sides.back())
      side.mover = side.mover < 0 ? -1 : p.movers - 1 - side.mover;  // bodies in another order, too
  }
  return out;
}

TEST(EquationForms, DoNotDependOnTheOrderOfContactsAndBodies) {
  RandomScenes random(33);
  for (int n = 0; n < 100; ++n) {
    OwnedContactProblem p = n % 2 ? random.grasp(5, 10, false) : random.stack(3, 1, 1e-4);
    std::vector<std::size_t> places(p.mu.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    for (std::size_t k = places.size(); k > 1; --k)
      std::swap(places[k - 1], places[static_cast<std::size_t>(random.integer(0, static_cast<int>(k) - 1))]);
    OwnedContactProblem other = permuted(p, places);
    const Solved s = tests::solve(p, kExact), t = tests::solve(other, kExact);
    ASSERT_TRUE(s.result.converged && t.result.converged) << n;
    double difference = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const int from = p.first_row[places[k]], to = other.first_row[k];
      difference = std::max(difference, (s.u.segment<3>(from) - t.u.segment<3>(to)).norm());
    }
    // residual 1e-10 of max |q|, times the condition of W
    EXPECT_LE(difference, 1e-10 + 1e-8 * p.q.cwiseAbs().maxCoeff()) << n;
  }
}

// The problem with each mover's six columns as two movers of three each, as long arms are cut into blocks.
struct CutProblem {
  std::vector<int> first_side{0};
  std::vector<ContactSide> sides;

  explicit CutProblem(const OwnedContactProblem& p) {
    for (const ContactSides& whole : p.sides) {
      for (const ContactSide& side : whole) {
        for (int part = 0; side.mover >= 0 && part < 2; ++part) {
          ContactSide& out =
              sides.emplace_back(ContactSide{.mover = 2 * side.mover + part, .is_point = false, .A = {}});
          for (int k = 0; k < kMaxContactRows; ++k)
            std::copy(side.A[k] + 3 * part, side.A[k] + 3 * part + 3, out.A[k] + 3 * part);
        }
      }
      first_side.push_back(static_cast<int>(sides.size()));
    }
  }
  Solved solve(OwnedContactProblem& p) const {
    ContactProblem view = p.view();
    view.sides = sides;
    view.first_side = first_side;
    view.movers = 2 * p.movers;
    SolverScratch scratch(solverSize(view.contactCount(), view.movers, 4));
    Solved s{Eigen::VectorXd::Zero(view.rowCount()), Eigen::VectorXd::Zero(view.rowCount()), {}};
    s.result = solveContacts(view, kExact, scratch, {s.r.data(), s.r.size()}, {s.u.data(), s.u.size()});
    return s;
  }
};

// W is the same, and so is the answer, by all forms: small, dense, mover by mover, swept.
TEST(EquationForms, DoNotDependOnHowAMoverIsCutIntoBlocks) {
  RandomScenes random(36);
  for (int n = 0; n < 200; ++n) {
    OwnedContactProblem p = n % 4 == 0   ? random.grasp(random.integer(1, 8), 1000, false)
                            : n % 4 == 1 ? random.cluster(random.integer(2, 6), random.integer(4, 12), 1000, 1, false)
                            : n % 4 == 2 ? random.stack(random.integer(1, 3), 1, 1e-4)
                                         : random.ring(random.integer(2, 12), 1e-4);
    const Solved whole = tests::solve(p, kExact), cut = CutProblem(p).solve(p);
    EXPECT_EQ(cut.result.converged, whole.result.converged) << n;
    if (!whole.result.converged) continue;
    EXPECT_LE((cut.u - whole.u).cwiseAbs().maxCoeff(), 1e-10 + 1e-8 * p.q.cwiseAbs().maxCoeff()) << n;
  }
}

// A stack of twenty is solved mover by mover: eighty contacts, a block-tridiagonal matrix.
TEST(EquationForms, CarryATallStack) {
  RandomScenes random(34);
  OwnedContactProblem p = random.stack(20, 1, 0);
  const Solved s = tests::solve(p, kExact);
  ASSERT_TRUE(s.result.converged);
  EXPECT_LE((p.W * s.r + p.q).cwiseAbs().maxCoeff(), 2e-8);  // [m/s]; the tolerance times the condition of W
  double total = 0;                                          // of the floor's contacts
  for (int i = 0; i < 4; ++i) total += s.r[3 * i + 2];
  double weight = 0;  // sides hold sqrt(1/m) along the normal
  for (int k = 0; k < 20; ++k)
    weight += 9.81e-3 / p.sides[static_cast<std::size_t>(4 * k)][0].A[kNormalRow][2] /
              p.sides[static_cast<std::size_t>(4 * k)][0].A[kNormalRow][2];
  EXPECT_NEAR(total, weight, 1e-6 * weight);  // 10 nm/s of g h = 10 mm/s
}

// More entangled than a factorisation takes: sweeps, flagged or converged, never wrong.
TEST(EquationForms, SweepWhatIsTooLarge) {
  RandomScenes random(35);
  OwnedContactProblem p = random.cluster(150, 500, 1, 0.5, false);
  const Solved s = tests::solve(p);
  EXPECT_TRUE(s.r.allFinite());
  EXPECT_GE(s.result.method, SolveMethod::kSweeps);
  EXPECT_LE(s.r.dot(p.q + 0.5 * (p.W * s.r)), 1e-12);
}

// Contacts of a long rope on the floor: each with all of its blocks. Without memory for the factors they are swept.
TEST(EquationForms, SweepFiftyContactsOfTwentyFiveBlocksEach) {
  constexpr int kContacts = 50, kMovers = 25, kRows = 3 * kContacts;
  RandomScenes random(37);
  std::vector<ContactSide> sides;
  std::vector<int> first_side{0}, first_row{0};
  Eigen::MatrixXd A(kRows, kMoverFreedoms * kMovers);
  for (int i = 0; i < kContacts; ++i) {
    for (int b = 0; b < kMovers; ++b) {
      ContactSide& side = sides.emplace_back(ContactSide{.mover = b, .is_point = false, .A = {}});
      for (int k = 0; k < 3; ++k) {
        for (int j = 0; j < kMoverFreedoms; ++j)
          A(3 * i + k, kMoverFreedoms * b + j) = side.A[k][j] = random.uniform(-1, 1);
      }
    }
    first_side.push_back(static_cast<int>(sides.size()));
    first_row.push_back(3 * (i + 1));
  }
  const std::vector<double> mu(kContacts, 0.5);
  Eigen::VectorXd q = Eigen::VectorXd::NullaryExpr(kRows, [&](auto) { return random.uniform(-1, 1); }), r = 0 * q,
                  u = r;
  const ContactProblem problem{.first_row = first_row,
                               .mu = mu,
                               .sides = sides,
                               .q = VectorMap(q.data(), kRows),
                               .movers = kMovers,
                               .first_side = first_side};
  SolverScratch scratch(solverSize(kContacts, kMovers, kMovers));
  const SolveResult result = solveContacts(problem, {}, scratch, {r.data(), kRows}, {u.data(), kRows});
  EXPECT_GE(result.method, SolveMethod::kSweeps);
  EXPECT_LE((A * (A.transpose() * r) + q - u).cwiseAbs().maxCoeff(), 1e-12 * r.norm());
  EXPECT_LE(r.dot(q + 0.5 * (A * (A.transpose() * r))), 1e-12);
}

}  // namespace
}  // namespace pincer::engine
