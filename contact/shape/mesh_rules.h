// mesh_rules: what the contact of meshes with solids and with each other share (mesh_pairs.h, mesh_mesh.h).
#pragma once
#include <algorithm>
#include <cstdint>

#include "pincer/contact/surface/mesh_features.h"

namespace pincer::contact {

using FlatTriangle = MeshFeatures::Triangle;

// Lengths that tell apart what touches from what is on the far side.
//   size     [m] radius of the smaller body
//   deepest  [m] what is deeper than a quarter of it isn't looked at
struct MeshScale {
  static constexpr double kLonger = 0.01;  // of the size
  double size, margin;

  double deepest() const { return -0.25 * size; }
  double slack() const { return 1e-6 * size; }  // beside a triangle, or in front of it
  // A point at depth `distance` < 0 has the nearest way out; another counts as one when it is no more than four times
  // as long (so long is the way over an edge of 30 degrees), or longer by a hundredth of the size (a body that rests
  // with its corner at a rim is pushed up, not aside). A point that is refused for that still counts where a pair that
  // overlaps has nothing else (contact_candidates.h).
  bool isWayOut(double phi, double distance) const { return phi >= 4 * std::min(distance, 0.0) - kLonger * size; }
  // Of a point at `phi` < 0 under an edge along a normal that is as steep as `slope` (cosine) on the flatter of the
  // edge's two faces, whose signed distance from the surface is `distance`: whether it is behind the surface (before
  // that face, where the normal leans that way), and `phi` is a way out, or deeper overlap of these very faces.
  bool isBehindFaces(double distance, double phi, double slope) const {
    if (!(distance < std::max(1.1 * slope * phi, 0.0) + slack())) return false;
    return isWayOut(phi, distance) || distance < 0.5 * slope * phi;
  }
};

// Sines: how far the surroundings of a corner, or the faces of an edge, may fall below the plane across the normal, so
// that round bodies, and flat ones that rock, touch with more than one.
constexpr double kConeSlack = 0.3, kEdgeSlack = 0.02;

enum : std::uint32_t { kMeshCornerOfA = 0, kMeshCornerOfB = 1, kMeshEdges = 2, kMeshEdgeEnds = 3 };
inline std::uint32_t meshFeatureOf(std::uint32_t kind, std::uint32_t name) { return kind << 30 | (name & 0x3fffffff); }

}  // namespace pincer::contact
