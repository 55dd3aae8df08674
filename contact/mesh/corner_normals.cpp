#include <algorithm>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/mesh/union_find.h"

namespace pincer::contact {

namespace {

constexpr double kFarthestMirror = 0.35;  // [rad] 20 degrees: further away the neighbours belong to another shape

constexpr double kCancelled = 1e-6;  // opposite facets cancel; what is left below this has no direction

using Normals = std::vector<std::array<Vec3, 3>>;
using Sharp = std::vector<std::array<bool, 3>>;

class CornerNormalFinder {
 public:
  CornerNormalFinder(const TriangleMesh& mesh, const Neighbours& neighbours, bool use_file_normals)
      : mesh_(mesh),
        neighbours_(neighbours),
        use_file_normals_(use_file_normals && !mesh.triangle_normals.empty()),
        use_groups_(use_file_normals && !mesh.smoothing_groups.empty()),
        opposing_(use_file_normals_ ? findOpposingCorners(mesh) : std::vector<bool>()) {
    facet_normals_.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      facet_normals_.push_back((corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).normalized());
    }
  }

  CornerNormals find(double crease_angle) const {
    CornerNormals result;
    result.sharp.resize(mesh_.triangles.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) result.sharp[t][i] = isSharp(t, i, crease_angle);
    }
    const Fans fans = findFans(result.sharp);
    result.normals = averageOverFans(fans, result.sharp);
    continueToCreases(fans, result.normals);
    continueToCreaseEnds(fans, result.normals);
    return result;
  }

 private:
  const Vec3& corner(std::size_t t, std::size_t i) const {
    return mesh_.vertices[static_cast<std::size_t>(mesh_.triangles[t][i % 3])];
  }

  const Vec3* fileNormal(std::size_t t, std::size_t i) const {
    return use_file_normals_ ? usableFileNormal(mesh_, t, i, opposing_) : nullptr;
  }

  bool isSharp(std::size_t t, std::size_t i, double crease_angle) const {
    const auto [other, edge] = neighbours_[t][i];
    if (other < 0) return true;
    const auto s = static_cast<std::size_t>(other), j = static_cast<std::size_t>(edge);
    const Vec3 *a0 = fileNormal(t, i), *a1 = fileNormal(t, i + 1), *b0 = fileNormal(s, j + 1), *b1 = fileNormal(s, j);
    if (a0 && a1 && b0 && b1) return angleBetween(*a0, *b0) > kSameNormal || angleBetween(*a1, *b1) > kSameNormal;
    const double angle = angleBetween(facet_normals_[t], facet_normals_[s]);
    return use_groups_ ? angle > kSameNormal && !inOneGroup(t, s) : angle > crease_angle;
  }

  bool inOneGroup(std::size_t t, std::size_t s) const {
    return mesh_.smoothing_groups[t] != 0 && mesh_.smoothing_groups[t] == mesh_.smoothing_groups[s];
  }

  // How a fan ends: not at all (or at one edge, seen from both sides), along a crease that
  // goes straight on, or where creases meet.
  enum class FanEnd { none, straight, corner };

  struct Fan {
    // unit directions to the other ends of its first and last edge, if sharp
    Vec3 out = Vec3::Zero(), in = Vec3::Zero();
    double crease = std::numeric_limits<double>::infinity();                 // length of the shorter of the two [m]
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;  // of its edges at the vertex [m]

    // The exponent p of the edges' lengths in the weights.
    double exponent() const {
      constexpr double kEven = 2, kUneven = 6;  // longest over shortest
      return std::clamp(2 * math::log(longest / shortest / kEven) / math::log(kUneven / kEven), 0.0, 2.0) - 1;
    }
    FanEnd end() const {
      constexpr double kStraight = -0.5, kSame = 0.999;  // cosines
      const double cosine = out.dot(in);
      if ((out.isZero() && in.isZero()) || cosine > kSame) return FanEnd::none;
      return cosine < kStraight ? FanEnd::straight : FanEnd::corner;
    }
  };
  struct Fans {
    std::vector<std::size_t> of_corner;  // a fan is named by its first corner
    std::vector<Fan> fan;
  };

  Vec3 direction(std::size_t t, std::size_t from, std::size_t to) const {
    return (corner(t, to) - corner(t, from)).normalized();
  }

  Fans findFans(const std::vector<std::array<bool, 3>>& sharp) const {
    UnionFind sets(3 * sharp.size());
    for (std::size_t t = 0; t < sharp.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (!sharp[t][i]) joinAcross(t, i, sets);
      }
    }
    Fans fans{std::vector<std::size_t>(3 * sharp.size()), std::vector<Fan>(3 * sharp.size())};
    for (std::size_t c = 0; c < fans.of_corner.size(); ++c) {
      const std::size_t t = c / 3, i = c % 3;
      fans.of_corner[c] = static_cast<std::size_t>(sets.find(static_cast<std::int32_t>(c)));
      Fan& fan = fans.fan[fans.of_corner[c]];
      if (sharp[t][i]) {
        fan.out = direction(t, i, i + 1);
        fan.crease = std::min(fan.crease, side(t, i, i + 1).norm());
      }
      if (sharp[t][(i + 2) % 3]) {
        fan.in = direction(t, i, i + 2);
        fan.crease = std::min(fan.crease, side(t, i, i + 2).norm());
      }
      for (const std::size_t j : {i + 1, i + 2}) {
        const double length = (corner(t, j) - corner(t, i)).norm();
        fan.shortest = std::min(fan.shortest, length);
        fan.longest = std::max(fan.longest, length);
      }
    }
    return fans;
  }

  static Vec3 weightedNormal(const Vec3& e, const Vec3& f, const Fan& fan) {
    const double ef = e.norm() * f.norm();
    return e.cross(f) / ef * math::pow(ef / (fan.longest * fan.longest), fan.exponent());
  }
  Vec3 side(std::size_t t, std::size_t from, std::size_t to) const { return corner(t, to) - corner(t, from); }

  // True if the triangle goes on in one plane, and in one fan, across its edge.
  bool isFlatAcross(std::size_t t, std::size_t edge, const Sharp& sharp) const {
    // [rad]: what rounding in a file makes of a plane; beyond, triangles are facets of their own
    constexpr double kFlat = 2e-3;
    const std::int32_t other = neighbours_[t][edge].triangle;
    if (other < 0 || sharp[t][edge]) return false;
    return facet_normals_[t].cross(facet_normals_[static_cast<std::size_t>(other)]).squaredNorm() < kFlat * kFlat;
  }

  // The weighted normals of the fans' facets, one per corner c = 3 t + i. What lies in one plane is one facet, of the
  // outer two of its edges: else a quad would weigh as one triangle or as two, as its diagonal happens to run, and
  // normals lean to one side of a cylinder's rim.
  std::vector<Vec3> facetsOf(const Fans& fans, const Sharp& sharp) const {
    std::vector<Vec3> weighted(fans.of_corner.size(), Vec3::Zero());
    std::vector<bool> done(fans.of_corner.size());
    for (std::size_t c = 0; c < weighted.size(); ++c) {
      if (isFlatAcross(c / 3, c % 3, sharp) || !isFlatAcross(c / 3, (c % 3 + 2) % 3, sharp)) continue;
      weighted[c] = planeFrom(c, fans, sharp, done);
    }
    for (std::size_t c = 0; c < weighted.size(); ++c) {
      if (!done[c])
        weighted[c] =
            weightedNormal(side(c / 3, c % 3, c % 3 + 1), side(c / 3, c % 3, c % 3 + 2), fans.fan[fans.of_corner[c]]);
    }
    return weighted;
  }

  // Of the plane that begins, counter-clockwise around the vertex, at corner c. One that takes half the way around is
  // two facets, cut along its squarest edge; zero, with nothing done, if it takes more.
  Vec3 planeFrom(std::size_t c, const Fans& fans, const Sharp& sharp, std::vector<bool>& done) const {
    constexpr double kHalfWay = -0.9, kFarthest = 2.1;  // cosine; counted in right angles, roughly
    const Fan& fan = fans.fan[fans.of_corner[c]];
    const Vec3 e = side(c / 3, c % 3, c % 3 + 1), out = e.normalized();
    std::vector<std::size_t> corners = {c};
    Vec3 squarest = Vec3::Zero();
    double turn = 0, least = 1;
    for (std::size_t t = c / 3, i = c % 3;;) {
      const Vec3 first = direction(t, i, i + 1), last = direction(t, i, i + 2);
      if (std::abs(out.dot(first)) < least) {
        least = std::abs(out.dot(first));
        squarest = side(t, i, i + 1);
      }
      turn += 1 - first.dot(last);
      if (turn > kFarthest) return Vec3::Zero();
      const std::size_t edge = (i + 2) % 3;
      if (!isFlatAcross(t, edge, sharp)) {
        const Vec3 f = side(t, i, i + 2);
        for (const std::size_t each : corners) done[each] = true;
        return out.dot(last) < kHalfWay && least < 1
                   ? weightedNormal(e, squarest, fan) + weightedNormal(squarest, f, fan)
                   : weightedNormal(e, f, fan);
      }
      const Neighbour next = neighbours_[t][edge];
      t = static_cast<std::size_t>(next.triangle);
      i = static_cast<std::size_t>(next.edge);
      corners.push_back(3 * t + i);
    }
  }

  Normals averageOverFans(const Fans& fans, const Sharp& sharp) const {
    const std::size_t corners = fans.of_corner.size();
    std::vector<Vec3> from_file(corners, Vec3::Zero()), from_facets(corners, Vec3::Zero());
    std::vector<double> weight(corners, 0);
    const std::vector<Vec3> facets = facetsOf(fans, sharp);
    for (std::size_t c = 0; c < corners; ++c) {
      from_facets[fans.of_corner[c]] += facets[c];
      weight[fans.of_corner[c]] += facets[c].norm();
      if (const Vec3* n = fileNormal(c / 3, c % 3)) from_file[fans.of_corner[c]] += *n;
    }
    Normals normals(mesh_.triangles.size());
    for (std::size_t c = 0; c < corners; ++c) {
      const std::size_t fan = fans.of_corner[c];
      normals[c / 3][c % 3] = directionOf(from_file[fan], from_facets[fan] / weight[fan], facet_normals_[c / 3]);
    }
    return normals;
  }

  static Vec3 mirrored(const Vec3& n, const Vec3& along) { return n - 2 * n.dot(along) * along; }

  // Fans that end straight take the normal of whole neighbours that lie most squarely across the crease: the least
  // along it. (By angles, the far end of a long quad's diagonal would be as square as its side's, and what is mirrored
  // across that doesn't turn with the surface.)
  void continueToCreases(const Fans& fans, Normals& normals) const {
    constexpr double kAsSquare = 0.1;  // of the crease's edges there
    std::vector<double> least_along(fans.fan.size(), std::numeric_limits<double>::infinity());
    std::vector<Vec3> sum(fans.fan.size(), Vec3::Zero());
    for (std::size_t c = 0; c < fans.of_corner.size(); ++c) {
      const std::size_t t = c / 3, i = c % 3, fan = fans.of_corner[c];
      if (fans.fan[fan].end() != FanEnd::straight || fileNormal(t, i)) continue;
      const Vec3 crease = (fans.fan[fan].out - fans.fan[fan].in).normalized();
      for (const std::size_t j : {(i + 1) % 3, (i + 2) % 3}) {
        if (fans.fan[fans.of_corner[3 * t + j]].end() != FanEnd::none) continue;
        const Vec3 g = direction(t, i, j);
        const double along = std::abs(side(t, i, j).dot(crease)) / fans.fan[fan].crease;
        if (along > least_along[fan] + kAsSquare) continue;
        if (along < least_along[fan] - kAsSquare) sum[fan].setZero();
        least_along[fan] = std::min(along, least_along[fan]);
        sum[fan] += mirrored(normals[t][j], g);
      }
    }
    adopt(sum, fans, normals);
  }

  // Where creases meet, the normal comes along them.
  void continueToCreaseEnds(const Fans& fans, Normals& normals) const {
    std::vector<Vec3> sum(fans.fan.size(), Vec3::Zero());
    for (std::size_t c = 0; c < fans.of_corner.size(); ++c) {
      const std::size_t t = c / 3, i = c % 3;
      const Fan& fan = fans.fan[fans.of_corner[c]];
      if (fan.end() != FanEnd::corner || fileNormal(t, i)) continue;
      for (const std::size_t j : {(i + 1) % 3, (i + 2) % 3}) {
        const Vec3 g = direction(t, i, j);
        const bool on_crease = g == fan.out || g == fan.in;
        if (on_crease && fans.fan[fans.of_corner[3 * t + j]].end() != FanEnd::corner)
          sum[fans.of_corner[c]] += mirrored(normals[t][j], g);
      }
    }
    adopt(sum, fans, normals);
  }

  void adopt(const std::vector<Vec3>& sum, const Fans& fans, Normals& normals) const {
    for (std::size_t c = 0; c < fans.of_corner.size(); ++c) {
      const Vec3& n = sum[fans.of_corner[c]];
      if (n.norm() > kCancelled && angleBetween(n, normals[c / 3][c % 3]) < kFarthestMirror)
        normals[c / 3][c % 3] = n.normalized();
    }
  }

  void joinAcross(std::size_t t, std::size_t i, UnionFind& sets) const {
    const auto [other, edge] = neighbours_[t][i];
    const auto here = static_cast<std::int32_t>(3 * t + i), here_next = static_cast<std::int32_t>(3 * t + (i + 1) % 3);
    sets.join(here, 3 * other + (edge + 1) % 3);
    sets.join(here_next, 3 * other + edge);
  }

  // Where everything cancels each facet keeps its own.
  static Vec3 directionOf(const Vec3& from_file, const Vec3& from_facets, const Vec3& facet) {
    if (from_file.norm() > kCancelled) return from_file.normalized();
    if (from_facets.norm() > kCancelled) return from_facets.normalized();
    return facet;
  }

  const TriangleMesh& mesh_;
  const Neighbours& neighbours_;
  bool use_file_normals_, use_groups_;
  std::vector<bool> opposing_;  // corners
  std::vector<Vec3> facet_normals_;
};

}  // namespace

CornerNormals findCornerNormals(const TriangleMesh& mesh, const Neighbours& neighbours, double crease_angle,
                                bool use_file_normals) {
  PINCER_ASSERT(neighbours.size() == mesh.triangles.size());
  PINCER_ASSERT(0 < crease_angle && crease_angle <= M_PI);
  return CornerNormalFinder(mesh, neighbours, use_file_normals).find(crease_angle);
}

}  // namespace pincer::contact
