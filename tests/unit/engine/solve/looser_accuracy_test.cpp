// Accuracies looser than the default: what the search leaves undone.
#include <gtest/gtest.h>

#include "pincer/engine/solve/contact_solver.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/search.h"
#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

using tests::OwnedContactProblem;
using tests::RandomScenes;

// Eighty contacts at rest were brought to round-off from whatever was good enough, in up to 24 steps: heaps cost as
// much at 1e-3 m/s as at 1e-6.
TEST(LooserAccuracy, LeavesWhatIsAsGoodAsRestAsItIs) {
  RandomScenes random(41);
  OwnedContactProblem p = random.stack(20, 1, 0);
  const ContactProblem problem = p.view();
  SolverScratch scratch(problem.contactCount(), p.movers);
  Eigen::VectorXd answer = Eigen::VectorXd::Zero(p.q.size()), u = answer;
  ASSERT_TRUE(searchImpulses(problem, {}, scratch, answer.data(), u.data()).converged);
  for (int i = 0; i < problem.contactCount(); ++i)
    answer[problem.firstRow(i) + kNormalRow] *= 1 + random.uniform(0, 1e-6);
  const double error = errorOf(problem, answer.data(), scratch, u.data()).speed;
  ASSERT_LT(error, SolverOptions{}.accuracy);
  for (const bool is_loose : {false, true}) {
    const SolverOptions options{.accuracy = is_loose ? 200 * error : SolverOptions{}.accuracy};
    ASSERT_EQ(is_loose, error < restErrorOf(options)) << error;
    Eigen::VectorXd r = answer;
    const SolveResult result = searchImpulses(problem, options, scratch, r.data(), u.data());
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.iterations == 0, is_loose) << result.iterations;
    EXPECT_EQ(r == answer, is_loose);
  }
}

}  // namespace
}  // namespace pincer::engine
