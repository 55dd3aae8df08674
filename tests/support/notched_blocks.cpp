#include "pincer/tests/support/notched_blocks.h"

#include <map>
#include <utility>

namespace pincer::tests {

using Cell = std::array<int, 3>;

contact::TriangleMesh cellSolid(int n, double cell, const std::function<bool(int, int, int)>& is_solid) {
  contact::TriangleMesh mesh;
  mesh.source = "cells";
  std::map<Cell, std::int32_t> numbers;
  const auto corner = [&](const Cell& at) {
    const auto [it, is_new] = numbers.try_emplace(at, static_cast<std::int32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(cell * (Vec3(at[0], at[1], at[2]) - 0.5 * n * Vec3::Ones()));
    return it->second;
  };
  const auto isSolid = [&](const Cell& c) {
    for (const int k : c) {
      if (k < 0 || k >= n) return false;
    }
    return is_solid(c[0], c[1], c[2]);
  };
  const auto addFace = [&](const Cell& c, std::size_t axis, int side) {
    std::array<std::int32_t, 4> q{};
    for (std::size_t i = 0; i < 4; ++i) {
      Cell at = c;
      at[axis] += side;
      at[(axis + 1) % 3] += i == 1 || i == 2;
      at[(axis + 2) % 3] += i >= 2;
      q[i] = corner(at);
    }
    if (side == 0) std::swap(q[1], q[3]);
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  };
  for (int i = 0; i < n * n * n; ++i) {
    const Cell c{i / (n * n), i / n % n, i % n};
    if (!isSolid(c)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        Cell beside = c;
        beside[axis] += side == 0 ? -1 : 1;
        if (!isSolid(beside)) addFace(c, axis, side);
      }
    }
  }
  return mesh;
}

contact::TriangleMesh mapped(contact::TriangleMesh mesh, const Mat3& A) {
  for (Vec3& v : mesh.vertices) v = A * v;
  return mesh;
}

contact::TriangleMesh stepBlock(double half) {
  return cellSolid(2, half, [](int x, int, int z) { return x == 0 || z == 0; });
}

contact::TriangleMesh cornerBlock(double half) {
  return cellSolid(2, half, [](int x, int y, int z) { return x == 0 || y == 0 || z == 0; });
}

contact::TriangleMesh pitBlock(double cell) {
  return cellSolid(3, cell, [](int x, int y, int z) { return x != 1 || y != 1 || z != 2; });
}

}  // namespace pincer::tests
