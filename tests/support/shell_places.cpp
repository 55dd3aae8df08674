// ShellOracle::placesNear: all places of faces, sharp edges and vertices that face a point within reach.
#include <Eigen/LU>
#include <algorithm>

#include "pincer/contact/math.h"
#include "pincer/tests/support/shell_oracle.h"

namespace pincer::tests {
namespace {

constexpr int kStarts = 3;        // of Newton's method, per side of a triangle
constexpr int kEdgeSamples = 48;  // between which an edge's equation may change its sign once
constexpr double kSame = 1e-8;    // of the mesh's size: solutions so near are one, found from two triangles

std::size_t at(int i) { return static_cast<std::size_t>(i); }
Vec3 unit(const Vec3& v) { return v / v.norm(); }

Vec3 bezier(const std::array<Vec3, 4>& c, double s) {
  const double q = 1 - s;
  return q * q * q * c[0] + 3 * q * q * s * c[1] + 3 * q * s * s * c[2] + s * s * s * c[3];
}
Vec3 bezierTangent(const std::array<Vec3, 4>& c, double s) {
  const double q = 1 - s;
  return 3 * (q * q * (c[1] - c[0]) + 2 * q * s * (c[2] - c[1]) + s * s * (c[3] - c[2]));
}
Vec3 bezier(const std::array<Vec3, 3>& c, double s) {
  return (1 - s) * (1 - s) * c[0] + 2 * s * (1 - s) * c[1] + s * s * c[2];
}

struct EdgeFrame {
  Vec3 E, along, left, right, D;
};

// contact/surface/shell_edge.h: D = +- NL x NR + 1e-3 E' / L.
template <class SharpEdge>
EdgeFrame frameAt(const SharpEdge& edge, double s) {
  EdgeFrame f{bezier(edge.curve, s), bezierTangent(edge.curve, s), bezier(edge.left, s), bezier(edge.right, s), {}};
  const Vec3 across = edge.is_border ? Vec3(Vec3::Zero()) : Vec3(f.left.cross(f.right));
  f.D = (across.dot(f.along) < 0 ? -1 : 1) * across + 1e-3 / (edge.curve[3] - edge.curve[0]).norm() * f.along;
  return f;
}

// True if the residual over a side with the normal N leads into it; `inward` lies in that side, across the edge.
bool leadsInto(const Vec3& R, const Vec3& N, const Vec3& inward) {
  return (R - R.dot(N) / N.squaredNorm() * N).dot(inward) > 0;
}

}  // namespace

// The angle between C - S and the cone's axis is at most its spread, that between C - S and C - middle at most
// asin(reach / distance).
bool ShellOracle::mayFace(const Face& face, const Vec3& C) const {
  const Vec3 D = C - face.middle;
  const double distance = D.norm();
  if (distance <= face.reach || face.spread >= M_PI / 2) return true;
  return angleBetween(D, face.axis) <= face.spread + math::asin(face.reach / distance);
}

// True if the foot moves with the centre: dS of dC has a positive symmetric part in the plane across n.
bool ShellOracle::isStable(const Vec3& C, const ShellSolution& s) const {
  const Jet x = jetAt(faces_[at(s.triangle)], s.u, s.v);
  const double h = (C - x.S).dot(x.N) / x.N.squaredNorm();
  Mat3 J;
  J << x.Su + h * x.Nu, x.Sv + h * x.Nv, x.N;
  const Vec3 t1 = s.n.unitOrthogonal(), t2 = s.n.cross(t1);
  const Eigen::PartialPivLU<Mat3> lu(J);
  const Vec3 d1 = lu.solve(t1), d2 = lu.solve(t2);
  const Vec3 m1 = x.Su * d1[0] + x.Sv * d1[1], m2 = x.Su * d2[0] + x.Sv * d2[1];
  const double p = m1.dot(t1), q = 0.5 * (m1.dot(t2) + m2.dot(t1)), r = m2.dot(t2);
  return p > 0 && p * r > q * q;
}

void ShellOracle::addFacePlaces(const Vec3& C, double reach, std::vector<ShellPlace>& found) const {
  for (int t = 0; t < static_cast<int>(faces_.size()); ++t) {
    const Face& face = faces_[at(t)];
    if ((C - face.middle).norm() - face.reach >= reach || !mayFace(face, C)) continue;
    for (int i = 0; i <= kStarts; ++i) {
      for (int k = 0; i + k <= kStarts; ++k) {
        const auto s = newton(C, t, static_cast<double>(i) / kStarts, static_cast<double>(k) / kStarts);
        if (s && std::abs(s->h) < reach) addPlace({s->S, s->n, s->h, isStable(C, *s)}, found);
      }
    }
  }
}

void ShellOracle::addEdgePlaces(const Vec3& C, double reach, std::vector<ShellPlace>& found) const {
  for (const SharpEdge& edge : edges_) {
    const double length = (edge.curve[3] - edge.curve[0]).norm();
    if ((C - edge.curve[0]).norm() > reach + 2 * length) continue;
    const auto g = [&](double s) {
      const EdgeFrame f = frameAt(edge, s);
      return (C - f.E).dot(f.D);
    };
    for (int i = 0; i < kEdgeSamples; ++i) {
      double low = static_cast<double>(i) / kEdgeSamples, high = static_cast<double>(i + 1) / kEdgeSamples;
      if (!(g(low) > 0 && g(high) <= 0)) continue;  // from + to -: the foot moves with the centre
      for (int k = 0; k < 50; ++k) (g(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
      const EdgeFrame f = frameAt(edge, high);
      const Vec3 R = C - f.E;
      if (leadsInto(R, f.left, f.left.cross(f.along))) continue;
      if (!edge.is_border && leadsInto(R, f.right, f.along.cross(f.right))) continue;
      const bool in_front = edge.is_border || R.dot(unit(f.left) + unit(f.right)) >= 0;
      if (R.norm() < reach) addPlace({f.E, (in_front ? 1 : -1) * unit(R), (in_front ? 1 : -1) * R.norm(), true}, found);
    }
  }
}

// At a vertex where no face's residual leads inside, nor a sharp edge away.
void ShellOracle::addVertexPlaces(const Vec3& C, double reach, std::vector<ShellPlace>& found) const {
  for (const SharpEnd& end : sharp_ends_) {
    const Vec3& V = mesh_.vertices[at(end.vertex)];
    const Vec3 R = C - V;
    if (R.norm() >= reach) continue;
    Vec3 outward = Vec3::Zero();
    bool stays = true;
    for (const auto& [t, c] : corners_[at(end.vertex)]) {
      const Jet x = jetAt(faces_[at(t)], c == 1, c == 2);
      const std::array<Vec3, 3> next = {x.Su, x.Sv - x.Su, -x.Sv}, last = {x.Sv, -x.Su, x.Su - x.Sv};
      Mat3 basis;
      basis << unit(next[at(c)]), unit(last[at(c)]), unit(x.N);
      const Vec3 share = basis.partialPivLu().solve(R);
      stays = stays && !(share[0] > 0 && share[1] > 0);
      outward += unit(x.N);
    }
    bool has_border = false;
    for (const auto& [edge, side] : end.edges) {
      const EdgeFrame f = frameAt(edges_[at(edge)], side);
      stays = stays && (side == 0 ? 1 : -1) * R.dot(unit(f.D)) <= 0;
      has_border = has_border || edges_[at(edge)].is_border;
    }
    if (!stays) continue;
    const double sign = has_border || R.dot(outward) >= 0 ? 1 : -1;
    addPlace({V, sign * unit(R), sign * R.norm(), true}, found);
  }
}

void ShellOracle::addPlace(const ShellPlace& place, std::vector<ShellPlace>& found) const {
  const bool is_known = std::any_of(found.begin(), found.end(), [&](const ShellPlace& other) {
    return (other.S - place.S).norm() < kSame * size_ && (other.n - place.n).norm() < 1e-5;
  });
  if (!is_known) found.push_back(place);
}

std::vector<ShellPlace> ShellOracle::placesNear(const Vec3& C, double reach) const {
  std::vector<ShellPlace> found;
  addFacePlaces(C, reach, found);
  addEdgePlaces(C, reach, found);
  addVertexPlaces(C, reach, found);
  return found;
}

bool ShellOracle::isHidden(const Vec3& a, const Vec3& b) const {
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    if ((faces_[i].middle - a).norm() > faces_[i].reach + (b - a).norm()) continue;
    const auto corner = [&](std::size_t k) -> const Vec3& { return mesh_.vertices[at(mesh_.triangles[i][k])]; };
    Mat3 A;
    A << corner(1) - corner(0), corner(2) - corner(0), a - b;
    const Vec3 x = A.partialPivLu().solve(a - corner(0));
    if (x[0] >= 0 && x[1] >= 0 && x[0] + x[1] <= 1 && x[2] >= 0 && x[2] <= 1) return true;
  }
  return false;
}

}  // namespace pincer::tests
