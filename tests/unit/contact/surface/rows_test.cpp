// How fast a contact runs over meshes of few rows, as CAD programs and lathes write them: minimum and maximum of its
// speed over the true one, once around. One row ran at .88 to 1.16, beside a crease two rows at .72 to 1.65, cones at
// .22 to 1.53 and, up to their tip, 2.9 mm too deep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh/edge_weights.h"
#include "pincer/contact/mesh/lathe.h"
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

// A cone of height 40 mm from 30 mm at its foot to `top`; to a tip if that is 0. [m]
TriangleMesh cone(double top, int segments, int rows) {
  std::vector<Vec2> profile = {{0, -0.02}};
  for (int k = 0; k <= rows; ++k) {
    const double share = static_cast<double>(k) / rows, rho = 0.03 + share * (top - 0.03);
    if (rho > 1e-12) profile.push_back({rho, -0.02 + 0.04 * share});
  }
  profile.push_back({0, 0.02});
  return lathe(profile, segments);
}

void expectEvenCone(const TriangleMesh& mesh, double top, int segments, const std::string& what) {
  const double part = 1.0 / (segments * segments);
  for (const double share : {0.2, 0.5, 0.8}) {
    const Evenness run =
        runAround(mesh, 0.03 + share * (top - 0.03), -0.02 + 0.04 * share, std::atan((0.03 - top) / 0.04), 0, 2 * M_PI);
    expectEven(run, 15 * part + 7.5e-3, 16e-3 * part, what + " at " + std::to_string(share));
  }
}

TEST(SurfaceRows, ConesOfAnySlopeRunEvenlyUpToTheirTip) {
  for (const double top : {0.029, 0.015, 0.005, 0.001, 0.0}) {
    for (const int segments : {12, 24, 48, 200}) {
      for (const int rows : {1, 2, 8}) {
        expectEvenCone(cone(top, segments, rows), top, segments,
                       std::to_string(top) + ", " + std::to_string(segments) + ", " + std::to_string(rows));
      }
    }
  }
}

// Cuts each quad of two triangles one after the other along its other diagonal, or every second.
TriangleMesh cutOtherwise(TriangleMesh mesh, bool all) {
  int quads = 0;
  for (std::size_t t = 0; t + 1 < mesh.triangles.size(); ++t) {
    auto &first = mesh.triangles[t], &second = mesh.triangles[t + 1];
    if (first[0] != second[0] || first[2] != second[1]) continue;
    const std::array<std::int32_t, 4> quad = {first[0], first[1], first[2], second[2]};
    if (all || quads % 2 == 0) {
      first = {quad[0], quad[1], quad[3]};
      second = {quad[1], quad[2], quad[3]};
    }
    ++quads;
    ++t;
  }
  return mesh;
}

TEST(SurfaceRows, HowTheQuadsOfAConeAreCutMakesNoDifference) {
  for (const bool all : {true, false}) {
    for (const int rows : {1, 2}) {
      expectEvenCone(cutOtherwise(cone(0.01, 48, rows), all), 0.01, 48, std::to_string(rows));
    }
  }
}

// A cone that bulges by 0.45 mm over its length has rulings, nearly: 69 um beside its place with even weights.
TEST(SurfaceRows, ASlightlyRoundConeRunsEvenlyBetweenItsRings) {
  constexpr double kRound = 1, kTilt = 0.35, kHalf = 0.03;  // [m], [rad], [rad]
  const auto rho = [](double angle) { return kRound * (std::cos(angle) - std::cos(kTilt)) + 0.022; };
  std::vector<Vec2> profile = {{0, kRound * std::sin(kTilt - kHalf)}};
  for (int k = -2; k <= 2; ++k) {
    const double angle = kTilt + kHalf * k / 2;
    profile.push_back({rho(angle), kRound * std::sin(angle)});
  }
  profile.push_back({0, kRound * std::sin(kTilt + kHalf)});
  const TriangleMesh mesh = lathe(profile, 48);
  for (const double share : {-0.7, -0.2, 0.4}) {
    const double angle = kTilt + kHalf * share;
    const Evenness run = runAround(mesh, rho(angle), kRound * std::sin(angle), angle, 0, 2 * M_PI);
    expectEven(run, 0.02, 3e-6, std::to_string(share));
  }
}

TEST(SurfaceRows, OnlyWhereRulingsMeetDoesANormalOutweighAnother) {
  for (const TriangleMesh& mesh : {icosphere(0.02, 2), uvSphere(0.02, 12, 24), cylinder(0.025, 0.03, 24, 2),
                                   torus(0.03, 0.012, 24, 24), roundedCube(0.02, 0.004, 3)}) {
    const Neighbours neighbours = findNeighbours(mesh);
    const EdgeWeights weights =
        findEdgeWeights(mesh, neighbours, findCornerNormals(mesh, neighbours, tests::kCreaseAngle, true));
    EXPECT_TRUE(weights.empty()) << mesh.source << ", " << mesh.triangles.size();
  }
}

// A body turned from sections of one row each; its rings lie on a circle of 60 mm, where it is felt.
TEST(SurfaceRows, ATurnedPartOfOneRowPerSectionRunsEvenlyOnItsRings) {
  constexpr double kRound = 0.06, kAxis = 0.035;  // [m]
  std::vector<Vec2> profile = {{0, kRound * std::sin(-0.5)}};
  for (int k = -5; k <= 5; ++k) profile.push_back({kRound * std::cos(0.1 * k) - kAxis, kRound * std::sin(0.1 * k)});
  profile.push_back({0, kRound * std::sin(0.5)});
  const TriangleMesh mesh = lathe(profile, 48);
  for (const double angle : {-0.3, 0.0, 0.2}) {
    const Evenness run =
        runAround(mesh, kRound * std::cos(angle) - kAxis, kRound * std::sin(angle), angle, 0, 2 * M_PI);
    expectEven(run, 5e-3, 2e-6, std::to_string(angle));
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
