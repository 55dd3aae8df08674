// Quality of a grasp against closed forms, and against the support function searched at random.
#include "pincer/grasp/grasp_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pincer/grasp/quality/wrench_set.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/random_poses.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

using tests::kGravity;
using tests::RandomNumbers;

// A fingertip at p_W that presses along -n_W.
GraspContact contactAt(const Vec3& p_W, const Vec3& n_W, double mu, double torsion_radius) {
  GraspContact c;
  c.p_W = p_W;
  c.R_WC.col(2) = n_W;
  c.R_WC.col(0) = n_W.unitOrthogonal();
  c.R_WC.col(1) = n_W.cross(c.R_WC.col(0));
  c.mu = mu;
  c.torsion_radius = torsion_radius;
  c.f_n = 1;
  return c;
}

std::vector<GraspContact> pinch(double R, double mu, double torsion_radius) {
  return {contactAt({-R, 0, 0}, {-1, 0, 0}, mu, torsion_radius), contactAt({R, 0, 0}, {1, 0, 0}, mu, torsion_radius)};
}

Vec6 randomWrench(RandomNumbers& random) {
  Vec6 d;
  for (int i = 0; i < 6; ++i) d[i] = random.uniform(-1, 1);
  return d.normalized();
}

// Two fingers opposite each other at rho from the centre, each with mu and a torsion that is no weakness: the
// weakest direction mixes a push along the line (x) with a rotation that one finger can't follow, f_y = tau_z = a,
// d_x = mu a, 2 a^2 + d_x^2 = 1: epsilon = mu a.
TEST(GraspQuality, PinchHasTheBallOfTheClosedForm) {
  for (const double mu : {0.2, 0.5, 1.0}) {
    const GraspQuality q = graspQuality(pinch(0.02, mu, 0.03), Vec3::Zero(), {0, 0, -1});
    EXPECT_EQ(q.rank, 6);
    EXPECT_TRUE(q.force_closure);
    EXPECT_NEAR(q.epsilon, mu / std::sqrt(2 + mu * mu), 2e-7 * mu) << mu;  // the bounds from both sides agree to 1e-7
    EXPECT_NEAR(q.weakest_W.norm(), 1, 1e-12);
  }
}

// Where the torsion is weak, it alone is the weakness: epsilon = mu e / rho.
TEST(GraspQuality, PinchIsWeakestAboutItsLineWithSmallPads) {
  const double mu = 0.5, e = 0.002, rho = 0.02;
  const GraspQuality q = graspQuality(pinch(rho, mu, e), Vec3::Zero(), {0, 0, -1});
  EXPECT_NEAR(q.epsilon, mu * e / rho, 1e-7 * mu);
  EXPECT_NEAR(std::abs(q.weakest_W[3]), 1, 1e-3);
}

// Two point contacts can't stop the body from turning about their line; the
// weight they hold with m g / mu all the same.
TEST(GraspQuality, PointContactsLeaveTheTurnAboutTheirLine) {
  const GraspQuality q = graspQuality(pinch(0.02, 0.5, 0), Vec3::Zero(), {0, 0, -0.981});
  EXPECT_EQ(q.rank, 5);
  EXPECT_FALSE(q.force_closure);
  EXPECT_EQ(q.epsilon, 0);
  EXPECT_EQ(q.volume, 0);
  EXPECT_NEAR(std::abs(q.weakest_W[3]), 1, 1e-12);
  EXPECT_NEAR(q.least_squeeze, 0.981 / 0.5, 2e-7 * 0.981 / 0.5);
}

// Along the line of the pinch the finger below carries the weight alone.
TEST(GraspQuality, WeightAlongThePinchNeedsItselfOnly) {
  for (const double torsion : {0.0, 0.004}) {
    EXPECT_NEAR(graspQuality(pinch(0.02, 0.5, torsion), Vec3::Zero(), {0.7, 0, 0}).least_squeeze, 0.7, 1e-7);
  }
}

TEST(GraspQuality, FingersOnOneSideHoldNothing) {
  const std::vector<GraspContact> contacts = {contactAt({0.02, 0.01, 0}, {1, 0, 0}, 0.5, 0.005),
                                              contactAt({0.02, -0.01, 0}, {1, 0, 0}, 0.5, 0.005),
                                              contactAt({0.02, 0, 0.01}, {1, 0, 0}, 0.5, 0.005)};
  const GraspQuality q = graspQuality(contacts, Vec3::Zero(), {1, 0, 0});
  EXPECT_EQ(q.rank, 6);
  EXPECT_FALSE(q.force_closure);
  EXPECT_EQ(graspQuality(contacts, Vec3::Zero(), {-1, 0, 0}).least_squeeze, std::numeric_limits<double>::infinity());
  EXPECT_EQ(graspQuality({}, Vec3::Zero(), {0, 0, -1}).least_squeeze, std::numeric_limits<double>::infinity());
}

// A single frictionless contact below the centre carries the weight, no more and no less.
TEST(GraspQuality, OnePushHoldsOneDirection) {
  const GraspQuality q = graspQuality({contactAt({0, 0, -0.02}, {0, 0, -1}, 0, 0)}, Vec3::Zero(), {0, 0, -2});
  EXPECT_EQ(q.rank, 1);
  EXPECT_NEAR(q.least_squeeze, 2, 1e-8);  // the programme's perturbation
}

// Brute force: no direction in 20,000 lets the grasp resist less than epsilon, and the one that it names does to the
// last 1e-7. The polytope search and the closed-form support function know nothing of each other.
TEST(GraspQuality, BallIsTheLeastOfTheSupportFunction) {
  RandomNumbers random(7);
  int closed = 0;
  for (int trial = 0; trial < 6; ++trial) {
    std::vector<GraspContact> contacts;
    for (int i = 0; i < 3 + trial % 3; ++i) {
      const Vec3 n_W = tests::direction(random);
      contacts.push_back(contactAt(0.02 * n_W + 0.004 * tests::direction(random), n_W, random.uniform(0.3, 0.9),
                                   trial % 2 ? 0.005 : 0));
    }
    const GraspQuality q = graspQuality(contacts, Vec3::Zero(), {0, 0, -1});
    const WrenchSet wrenches(contacts, Vec3::Zero(), q.rho);
    double least = 1;
    for (int k = 0; k < 20'000; ++k) least = std::min(least, wrenches.support(randomWrench(random)));
    EXPECT_GE(least, q.epsilon) << trial;
    if (!q.force_closure) continue;
    ++closed;
    EXPECT_NEAR(wrenches.support(q.weakest_W), q.epsilon, 1e-12) << trial;
    EXPECT_LT(q.epsilon, least) << trial;
  }
  EXPECT_GE(closed, 2);
}

// Turning the world turns the answer with it.
TEST(GraspQuality, DoesNotKnowWhereNorthIs) {
  RandomNumbers random(3);
  std::vector<GraspContact> contacts = {contactAt({0.02, 0, 0.003}, {1, 0, 0}, 0.6, 0),
                                        contactAt({-0.02, 0.01, 0}, {-1, 0, 0}, 0.6, 0),
                                        contactAt({0, -0.02, 0.002}, {0, -1, 0}, 0.6, 0)};
  const GraspQuality before = graspQuality(contacts, Vec3::Zero(), {0, 0, -1});
  const Quat R = tests::rotation(random);
  for (GraspContact& c : contacts) {
    c.p_W = R * c.p_W;
    c.R_WC = R.toRotationMatrix() * c.R_WC;
  }
  const GraspQuality after = graspQuality(contacts, Vec3::Zero(), R * Vec3(0, 0, -1));
  EXPECT_NEAR(after.epsilon, before.epsilon, 2e-7 * before.epsilon);
  EXPECT_NEAR(after.least_squeeze, before.least_squeeze, 2e-7 * before.least_squeeze);
}

TEST(GraspQuality, LengthMustBePositive) { EXPECT_THROW(WrenchSet(pinch(0.02, 0.5, 0), Vec3::Zero(), 0), InputError); }

// Two soft fingers opposite each other push f_x = a1 - a2 and, sideways and turning, the Minkowski sum of two balls of
// radii mu a1 and mu a2 that share the torsion: 4 pi^2/3 mu^5 a1^2 a2^2 (a1 + a2); the largest is that of a1 + a2 = 1.
// Over f_x, 4 pi^2/45 mu^5; in the wrench's coordinates 4 e/rho times that.
TEST(GraspQuality, PinchHasTheVolumeOfTheClosedForm) {
  const double mu = 0.5, e = 0.03, rho = 0.02;
  const double exact = 16 * tests::kPi * tests::kPi / 45 * std::pow(mu, 5) * e / rho;
  // t^6 over 2000 directions
  EXPECT_NEAR(WrenchSet(pinch(rho, mu, e), Vec3::Zero(), rho).volume(), exact, 0.05 * exact);
}

// The real thing: a ball held for a second. Together the fingers carry the weight,
// and what they press besides is internal.
TEST(GraspQuality, HeldBallTellsItsMargins) {
  const double mass = 0.1, mu = 0.5, e = 0.004, weight = mass * kGravity;
  tests::GraspWorld w = tests::pinchedBall(mass, mu, 1000, e);
  GraspScratch scratch(w.model);
  const std::vector<FingerInput> inputs = tests::squeezing(0.004);
  for (int i = 0; i < 1000; ++i) step(w.model, w.state, scratch, inputs);
  const GraspQuality q = graspQuality(w.model, w.state, scratch, 0);
  ASSERT_EQ(q.contacts.size(), 2u);
  const double sag = 1e-3;  // [N]: the fingers sag by 0.5 mm and turn the normals a little; 4 N times that
  for (std::size_t k = 0; k < 2; ++k) {
    const GraspContact& c = q.contacts[k];
    EXPECT_EQ(c.finger, static_cast<int>(k));
    // at rest but for the last of a swing
    EXPECT_NEAR((c.R_WC * Vec3(c.f_T_C.x(), c.f_T_C.y(), -c.f_n)).z(), weight / 2, 1e-6);
    EXPECT_NEAR(q.slip_margins[k], 1 - weight / 2 / (mu * c.f_n), sag);
    EXPECT_NEAR(std::abs(q.internal_f_W[k].x()), c.f_n, sag);
  }
  EXPECT_NEAR((q.internal_f_W[0] + q.internal_f_W[1]).norm(), 0, 1e-12);
  EXPECT_NEAR(q.least_squeeze, weight / mu, sag);
  EXPECT_TRUE(q.force_closure);
}

// A grasp's tau_n once was the solver's impulse over the tick, which is scaled by the
// equivalent radius: off by 1/e, 300 times here.
TEST(GraspQuality, TorsionOfAGraspContactIsTheMomentThatItsSpringCarries) {
  constexpr double kTwist = 0.2, kAngle = 2e-3;  // [N m/rad], [rad]: an eighth of what the pad carries
  engine::WorldOptions options;
  options.gravity_W.setZero();
  engine::WorldBuilder builder(options);
  builder.addBody({"plate", contact::HalfSpace{}, false, 0, {0.5, 0.5, 0, 0}});
  FingerModel finger = tests::softFinger("soft");
  finger.pad.patch_radius = 5e-3;
  finger.coupling.twist_stiffness = kTwist;
  const GraspModel model = buildGrasp(builder, {finger});
  GraspState state = makeState(model, {tests::startAt(Vec3::Zero())}, {Vec3(0, 0, 8e-3)});
  GraspScratch scratch(model);
  std::vector<FingerInput> input(1);
  for (int i = 1; i <= 500; ++i) {
    input[0].p_WF = Vec3(0, 0, 8e-3 - 2e-3 * std::min(1.0, i / 100.0));
    input[0].q_WF = Quat(Eigen::AngleAxisd(kAngle * std::clamp((i - 200) / 100.0, 0.0, 1.0), Vec3::UnitZ()));
    step(model, state, scratch, input);
  }
  const std::vector<GraspContact> contacts = graspContacts(model, scratch, 0);
  ASSERT_EQ(contacts.size(), 1u);
  const GraspContact& c = contacts[0];
  EXPECT_NEAR(c.tau_n, -kTwist * kAngle, 1e-6 * kTwist * kAngle);  // at rest: 200 ticks after the turn
  EXPECT_DOUBLE_EQ(std::abs(c.tau_n), std::abs(scratch.fingers[0].torsion));
  EXPECT_NEAR(slipMargin(c), 1 - kTwist * kAngle / (2.0 / 3 * 5e-3 * 0.5 * c.f_n), 1e-6);
}

}  // namespace
}  // namespace pincer::grasp
