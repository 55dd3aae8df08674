// solids: the seven models of the shape-identification experiment, made here, lying as
// they are felt: the axis from left to right.
//
// Within a radius of 40 mm about x, 80 mm long, the cube 56.6 mm; their middle is B's origin (A. J. Doxon, doctoral
// dissertation, University of Utah, 2014, ch. 2). Cone and tetrahedron point right or left; triangle and tetrahedron
// have an edge on top, cube and octagon a face (ours). Shaded: edges rounded with 1.5 mm, felt as the smooth surface,
// round ones of 24 sides. Not shaded: facets, sharp edges, round ones of 180.
#pragma once
#include <memory>
#include <string>

#include "pincer/contact/smooth_mesh.h"

namespace pincer::tasks {

struct SolidSizes {
  double radius = 0.04;         // [m]
  double length = 0.08;         // [m]
  double edge_radius = 1.5e-3;  // of shaded ones [m]
  int sides = 24;               // of shaded round ones
  int facet_sides = 180;        // of round ones that aren't shaded
};

// True if its two ends differ.
bool isPointed(const std::string& name);

// `name`: cone, cylinder, cube, sphere, tetrahedron, octagon or triangle; pointed ones point right, or left. Throws
// InputError for another name, or sizes that don't fit.
std::shared_ptr<const contact::SmoothMesh> makeSolid(const std::string& name, bool shaded, const SolidSizes& sizes,
                                                     bool points_left = false);

}  // namespace pincer::tasks
