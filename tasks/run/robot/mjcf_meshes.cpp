// asset: meshes from files, or written out in the model.
#include <fmt/format.h>

#include <filesystem>

#include "pincer/tasks/run/robot/mjcf_parts.h"
#include "pincer/tasks/run/robot/model_mesh.h"

namespace pincer::tasks::mjcf {
namespace {

constexpr std::size_t kMostInlineNumbers = 3000000;  // of one mesh that is written out

contact::TriangleMesh readInline(const Values& values) {
  contact::TriangleMesh mesh;
  const std::vector<double> numbers = values.numbers("vertex", 12, kMostInlineNumbers);
  if (numbers.size() % 3 != 0) values.reject("vertex", "isn't made of threes: x y z of each corner.");
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    mesh.vertices.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  if (!values.has("face")) return mesh;  // its hull is meant
  const std::vector<double> faces = values.numbers("face", 3, kMostInlineNumbers);
  if (faces.size() % 3 != 0) values.reject("face", "isn't made of threes: the corners of each triangle.");
  for (std::size_t i = 0; i + 2 < faces.size(); i += 3) {
    auto& triangle = mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const double index = faces[i + k];
      if (!(index >= 0 && index < static_cast<double>(mesh.vertices.size())))
        values.reject("face", fmt::format("names corner {}, and there are {}.", index, mesh.vertices.size()));
      triangle[k] = static_cast<std::int32_t>(index);
    }
  }
  return mesh;
}

// Of the file's corners to those that geoms have: moved, turned and scaled.
void place(const Values& values, contact::TriangleMesh& mesh) {
  const Vec3 reference = values.vector("refpos", Vec3::Zero()), scale = values.vector("scale", Vec3::Ones());
  const std::vector<double> turn = values.numbers("refquat", 4, 4);
  const Quat back = turn.empty() ? Quat::Identity() : Quat(turn[0], turn[1], turn[2], turn[3]).normalized().conjugate();
  if (!(scale.cwiseAbs().minCoeff() > 0)) values.reject("scale", "flattens the mesh: no factor may be 0.");
  for (Vec3& v : mesh.vertices) v = back * (v - reference);
  scaleMesh(scale, mesh);
}

RobotMesh readMeshElement(const Reading& reading, const XmlElement& element) {
  const Values values(reading.document, element, "mesh", 0);
  RobotMesh mesh;
  mesh.place = element.place();
  std::string file = values.text("file");
  mesh.name = values.text("name", std::filesystem::path(file).stem().string());
  if (mesh.name.empty()) element.reject("needs a name, or a file to be named after.");
  if (reading.compiler().strip_path) file = std::filesystem::path(file).filename().string();
  if (!file.empty()) mesh.file = reading.document.folder.find(element, reading.compiler().mesh_folder, file);
  mesh.triangles = file.empty() ? readInline(values) : readModelMesh(element, mesh.file);
  mesh.triangles.source = file.empty() ? element.place() : mesh.file;
  place(values, mesh.triangles);
  constexpr std::string_view kWords[] = {"convex", "legacy", "exact", "shell"};  // by MeshInertia
  mesh.inertia = static_cast<MeshInertia>(values.oneOf("inertia", kWords, static_cast<int>(MeshInertia::kLegacy)));
  return mesh;
}

}  // namespace

void readMeshes(Reading& reading) {
  for (const XmlElement* section : sections(reading.document, "asset")) {
    for (const XmlElement& element : section->children) {
      if (element.tag != "mesh") continue;
      RobotMesh mesh = readMeshElement(reading, element);
      const auto [at, is_new] = reading.meshes.emplace(mesh.name, static_cast<int>(reading.robot.meshes.size()));
      if (!is_new) element.reject(fmt::format("is the second mesh called \"{}\".", mesh.name));
      reading.robot.meshes.push_back(std::move(mesh));
    }
  }
}

}  // namespace pincer::tasks::mjcf
