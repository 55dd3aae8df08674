#include "pincer/contact/remesh/simplify.h"

#include <gtest/gtest.h>

#include <random>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/touch.h"

namespace pincer::contact {
namespace {

// How far the smooth surface is from the ball that both meshes stand for, at
// random places: an oracle that knows no probe.
double greatestErrorOfBall(const TriangleMesh& mesh, double radius) {
  const auto surface = SmoothMesh::build(mesh);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double greatest = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
    SurfaceTracker tracker;
    greatest = std::max(greatest, std::abs(touch(*surface, (radius + 0.003) * direction, 0.003, tracker).phi));
  }
  return greatest;
}

TEST(MeshSimplify, KeepsTheSmoothBallToTheErrorThatIsAllowed) {
  const double radius = 0.02;
  const TriangleMesh fine = icosphere(radius, 4);
  std::size_t before = fine.triangles.size();
  for (const double error : {2e-6, 20e-6, 100e-6}) {
    const SimplifiedMesh simple = simplify(fine, {.error = error});
    EXPECT_LE(simple.error, error);
    EXPECT_LE(greatestErrorOfBall(simple.mesh, radius), 1.5 * error) << "between the input's vertices too";
    EXPECT_TRUE(inspect(simple.mesh).isFit());
    EXPECT_LT(simple.mesh.triangles.size(), before) << "of " << before;
    before = simple.mesh.triangles.size();
    RecordProperty("triangles_" + std::to_string(static_cast<int>(1e6 * error)), static_cast<int>(before));
  }
  EXPECT_LT(before, 400u) << "an even mesh needs 80 to 320 for 45 to 3 um";
}

// Planes cost nothing, and creases are kept: all that is left of a cube of 2400 triangles is its 12.
TEST(MeshSimplify, ACubeOfManyTrianglesIsTwelveAgain) {
  const SimplifiedMesh simple = simplify(gridBox(Vec3(0.02, 0.03, 0.01), 20), {.error = 1e-6});
  EXPECT_EQ(simple.mesh.triangles.size(), 12u);
  const MeshReport report = inspect(simple.mesh);
  EXPECT_EQ(report.crease_edges, 12);
  EXPECT_NEAR(report.volume, 8 * 0.02 * 0.03 * 0.01, 1e-15);
}

TEST(MeshSimplify, KeepsRimsAndCreasesOfACylinderWithFlat) {
  const TriangleMesh fine = cylinderWithFlat(0.02, 0.03, 0.012, 120, 40);
  const SimplifiedMesh simple = simplify(fine, {.error = 20e-6});
  EXPECT_LT(simple.mesh.triangles.size(), fine.triangles.size() / 8);
  const MeshReport before = inspect(fine), after = inspect(simple.mesh);
  EXPECT_TRUE(after.isFit());
  // the facets cut off more than the surface that they stand for
  const MeshReport smooth = inspect(subdivide(subdivide(simple.mesh)));
  EXPECT_NEAR(smooth.volume, before.volume, 3e-3 * before.volume);
  EXPECT_EQ(after.box_max.z(), before.box_max.z());
  EXPECT_LE(after.crease_edges, before.crease_edges);
  for (const Vec3& v : simple.mesh.vertices)
    EXPECT_NEAR(std::min(0.012 - v.x(), 0.02 - v.head<2>().norm()) * (0.03 - std::abs(v.z())), 0, 1e-4);
}

TEST(MeshSimplify, StopsAtTheNumberOfTrianglesAskedFor) {
  for (const int n : {4000, 1000, 300}) {
    for (const TriangleMesh& mesh : {bumpySphere(0.02, 0.1, 4, 30), torus(0.03, 0.01, 120, 60)}) {
      const SimplifiedMesh simple = simplify(mesh, {.triangles = n});
      EXPECT_LE(static_cast<int>(simple.mesh.triangles.size()), n);
      EXPECT_GE(static_cast<int>(simple.mesh.triangles.size()), n - 2);
      EXPECT_TRUE(inspect(simple.mesh).isFit());
    }
  }
}

TEST(MeshSimplify, AnOpenBorderStaysWhereItIs) {
  TriangleMesh open = gridBox(Vec3(0.02, 0.02, 0.02), 12);
  std::erase_if(open.triangles, [&](const auto& t) {
    return open.vertices[static_cast<std::size_t>(t[0])].z() > 0.02 - 1e-9 &&
           open.vertices[static_cast<std::size_t>(t[1])].z() > 0.02 - 1e-9 &&
           open.vertices[static_cast<std::size_t>(t[2])].z() > 0.02 - 1e-9;
  });
  const SimplifiedMesh simple = simplify(open, {.error = 1e-6});
  EXPECT_EQ(simple.mesh.triangles.size(), 10u);
  EXPECT_EQ(inspect(simple.mesh).boundary_edges, 4);
  EXPECT_NEAR(inspect(simple.mesh).area, 5 * 0.04 * 0.04, 1e-12);
}

// Single places along creases that curve were off by up to 90 times what was allowed, in hollows and noise by 7 times.
TEST(MeshSimplify, NoPlaceIsOffByMoreThanIsAllowed) {
  for (const double error : {5e-6, 100e-6}) {
    for (const TriangleMesh& mesh :
         {cylinderWithFlat(0.02, 0.03, 0.012, 120, 20), noisy(bumpySphere(0.02, 0.1, 4, 20), 1e-5, 4),
          noisy(grooveBlock(M_PI / 3, 0.01, 0.04, 0.04), 2e-5, 2), torus(0.03, 0.01, 80, 40)}) {
      const SimplifiedMesh simple = simplify(mesh, {.error = error});
      EXPECT_LE(simple.error, error) << mesh.source;
      EXPECT_LE(simple.mesh.triangles.size(), mesh.triangles.size());
    }
  }
}

// Normals that were written of a surface that folds over itself moved it by more than 0.5 mm, with all triangles left.
TEST(MeshSimplify, WhatCannotBeMadeSimplerComesOutAsItWentIn) {
  const TriangleMesh coarse = torus(0.03, 0.012, 12, 8);
  const SimplifiedMesh simple = simplify(coarse, {.error = 1e-6});
  EXPECT_EQ(simple.mesh.vertices, coarse.vertices);
  EXPECT_EQ(simple.mesh.triangles, coarse.triangles);
  EXPECT_TRUE(simple.mesh.triangle_normals.empty());
  EXPECT_EQ(simple.error, 0);
  const SimplifiedMesh asked = simplify(coarse, {.error = 1e-6, .crease_angle = 0.1});
  EXPECT_FALSE(asked.mesh.triangle_normals.empty()) << "a file has no room for another crease angle";
}

TEST(MeshSimplify, GivesTheSameBitsEachTime) {
  const TriangleMesh mesh = noisy(bumpySphere(0.02, 0.1, 4, 20), 1e-5, 4);
  const SimplifiedMesh a = simplify(mesh, {.error = 50e-6}), b = simplify(mesh, {.error = 50e-6});
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.error, b.error);
}

TEST(MeshSimplify, RefusesOptionsOutOfRangeAndMeshesThatBranch) {
  EXPECT_NE(tests::errorOf([] { simplify(icosphere(0.02, 1), {}); }).find("simplify to what?"), std::string::npos);
  EXPECT_THROW(simplify(icosphere(0.02, 1), {.triangles = -1}), InputError);
  EXPECT_THROW(simplify(icosphere(0.02, 1), {.error = std::nan("")}), InputError);
  TriangleMesh branching = icosphere(0.02, 0);
  branching.triangles.push_back({branching.triangles[0][0], branching.triangles[0][1], branching.triangles[7][2]});
  EXPECT_THROW(simplify(branching, {.triangles = 10}), InputError);
}

// New vertices lie on the smooth surface, and what was sharp stays so.
TEST(MeshSubdivide, PutsNewVerticesOnTheSmoothSurface) {
  const TriangleMesh ball = subdivide(subdivide(icosphere(0.02, 2)));
  EXPECT_EQ(ball.triangles.size(), 16u * 320u);
  for (const Vec3& v : ball.vertices) EXPECT_NEAR(v.norm(), 0.02, 4e-6) << "as far as 320 triangles stand for a ball";
  EXPECT_TRUE(inspect(ball).isFit());
  const TriangleMesh cube = subdivide(box(Vec3::Constant(0.02)));
  EXPECT_EQ(inspect(cube).crease_edges, 24);
  EXPECT_NEAR(inspect(cube).volume, 64e-6, 1e-18);
}

}  // namespace
}  // namespace pincer::contact
