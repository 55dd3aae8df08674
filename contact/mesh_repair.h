// mesh_repair: mends what can be mended without guessing at the shape, and says what
// it did (`pincer mesh convert --repair`).
//
// In this order: weld vertices on open edges that lie at one place; turn the neighbours of triangles without area so
// that these vanish without a gap; drop duplicate faces; make the orientation consistent; cut edges and vertices apart
// where the surface branches or touches itself; fill small holes, if asked; turn closed pieces outwards; drop the
// file's normals of triangles that have one to their back; drop unused vertices.
// A mesh that has none of these faults comes back as it was, to the last bit. No vertex is
// moved: a welded one takes its partner's place.
#pragma once
#include <string>
#include <vector>

#include "pincer/contact/error.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

struct RepairOptions {
  double weld = 0;  // vertices on open edges this near to each other become one [m], >= 0; 0: exactly equal ones
  // nearly flat holes of at most so many edges are closed with triangles between the vertices of their rim; not the rim
  // of a flat sheet, which would enclose nothing
  int fill_holes = 0;
};

struct MeshChange {
  std::string name;  // for example "welded-vertices"
  int count;
  // a sentence: what, how many, where the first is (elements as the input numbers them, where it has them)
  std::string text;
};

struct RepairedMesh {
  TriangleMesh mesh;
  std::vector<MeshChange> changes;  // in the order in which they were made; empty: the mesh is the input
};

// Total over every validated mesh, also one whose reader kept degenerate triangles. What remains is for inspect()
// (mesh_report.h) to say. Throws InputError for options out of range.
RepairedMesh repair(TriangleMesh mesh, const RepairOptions& options = {});

}  // namespace pincer::contact
