// mesh_report: what a triangle mesh is and what is wrong with it, in numbers and in sentences
// for a person (`pincer mesh info`, `check`).
//
//   V = sum over triangles of p0 . (p1 x p2) / 6  [m^3], negative when the triangles face inwards
//   A = sum over triangles of |(p1 - p0) x (p2 - p0)| / 2  [m^2]
//
// A closed mesh has two triangles at every edge, running along it in opposite directions. Every finding has a short
// name that stays the same over versions; docs/meshes.md explains each.
#pragma once
#include <string>
#include <vector>

#include "pincer/contact/error.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

struct MeshFinding {
  std::string name;  // for example "boundary-edges"
  bool unfit;        // for grasping: mass or contact would be wrong or missing; false: good to know
  int count;         // how many places
  std::string text;  // one sentence or more: what, where the first is, remedy
};

struct MeshReport {
  int vertices = 0;            // in the file
  int unused_vertices = 0;     // in no triangle
  int duplicate_vertices = 0;  // used ones at exactly the place of an earlier one
  int triangles = 0;
  int zero_area_triangles = 0;  // flat to round-off, or naming a vertex twice
  int needle_triangles = 0;     // whose height is below 1/1000 of their longest side
  int duplicate_triangles = 0;  // with the vertices of an earlier one, facing either way
  Vec3 box_min = Vec3::Zero();  // of the used vertices [m]
  Vec3 box_max = Vec3::Zero();  // [m]
  double volume = 0;            // signed [m^3]; meaningful for a closed mesh only
  double area = 0;              // [m^2]
  int edges = 0;
  int boundary_edges = 0;        // with one triangle
  int boundary_loops = 0;        // holes, or rims of sheets
  int nonmanifold_edges = 0;     // with more than two triangles, or two that run the same way (one of them is flipped)
  int reversed_edges = 0;        // the latter alone
  int nonmanifold_vertices = 0;  // where fans of triangles touch that share no edge
  // sharp: by the file's normals, else its smoothing groups, else the crease angle (connectivity.h)
  int crease_edges = 0;
  int creased_vertices = 0;           // at such an edge
  bool file_normals = false;          // the file has normals, and they say what is sharp
  bool smoothing_groups = false;      // where there are no normals, the file's smoothing groups do
  int components = 0;                 // pieces joined by edges
  bool closed = false;                // every edge has two triangles, running opposite ways
  bool inverted = false;              // closed, and its volume is negative
  std::vector<MeshFinding> findings;  // empty when all is well

  bool isFit() const;  // for grasping: no finding says otherwise
};

struct InspectOptions {
  double crease_angle = 0.6981317007977318;  // between facet normals [rad]
  double metres_per_unit = 1;  // that the file was read with: for a suggestion where the size isn't a hand's
};

// Total over every validated mesh, also one whose reader kept degenerate triangles.
MeshReport inspect(const TriangleMesh& mesh, const InspectOptions& options = {});

// Throws InputError naming the first element that no reader would have let through: a vertex that isn't finite, an
// index that is out of range or named twice by one triangle, a list that is as long as no other, a normal that isn't of
// unit length to 1e-3. For meshes that were made in memory; everything below needs it.
void requireWellFormed(const TriangleMesh& mesh);
// Throws InputError naming the first edge (or vertex) where the surface branches, how many there are, and the remedy.
void requireManifold(const TriangleMesh& mesh);
// The same, and for open borders and pieces that face inwards: what mass properties and grasping need.
void requireClosed(const TriangleMesh& mesh);

}  // namespace pincer::contact
