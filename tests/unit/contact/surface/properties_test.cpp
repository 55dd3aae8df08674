// Properties that must stay the same when the question is asked in another way.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::contact {
namespace {

using tests::kFinger;
using tests::RandomNumbers;

// [m] two solutions of 1e-9 m each, magnified where the surface's curvature is near the finger's
constexpr double kSolved = 1e-8;

std::vector<TriangleMesh> objects() {
  return {icosphere(0.02, 2), torus(0.03, 0.012, 24, 12), cylinderWithFlat(0.025, 0.03, 0.018, 18, 4),
          box({0.02, 0.015, 0.03}), bumpySphere(0.03, 0.02, 4, 8)};
}

// A finger's way in and around an object of bounding radius R, pressing 0 to 3 mm, never beyond the surface.
std::vector<Vec3> wayOver(const SmoothMesh& object, int ticks, std::uint64_t seed) {
  RandomNumbers random(seed);
  PatchCache cache;
  SurfaceTracker tracker;
  std::vector<Vec3> way;
  Vec3 C(1.5 * object.boundingRadius(), 0.001, 0.002), heading(0.1, 1, 0.3);
  C = object.querySphere(C, kFinger, 0, tracker, cache).main().p_BS + 0.008 * Vec3::UnitX();
  for (int i = 0; i < ticks; ++i) {
    const SurfaceContact c = object.querySphere(C, kFinger, 0, tracker, cache).main();
    way.push_back(C);
    heading += 0.03 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    heading = (heading - heading.dot(c.n_B) * c.n_B).normalized();
    C += 1e-4 * heading + std::clamp(-0.0015 * (1 - std::cos(0.01 * i)) - c.phi, -5e-5, 5e-5) * c.n_B;
  }
  return way;
}

std::vector<SurfaceContact> answersAlong(const SmoothMesh& object, const std::vector<Vec3>& way, double r = kFinger) {
  PatchCache cache;
  SurfaceTracker tracker;
  std::vector<SurfaceContact> answers;
  for (const Vec3& C : way) answers.push_back(object.querySphere(C, r, 0, tracker, cache).main());
  return answers;
}

void expectSame(const SurfaceContact& a, const SurfaceContact& b, double tolerance, const std::string& where) {
  EXPECT_LT((a.p_BS - b.p_BS).norm(), tolerance) << where;
  EXPECT_LT((a.n_B - b.n_B).norm(), tolerance / 0.002) << where;  // the centre is 2 mm or more from the surface
  EXPECT_LT(std::abs(a.phi - b.phi), tolerance) << where;
}

TEST(SurfaceProperties, TurningTheWorldTurnsTheAnswer) {
  const Pose X{quatFromRotationVector({0.7, -1.1, 0.4}), {0.05, -0.02, 0.11}};
  for (const TriangleMesh& mesh : objects()) {
    const auto object = SmoothMesh::build(mesh), turned = SmoothMesh::build(transformed(mesh, X));
    const std::vector<Vec3> way = wayOver(*object, 400, 1);
    std::vector<Vec3> turned_way;
    for (const Vec3& C : way) turned_way.push_back(X * C);
    const auto a = answersAlong(*object, way), b = answersAlong(*turned, turned_way);
    for (std::size_t i = 0; i < a.size(); ++i) {
      const SurfaceContact back{X.inverse() * b[i].p_BS, X.q.conjugate() * b[i].n_B, b[i].phi};
      expectSame(a[i], back, kSolved, mesh.source + ' ' + std::to_string(i));
    }
  }
}

// The solver stops at 1e-9 m: on an object of 20 um that is 5e-5 of it.
TEST(SurfaceProperties, ScaleChangesNothingButTheScale) {
  for (const double scale : {1e-3, 0.1, 10.0, 1e3}) {
    for (const TriangleMesh& mesh : objects()) {
      const auto object = SmoothMesh::build(mesh), scaled = SmoothMesh::build(transformed(mesh, Pose{}, scale));
      std::vector<Vec3> way = wayOver(*object, 200, 2);
      const auto a = answersAlong(*object, way);
      for (Vec3& C : way) C *= scale;
      const auto b = answersAlong(*scaled, way, scale * kFinger);
      for (std::size_t i = 0; i < a.size(); ++i) {
        const SurfaceContact back{b[i].p_BS / scale, b[i].n_B, b[i].phi / scale};
        expectSame(a[i], back, kSolved / std::min(scale, 1.0),
                   mesh.source + " x" + std::to_string(scale) + ' ' + std::to_string(i));
      }
    }
  }
}

TEST(SurfaceProperties, TheOrderOfTrianglesDoesNotMatter) {
  for (const TriangleMesh& mesh : objects()) {
    TriangleMesh shuffled = mesh;
    RandomNumbers random(5);
    for (std::size_t i = shuffled.triangles.size() - 1; i > 0; --i) {
      std::swap(shuffled.triangles[i],
                shuffled.triangles[static_cast<std::size_t>(random.below(static_cast<int>(i) + 1))]);
    }
    for (auto& t : shuffled.triangles) std::rotate(t.begin(), t.begin() + random.below(3), t.end());
    const auto object = SmoothMesh::build(mesh), other = SmoothMesh::build(shuffled);
    const std::vector<Vec3> way = wayOver(*object, 400, 3);
    const auto a = answersAlong(*object, way), b = answersAlong(*other, way);
    for (std::size_t i = 0; i < a.size(); ++i) expectSame(a[i], b[i], kSolved, mesh.source + ' ' + std::to_string(i));
  }
}

// Where the finger fits, the contact depends on where it is, not on how it came there.
TEST(SurfaceProperties, TheWayBackGivesTheSameAnswers) {
  for (const TriangleMesh& mesh : objects()) {
    const auto object = SmoothMesh::build(mesh);
    std::vector<Vec3> way = wayOver(*object, 400, 4);
    const std::size_t n = way.size();
    for (std::size_t i = n; i-- > 0;) way.push_back(way[i]);
    const auto answers = answersAlong(*object, way);
    for (std::size_t i = 0; i < n; ++i)
      expectSame(answers[i], answers[2 * n - 1 - i], kSolved, mesh.source + ' ' + std::to_string(i));
  }
}

// Work done on the finger along a closed way of its centre by the force f = k depth n.
//
//   C = S + h N:  dh = N . dC - N . dS,  so  W = k loop-integral of depth N . dC = k loop-integral of depth N . dS
//
// (the part in dh integrates to zero). N . dS is zero where the shading normal is the surface's own: on the true shape,
// and on creases and flats. On a coarse mesh it isn't, and a closed way may gain that much: the field is conservative
// only as far as the shading normal is normal.
struct Loop {
  double work = 0;   // [J] with k = 1000 N/m
  double moved = 0;  // loop-integral of |f| |dC| [J]
};
Loop workAround(const SmoothMesh& object, const Vec3& middle, const Vec3& e1, const Vec3& e2, int steps) {
  PatchCache cache;
  SurfaceTracker tracker;
  Loop loop;
  const auto at = [&](int i) -> Vec3 {
    const double a = 2 * M_PI * i / steps;
    return middle + std::cos(a) * e1 + std::sin(a) * e2;
  };
  const auto force = [&](const Vec3& C) -> Vec3 {
    const SurfaceContact c = object.querySphere(C, kFinger, 0, tracker, cache).main();
    return 1000 * std::max(-c.phi, 0.0) * c.n_B;
  };
  Vec3 before = force(at(0));
  for (int i = 1; i <= steps; ++i) {
    const Vec3 now = force(at(i)), dC = at(i) - at(i - 1);
    loop.work += 0.5 * (before + now).dot(dC);  // trapezoids: the error dies with the square of the step
    loop.moved += 0.5 * (before.norm() + now.norm()) * dC.norm();
    before = now;
  }
  return loop;
}

struct LoopCase {
  TriangleMesh mesh;
  Vec3 middle, e1, e2;
  double bound;  // of |W| / loop-integral |f| |dC|
};

TEST(SurfaceProperties, ClosedLoopsGainNoEnergy) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const std::vector<LoopCase> cases = {
      {box({0.02, 0.015, 0.03}),
       {0.024, 0.0, 0.034},
       0.003 * x + 0.002 * y,
       0.003 * z,
       1e-6},  // over an edge: exact but for the trapezoids
      {cylinderWithFlat(0.025, 0.03, 0.018, 18, 4), {0, 0, 0.003}, 0.0315 * x, 0.0315 * y, 1e-3},
      {icosphere(0.02, 1), {0.003, 0.006, 0.0257}, 0.004 * x, 0.003 * y + 0.0005 * z, 2e-3},
      {icosphere(0.02, 3), {0.003, 0.006, 0.0257}, 0.004 * x, 0.003 * y + 0.0005 * z, 1e-4},
      {torus(0.03, 0.012, 24, 12), {0.03, 0, 0.0185}, 0.005 * x, 0.005 * y, 2e-3},
  };
  for (const LoopCase& c : cases) {
    const Loop loop = workAround(*SmoothMesh::build(c.mesh), c.middle, c.e1, c.e2, 4000);
    EXPECT_GT(loop.moved, 1e-6) << c.mesh.source << ": the loop must touch";
    EXPECT_LT(std::abs(loop.work) / loop.moved, c.bound) << c.mesh.source;
  }
}

}  // namespace
}  // namespace pincer::contact
