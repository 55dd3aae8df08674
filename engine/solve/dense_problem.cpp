#include "pincer/engine/dense_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/error.h"
#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/contact_solver.h"

namespace pincer::engine {
namespace {

constexpr double kSameEntry = 1e-9;  // of W's largest: what symmetry may be off by, as printed numbers are
constexpr double kNoEntry = 1e-6;    // the same: what may lie below 0 of what isn't, after elimination

void check(const DenseProblem& problem) {
  const auto contacts = static_cast<Eigen::Index>(problem.mu.size()), rows = kTorsionRow * contacts;
  if (problem.W.rows() != rows || problem.W.cols() != rows || problem.q.size() != rows) {
    throw InputError(
        fmt::format("contact problem: {} contacts need a W of {} x {} and a q of {}; W is {} x {}, q has {}.", contacts,
                    rows, rows, rows, problem.W.rows(), problem.W.cols(), problem.q.size()));
  }
  if (!problem.W.allFinite() || !problem.q.allFinite()) throw InputError("contact problem: W or q isn't finite.");
  for (std::size_t i = 0; i < problem.mu.size(); ++i) {
    if (!(problem.mu[i] >= 0) || !std::isfinite(problem.mu[i]))
      throw InputError(
          fmt::format("contact problem: friction {} of contact {}; it must be 0 or more.", problem.mu[i], i));
  }
  const double largest = rows == 0 ? 0 : problem.W.cwiseAbs().maxCoeff();
  if (rows > 0 && (problem.W - problem.W.transpose()).cwiseAbs().maxCoeff() > kSameEntry * largest)
    throw InputError("contact problem: W isn't symmetric. Give (W + W^T) / 2.");
}

// W = A A^T, the columns of A by falling pivots; as many as W's rank.
Eigen::MatrixXd factorOf(const Eigen::MatrixXd& W) {
  const Eigen::Index n = W.rows();
  Eigen::VectorXd left = W.diagonal();
  const double largest = n == 0 ? 0 : left.maxCoeff(), none = 4e-16 * static_cast<double>(n) * largest;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  Eigen::Index rank = 0;
  for (; rank < n; ++rank) {
    Eigen::Index pivot = 0;
    if (!(left.maxCoeff(&pivot) > none)) break;
    const double root = std::sqrt(left[pivot]);
    A.col(rank) = (W.col(pivot) - A.leftCols(rank) * A.row(pivot).head(rank).transpose()) / root;
    left -= A.col(rank).cwiseAbs2();
    left[pivot] = 0;
  }
  if (n > 0 && left.minCoeff() < -kNoEntry * largest)
    throw InputError("contact problem: W isn't positive semi-definite; a body's response can't oppose its impulse.");
  return A.leftCols(rank);
}

// A in blocks of movers, and the problem that looks at them.
struct FactoredProblem {
  std::vector<int> first_row, first_side;
  std::vector<ContactSide> sides;
  int movers = 0, most_sides = 0;

  explicit FactoredProblem(const Eigen::MatrixXd& A)
      : movers(static_cast<int>((A.cols() + kMoverFreedoms - 1) / kMoverFreedoms)) {
    const int contacts = static_cast<int>(A.rows()) / kTorsionRow;
    for (int i = 0; i <= contacts; ++i) {
      first_row.push_back(kTorsionRow * i);
      first_side.push_back(static_cast<int>(sides.size()));
      if (i == contacts) break;
      for (int b = 0; b < movers; ++b) addSide(A, i, b);
      most_sides = std::max(most_sides, static_cast<int>(sides.size()) - first_side.back());
    }
  }
  void addSide(const Eigen::MatrixXd& A, int contact, int mover) {
    const Eigen::Index first = kMoverFreedoms * mover,
                       columns = std::min<Eigen::Index>(kMoverFreedoms, A.cols() - first);
    const auto block = A.block(kTorsionRow * contact, first, kTorsionRow, columns);
    if (block.isZero(0)) return;
    ContactSide side{.mover = mover, .is_point = false, .A = {}};
    for (int k = 0; k < kTorsionRow; ++k) {
      for (Eigen::Index j = 0; j < columns; ++j) side.A[k][j] = block(k, j);
    }
    sides.push_back(side);
  }
};

double naturalMapOf(const DenseProblem& problem, const Eigen::VectorXd& r, const Eigen::VectorXd& u) {
  double sum2 = 0;
  for (std::size_t i = 0; i < problem.mu.size(); ++i) {
    const Eigen::Index first = kTorsionRow * static_cast<Eigen::Index>(i);
    double x[kMaxContactRows] = {}, inside[kMaxContactRows] = {};
    for (int k = 0; k < kTorsionRow; ++k) x[k] = r[first + k] - u[first + k];
    x[kNormalRow] -= problem.mu[i] * std::sqrt(u[first] * u[first] + u[first + 1] * u[first + 1]);
    projectOntoCone(x, kTorsionRow, problem.mu[i], inside);
    for (int k = 0; k < kTorsionRow; ++k) sum2 += (r[first + k] - inside[k]) * (r[first + k] - inside[k]);
  }
  const double q = problem.q.norm();
  return q > 0 ? std::sqrt(sum2) / q : std::sqrt(sum2);
}

}  // namespace

DenseAnswer solveDense(const DenseProblem& problem, const SolverOptions& options) {
  constexpr int kRefinements = 3;  // each by the residual of the full W
  check(problem);
  const Eigen::MatrixXd A = factorOf(problem.W);
  FactoredProblem factored(A);
  const int contacts = static_cast<int>(problem.mu.size()), movers = factored.movers;
  DenseAnswer answer{Eigen::VectorXd::Zero(problem.q.size()), problem.q, {}};
  if (contacts == 0) return answer;
  SolverScratch scratch(SolverSize{.contacts = contacts,
                                   .movers = movers,
                                   .movers_per_contact = factored.most_sides,
                                   .places = contacts * factored.most_sides * factored.most_sides,
                                   .blocks = movers * movers,
                                   .products = movers * movers * movers});
  scratch.is_patient = true;
  Eigen::VectorXd q = problem.q;
  const ContactProblem posed{.first_row = factored.first_row,
                             .mu = problem.mu,
                             .sides = factored.sides,
                             .q = VectorMap(q.data(), q.size()),
                             .movers = movers,
                             .first_side = factored.first_side};
  // A W that isn't quite semi-definite has no factor: what A A^T leaves of it is taken from the last answer.
  for (int n = 0; n <= kRefinements; ++n) {
    DenseAnswer next = answer;
    next.result = solveContacts(posed, options, scratch, VectorMap(next.r.data(), next.r.size()),
                                VectorMap(next.u.data(), next.u.size()));
    next.result.iterations += answer.result.iterations;
    next.u = problem.W * next.r + problem.q;
    next.natural_map = naturalMapOf(problem, next.r, next.u);
    if (n > 0 && !(next.natural_map < 0.5 * answer.natural_map)) break;
    answer = std::move(next);
    q = answer.u - A * (A.transpose() * answer.r);
  }
  return answer;
}

}  // namespace pincer::engine
