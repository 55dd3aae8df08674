// sampled_surface: the brute-force oracle of closed forms: a shape's surface as a set
// of patches that are sampled, not solved.
//
//   min f = min over the patches, over (u, v) in [0, 1]^2, of f(S(u, v));   d(q) = +-sqrt(min |S - q|^2),
//                                                                           negative where q is inside
//
// Each patch is small enough (a quarter turn at most) that the distance to a point has one basin on it; a grid is laid
// over the patch and laid again, finer, around its best sample until its cells are below 1e-9 of the patch. Shares no
// line with contact/shape. A half-space is a square of side 1 m: keep test points within 0.2 m of B's origin.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pincer/contact/math.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/shape.h"
#include "pincer/contact/surface/patch.h"

namespace pincer::tests {

struct Patch {
  std::function<Vec3(double u, double v)> point;  // u, v in [0, 1] -> S [m]
};

class SampledSurface {
 public:
  explicit SampledSurface(const contact::Shape& shape);  // any but Mesh

  bool contains(const Vec3& q) const { return contains_(q); }
  double signedDistance(const Vec3& q) const;                         // [m], within kSamplingError
  double minimum(const std::function<double(const Vec3&)>& f) const;  // of f over the surface

  // A zoomed cell is 1e-9 of a patch of at most 0.5 m; the distance is flat to first order
  // at a smooth minimum, but not at a corner.
  static constexpr double kSamplingError = 2e-9;  // [m]

 private:
  std::vector<Patch> patches_;
  std::function<bool(const Vec3&)> contains_;
};

// One of each primitive, hand-sized and of no special proportions; `name` for messages.
struct NamedShape {
  std::string name;
  contact::Shape shape;
};
std::shared_ptr<const contact::Polytope> voussoir();  // a stone of an arch
const std::vector<NamedShape>& samplePrimitives();    // all that contact/shape has closed forms for
const std::vector<NamedShape>& sampleConvexSolids();  // those of them that are bounded: no half-space, no dish

}  // namespace pincer::tests
