// moving_mesh: triangles whose corners move in proportion to a radius, and how large that radius may become.
//
//   x(rho) = p + rho w     p  place at rho = 0 [m], w  displacement per radius [-], rho  radius [m]
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pincer/contact/assert.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

struct MovingPoint {
  Vec3 p, w;
  Vec3 n;  // unit normal of the surface there
  Vec3 at(double rho) const { return p + rho * w; }
};

struct RadiusLimit {
  double radius;          // [m]; infinity where nothing limits it
  std::int32_t triangle;  // of the input, which has no room for more; -1 if none
};

class MovingMesh {
 public:
  std::int32_t add(const MovingPoint& point);
  // A new triangle that cannot turn over; those that name a point twice are left out.
  void addTriangle(std::int32_t a, std::int32_t b, std::int32_t c);
  // A part of the input's triangle `source`, of unit normal `normal`: it must not turn over.
  void addFace(const std::array<std::int32_t, 3>& corners, const Vec3& normal, std::int32_t source);
  // The side from `a` to `b` of the input's triangle `source` must not turn round.
  void addSide(std::int32_t a, std::int32_t b, std::int32_t source);

  const MovingPoint& point(std::int32_t i) const {
    PINCER_ASSERT(i >= 0 && static_cast<std::size_t>(i) < points_.size());
    return points_[static_cast<std::size_t>(i)];
  }
  RadiusLimit limit() const;
  TriangleMesh at(double rho, const std::string& source) const;

 private:
  struct Face {
    std::array<std::int32_t, 3> corners;
    Vec3 normal;
    std::int32_t source;
  };
  struct Side {
    std::int32_t a, b, source;
  };
  double largestOf(const Face& face) const;
  double largestOf(const Side& side) const;

  std::vector<MovingPoint> points_;
  std::vector<std::array<std::int32_t, 3>> triangles_;
  std::vector<Face> faces_;
  std::vector<Side> sides_;
};

}  // namespace pincer::contact
