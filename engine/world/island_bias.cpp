#include "pincer/engine/world/island_bias.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/mover_matrix.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/round_contact.h"
#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/stick_bias.h"

namespace pincer::engine {
namespace {

constexpr double kInside = -1e-9;  // of the cone's radius: what is further in sticks
// contradictions between biases below this are below the solver's tolerance [m/s]
constexpr double kNegligible = 1e-11;
constexpr double kConverged = 1e-10;  // of |A^T b|, squared: 1e-5
constexpr double kConsistent = 1e-6;  // of what is asked for: what is left then is the ridge's
constexpr double kMostLeft = 1.01;    // of all that is asked for, squared: a least square is less, but for round-off
constexpr int kMostSteps = 40;        // of conjugate gradients
constexpr int kFewFitted = 200;       // for which so many may be taken; beyond,
constexpr int kFitVisits = 1500;      // of contacts, but
constexpr int kFewestSteps = 3;       // however many contacts there are
constexpr std::int64_t kPerContactFitted = 200;  // multiplications of a step

double unitOfRow(const Contact& c, int k) { return k >= kTorsionRow ? radiusOf(c, k) : 1; }

double dot(const double* a, const double* b, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

// The stick offset follows.
void changeBias(double h, double offset_rate, double change, int k, Contact& c) {
  c.bias_C[k] += change;
  if (k != kNormalRow && c.stuck && offset_rate > 0)
    c.offset_C[k] = c.bias_C[k] / offset_rate - 0.5 * h * c.v_start_C[k];
}

class BiasFit {
 public:
  // asked: of each row [m/s]; null for the biases
  BiasFit(PushingBy pushing, const ContactProblem& problem, const double* r, const double* asked,
          std::span<const int> order, std::vector<Contact>& contacts, SolverScratch& memory)
      : pushing_(pushing),
        problem_(problem),
        r_(r),
        asked_(asked),
        order_(order),
        contacts_(contacts),
        memory_(memory),
        rows_(problem.rowCount()),
        size_(kMoverFreedoms * problem.movers),
        most_steps_(problem.contactCount() <= kFewFitted ? kMostSteps
                                                         : std::max(kFewestSteps, kFitVisits / problem.contactCount())),
        b_(memory.work.data()),
        image_(memory.change.data()),
        weight_(memory.best_r.data()),
        direction_(memory.direction.data()),
        gradient_(memory.gradient.data()),
        response_(memory.way.data()) {}

  // How much is asked for [m/s].
  double gather() {
    double largest = 0;
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i), rows = problem_.rows(i);
      std::fill(b_ + first, b_ + first + rows, 0.0);
      std::fill(weight_ + first, weight_ + first + rows, 0.0);
      if (!(r_[first + kNormalRow] > 0)) continue;
      const Contact& c = contact(i);
      if (!takesPart(c)) continue;
      const bool is_stuck = sticks(c, i);
      for (int k = 0; k < rows; ++k) {
        const double w = weight_[first + k] = k == kNormalRow ? kNormalWeight : is_stuck ? 1 : 0;
        b_[first + k] = w * (asked_ ? asked_[first + k] : unitOfRow(c, k) * c.bias_C[k]);
        largest = std::max(largest, std::abs(b_[first + k]));
      }
    }
    return largest;
  }

  // The rest of b is w (A z + b); z itself nobody needs.
  void minimise() {
    MoverMatrix matrix(problem_, memory_);
    matrix.fits() ? solveDirectly(matrix) : descend();
  }

 private:
  // With a ridge far below what any contact sees.
  void solveDirectly(MoverMatrix& matrix) {
    constexpr double kStiff = 1e8;  // over the least weight of a contact
    double least = std::numeric_limits<double>::infinity();
    weighContacts(problem_, memory_);
    for (int i = 0; i < problem_.contactCount(); ++i)
      least = std::min(least, memory_.weight[static_cast<std::size_t>(i)]);
    const double stiff = kStiff / least;
    matrix.clear();
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const double* const weight = weight_ + problem_.firstRow(i);
      if (weight[kNormalRow] == 0) {
        matrix.skip(i);
        continue;
      }
      double G[kMaxContactRows][kMaxContactRows] = {};
      for (int k = 0; k < problem_.rows(i); ++k) G[k][k] = stiff * weight[k] * weight[k];
      matrix.add(i, G);
    }
    if (!matrix.factorise()) return;
    respond();
    for (int j = 0; j < size_; ++j) direction_[j] = stiff * gradient_[j];
    matrix.solve(direction_);
    move();
    for (int row = 0; row < rows_; ++row) b_[row] += image_[row];
  }

  void descend() {
    respond();
    for (int j = 0; j < size_; ++j) direction_[j] = gradient_[j];
    double g2 = dot(gradient_, gradient_, size_);
    const double enough = kConverged * g2;
    for (int n = 0; n < most_steps_ && g2 > enough && spend(kPerContactFitted * problem_.contactCount(), memory_);
         ++n) {
      move();
      const double step = g2 / dot(image_, image_, rows_);
      if (!std::isfinite(step)) return;
      for (int row = 0; row < rows_; ++row) b_[row] += step * image_[row];
      for (int j = 0; j < size_; ++j) gradient_[j] -= step * response_[j];
      const double before = g2;
      g2 = dot(gradient_, gradient_, size_);
      for (int j = 0; j < size_; ++j) direction_[j] = gradient_[j] + g2 / before * direction_[j];
    }
  }

  // The largest of b that no motion gives [m/s].
 public:
  double largestLeft() const {
    double largest = 0;
    for (int row = 0; row < rows_; ++row) largest = std::max(largest, std::abs(b_[row]));
    return largest;
  }
  double squaredLeft() const { return dot(b_, b_, rows_); }
  // And of what is asked for, which b weighs.
  double largestSpeedLeft() const {
    double largest = 0;
    for (int row = 0; row < rows_; ++row)
      if (weight_[row] > 0) largest = std::max(largest, std::abs(b_[row]) / weight_[row]);
    return largest;
  }

  // Takes what is left of b away from the biases: no motion gives it.
  void apply(double h, double offset_rate, double* q) {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      if (weight_[problem_.firstRow(i) + kNormalRow] == 0) continue;
      Contact& c = contact(i);
      for (int k = 0; k < problem_.rows(i); ++k) {
        const double w = weight_[problem_.firstRow(i) + k];
        if (!(w * unitOfRow(c, k) > 0)) continue;
        const double change = -b_[problem_.firstRow(i) + k] / w;
        q[problem_.firstRow(i) + k] += change;
        changeBias(h, offset_rate, change / unitOfRow(c, k), k, c);
      }
    }
  }

 private:
  Contact& contact(int i) const { return contacts_[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])]; }

  // Of the contacts that push: stuck ones with all rows, sliding ones along the normal.
  bool takesPart(const Contact& c) const {
    if (pushing_ == PushingBy::kWedged) return true;
    if (pushing_ == PushingBy::kLastTick && c.closing) return false;
    return !(c.bias_C[kNormalRow] > kLargestCorrection);  // far from touching: it may land, and asks for nothing
  }
  bool sticks(const Contact& c, int i) const {
    if (pushing_ == PushingBy::kWedged) return true;
    if (pushing_ == PushingBy::kLastTick) return c.stuck;
    return isInCone(r_ + problem_.firstRow(i), problem_.rows(i), problem_.friction(i), kInside);
  }

  // gradient = -A^T w b
  void respond() {
    std::fill(gradient_, gradient_ + size_, 0.0);
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i);
      if (weight_[first + kNormalRow] == 0) continue;
      double weighed[kMaxContactRows] = {};
      for (int k = 0; k < problem_.rows(i); ++k) weighed[k] = -weight_[first + k] * b_[first + k];
      withForm(problem_, i, [&](auto rows, const auto& form) { addImpulse(form, rows, weighed, gradient_); });
    }
  }
  // image = w A direction,  response = A^T w image: each contact is read once
  void move() {
    std::fill(response_, response_ + size_, 0.0);
    for (int i = 0; i < problem_.contactCount(); ++i) {
      double* const u = image_ + problem_.firstRow(i);
      const double* const weight = weight_ + problem_.firstRow(i);
      withForm(problem_, i, [&](auto rows, const auto& form) {
        for (int k = 0; k < rows; ++k) u[k] = 0;
        if (weight[kNormalRow] == 0) return;
        addVelocity(form, rows, direction_, u);
        double weighed[kMaxContactRows] = {};
        for (int k = 0; k < rows; ++k) {
          u[k] *= weight[k];
          weighed[k] = weight[k] * u[k];
        }
        addImpulse(form, rows, weighed, response_);
      });
    }
  }

  const PushingBy pushing_;
  const ContactProblem& problem_;
  const double *r_, *asked_;
  std::span<const int> order_;
  std::vector<Contact>& contacts_;
  SolverScratch& memory_;
  int rows_, size_, most_steps_;
  double *b_, *image_, *weight_, *direction_, *gradient_, *response_;
};

// By how much a point of what turns misses its arc at most: a tick's chord is shorter [m/s].
double chordError(double h, const Motion& m, const Vec3& arm_W) {
  constexpr double kChord = 1.0 / 24;  // sin(x / 2) = x / 2 (1 - x^2 / 24 + ..)
  const double turn2 = h * h * m.w_W.squaredNorm();
  if (!(turn2 <= kFastTurn * kFastTurn)) return 0;
  return kChord * turn2 * (m.v_W.norm() + m.w_W.cross(arm_W).norm());
}

double largestChordError(double h, std::span<const int> order, const std::vector<Contact>& contacts) {
  double largest = 0;
  for (const int i : order) {
    const Contact& c = contacts[static_cast<std::size_t>(i)];
    if (c.a.kind == SideKind::kJoint) continue;
    largest =
        std::max(largest, chordError(h, c.mover_a->start, c.arm_a_W) + chordError(h, c.mover_b->start, c.arm_b_W));
  }
  return largest;
}

}  // namespace

bool mayContradict(const ContactProblem& problem) {
  const int n = problem.contactCount();
  const bool is_twisted = n >= 2 && problem.rowCount() > kPointRows * n;
  return problem.movers >= 2 && (n >= problem.movers || is_twisted);
}

bool askForNothing(const ContactProblem& problem, const double* r, std::span<const int> order,
                   const std::vector<Contact>& contacts) {
  double largest = 0;
  for (int i = 0; i < problem.contactCount(); ++i) {
    const Contact& c = contacts[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
    if (!(r[problem.firstRow(i) + kNormalRow] > 0)) continue;
    withRows(problem.rows(i), [&](auto rows) {
      for (int k = 0; k < rows; ++k) largest = std::max(largest, std::abs(unitOfRow(c, k) * c.bias_C[k]));
    });
  }
  return kNormalWeight * largest <= kNegligible;
}

bool fitIslandBiases(PushingBy pushing, double h, double offset_rate, const ContactProblem& problem, const double* r,
                     double* q, std::span<const int> order, std::vector<Contact>& contacts, SolverScratch& memory) {
  if (memory.operations_left < 0 || askForNothing(problem, r, order, contacts)) return false;
  BiasFit fit(pushing, problem, r, nullptr, order, contacts, memory);
  const double asked = fit.gather(), all_asked = fit.squaredLeft();
  if (asked <= kNegligible) return false;
  fit.minimise();
  if (fit.largestLeft() <= kConsistent * asked) return false;
  if (!(fit.squaredLeft() <= kMostLeft * all_asked)) return false;
  fit.apply(h, offset_rate, q);
  return true;
}

void fitToTurn(double h, double offset_rate, const ContactProblem& problem, const double* r, const double* u, double* q,
               std::span<const int> order, std::vector<Contact>& contacts, SolverScratch& memory) {
  const double most = largestChordError(h, order, contacts);
  if (memory.operations_left < 0 || most <= kNegligible) return;
  BiasFit fit(PushingBy::kLastTick, problem, r, u, order, contacts, memory);
  fit.gather();
  fit.minimise();
  if (fit.largestSpeedLeft() <= most) fit.apply(h, offset_rate, q);
}

void giveWay(double h, double offset_rate, const ContactProblem& problem, const double* give, double* q,
             std::span<const int> order, std::vector<Contact>& contacts) {
  for (int i = 0; i < problem.contactCount(); ++i) {
    Contact& c = contacts[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
    for (int k = 0; k < problem.rows(i); ++k) {
      const int row = problem.firstRow(i) + k;
      q[row] += give[row];
      if (unitOfRow(c, k) > 0) changeBias(h, offset_rate, give[row] / unitOfRow(c, k), k, c);
    }
  }
}

}  // namespace pincer::engine
