// surface_cell: one triangle as the solver sees it: its patch and how it hangs together with the others.
#pragma once
#include <array>
#include <cstdint>

#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/surface/patch.h"

namespace pincer::contact {

struct SurfaceCell {
  Patch patch;
  std::array<Neighbour, 3> neighbours;   // across edge i, from corner i to (i + 1) mod 3
  std::array<std::int32_t, 3> vertices;  // of the mesh
  std::array<bool, 3> sharp;             // edge i has different normals on its two sides, or only one side
};

}  // namespace pincer::contact
