// Sharp edges: the place that the finger's centre is over, however much the edge bends about it.
#include <gtest/gtest.h>

#include <filesystem>

#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/shell_edge.h"
#include "pincer/tests/support/constants.h"

namespace pincer::contact {
namespace {

// An arc of +-30 degrees and 10 mm radius about the origin, as a border.
SharpEdge arcOfBorder() {
  constexpr double kRadius = 0.01, kHalf = M_PI / 6;
  const double handle = 4.0 / 3 * std::tan(0.5 * kHalf);
  const auto at = [&](double a) -> Vec3 { return kRadius * Vec3(std::sin(a), -std::cos(a), 0); };
  const auto along = [&](double a) -> Vec3 { return kRadius * handle * Vec3(std::cos(a), std::sin(a), 0); };
  SharpEdge edge{{at(-kHalf), at(-kHalf) + along(-kHalf), at(kHalf) - along(kHalf), at(kHalf)}, {}, {}, true};
  edge.left = edge.right = {Vec3::UnitZ(), Vec3::UnitZ(), Vec3::UnitZ()};
  return edge;
}

double nearestOf(const SharpEdge& edge, const Vec3& C) {
  constexpr int kTried = 200000;
  double best = 0, least = kInfinity;
  for (int i = 0; i <= kTried; ++i) {
    const double s = static_cast<double>(i) / kTried, distance = (C - evaluate(edge, s).E).norm();
    if (distance >= least) continue;
    least = distance;
    best = s;
  }
  return best;
}

// Near the middle of the arc a step leads from either end past the other. It once went from end to end until its steps
// were used up, and the walk around it from edge to corner and back.
TEST(SurfaceEdges, AnEdgeThatLeadsInwardFromBothItsEndsIsSolvedBetweenThem) {
  const SharpEdge edge = arcOfBorder();
  for (const double aside : {-2e-4, 0.0, 1e-4}) {
    const Vec3 C(aside, -9e-4, 0.002);
    for (const double start : {0.0, 0.3, 1.0})
      EXPECT_NEAR(footOnEdge(edge, C, start).s, nearestOf(edge, C), 1e-5) << aside << ' ' << start;
  }
}

// On the bunny, 80 mm long, a finger that comes down beside a border of kinked patches: the walk went to and fro over
// their common edge, whose normals show a way in where the patch itself shows none.
TEST(SurfaceEdges, AFingerThatComesDownOnAKinkedPatchIsAnswered) {
  const auto file =
      std::filesystem::path(PINCER_SOURCE_DIR).parent_path() / "shared" / "data" / "meshes" / "stanford-bunny.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the shared meshes aren't beside this checkout";
  TriangleMesh bunny = readMesh(file);
  const MeshReport report = inspect(bunny);
  const double scale = 0.08 / (report.box_max - report.box_min).maxCoeff();
  for (Vec3& v : bunny.vertices) v = scale * (v - 0.5 * (report.box_min + report.box_max));
  const auto surface = SmoothMesh::build(bunny);
  SurfaceTracker tracker;
  PatchCache cache;
  const SurfaceContacts found =
      surface->querySphere({6.3654e-3, 37.1248e-3, -21.6650e-3}, tests::kFinger, tests::kMargin, tracker, cache);
  EXPECT_EQ(found.cost.held, 0);
  EXPECT_EQ(tracker.status, kQueryOk);
}

}  // namespace
}  // namespace pincer::contact
