#include "engine/world/island_bias.h"

#include <algorithm>
#include <cmath>

#include "engine/solve/cone.h"
#include "engine/solve/mobility.h"
#include "engine/world/contact_rows.h"

namespace pincer::engine {
namespace {

constexpr double kNormalRowWeight = 10;
constexpr double kInside = -1e-9;      // of the cone's radius: what is further in sticks
constexpr double kNegligible = 1e-11;  // contradictions between biases below this are below the solver's tolerance [m/s]
constexpr double kConverged = 1e-10;   // of |A^T b|, squared: 1e-5
constexpr int kMostSteps = 40;         // of conjugate gradients
constexpr int kFewContacts = 200;      // for which so many may be taken; beyond,
constexpr int kFitVisits = 1500;       // of contacts, but
constexpr int kFewestSteps = 3;
constexpr std::int64_t kPerContactFitted = 200;  // multiplications of a step

double unitOfRow(const Contact& c, int k) { return k >= kTorsionRow ? radiusOf(c, k) : 1; }

double dot(const double* a, const double* b, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

class BiasFit {
 public:
  BiasFit(PushingBy pushing, const ContactProblem& problem, const double* r, std::span<const int> order, std::vector<Contact>& contacts,
          SolverScratch& memory)
      : pushing_(pushing),
        problem_(problem),
        r_(r),
        order_(order),
        contacts_(contacts),
        memory_(memory),
        rows_(problem.rowCount()),
        size_(kMoverFreedoms * problem.movers),
        most_steps_(problem.contactCount() <= kFewContacts ? kMostSteps : std::max(kFewestSteps, kFitVisits / problem.contactCount())) {
    double* next = memory.interior.data();
    for (double** vector : {&b_, &image_, &weight_}) {
      *vector = next;
      next += rows_;
    }
    for (double** vector : {&z_, &direction_, &gradient_}) {
      *vector = next;
      next += size_;
    }
  }

  // How much the biases ask for [m/s].
  double gather() {
    double largest = 0;
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const Contact& c = contact(i);
      for (int k = 0; k < problem_.rows(i); ++k) {
        double& b = b_[problem_.firstRow(i) + k];
        const double w = weight_[problem_.firstRow(i) + k] = weightOf(c, i, k);
        b = w > 0 ? w * unitOfRow(c, k) * c.bias_C[k] : 0;
        largest = std::max(largest, std::abs(b));
      }
    }
    return largest;
  }

  // z; what is left of b is A z + b.
  void minimise() {
    std::fill(z_, z_ + size_, 0.0);
    respond(b_, gradient_);
    for (int j = 0; j < size_; ++j) direction_[j] = gradient_[j] = -gradient_[j];
    double g2 = dot(gradient_, gradient_, size_);
    const double enough = kConverged * g2;
    for (int n = 0; n < most_steps_ && g2 > enough && spend(kPerContactFitted * problem_.contactCount(), memory_); ++n) {
      move(direction_, image_);
      const double step = g2 / dot(image_, image_, rows_);
      if (!std::isfinite(step)) return;
      for (int j = 0; j < size_; ++j) z_[j] += step * direction_[j];
      for (int row = 0; row < rows_; ++row) b_[row] += step * image_[row];
      respond(b_, gradient_);
      for (int j = 0; j < size_; ++j) gradient_[j] = -gradient_[j];
      const double before = g2;
      g2 = dot(gradient_, gradient_, size_);
      for (int j = 0; j < size_; ++j) direction_[j] = gradient_[j] + g2 / before * direction_[j];
    }
  }

  // Takes what is left of b away from the biases: no motion gives it.
  void apply(double h, double offset_rate, double* q) {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      Contact& c = contact(i);
      for (int k = 0; k < problem_.rows(i); ++k) {
        const double w = weight_[problem_.firstRow(i) + k];
        if (!(w * unitOfRow(c, k) > 0)) continue;
        const double change = -b_[problem_.firstRow(i) + k] / w;
        q[problem_.firstRow(i) + k] += change;
        c.bias_C[k] += change / unitOfRow(c, k);
        if (k != kNormalRow && c.stuck && offset_rate > 0) c.offset_C[k] = c.bias_C[k] / offset_rate - 0.5 * h * c.v_start_C[k];
      }
    }
  }

 private:
  Contact& contact(int i) const { return contacts_[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])]; }

  // Contacts that push take part: stuck ones with all rows, sliding ones along the normal.
  double weightOf(const Contact& c, int i, int k) const {
    const double* const r_i = r_ + problem_.firstRow(i);
    if (!(r_i[kNormalRow] > 0)) return 0;
    if (pushing_ == PushingBy::kLastTick && c.closing) return 0;
    if (c.bias_C[kNormalRow] > kLargestCorrection) return 0;  // far from touching: it may land, and asks for nothing
    if (k == kNormalRow) return kNormalRowWeight;
    const bool sticks = pushing_ == PushingBy::kLastTick ? c.stuck : isInCone(r_i, problem_.rows(i), problem_.friction(i), kInside);
    return sticks ? 1 : 0;
  }

  // out = A^T w v,  out = w A z
  void respond(const double* v, double* out) const {
    std::fill(out, out + size_, 0.0);
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i);
      if (weight_[first + kNormalRow] == 0) continue;
      double weighed[kMaxContactRows] = {};
      for (int k = 0; k < problem_.rows(i); ++k) weighed[k] = weight_[first + k] * v[first + k];
      addImpulse(problem_.sides[static_cast<std::size_t>(i)], problem_.rows(i), weighed, out);
    }
  }
  void move(const double* z, double* out) const {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      double* const u = out + problem_.firstRow(i);
      for (int k = 0; k < problem_.rows(i); ++k) u[k] = 0;
      const double* const weight = weight_ + problem_.firstRow(i);
      if (weight[kNormalRow] == 0) continue;
      addVelocity(problem_.sides[static_cast<std::size_t>(i)], problem_.rows(i), z, u);
      for (int k = 0; k < problem_.rows(i); ++k) u[k] *= weight[k];
    }
  }

  const PushingBy pushing_;
  const ContactProblem& problem_;
  const double* r_;
  std::span<const int> order_;
  std::vector<Contact>& contacts_;
  SolverScratch& memory_;
  int rows_, size_, most_steps_;
  double *b_, *image_, *weight_, *z_, *direction_, *gradient_;
};

}  // namespace

bool mayContradict(const ContactProblem& problem) {
  const int n = problem.contactCount();
  return problem.movers >= 2 && n >= problem.movers;
}

void fitIslandBiases(PushingBy pushing, double h, double offset_rate, const ContactProblem& problem, const double* r, double* q,
                     std::span<const int> order, std::vector<Contact>& contacts, SolverScratch& memory) {
  BiasFit fit(pushing, problem, r, order, contacts, memory);
  if (memory.operations_left < 0 || fit.gather() <= kNegligible) return;
  fit.minimise();
  fit.apply(h, offset_rate, q);
}

}  // namespace pincer::engine
