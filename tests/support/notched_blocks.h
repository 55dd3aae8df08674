// notched_blocks: solids made of equal cells, some left out: steps, corners, pits, and what a
// linear map makes of them. All edges sharp.
#pragma once
#include <array>
#include <functional>

#include "pincer/contact/math.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::tests {

// n^3 cells of edge `cell` [m] around the origin, those that `is_solid(x, y, z)` keeps; x, y, z count
// cells from 0. Parts may touch at faces only.
contact::TriangleMesh cellSolid(int n, double cell, const std::function<bool(int, int, int)>& is_solid);

// Coordinates times `A`, whose determinant must be positive.
contact::TriangleMesh mapped(contact::TriangleMesh mesh, const Mat3& A);

// A step: floor z = 0 for x > 0, wall x = 0 for z > 0. A corner: three walls x, y, z = 0 around x, y, z > 0.
contact::TriangleMesh stepBlock(double half);
contact::TriangleMesh cornerBlock(double half);
// A pit of width `cell` from z = cell / 2 upwards.
contact::TriangleMesh pitBlock(double cell);

}  // namespace pincer::tests
