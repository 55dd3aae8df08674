// solids: the seven models of the shape-identification experiment, made here.
//
// Within a radius of 40 mm about z, 80 mm long, the cube 56.6 mm; their middle is B's origin (A. J. Doxon, doctoral dissertation, University of
// Utah, 2014, ch. 2). Shaded: edges rounded with 1.5 mm, felt as the smooth surface. Not shaded: facets, sharp edges. Round ones have 24 sides.
#pragma once
#include <memory>
#include <string>

#include "pincer/contact/smooth_mesh.h"

namespace pincer::tasks {

struct SolidSizes {
  double radius = 0.04;         // [m]
  double length = 0.08;         // [m]
  double edge_radius = 1.5e-3;  // of shaded ones [m]
  int sides = 24;               // of round ones
};

// `name`: cone, cylinder, cube, sphere, tetrahedron, octagon or triangle. Throws InputError for another, or sizes that don't fit.
std::shared_ptr<const contact::SmoothMesh> makeSolid(const std::string& name, bool shaded, const SolidSizes& sizes);

}  // namespace pincer::tasks
