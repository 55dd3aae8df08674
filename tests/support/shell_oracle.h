// shell_oracle: the brute-force judge of contact with a smooth mesh. Evaluates the patches by its
// own formulas and looks for all solutions.
//
//   F(u, v, h) = S(u, v) + h N(u, v) - C = 0                          on a face, |N| = 1 at the corners only
//   n = (C - E(s)) / |C - E(s)| between the two sides' normals        on a sharp edge
//   n = (C - V) / |C - V|, and no face or edge leads away from V      at a vertex
//
//   S, E, V  places on the face, the edge's curve, the vertex [m];  h  height [m];  C  fingertip centre [m]
//
// Faces: Newton's method in (u, v, h), all three unknowns at once, from a grid of starts in every triangle. Patches as
// sums over exponents, with Walton and Meek's edge cubics and the crease rule written down again from contact.md's
// formulas. Neighbours and corner normals come from contact/mesh (connectivity.h), which has tests of its own; nothing
// comes from contact/surface but the answer that is judged.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pincer/contact/math.h"
#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/surface_contact.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::tests {

struct ShellSolution {
  int triangle;
  Vec3 S, n;    // [m], unit
  double h;     // [m]
  double u, v;  // barycentric coordinates of corners 1 and 2
};

// A solution of any of the three equations.
struct ShellPlace {
  Vec3 S, n;       // [m], unit
  double h;        // [m], negative when the centre lies under the surface
  bool is_stable;  // it moves with the centre, not against it: a minimum of the distance along the surface
};

class ShellOracle {
 public:
  explicit ShellOracle(const contact::TriangleMesh& mesh, double crease_angle = 0.6981317007977318,
                       bool use_file_normals = true);

  // Every solution on a face within its borders (to 1e-9 of the barycentric coordinates).
  std::vector<ShellSolution> faceSolutions(const Vec3& C) const;
  // All places with |h| < `reach` that have C on their normal, each once (shell_places.cpp).
  std::vector<ShellPlace> placesNear(const Vec3& C, double reach) const;
  // True if a flat triangle lies between the two.
  bool isHidden(const Vec3& a, const Vec3& b) const;
  // From `C` to the patches [m].
  double distance(const Vec3& C) const;

  // The fault of the answer for a finger of radius `r`; empty if it has none. The answer is right
  // where it solves one of the three equations; a finger that touches nothing may also be given the
  // nearest place, whatever the normal there.
  std::string complaint(const Vec3& C, double r, const contact::SurfaceContact& answer) const;

  double size() const { return size_; }  // of the mesh's box [m]

 private:
  struct Term {
    std::array<int, 3> exponents;
    double factor;  // multinomial
    Vec3 point;
  };
  struct Face {
    std::array<Term, 10> cubic;
    std::array<Term, 6> quadratic;
    Vec3 middle;
    double reach;   // of the control points from `middle` [m]
    Vec3 axis;      // of a cone that holds all normals
    double spread;  // its half angle [rad]
  };
  struct SharpEdge {
    std::array<Vec3, 4> curve;
    std::array<Vec3, 3> left, right;
    bool is_border;
    std::array<int, 2> ends;  // vertices
  };
  struct SharpEnd {  // a vertex with sharp edges, each with its parameter there
    int vertex;
    std::vector<std::pair<int, double>> edges;
  };
  struct Jet {
    Vec3 S, Su, Sv, N, Nu, Nv;
  };
  struct Corner {
    int triangle, corner;
  };

  void buildFaces(const contact::TriangleMesh& mesh);
  void findSharpEnds();
  Jet jetAt(const Face& face, double u, double v) const;
  std::optional<ShellSolution> newton(const Vec3& C, int triangle, double u, double v) const;
  bool isFaceSolution(const Vec3& C, const contact::SurfaceContact& answer) const;
  bool isEdgeContact(const Vec3& C, const contact::SurfaceContact& answer) const;
  bool isVertexContact(const Vec3& C, const contact::SurfaceContact& answer) const;
  double distanceToFace(const Face& face, const Vec3& C) const;
  bool mayFace(const Face& face, const Vec3& C) const;
  bool isStable(const Vec3& C, const ShellSolution& s) const;
  void addFacePlaces(const Vec3& C, double reach, std::vector<ShellPlace>& found) const;
  void addEdgePlaces(const Vec3& C, double reach, std::vector<ShellPlace>& found) const;
  void addVertexPlaces(const Vec3& C, double reach, std::vector<ShellPlace>& found) const;
  void addPlace(const ShellPlace& place, std::vector<ShellPlace>& found) const;
  bool isBetween(const SharpEdge& edge, double s, const Vec3& n) const;

  contact::TriangleMesh mesh_;
  contact::Neighbours neighbours_;
  contact::CornerNormals normals_;
  std::vector<Face> faces_;
  std::vector<SharpEdge> edges_;
  std::vector<SharpEnd> sharp_ends_;
  std::vector<std::vector<Corner>> corners_;  // per vertex
  double size_;
};

}  // namespace pincer::tests
