// polytope: the convex hull of points, with its faces, edges and corners.
//
//   { p : n_f . p <= d_f for every face f }
//   n_f  unit normal out of the solid [-], d_f  distance of the face's plane from the origin [m]
//
// Facets that lie in one plane to within kFlat of the solid's size are one face, and corners within that of an edge or
// face are none: a cube given by points of its surface has six faces and eight corners. Frame: the points'.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::contact {

class Polytope {
 public:
  static constexpr double kFlat = 1e-6;      // of the size of the points' box [-]
  static constexpr int kMaxVertices = 4096;  // of the hull, so that a contact's feature holds two of them

  struct Face {
    Vec3 n;
    double d;
    int first, count;  // its corners' places in loops(), counter-clockwise seen from outside
  };
  struct Edge {
    int from, to;     // vertices
    int left, right;  // faces, seen from outside along from -> to
  };

  // The hull of `points` [m]. `source` names them in messages. Throws InputError: fewer than 4 points, a coordinate
  // that isn't finite, all points in one plane, more than kMaxVertices corners.
  static std::shared_ptr<const Polytope> hullOf(const std::vector<Vec3>& points, const std::string& source);
  // The vertices() of that hull, for less: without its inner body. Throws as hullOf.
  static std::vector<Vec3> cornersOfHull(const std::vector<Vec3>& points, const std::string& source);

  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<Edge>& edges() const { return edges_; }
  // Per place in a face's loop: the corner, and the edge from it to the next.
  std::span<const int> cornersOf(const Face& face) const { return loopOf(corners_, face); }
  std::span<const int> edgesOf(const Face& face) const { return loopOf(loop_edges_, face); }
  // Around a vertex: its edges, by increasing index, and for each the vertex at the other end.
  std::span<const int> edgesAt(int vertex) const { return around(vertex_edges_, vertex); }
  std::span<const int> neighboursAt(int vertex) const { return around(vertex_neighbours_, vertex); }

  // The vertex furthest along `d` (any length); of equal ones always the same. Allocates nothing.
  int extremeVertex(const Vec3& d) const;
  // Corners of an inner body, all its points at least inset() inside of every face; not empty.
  const std::vector<Vec3>& insetVertices() const { return inset_vertices_; }
  double inset() const { return inset_; }                     // [m]
  double boundingRadius() const { return bounding_radius_; }  // about the origin [m]

 private:
  Polytope(const std::vector<Vec3>& points, const std::string& source);
  std::span<const int> loopOf(const std::vector<int>& all, const Face& face) const {
    return std::span(all).subspan(static_cast<std::size_t>(face.first), static_cast<std::size_t>(face.count));
  }
  std::span<const int> around(const std::vector<int>& all, int vertex) const {
    const auto begin = static_cast<std::size_t>(first_at_vertex_[static_cast<std::size_t>(vertex)]);
    return std::span(all).subspan(
        begin, static_cast<std::size_t>(first_at_vertex_[static_cast<std::size_t>(vertex) + 1]) - begin);
  }
  void setFaces(const std::vector<std::array<int, 3>>& facets, double flat, const std::string& source);
  void setEdges(const std::string& source);
  void setSurroundings();
  double thickness() const;
  void setInset();
  double leastDepth(const std::vector<Vec3>& points) const;

  std::vector<Vec3> vertices_, inset_vertices_;
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  std::vector<int> corners_, loop_edges_;
  std::vector<int> first_at_vertex_, vertex_edges_, vertex_neighbours_;
  double inset_ = 0, bounding_radius_ = 0;
};

}  // namespace pincer::contact
