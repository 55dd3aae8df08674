// How fast a contact runs over meshes of few rows, as CAD programs and lathes write them: minimum and maximum of its
// speed over the true one, once around. One row ran at .88 to 1.16, beside a crease two rows at .72 to 1.65.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/generated_meshes.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/touch.h"

namespace pincer::contact {
namespace {

struct Evenness {
  double slowest = 1e9, fastest = 0;  // over the true speed [-]
  double depth_error = 0;             // [m]
};

// A finger on the round surface of radius `rho` [m] about the z axis, its centre at latitude
// `slope` [rad] over the place at height z.
Evenness runAround(const TriangleMesh& mesh, double rho, double z, double slope, double from, double to) {
  constexpr double kDepth = 1.5e-3;
  constexpr int kSteps = 5000;
  const auto surface = SmoothMesh::build(mesh);
  const double h = tests::kFinger - kDepth, step = rho * (to - from) / kSteps;
  SurfaceTracker tracker;
  Evenness run;
  Vec3 last = Vec3::Zero();
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = from + (to - from) * i / kSteps, reach = rho + h * std::cos(slope);
    const Vec3 C(reach * std::cos(angle), reach * std::sin(angle), z + h * std::sin(slope));
    const SurfaceContact c = touch(*surface, C, tests::kFinger, tracker);
    run.depth_error = std::max(run.depth_error, std::abs(c.phi + kDepth));
    if (i > 0) {
      run.slowest = std::min(run.slowest, (c.p_BS - last).norm() / step);
      run.fastest = std::max(run.fastest, (c.p_BS - last).norm() / step);
    }
    last = c.p_BS;
  }
  return run;
}

void expectEven(const Evenness& run, double speed, double depth, const std::string& what) {
  EXPECT_GT(run.slowest, 1 - speed) << what;
  EXPECT_LT(run.fastest, 1 + speed) << what;
  EXPECT_LT(run.depth_error, depth) << what;
}

TEST(SurfaceRows, CylindersOfOneRowRunAsEvenlyAsOfMany) {
  for (const int rows : {1, 2, 8}) {
    for (const double z : {0.0, 0.02, 0.029}) {
      const std::string what = std::to_string(rows) + " rows at " + std::to_string(z);
      expectEven(runAround(cylinder(0.025, 0.03, 24, rows), 0.025, z, 0, 0, 2 * M_PI), 2e-3, 0.5e-6, what);
      expectEven(runAround(cylinder(0.025, 0.03, 50, rows), 0.025, z, 0, 0, 2 * M_PI), 1e-3, 0.05e-6, what);
    }
  }
}

TEST(SurfaceRows, ACornerOfCreaseAndRimDoesNotTurnTheNormalsBesideIt) {
  const double first = std::acos(0.015 / 0.025) + 1e-3;  // from the flat's one crease to the other
  for (const int rows : {1, 2, 8}) {
    for (const double z : {0.0, 0.02, 0.029}) {
      const Evenness run =
          runAround(cylinderWithFlat(0.025, 0.03, 0.015, 48, rows), 0.025, z, 0, first, 2 * M_PI - first);
      expectEven(run, 1e-3, 0.05e-6, std::to_string(rows) + " rows at " + std::to_string(z));
    }
  }
}

TEST(SurfaceRows, DiagonalsOfABallAlongParallelsAreNotFelt) {
  for (const double latitude : {0.1, 0.3, 0.6, 0.9, 1.2}) {
    const Evenness run =
        runAround(uvSphere(0.02, 12, 24), 0.02 * std::cos(latitude), 0.02 * std::sin(latitude), latitude, 0, 2 * M_PI);
    expectEven(run, 2e-3, 1e-6, std::to_string(latitude));
  }
}

}  // namespace
}  // namespace pincer::contact
