// objects: the meshes that `pincer bench contact` touches: generated ones whose true surface is known, and files.
#pragma once
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "pincer/contact/triangle_mesh.h"
#include "pincer/tasks/run/measure/record.h"

namespace pincer::tasks {

enum class ObjectKind {
  smooth,   // no edge, and the finger fits everywhere
  creased,  // sharp edges, rims, corners
  tight,    // hollows that are tighter than the finger, or nearly so
};

struct BenchObject {
  std::string name;  // "torus"
  ObjectKind kind;
  contact::TriangleMesh mesh;
  double concave_radius = std::numeric_limits<double>::infinity();  // of the true surface's tightest hollow [m]
};

std::vector<BenchObject> generatedObjects();

struct MeshFile {
  std::string name, path;
};

// In alphabetical order. Throws InputError where there is none.
std::vector<MeshFile> meshFilesIn(const std::string& directory);

// Measures the mesh of a file, scaled to 80 mm and centred, for files don't tell their units; nothing is known of its
// hollows, so it counts as `tight`. A file that can't be touched gives a single record that says why.
std::vector<Record> measureFile(const MeshFile& file, const std::function<std::vector<Record>(BenchObject)>& measure);

const char* nameOf(ObjectKind kind);

}  // namespace pincer::tasks
