#include "pincer/tasks/judge/bench/objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "pincer/contact/error.h"
#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_report.h"

namespace pincer::tasks {
namespace {

namespace fs = std::filesystem;
using contact::TriangleMesh;

constexpr double kHandSize = 0.08;  // [m]

TriangleMesh handSized(TriangleMesh mesh) {
  const contact::MeshReport report = contact::inspect(mesh);
  const double scale = kHandSize / (report.box_max - report.box_min).maxCoeff();
  const Vec3 middle = 0.5 * (report.box_min + report.box_max);
  for (Vec3& v : mesh.vertices) v = scale * (v - middle);
  return mesh;
}

}  // namespace

const char* nameOf(ObjectKind kind) {
  switch (kind) {
    case ObjectKind::smooth:
      return "smooth";
    case ObjectKind::creased:
      return "creased";
    case ObjectKind::tight:
      return "tight";
  }
  return "";
}

std::vector<BenchObject> generatedObjects() {
  using enum ObjectKind;
  std::vector<BenchObject> objects;
  objects.push_back({"sphere-80", smooth, contact::icosphere(0.02, 1)});
  objects.push_back({"sphere-1280", smooth, contact::icosphere(0.02, 3)});
  objects.push_back({"uv-sphere", smooth, contact::uvSphere(0.02, 24, 48)});
  objects.push_back({"ellipsoid", smooth, contact::ellipsoid({0.03, 0.02, 0.015}, 10)});
  objects.push_back({"torus", smooth, contact::torus(0.03, 0.012, 48, 24), 0.018});
  objects.push_back({"rounded-cube", smooth, contact::roundedCube(0.02, 0.004, 4)});
  objects.push_back({"bumpy-sphere", smooth, contact::bumpySphere(0.03, 0.02, 4, 20), 0.06});
  objects.push_back({"cylinder-15deg", creased, contact::cylinder(0.025, 0.03, 24, 6)});
  objects.push_back({"cylinder-with-flat", creased, contact::cylinderWithFlat(0.025, 0.03, 0.018, 18, 6)});
  objects.push_back({"box", creased, contact::box({0.02, 0.015, 0.03})});
  objects.push_back({"thin-plate", creased, contact::gridBox({0.03, 0.02, 0.0005}, 12)});
  objects.push_back({"noisy-sphere", tight, contact::noisy(contact::geodesicSphere(0.03, 12), 5e-5, 1)});
  objects.push_back({"hilly-sphere", tight, contact::bumpySphere(0.03, 0.06, 9, 24), 0.004});
  objects.push_back({"tight-torus", tight, contact::torus(0.02, 0.015, 48, 32), 0.005});
  objects.push_back({"groove-90deg", tight, contact::grooveBlock(M_PI / 4, 0.012, 0.03, 0.03), 0});
  return objects;
}

std::vector<MeshFile> meshFilesIn(const std::string& directory) {
  std::vector<MeshFile> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    const std::string extension = entry.path().extension();
    if (extension == ".obj" || extension == ".stl" || extension == ".ply" || extension == ".off")
      files.push_back({entry.path().stem().string(), entry.path().string()});
  }
  if (error || files.empty())
    throw InputError(
        fmt::format("--meshes {}: there is no mesh file (.obj, .stl, .ply, .off) in this directory.", directory));
  std::sort(files.begin(), files.end(), [](const MeshFile& a, const MeshFile& b) { return a.path < b.path; });
  return files;
}

std::vector<Record> measureFile(const MeshFile& file, const std::function<std::vector<Record>(BenchObject)>& measure) {
  try {
    TriangleMesh mesh = handSized(contact::readMesh(file.path));
    contact::requireManifold(mesh);
    return measure({file.name, ObjectKind::tight, std::move(mesh), 0});
  } catch (const InputError& refusal) {
    // the rest is `pincer mesh info`'s to tell
    const std::string reason = std::string(refusal.what()).substr(file.path.size() + 1);
    return {unbounded("refused:" + reason.substr(0, reason.find_first_of(",.;(")), 1, "-")};
  }
}

}  // namespace pincer::tasks
