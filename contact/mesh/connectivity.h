// connectivity: which triangle lies across each edge, which edges are sharp, and the normal at each corner.
//
//   n_corner = normalised sum over the corner's fan of  (e_i x f_i / |e_i||f_i|) (|e_i||f_i|)^p
//   e_i, f_i  a triangle's two edges there [m]
//   p = -1 where the fan's edges are of about one length (up to 2 : 1), +1 where they
//   aren't (from 6 : 1), between in the logarithm
//
// Triangles of the fan that lie in one plane count as one facet, with the outer two of their edges, or as two, cut
// along the squarest edge, where they take half the way around: a quad weighs the same whichever way its diagonal
// runs. Edge i of a triangle goes from its corner i to corner (i + 1) mod 3. A fan is
// the triangles around a vertex between two sharp edges, so a vertex on a crease has several normals. Where the file
// has usable normals their mean replaces that sum, and an edge is sharp where the two sides' normals differ at an end
// by more than kSameNormal; elsewhere, where the file has smoothing groups, it is sharp unless both sides are in the
// same one or in one plane (within kSameNormal); elsewhere where the facets' angle exceeds the crease angle. A fan that
// ends at a sharp edge sees one side of its vertex only, and its facets' mean would lean away from the edge by half a
// facet's angle (0.1 mm of shape on a 15-degree cylinder of 25 mm). Its normal is continued instead, as along a
// circular arc, from a neighbour q across the crease whose fan is whole: n = n_q - 2 (n_q . g) g, g the direction to q;
// and where creases meet, from the neighbours along them. The facets' mean remains where there is no such neighbour, or
// where it differs by more than 20 degrees. Source for p = -1: N. Max, "Weights for computing vertex normals from facet
// normals", J. Graphics Tools 4(2), 1999: exact on spheres, where weights by angle lean by up to 0.6 degrees, which a
// finger feels as 23 um instead of 3 on a sphere of 320 triangles and 20 mm. But where a large plane meets a small
// rounding it takes the rounding's side; p = +1, weights by area, takes the plane's.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

// File normals closer than this are one normal, written with rounding: 1 degree. [rad]
constexpr double kSameNormal = 0.017453292519943295;

struct Neighbour {
  std::int32_t triangle = -1;  // -1: open border
  std::int8_t edge = -1;       // the same edge as the neighbour counts it
};

using Neighbours = std::vector<std::array<Neighbour, 3>>;  // per triangle and edge

struct CornerNormals {
  std::vector<std::array<bool, 3>> sharp;    // per triangle and edge; open borders are sharp
  std::vector<std::array<Vec3, 3>> normals;  // per triangle and corner, unit; equal to the last bit within a fan
};

// Requires a manifold mesh (requireManifold); throws std::logic_error if it isn't.
Neighbours findNeighbours(const TriangleMesh& mesh);

// Corners 3 t + i whose normal of the file points to the back of their triangle, and also to that of all
// triangles at the vertex with this normal: a sliver alone may lie askew. Between normals that oppose each other
// no shading exists. Empty where there is none.
std::vector<bool> findOpposingCorners(const TriangleMesh& mesh);

// The file's normal at corner i (mod 3) of triangle t; null where it has none or where it
// opposes the triangle, as `opposing` says.
const Vec3* usableFileNormal(const TriangleMesh& mesh, std::size_t t, std::size_t i, const std::vector<bool>& opposing);

// Requires 0 < crease_angle <= pi [rad].
CornerNormals findCornerNormals(const TriangleMesh& mesh, const Neighbours& neighbours, double crease_angle,
                                bool use_file_normals);

}  // namespace pincer::contact
