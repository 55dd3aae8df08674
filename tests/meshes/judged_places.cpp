// All places of meshes in files judged by brute force (tests/support/place_judge.h): a table for docs/accuracy.md.
//
//     cmake --build build --target judged_places
//     build/judged_places QUERIES MESH...
//
// Each mesh, mended as `mesh convert --repair` does, is brought to 80 mm. A finger of 8 mm wanders over it, 60 times
// with each kind of step, QUERIES judged in all.
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_repair.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/tests/support/place_judge.h"

namespace pincer {
namespace {

constexpr double kSize = 0.08, kFinger = 0.008, kMargin = 0.001;  // [m]
constexpr int kWalks = 60;

contact::TriangleMesh handSized(contact::TriangleMesh mesh) {
  const contact::MeshReport report = contact::inspect(mesh);
  const double scale = kSize / (report.box_max - report.box_min).maxCoeff();
  for (Vec3& v : mesh.vertices) v = scale * (v - 0.5 * (report.box_min + report.box_max));
  return mesh;
}

struct Kind {
  const char* name;
  double step, depth;  // [m]
};
constexpr Kind kKinds[] = {{"led, 20 um", 2e-5, 0}, {"led, 200 um", 2e-4, 0}, {"pressed 1 mm, 100 um", 1e-4, 1e-3}};

void judgeFile(const std::filesystem::path& file, int queries) {
  tests::PlaceJudge judge(handSized(contact::repair(contact::readMesh(file)).mesh));
  for (const Kind& kind : kKinds) {
    const tests::LedFinger finger{kFinger, kMargin, kind.step, kind.depth};
    tests::RandomNumbers random(1);
    tests::PlaceVerdicts v;
    for (int i = 0; i < kWalks; ++i)
      judge.wander(finger, judge.homeOver(kFinger + 0.0002, random), finger.each * queries / kWalks + 1, random, v);
    fmt::print("| {} | {} | {} | {} | {} | {} | {:.0f} um | {} | {:.1e} | {:.1e} |  {}\n", file.stem().string(),
               kind.name, v.judged, v.places, v.missed, v.felt, 1e6 * v.deepest, v.extra, v.off_place, v.off_gap,
               v.first);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace pincer

int main(int argc, char** argv) {
  if (argc < 3) return fmt::print(stderr, "judged_places QUERIES MESH...\n"), 2;
  fmt::print(
      "| mesh | finger | queries | places | missed | of those touched | deepest | extra | place off [m] | gap off [m] "
      "|\n");
  for (int i = 2; i < argc; ++i) pincer::judgeFile(argv[i], std::atoi(argv[1]));
}
