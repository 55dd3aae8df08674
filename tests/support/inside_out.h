// inside_out: a mesh whose faces look the other way.
#pragma once
#include <utility>

#include "pincer/contact/triangle_mesh.h"

namespace pincer::tests {

inline contact::TriangleMesh insideOut(contact::TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  return mesh;
}

}  // namespace pincer::tests
