// Meshes that are bad in ways which look sound: what reading, repair and contact make of them. Counts, of which one is
// too many.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "pincer/contact/error.h"
#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_repair.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/remesh/simplify.h"
#include "pincer/tasks/judge/bench/contact_bench.h"
#include "pincer/tasks/judge/bench/finger_path.h"

namespace pincer::tasks {
namespace {

using contact::SmoothMesh;
using contact::TriangleMesh;

constexpr double kDefectBall = 0.02;  // radius [m]

// A ball whose corners have normals of their own, each in any direction at all.
TriangleMesh ballWithRandomNormals(std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh = contact::icosphere(kDefectBall, 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto first = static_cast<std::int32_t>(mesh.normals.size());
    for (int i = 0; i < 3; ++i) mesh.normals.push_back(randomDirection(random));
    mesh.triangle_normals.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

// One normal per vertex, every n-th reversed: averages of facets that face both ways.
TriangleMesh ballWithReversedNormals(std::size_t every) {
  TriangleMesh mesh = contact::icosphere(kDefectBall, 2);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    mesh.normals.emplace_back((i % every == 0 ? -1 : 1) * mesh.vertices[i].normalized());
  mesh.triangle_normals = mesh.triangles;
  return mesh;
}

double contactsNotFinite(const TriangleMesh& mesh) {
  constexpr int kQueries = 5000;
  const auto surface = SmoothMesh::build(mesh);
  Random random(5);
  BenchFinger finger;
  int count = 0;
  for (int i = 0; i < kQueries; ++i) {
    finger.tracker = {};
    const contact::SurfaceContact c =
        finger.on(*surface, (kDefectBall + 0.9 * kBenchFinger) * randomDirection(random)).main();
    count += !(c.p_BS.allFinite() && std::abs(c.n_B.norm() - 1) < 1e-9 && std::isfinite(c.phi));
  }
  return count;
}

std::vector<Record> opposingNormals(MeasureContext&) {
  double at_random = 0, reversed = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) at_random += contactsNotFinite(ballWithRandomNormals(seed));
  for (const std::size_t every : {1, 2, 3, 7}) reversed += contactsNotFinite(ballWithReversedNormals(every));
  return {exactly("at random: contacts of 20,000 that aren't finite", at_random, "-", 0),
          exactly("reversed: contacts of 20,000 that aren't finite", reversed, "-", 0)};
}

bool isRefused(const TriangleMesh& mesh) {
  try {
    SmoothMesh::build(mesh);
  } catch (const InputError&) {
    return true;
  }
  return false;
}

std::vector<Record> notFinite(MeasureContext&) {
  int taken = 0;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (std::size_t i = 0; i < 12; ++i) {
      TriangleMesh mesh = contact::icosphere(kDefectBall, 0);
      mesh.vertices[i][static_cast<int>(i % 3)] = bad;
      taken += !isRefused(mesh);
    }
  }
  return {exactly("meshes with such a vertex, of 24, that are taken", taken, "-", 0)};
}

// The upper side of a block.
TriangleMesh flatSheet(int cells) {
  constexpr double kUp = 0.005;  // [m]
  TriangleMesh sheet = contact::gridBox(Vec3(0.02, 0.02, kUp), cells);
  std::erase_if(sheet.triangles, [&](const auto& t) {
    return std::any_of(t.begin(), t.end(),
                       [&](std::int32_t v) { return sheet.vertices[static_cast<std::size_t>(v)].z() < kUp - 1e-9; });
  });
  return sheet;
}

std::vector<Record> filledHoles(MeasureContext&) {
  int added = 0, called_fit = 0;
  for (const int cells : {1, 2, 4, 10}) {
    const TriangleMesh sheet = flatSheet(cells);
    const TriangleMesh filled = contact::repair(sheet, {.fill_holes = 100}).mesh;
    added += static_cast<int>(filled.triangles.size()) - static_cast<int>(sheet.triangles.size());
    called_fit += contact::inspect(filled).isFit();
  }
  int doubled = 0;
  for (const int level : {0, 1, 2}) {
    TriangleMesh ball = contact::icosphere(kDefectBall, level);
    ball.triangles.erase(ball.triangles.begin());
    const TriangleMesh filled = contact::repair(ball, {.fill_holes = 3}).mesh;
    doubled += filled.triangles.size() != ball.triangles.size() + 1 || !contact::inspect(filled).isFit();
  }
  return {exactly("flat sheets: triangles added by filling", added, "-", 0),
          exactly("flat sheets called fit", called_fit, "-", 0),
          exactly("balls of which one triangle was missing, of 3, not closed by it alone", doubled, "-", 0)};
}

std::vector<Record> readInPart(MeasureContext&) {
  int named = 0;
  contact::ReadOptions options{.degenerate = contact::Degenerate::keep};
  options.left_out = [&](const std::string&) { ++named; };
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 9\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const auto read = contact::parseMesh(obj, contact::MeshFormat::obj, "one bad polygon", options).triangles.size();
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n6 0 1 2 3 4 5\n";
  const auto strip = contact::parseMesh(ply, contact::MeshFormat::ply, "strip").triangles.size();
  return {exactly("polygons read beside a bad one, of 4", static_cast<double>(read), "-", 4),
          exactly("bad ones named", named, "-", 1),
          exactly("triangles read of a strip of 6", static_cast<double>(strip), "-", 4)};
}

// A scan of 18,000 triangles becomes a part by one command.
std::vector<Record> simplifiedScan(MeasureContext&) {
  constexpr double kNoise = 1e-5, kAllowed = 5e-5;  // [m]
  const TriangleMesh scan = contact::noisy(contact::bumpySphere(kDefectBall, 0.1, 4, 30), kNoise, 4);
  const contact::SimplifiedMesh part = contact::simplify(scan, {.error = kAllowed});
  return {unbounded("triangles before", static_cast<double>(scan.triangles.size()), "-"),
          atMost("triangles after", static_cast<double>(part.mesh.triangles.size()), "-", 2000),
          atMost("felt error, 50 um allowed", 1e6 * part.error, "um", 1e6 * kAllowed),
          exactly("findings that make it unfit", !contact::inspect(part.mesh).isFit(), "-", 0)};
}

}  // namespace

std::vector<Measurement> meshDefectMeasurements() {
  return {{"mesh/opposing-normals", opposingNormals},
          {"mesh/not-finite", notFinite},
          {"mesh/filled-holes", filledHoles},
          {"mesh/bad-polygons-and-strips", readInPart},
          {"mesh/simplified-scan", simplifiedScan}};
}

}  // namespace pincer::tasks
