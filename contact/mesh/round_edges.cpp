#include "pincer/contact/mesh/round_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/mesh/cone_tips.h"
#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/mesh/edge_balls.h"
#include "pincer/contact/mesh/mesh_findings.h"
#include "pincer/contact/mesh/moving_mesh.h"
#include "pincer/contact/mesh_report.h"

namespace pincer::contact {

namespace {

constexpr double kFullest = 0.99;  // of the radius at which some triangle would vanish

using Chain = std::vector<std::int32_t>;  // points in a row

// The unit vector at the share `x` of the way along the great circle from `a` to `b`.
Vec3 onGreatCircle(const Vec3& a, const Vec3& b, double x) {
  PINCER_ASSERT(isUnit(a) && isUnit(b));
  PINCER_ASSERT(0 <= x && x <= 1);
  const double angle = math::atan2(a.cross(b).norm(), a.dot(b));
  return (math::sin((1 - x) * angle) * a + math::sin(x * angle) * b).normalized();
}

class EdgeRounder {
 public:
  EdgeRounder(const TriangleMesh& mesh, const RoundOptions& options)
      : mesh_(mesh),
        options_(options),
        neighbours_(findNeighbours(mesh)),
        corners_(findCornerNormals(mesh, neighbours_, options.crease_angle, options.use_file_normals)),
        balls_(findEdgeBalls(mesh, neighbours_, corners_)),
        segments_(segmentsOf(balls_.widest_turn)) {}

  RoundedMesh round() {
    findTips();
    addFanPoints();
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) addFace(t);
    for (std::size_t v = 0; v < balls_.at_vertex.size(); ++v) {
      for (const CreaseEnd& crease : balls_.at_vertex[v].creases) addStrip(v, crease);
      if (balls_.at_vertex[v].creases.size() > 2) addCorner(v);
    }
    for (const auto& [vertex, tip] : tips_) addCap(tip);
    if (result_.creases == 0 && result_.tips == 0) return {mesh_};
    requireRoom();
    result_.mesh = moving_.at(options_.radius, mesh_.source);
    return std::move(result_);
  }

 private:
  struct Tip {
    ConeTip cone;
    Vec3 p;
    std::int32_t pole = -1;
    std::map<std::int32_t, Chain> meridians;           // by the ruling's far end, from there to the pole
    std::vector<std::array<std::int32_t, 2>> sectors;  // far ends of the rulings left and right of a facet
  };

  std::size_t segmentsOf(double turn) const {
    const double segments = std::ceil(turn / (M_PI / 2) * options_.segments - 1e-9);
    return static_cast<std::size_t>(std::max(1.0, segments));
  }
  const Vec3& vertex(std::int32_t v) const { return mesh_.vertices[static_cast<std::size_t>(v)]; }
  const Vec3& normal(Fan fan) const {
    return corners_.normals[static_cast<std::size_t>(fan) / 3][static_cast<std::size_t>(fan) % 3];
  }
  const EdgeBall& ballAt(std::int32_t v) const { return balls_.at_vertex[static_cast<std::size_t>(v)]; }

  void findTips() {
    std::vector<std::vector<std::int32_t>> corners_at(mesh_.vertices.size());
    for (std::size_t c = 0; c < balls_.fan_of.size(); ++c) {
      const std::int32_t v = mesh_.triangles[c / 3][c % 3];
      if (ballAt(v).creases.empty()) corners_at[static_cast<std::size_t>(v)].push_back(static_cast<std::int32_t>(c));
    }
    for (std::size_t v = 0; v < corners_at.size(); ++v) {
      const auto cone = findConeTip(mesh_, corners_, corners_at[v], options_.crease_angle / 2);
      if (cone) tips_[static_cast<std::int32_t>(v)] = {*cone, mesh_.vertices[v], -1, {}, {}};
    }
    result_.tips = static_cast<int>(tips_.size());
  }

  // One point per fan; where a ball vanishes both sides share one.
  void addFanPoints() {
    fan_point_.assign(balls_.fan_of.size(), -1);
    for (std::size_t c = 0; c < balls_.fan_of.size(); ++c) {
      const Fan fan = balls_.fan_of[c];
      const std::int32_t v = mesh_.triangles[c / 3][c % 3];
      if (fan != static_cast<std::int32_t>(c) || tips_.count(v)) continue;
      const EdgeBall& ball = ballAt(v);
      const bool stays = ball.creases.empty() || ball.vanishes;
      if (ball.vanishes && twinPoint(ball, fan) >= 0) {
        fan_point_[c] = twinPoint(ball, fan);
      } else {
        fan_point_[c] =
            moving_.add({vertex(v), stays ? Vec3::Zero() : Vec3(ball.s * (normal(fan) - ball.x)), normal(fan)});
      }
    }
  }
  std::int32_t twinPoint(const EdgeBall& ball, Fan fan) const {
    const Fan twin = ball.creases[0].left == fan ? ball.creases[0].right : ball.creases[0].left;
    return fan_point_[static_cast<std::size_t>(twin)];
  }
  std::int32_t pointOf(std::size_t t, std::size_t i) const {
    return fan_point_[static_cast<std::size_t>(balls_.fan_of[3 * t + i % 3])];
  }

  void addFace(std::size_t t) {
    const auto& v = mesh_.triangles[t];
    const Vec3 n = areaVector(mesh_, v).normalized();
    const auto source = static_cast<std::int32_t>(t);
    std::size_t tips = 0, at = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!tips_.count(v[i])) continue;
      at = i;
      ++tips;
    }
    if (tips == 0) return moving_.addFace({pointOf(t, 0), pointOf(t, 1), pointOf(t, 2)}, n, source);
    if (tips > 1) refuseTwins(v);
    Tip& tip = tips_[v[at]];
    const std::int32_t left = v[(at + 1) % 3], right = v[(at + 2) % 3];
    const std::int32_t a = pointOf(t, at + 1), b = pointOf(t, at + 2);
    const std::int32_t top_a = meridian(tip, left).front(), top_b = meridian(tip, right).front();
    moving_.addFace({top_a, a, b}, n, source);
    moving_.addFace({top_a, b, top_b}, n, source);
    moving_.addSide(top_a, a, source);
    tip.sectors.push_back({left, right});
  }

  [[noreturn]] void refuseTwins(const std::array<std::int32_t, 3>& v) const {
    throw InputError(fmt::format(
        "{}: the tips of two cones share the triangle at {}: there is no room to round them. Refine the mesh there.",
        mesh_.source, vertexPlace(mesh_, v[0])));
  }

  // From the ruling's touching point over the ball to the pole, which all meridians share.
  const Chain& meridian(Tip& tip, std::int32_t far_end) {
    const auto [it, is_new] = tip.meridians.try_emplace(far_end);
    if (!is_new) return it->second;
    const ConeTip& cone = tip.cone;
    const Vec3 touch = cone.touch((vertex(far_end) - tip.p).normalized());
    const std::size_t rings = segmentsOf(math::atan2(cone.cos, cone.sin));
    for (std::size_t k = 0; k < rings; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(rings);
      const Vec3 u = onGreatCircle((touch - cone.centre()).normalized(), cone.axis, share);
      it->second.push_back(moving_.add({tip.p, k == 0 ? touch : Vec3(cone.centre() + u), cone.s * u}));
    }
    if (tip.pole < 0) tip.pole = moving_.add({tip.p, cone.centre() + cone.axis, cone.s * cone.axis});
    it->second.push_back(tip.pole);
    return it->second;
  }

  void addCap(const Tip& tip) {
    for (const auto& [left, right] : tip.sectors) {
      const Chain &a = tip.meridians.at(left), &b = tip.meridians.at(right);
      for (std::size_t k = 0; k + 1 < a.size(); ++k) addQuad(a[k], b[k], b[k + 1], a[k + 1]);
    }
  }

  // Split along the shorter diagonal at radius rho; where a side has no length one triangle remains.
  void addQuad(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    const auto at = [&](std::int32_t i) { return moving_.point(i).at(options_.radius); };
    const bool other = a == b || c == d || (at(b) - at(d)).squaredNorm() < (at(a) - at(c)).squaredNorm();
    if (other) {
      moving_.addTriangle(a, b, d);
      moving_.addTriangle(b, c, d);
    } else {
      moving_.addTriangle(a, b, c);
      moving_.addTriangle(a, c, d);
    }
  }

  // Points from the left face of a crease to its right one, over the ball at vertex `v`.
  Chain arc(std::int32_t v, Fan left, Fan right) {
    const std::int32_t a = fan_point_[static_cast<std::size_t>(left)], b = fan_point_[static_cast<std::size_t>(right)];
    if (a == b) return Chain(segments_ + 1, a);
    const auto [it, is_new] = arcs_.try_emplace(std::minmax(a, b));
    Chain& chain = it->second;
    if (is_new) {
      const auto [low, high] = it->first;
      const EdgeBall& ball = ballAt(v);
      chain.push_back(low);
      for (std::size_t k = 1; k < segments_; ++k) {
        const double share = static_cast<double>(k) / static_cast<double>(segments_);
        const Vec3 n = onGreatCircle(moving_.point(low).n, moving_.point(high).n, share);
        chain.push_back(moving_.add({vertex(v), ball.s * (n - ball.x), n}));
      }
      chain.push_back(high);
    }
    return a < b ? chain : Chain(chain.rbegin(), chain.rend());
  }

  void addStrip(std::size_t v, const CreaseEnd& crease) {
    const auto t = static_cast<std::size_t>(crease.triangle), i = static_cast<std::size_t>(crease.side);
    const std::int32_t other = neighbours_[t][i].triangle;
    if (other < crease.triangle) return;  // the crease is also seen from its other end
    const std::int32_t to = mesh_.triangles[t][(i + 1) % 3];
    const auto j = static_cast<std::size_t>(neighbours_[t][i].edge);
    const Chain near = arc(static_cast<std::int32_t>(v), crease.left, crease.right);
    const Chain far =
        arc(to, balls_.fan_of[3 * t + (i + 1) % 3], balls_.fan_of[3 * static_cast<std::size_t>(other) + j]);
    moving_.addSide(near.front(), far.front(), crease.triangle);
    moving_.addSide(near.back(), far.back(), other);
    for (std::size_t k = 0; k < segments_; ++k) addQuad(far[k], near[k], near[k + 1], far[k + 1]);
    ++result_.creases;
  }

  // Fans around the vertex, counter-clockwise seen from outside: a crease's right fan comes before its left one.
  std::vector<Fan> fansAround(const EdgeBall& ball) const {
    std::vector<Fan> fans = {ball.creases[0].right};
    while (fans.size() < ball.creases.size()) {
      const auto next = std::find_if(ball.creases.begin(), ball.creases.end(),
                                     [&](const CreaseEnd& c) { return c.right == fans.back(); });
      PINCER_ASSERT(next != ball.creases.end());
      fans.push_back(next->left);
    }
    return fans;
  }

  // A patch of the ball: a spherical triangle, or for more faces one from each side to the middle.
  void addCorner(std::size_t v) {
    const EdgeBall& ball = balls_.at_vertex[v];
    const auto at = static_cast<std::int32_t>(v);
    const std::vector<Fan> fans = fansAround(ball);
    ++result_.corners;
    if (fans.size() == 3) {
      addSphericalTriangle(at, arc(at, fans[0], fans[1]), arc(at, fans[1], fans[2]), arc(at, fans[2], fans[0]));
      return;
    }
    Vec3 middle = Vec3::Zero();
    for (const Fan fan : fans) middle += normal(fan);
    middle.normalize();
    const std::int32_t pole = moving_.add({vertex(at), ball.s * (middle - ball.x), middle});
    std::vector<Chain> spokes;
    for (const Fan fan : fans) spokes.push_back(spoke(at, fan, pole));
    for (std::size_t k = 0; k < fans.size(); ++k) {
      const std::size_t next = (k + 1) % fans.size();
      addSphericalTriangle(at, arc(at, fans[k], fans[next]), spokes[next], Chain(spokes[k].rbegin(), spokes[k].rend()));
    }
  }

  Chain spoke(std::int32_t v, Fan fan, std::int32_t pole) {
    const EdgeBall& ball = ballAt(v);
    Chain chain = {fan_point_[static_cast<std::size_t>(fan)]};
    for (std::size_t k = 1; k < segments_; ++k) {
      const Vec3 n =
          onGreatCircle(normal(fan), moving_.point(pole).n, static_cast<double>(k) / static_cast<double>(segments_));
      chain.push_back(moving_.add({vertex(v), ball.s * (n - ball.x), n}));
    }
    chain.push_back(pole);
    return chain;
  }

  // Between three arcs that run one after the other. Inner points: the mean of the three ways
  // to divide the triangle by great circles.
  void addSphericalTriangle(std::int32_t v, const Chain& ab, const Chain& bc, const Chain& ca) {
    const std::size_t n = segments_;
    std::vector<Chain> rows(n + 1);  // row i: i + 1 points, from side ca to side ab; row 0 is a
    for (std::size_t i = 0; i <= n; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        if (i == n) {
          rows[i].push_back(bc[n - j]);
        } else {
          rows[i].push_back(j == 0 ? ca[n - i] : j == i ? ab[i] : innerPoint(v, {n - i, j, i - j}, ab, bc, ca));
        }
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        moving_.addTriangle(rows[i][j], rows[i + 1][j + 1], rows[i + 1][j]);
        if (j < i) moving_.addTriangle(rows[i][j], rows[i][j + 1], rows[i + 1][j + 1]);
      }
    }
  }

  // `share`: of a, b and c, in parts of `segments_`.
  std::int32_t innerPoint(std::int32_t v, const std::array<std::size_t, 3>& share, const Chain& ab, const Chain& bc,
                          const Chain& ca) {
    const auto n_at = [&](const Chain& chain, std::size_t k) -> const Vec3& { return moving_.point(chain[k]).n; };
    const auto [a, b, c] = share;
    const auto between = [](const Vec3& from, const Vec3& to, std::size_t x, std::size_t of) {
      return onGreatCircle(from, to, static_cast<double>(x) / static_cast<double>(of));
    };
    const std::size_t n = segments_;
    const Vec3 sum = between(n_at(ab, n - a), n_at(ca, a), c, b + c) + between(n_at(bc, n - b), n_at(ab, b), a, c + a) +
                     between(n_at(ca, n - c), n_at(bc, c), b, a + b);
    const EdgeBall& ball = ballAt(v);
    const Vec3 u = sum.normalized();
    return moving_.add({vertex(v), ball.s * (u - ball.x), u});
  }

  void requireRoom() const {
    const RadiusLimit limit = moving_.limit();
    if (options_.radius <= kFullest * limit.radius) return;
    throw InputError(
        fmt::format("{}: a rounding of {:.4g} mm doesn't fit at {}. The largest that fits is --radius {} (mm). Use "
                    "that or less, or merge "
                    "small faces in a "
                    "mesh editor.",
                    mesh_.source, 1e3 * options_.radius, trianglePlace(mesh_, limit.triangle),
                    roundedDown(1e3 * kFullest * limit.radius)));
  }
  // To three digits.
  static std::string roundedDown(double x) {
    const double unit = math::pow(10, std::floor(math::log10(x)) - 2);
    return fmt::format("{:.3g}", std::floor(x / unit) * unit);
  }

  const TriangleMesh& mesh_;
  const RoundOptions& options_;
  Neighbours neighbours_;
  CornerNormals corners_;
  EdgeBalls balls_;
  std::size_t segments_;  // of every arc
  std::map<std::int32_t, Tip> tips_;
  std::vector<std::int32_t> fan_point_;                          // by a fan's first corner
  std::map<std::pair<std::int32_t, std::int32_t>, Chain> arcs_;  // by their ends
  MovingMesh moving_;
  RoundedMesh result_;
};

void requireInRange(const TriangleMesh& mesh, const RoundOptions& options) {
  const auto refuse = [&](const char* what, double value, const char* range) {
    throw InputError(fmt::format("{}: {} = {} is out of range {}.", mesh.source, what, value, range));
  };
  if (!(options.radius > 0 && std::isfinite(options.radius)))
    refuse("radius", options.radius, "(0, inf) m; typical: 0.0015");
  if (!(options.crease_angle > 0 && options.crease_angle <= M_PI))
    refuse("crease angle", options.crease_angle, "(0, 3.1416] rad");
  if (options.segments < 1 || options.segments > 64) refuse("segments", options.segments, "1 .. 64 per quarter turn");
}

}  // namespace

RoundedMesh roundEdges(const TriangleMesh& mesh, const RoundOptions& options) {
  requireInRange(mesh, options);
  requireClosed(mesh);
  return EdgeRounder(mesh, options).round();
}

}  // namespace pincer::contact
