#include "pincer/tests/support/shell_oracle.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "pincer/contact/mesh/edge_weights.h"

namespace pincer::tests {
namespace {

using contact::SurfaceContact;
using contact::TriangleMesh;

// of the mesh's size: residuals of 1e-9 m, where hollows about as tight as the finger magnify them
constexpr double kPlace = 1e-7;
constexpr double kDirection = 1e-5;  // [rad]

std::size_t at(int i) { return static_cast<std::size_t>(i); }
Vec3 unit(const Vec3& v) { return v / v.norm(); }
int factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

// x^-1 counts as 1: it stands only beside a factor 0.
class Powers {
 public:
  explicit Powers(double x) : powers_{1, 1, x, x * x, x * x * x} {}
  double operator[](int n) const { return powers_[at(n + 1)]; }

 private:
  std::array<double, 5> powers_;
};

// w^i u^j v^k and its derivatives along u and v, where w = 1 - u - v.
struct Monomial {
  double value, du, dv;
};
Monomial monomial(const std::array<int, 3>& e, const Powers& w, const Powers& u, const Powers& v) {
  const double dw = e[0] * w[e[0] - 1] * u[e[1]] * v[e[2]];
  const double du = e[1] * w[e[0]] * u[e[1] - 1] * v[e[2]];
  const double dv = e[2] * w[e[0]] * u[e[1]] * v[e[2] - 1];
  return {w[e[0]] * u[e[1]] * v[e[2]], du - dw, dv - dw};
}

// contact.md: Walton and Meek; bent by 4 w / (1 + w)^2 of it where N0 outweighs N1 by w.
std::array<Vec3, 2> smoothHandles(const Vec3& P0, const Vec3& P1, const Vec3& N0, const Vec3& N1, double w) {
  const double d = (P1 - P0).norm();
  const Vec3 g = unit(P1 - P0);
  const double a = N0.dot(N1), a0 = N0.dot(g), a1 = N1.dot(g);
  const double rho = 6 * (2 * a0 + a * a1) / (4 - a * a), sigma = 6 * (2 * a1 + a * a0) / (4 - a * a);
  const double bend = 4 * w / ((1 + w) * (1 + w));
  return {P0 + d * (6 * g + bend * (-2 * rho * N0 + sigma * N1)) / 18,
          P1 - d * (6 * g + bend * (rho * N0 - 2 * sigma * N1)) / 18};
}

// contact.md: both sides of a crease share T = nA x nB; at its smooth end the tangent
// there. g itself where that leads elsewhere.
Vec3 creaseHandle(const Vec3& P, const Vec3& nA, const Vec3& nB, const Vec3& g, double d) {
  Vec3 T = g;
  if (nA.cross(nB).norm() > 0.05) {
    T = unit(nA.cross(nB));
  } else if ((nA + nB).norm() > 1) {
    const Vec3 n = unit(nA + nB);
    T = unit(g - g.dot(n) * n);
  }
  if (T.dot(g) < 0) T = -T;
  if (T.dot(g) <= 0.3) T = g;
  return P + T * 2 * d / (3 * (1 + T.dot(g)));
}

// Overveld and Wyvill: the ends' mean mirrored across the edge's middle.
Vec3 middleNormal(const Vec3& p0, const Vec3& p1, const Vec3& n0, const Vec3& n1) {
  const Vec3 g = unit(p1 - p0);
  const Vec3 mirrored = n0 + n1 - 2 * g.dot(n0 + n1) * g;
  if (mirrored.norm() > 1e-3) return unit(mirrored);
  return (n0 + n1).norm() > 1e-3 ? unit(n0 + n1) : n0;
}

Vec3 bezier(const std::array<Vec3, 4>& c, double s) {
  const double q = 1 - s;
  return q * q * q * c[0] + 3 * q * q * s * c[1] + 3 * q * s * s * c[2] + s * s * s * c[3];
}
Vec3 bezierTangent(const std::array<Vec3, 4>& c, double s) {
  const double q = 1 - s;
  return q * q * (c[1] - c[0]) + 2 * q * s * (c[2] - c[1]) + s * s * (c[3] - c[2]);
}
Vec3 bezier(const std::array<Vec3, 3>& c, double s) {
  return (1 - s) * (1 - s) * c[0] + 2 * s * (1 - s) * c[1] + s * s * c[2];
}

// The parameter of the curve's place nearest to p: a grid laid again, finer, around its best sample.
double nearestOn(const std::array<Vec3, 4>& curve, const Vec3& p) {
  double best = 0.5, half = 0.5;
  while (half > 1e-12) {
    const double from = best - half;
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 16; ++i) {
      const double s = std::clamp(from + half * i / 8, 0.0, 1.0);
      const double distance = (bezier(curve, s) - p).squaredNorm();
      if (distance >= nearest) continue;
      nearest = distance;
      best = s;
    }
    half /= 6;
  }
  return best;
}

}  // namespace

ShellOracle::ShellOracle(const TriangleMesh& mesh, double crease_angle, bool use_file_normals)
    : mesh_(mesh),
      neighbours_(contact::findNeighbours(mesh)),
      normals_(contact::findCornerNormals(mesh, neighbours_, crease_angle, use_file_normals)),
      corners_(mesh.vertices.size()) {
  Vec3 low = mesh.vertices.front(), high = low;
  for (const Vec3& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  size_ = (high - low).maxCoeff();
  buildFaces(mesh);
  findSharpEnds();
}

void ShellOracle::buildFaces(const TriangleMesh& mesh) {
  const contact::EdgeWeights excess = contact::findEdgeWeights(mesh, neighbours_, normals_);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Vec3, 3> p, n, middles;
    std::array<std::array<Vec3, 2>, 3> handles;  // per edge, from its first corner on
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = mesh.vertices[at(mesh.triangles[t][i])];
      n[i] = normals_.normals[t][i];
      corners_[at(mesh.triangles[t][i])].push_back({static_cast<int>(t), static_cast<int>(i)});
    }
    std::array<double, 3> weight = {1, 1, 1};  // of each edge's first end over its second
    for (std::size_t i = 0; i < 3 && !excess.empty(); ++i) {
      const double e = static_cast<double>(excess[t][i]);
      weight[i] = e < 0 ? 1 / (1 - e) : 1 + e;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = (i + 1) % 3;
      const contact::Neighbour other = neighbours_[t][i];
      std::array<Vec3, 2> beyond = {n[i], n[k]};  // the other side's normals at the same ends
      if (other.triangle >= 0) {
        const auto& theirs = normals_.normals[at(other.triangle)];
        beyond = {theirs[at((other.edge + 1) % 3)], theirs[at(other.edge)]};
      }
      const bool smooth = beyond[0] == n[i] && beyond[1] == n[k];
      const double d = (p[k] - p[i]).norm();
      const Vec3 g = (p[k] - p[i]) / d;
      if (smooth) {
        handles[i] = smoothHandles(p[i], p[k], n[i], n[k], weight[i]);
      } else {
        handles[i] = {creaseHandle(p[i], n[i], beyond[0], g, d), creaseHandle(p[k], n[k], beyond[1], -g, d)};
      }
      middles[i] = middleNormal(p[i], p[k], n[i], n[k]) + 0.5 * ((weight[i] - 1) * n[i] + (1 / weight[i] - 1) * n[k]);
      const bool mine = other.triangle < 0 || other.triangle > static_cast<std::int32_t>(t);
      if ((!smooth || other.triangle < 0) && mine) {
        const Vec3 their_middle = middleNormal(p[i], p[k], beyond[0], beyond[1]);
        edges_.push_back({{p[i], handles[i][0], handles[i][1], p[k]},
                          {n[i], middles[i], n[k]},
                          {beyond[0], their_middle, beyond[1]},
                          other.triangle < 0,
                          {mesh.triangles[t][i], mesh.triangles[t][k]}});
      }
    }
    // The middle of the patch is the mean of three smooth curves, each from a corner
    // to the middle of the side across, at 2/3.
    Vec3 middle = Vec3::Zero(), others = p[0] + p[1] + p[2];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = (i + 1) % 3, l = (i + 2) % 3;
      const Vec3 M = bezier(std::array<Vec3, 4>{p[k], handles[k][0], handles[k][1], p[l]}, 0.5);
      const std::array<double, 3> omega = {1, 1 / weight[0], weight[2]};  // of the corners
      const auto median = smoothHandles(p[i], M, n[i], unit(bezier(std::array<Vec3, 3>{n[k], middles[k], n[l]}, 0.5)),
                                        2 * omega[i] / (omega[k] + omega[l]));
      middle += bezier(std::array<Vec3, 4>{p[i], median[0], median[1], M}, 2.0 / 3) / 3;
      others += 3 * (handles[i][0] + handles[i][1]);
    }
    Face face;
    std::size_t m = 0, q = 0;
    const auto cubic = [&](int i, int j, int k, const Vec3& point) {
      face.cubic[m++] = {{i, j, k}, 6.0 / (factorial(i) * factorial(j) * factorial(k)), point};
    };
    const auto quadratic = [&](int i, int j, int k, const Vec3& normal) {
      face.quadratic[q++] = {{i, j, k}, 2.0 / (factorial(i) * factorial(j) * factorial(k)), normal};
    };
    cubic(3, 0, 0, p[0]), cubic(0, 3, 0, p[1]), cubic(0, 0, 3, p[2]);
    cubic(2, 1, 0, handles[0][0]), cubic(1, 2, 0, handles[0][1]), cubic(0, 2, 1, handles[1][0]);
    cubic(0, 1, 2, handles[1][1]), cubic(1, 0, 2, handles[2][0]), cubic(2, 0, 1, handles[2][1]);
    cubic(1, 1, 1, (27 * middle - others) / 6);
    quadratic(2, 0, 0, n[0]), quadratic(0, 2, 0, n[1]), quadratic(0, 0, 2, n[2]);
    quadratic(1, 1, 0, middles[0]), quadratic(0, 1, 1, middles[1]), quadratic(1, 0, 1, middles[2]);
    face.middle = (p[0] + p[1] + p[2]) / 3;
    face.reach = 0;
    for (const Term& term : face.cubic) face.reach = std::max(face.reach, (term.point - face.middle).norm());
    face.axis = Vec3::Zero();
    for (const Term& term : face.quadratic) face.axis += term.point;
    face.spread = 0;
    for (const Term& term : face.quadratic) face.spread = std::max(face.spread, angleBetween(term.point, face.axis));
    faces_.push_back(face);
  }
}

void ShellOracle::findSharpEnds() {
  std::vector<int> number(corners_.size(), -1);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    for (const int side : {0, 1}) {
      const int vertex = edges_[i].ends[at(side)];
      int& known = number[at(vertex)];
      if (known < 0) {
        known = static_cast<int>(sharp_ends_.size());
        sharp_ends_.push_back({vertex, {}});
      }
      sharp_ends_[at(known)].edges.emplace_back(static_cast<int>(i), side);
    }
  }
}

ShellOracle::Jet ShellOracle::jetAt(const Face& face, double u, double v) const {
  Jet x{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const Powers pw(1 - u - v), pu(u), pv(v);
  for (const Term& term : face.cubic) {
    const Monomial m = monomial(term.exponents, pw, pu, pv);
    x.S += term.factor * m.value * term.point;
    x.Su += term.factor * m.du * term.point;
    x.Sv += term.factor * m.dv * term.point;
  }
  for (const Term& term : face.quadratic) {
    const Monomial m = monomial(term.exponents, pw, pu, pv);
    x.N += term.factor * m.value * term.point;
    x.Nu += term.factor * m.du * term.point;
    x.Nv += term.factor * m.dv * term.point;
  }
  return x;
}

std::optional<ShellSolution> ShellOracle::newton(const Vec3& C, int triangle, double u, double v) const {
  constexpr double kInside = 1e-9;
  const Face& face = faces_[at(triangle)];
  const Jet start = jetAt(face, u, v);
  double h = (C - start.S).dot(start.N) / start.N.squaredNorm();
  for (int i = 0; i < 30; ++i) {
    const Jet x = jetAt(face, u, v);
    const Vec3 F = x.S + h * x.N - C;
    if (F.norm() < 1e-14 * size_) {
      if (u < -kInside || v < -kInside || u + v > 1 + kInside) return std::nullopt;
      return ShellSolution{triangle, x.S, unit(x.N), h * x.N.norm(), u, v};
    }
    Mat3 J;
    J << x.Su + h * x.Nu, x.Sv + h * x.Nv, x.N;
    const Vec3 step = J.partialPivLu().solve(-F);
    if (!step.allFinite()) return std::nullopt;
    const double scale = std::min(1.0, 0.5 / std::max(std::abs(step[0]), std::abs(step[1])));
    u += scale * step[0];
    v += scale * step[1];
    h += scale * step[2];
    if (u < -1 || v < -1 || u + v > 2) return std::nullopt;  // another start will find what is inside
  }
  return std::nullopt;
}

std::vector<ShellSolution> ShellOracle::faceSolutions(const Vec3& C) const {
  std::vector<ShellSolution> found;
  constexpr int kGrid = 3;
  for (int t = 0; t < static_cast<int>(faces_.size()); ++t) {
    for (int i = 0; i <= kGrid; ++i) {
      for (int k = 0; i + k <= kGrid; ++k) {
        const auto solution = newton(C, t, static_cast<double>(i) / kGrid, static_cast<double>(k) / kGrid);
        if (!solution) continue;
        const bool known = std::any_of(found.begin(), found.end(), [&](const ShellSolution& s) {
          return s.triangle == t && (s.S - solution->S).norm() < 1e-10 * size_;
        });
        if (!known) found.push_back(*solution);
      }
    }
  }
  return found;
}

// Only the faces around the answer's place are searched: a solution elsewhere wouldn't be this one.
bool ShellOracle::isFaceSolution(const Vec3& C, const SurfaceContact& answer) const {
  constexpr int kGrid = 4;
  for (int t = 0; t < static_cast<int>(faces_.size()); ++t) {
    if ((answer.p_BS - faces_[at(t)].middle).norm() > faces_[at(t)].reach + kPlace * size_) continue;
    for (int i = 0; i <= kGrid; ++i) {
      for (int k = 0; i + k <= kGrid; ++k) {
        const auto s = newton(C, t, static_cast<double>(i) / kGrid, static_cast<double>(k) / kGrid);
        if (s && (s->S - answer.p_BS).norm() < kPlace * size_ && (s->n - answer.n_B).norm() < kDirection) return true;
      }
    }
  }
  return false;
}

// n as a combination of the sides' normals and the edge's direction: the first two not negative, the
// third next to nothing. What is let through: 2e-3 of the sides' cross product, for the product's edge
// equation has a small part along the edge.
bool ShellOracle::isBetween(const SharpEdge& edge, double s, const Vec3& n) const {
  constexpr double kAlong = 2e-3;
  const Vec3 left = unit(bezier(edge.left, s)), right = unit(bezier(edge.right, s)),
             along = unit(bezierTangent(edge.curve, s));
  // not over the face
  if (edge.is_border) return std::abs(n.dot(along)) < 1e-4 && n.dot(left.cross(along)) <= kDirection;
  const Vec3 across = left.cross(right);
  if (across.norm() < 1e-2) return std::abs(n.dot(along)) < 0.1;  // the crease has all but ended
  Mat3 basis;
  basis << left, right, unit(across);
  const Vec3 share = basis.partialPivLu().solve(n);
  const double sign = share[0] + share[1] < 0 ? -1 : 1;
  return sign * share[0] > -1e-4 && sign * share[1] > -1e-4 && std::abs(share[2]) < kAlong / across.norm();
}

bool ShellOracle::isEdgeContact(const Vec3& C, const SurfaceContact& answer) const {
  for (const SharpEdge& edge : edges_) {
    const double length = (edge.curve[3] - edge.curve[0]).norm();
    if ((answer.p_BS - edge.curve[0]).norm() > 2 * length) continue;
    const double s = nearestOn(edge.curve, answer.p_BS);
    if ((bezier(edge.curve, s) - answer.p_BS).norm() < kPlace * size_ && isBetween(edge, s, answer.n_B)) return true;
  }
  return (C - answer.p_BS).norm() < 1e-8 * size_;  // on the surface itself every direction is as good
}

// The residual at a corner may lead along neither the corner's face nor a sharp edge.
bool ShellOracle::isVertexContact(const Vec3& C, const SurfaceContact& answer) const {
  constexpr double kLeads = 0.05;  // [rad] the product leaves along its edge equation, not quite along the curve
  for (std::size_t v = 0; v < corners_.size(); ++v) {
    const Vec3 R = C - mesh_.vertices[v];
    if ((mesh_.vertices[v] - answer.p_BS).norm() > kPlace * size_) continue;
    bool stays = true;
    for (const auto& [t, c] : corners_[v]) {
      const Jet x = jetAt(faces_[at(t)], c == 1, c == 2);
      // along the corner's two sides
      const std::array<Vec3, 3> next = {x.Su, x.Sv - x.Su, -x.Sv}, last = {x.Sv, -x.Su, x.Su - x.Sv};
      Mat3 basis;
      basis << unit(next[at(c)]), unit(last[at(c)]), unit(x.N);
      const Vec3 share = basis.partialPivLu().solve(R);
      if (share[0] > kLeads * R.norm() && share[1] > kLeads * R.norm()) stays = false;
    }
    if (stays) return true;
  }
  return false;
}

double ShellOracle::distanceToFace(const Face& face, const Vec3& C) const {
  double u = 1.0 / 3, v = 1.0 / 3, half = 1, nearest = std::numeric_limits<double>::infinity();
  while (half > 1e-8) {
    const double u0 = u, v0 = v;
    for (int i = -4; i <= 4; ++i) {
      for (int k = -4; k <= 4; ++k) {
        double tu = std::clamp(u0 + half * i / 4, 0.0, 1.0), tv = std::clamp(v0 + half * k / 4, 0.0, 1.0);
        if (tu + tv > 1) {
          const double beyond = (tu + tv - 1) / 2;
          tu = std::clamp(tu - beyond, 0.0, 1.0);
          tv = 1 - tu;
        }
        Vec3 S = Vec3::Zero();
        const Powers pw(1 - tu - tv), pu(tu), pv(tv);
        for (const Term& term : face.cubic) S += term.factor * monomial(term.exponents, pw, pu, pv).value * term.point;
        const double distance = (S - C).norm();
        if (distance >= nearest) continue;
        nearest = distance;
        u = tu;
        v = tv;
      }
    }
    half /= 2.5;
  }
  return nearest;
}

double ShellOracle::distance(const Vec3& C) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Face& face : faces_) nearest = std::min(nearest, (C - face.cubic[0].point).norm());
  for (const Face& face : faces_) {
    if ((C - face.middle).norm() - face.reach < nearest) nearest = std::min(nearest, distanceToFace(face, C));
  }
  return nearest;
}

std::string ShellOracle::complaint(const Vec3& C, double r, const SurfaceContact& answer) const {
  if (!answer.p_BS.allFinite() || !answer.n_B.allFinite() || !std::isfinite(answer.phi))
    return "the answer isn't finite";
  if (std::abs(answer.n_B.norm() - 1) > 1e-12) return fmt::format("|n| = {}", answer.n_B.norm());
  const double height = answer.phi + r;
  const double off = (C - answer.p_BS - height * answer.n_B).norm();
  if (off > 1e-13 * (size_ + C.norm()))
    return fmt::format("the centre lies {:.3g} m beside the normal over the contact", off);
  if (isFaceSolution(C, answer) || isEdgeContact(C, answer) || isVertexContact(C, answer)) return {};
  const double nearest = distance(C);
  if (height >= r && std::abs(height - nearest) < 1e-3 * size_) return {};
  return fmt::format("height {:.6g} m solves neither face, edge nor vertex; the surface is {:.6g} m away", height,
                     nearest);
}

}  // namespace pincer::tests
