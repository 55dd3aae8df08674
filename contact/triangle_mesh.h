// triangle_mesh: triangles as a file gives them, after validation: indices in range,
// coordinates finite, no degenerate triangle.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::contact {

struct TriangleMesh {
  std::vector<Vec3> vertices;                          // [m]
  std::vector<std::array<std::int32_t, 3>> triangles;  // vertex indices, counter-clockwise seen from outside
  std::vector<Vec3> normals;                           // unit normals as the file gave them; may be empty
  std::vector<std::array<std::int32_t, 3>>
      triangle_normals;  // indices into `normals` per corner, -1 where the file has none; empty if none at all
  // per triangle, from 1; 0 where the file asks for flat facets; empty if it names no group
  std::vector<std::int32_t> smoothing_groups;
  std::string source;  // the file's name, for messages
};

}  // namespace pincer::contact
