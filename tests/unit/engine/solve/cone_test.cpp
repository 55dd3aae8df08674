// The Coulomb cone: its projection, the coupled projections of Alart and Curnier, the natural map.
#include "pincer/engine/solve/cone.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

using Vec6 = ContactVector;

constexpr int kRowsOfContacts[] = {3, 4, 6};

Vec6 anyVector(tests::RandomScenes& random, int rows) {
  Vec6 v = Vec6::Zero();  // rows that the contact doesn't have are 0
  v.head<3>() = random.vector(1);
  for (int k = 3; k < rows; ++k) v[k] = random.uniform(-1, 1);
  return v;
}

constexpr double kRoundOff = 1e-15;  // 4 ulp of a number of size 1
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Sample {
  Vec6 y = Vec6::Zero();
  int rows = 3;
  double mu = 0;

  explicit Sample(tests::RandomScenes& random)
      : rows(kRowsOfContacts[random.integer(0, 2)]), mu(random.integer(0, 9) == 0 ? 0 : random.uniform(0, 5)) {
    y = anyVector(random, rows);
  }
  Vec6 projected() const {
    Vec6 p = Vec6::Zero();
    projectOntoCone(y.data(), rows, mu, p.data());
    return p;
  }
  double size() const { return y.norm() * (1 + mu); }
};

// Moreau: y splits into its projections onto K and onto the polar cone { v : v_n <= -mu |v_T| }, which are orthogonal.
RC_GTEST_PROP(Cone, SplitsAnyVectorIntoOrthogonalParts, (unsigned seed)) {
  tests::RandomScenes random(seed);
  const Sample s(random);
  const Vec6 p = s.projected();
  const Vec6 rest = s.y - p;
  RC_ASSERT(isInCone(p.data(), s.rows, s.mu, kRoundOff));
  RC_ASSERT(rest[2] <= -s.mu * std::sqrt(tangentNorm2(rest.data(), s.rows)) + 4 * kRoundOff * s.size());
  RC_ASSERT(std::abs(p.dot(rest)) <= 8 * kRoundOff * s.size() * s.size());
}

// Without friction |y_T| = mu y_n = 0 holds for a pull too; it isn't in the cone.
TEST(Cone, LetsGoOfAPullWithoutFriction) {
  Eigen::Vector4d p = Eigen::Vector4d::Ones();
  projectOntoCone(Eigen::Vector4d(0, 0, -1e-12, 0).data(), 4, 0, p.data());
  EXPECT_EQ(p, Eigen::Vector4d::Zero());
}

// Brute force: no point of the cone is closer.
RC_GTEST_PROP(Cone, ProjectsOntoTheClosestPoint, (unsigned seed)) {
  tests::RandomScenes random(seed);
  const Sample s(random);
  const double distance = (s.y - s.projected()).norm();
  for (int n = 0; n < 200; ++n) {
    const double normal = random.uniform(0, 3);
    Vec6 other = anyVector(random, s.rows);
    other[2] = 0;
    if (other.norm() > s.mu * normal) other *= s.mu * normal / other.norm();
    other[2] = normal;
    RC_ASSERT((s.y - other).norm() >= distance - kRoundOff * s.size());
  }
}

TEST(Cone, IsTheHalfLineWithoutFriction) {
  const double y[] = {3, -4, 2};
  double p[3];
  projectOntoCone(y, 3, 0, p);
  EXPECT_EQ(p[0], 0);
  EXPECT_EQ(p[1], 0);
  EXPECT_EQ(p[2], 2);
}

TEST(Cone, MayProjectInPlace) {
  double y[] = {3, -4, 1, 12};
  double p[4];
  projectOntoCone(y, 4, 0.5, p);
  projectOntoCone(y, 4, 0.5, y);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(p[k], y[k]);
}

TEST(Cone, HoldsNothingThatIsNotANumber) {
  const double tangent[] = {kNaN, 0, 1}, normal[] = {0, 0, kNaN};
  EXPECT_FALSE(isInCone(tangent, 3, 0.5));
  EXPECT_FALSE(isInCone(normal, 3, 0.5));
}

// Finite differences of the coupled projections: 1e-7 steps leave an error of
// about 1e-7 (curvature) plus 1e-9 (round-off).
RC_GTEST_PROP(Cone, SlideDerivativeIsThatOfTheCoupledProjections, (unsigned seed)) {
  tests::RandomScenes random(seed);
  const Sample s(random);
  RC_PRE(contactMode(s.y.data(), s.rows, s.mu) == ContactMode::kSlide);
  RC_PRE(tangentNorm2(s.y.data(), s.rows) > 0.01);
  const auto coupled = [&](const Vec6& y) {
    Vec6 p = y * (s.mu * y[2] / std::sqrt(tangentNorm2(y.data(), s.rows)));
    p[2] = y[2];
    return p;
  };
  const SlideDerivative derivative = slideDerivative(s.y.data(), s.rows, s.mu);
  for (int k = 0; k < s.rows; ++k) {
    const Vec6 dy = Vec6::Unit(k);
    Vec6 dp = Vec6::Zero();
    for (int row = 0; row < s.rows; ++row) dp[row] = derivative.at(row, k);
    const Vec6 difference = (coupled(s.y + 1e-7 * dy) - coupled(s.y - 1e-7 * dy)) / 2e-7;
    RC_ASSERT((difference - dp).norm() <= 1e-6 * (1 + s.mu));
  }
}

// The three ways to obey the law, and one violation of each kind.
TEST(NaturalMap, IsZeroExactlyWhereTheLawHolds) {
  const auto error = [](Vec3 r, Vec3 u) { return std::sqrt(naturalMap2(r.data(), u.data(), 3, 0.5, 2.0)); };
  EXPECT_EQ(error({0, 0, 0}, {0.3, 0.4, 0.1}), 0);              // open
  EXPECT_EQ(error({0.1, 0.2, 1}, {0, 0, 0}), 0);                // stick
  EXPECT_LE(error({-0.3, -0.4, 1}, {0.6, 0.8, 0}), kRoundOff);  // slide: |r_T| = mu r_n against u_T
  EXPECT_GT(error({0, 0, 0}, {0, 0, -0.1}), 0.09);              // penetrates
  EXPECT_GT(error({0, 0, 1}, {0, 0, 0.1}), 0.05);               // pushes while it opens
  EXPECT_GT(error({0.3, 0.4, 1}, {0.6, 0.8, 0}), 0.5);          // friction drives
  EXPECT_GT(error({0.6, 0, 1}, {0, 0, 0}), 0.1);                // outside the cone
}

}  // namespace
}  // namespace pincer::engine
