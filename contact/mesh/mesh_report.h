// mesh_report: what a triangle mesh is and what is wrong with it, in numbers and in sentences for a person (`pincer mesh info`).
//
//   V = sum over triangles of p0 . (p1 x p2) / 6  [m^3], negative when the triangles face inwards;  A = sum |(p1 - p0) x (p2 - p0)| / 2  [m^2]
//
// A closed mesh has two triangles at every edge, running along it in opposite directions.
#pragma once
#include <string>
#include <vector>

#include "contact/error.h"
#include "contact/mesh/triangle_mesh.h"

namespace pincer::contact {

struct MeshReport {
  int vertices = 0;            // in the file
  int unused_vertices = 0;     // in no triangle
  int duplicate_vertices = 0;  // used ones at exactly the place of an earlier one
  int triangles = 0;
  Vec3 box_min = Vec3::Zero();  // of the used vertices [m]
  Vec3 box_max = Vec3::Zero();  // [m]
  double volume = 0;            // signed [m^3]; meaningful for a closed mesh only
  double area = 0;              // [m^2]
  int edges = 0;
  int boundary_edges = 0;             // with one triangle
  int nonmanifold_edges = 0;          // with more than two triangles, or two that run the same way (one of them is flipped)
  int nonmanifold_vertices = 0;       // where fans of triangles touch that share no edge
  int crease_edges = 0;               // sharper than the crease angle
  int components = 0;                 // pieces joined by edges
  bool closed = false;                // every edge has two triangles, running opposite ways
  bool inverted = false;              // closed, and its volume is negative
  std::vector<std::string> findings;  // one sentence each: what, where, remedy; empty when all is well
};

// Total over every validated mesh. `crease_angle` [rad] between facet normals.
MeshReport inspect(const TriangleMesh& mesh, double crease_angle = 0.6981317007977318);

// Throws InputError naming the first edge (or vertex) where the surface branches, how many there are, and the remedy.
void requireManifold(const TriangleMesh& mesh);
// The same, and for open borders and inverted orientation: what mass properties and grasping need.
void requireClosed(const TriangleMesh& mesh);

}  // namespace pincer::contact
