#include "pincer/contact/mesh/edge_weights.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/mesh/cone_tips.h"
#include "pincer/contact/mesh/union_find.h"

namespace pincer::contact {

namespace {

constexpr double kFlat = 0.005;      // angle between triangles of one plane, of what the normals over them turn; chosen
constexpr double kLeastLean = 0.35;  // [rad] of a tip's facets, as kFarthestMirror of corner_normals.cpp
constexpr double kTip = 1e-6;        // rounds a tip by less than 0.1 um of 50 mm
constexpr double kMost = 100;        // largest over smallest omega of a facet: further in its fit says nothing
constexpr double kEven = 0.05;       // of ln w: less changes the contact's speed by .7 % at most

// The smallest g of least squares, over the corners of one facet, for what the normals turn along their one arc.
class WeightFit {
 public:
  // `place`: in the facet's plane, of order 1; `n`: normal along the plane's two axes.
  void add(const Vec2& place, const Vec2& n) { corners_.push_back({place, n}); }

  // Where the normals turn across their arc by more than kRound of what they turn along it there are no rulings, and
  // g fades to 0.
  Vec2 gradient() const {
    constexpr double kRound = 0.3;
    Vec2 mean = Vec2::Zero();
    for (const Corner& c : corners_) mean += c.n / static_cast<double>(corners_.size());
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const Corner& c : corners_) spread += (c.n - mean) * (c.n - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread);
    const double across2 = axes.eigenvalues()[0], along2 = axes.eigenvalues()[1];
    const double ruled = 1 - across2 / (kRound * kRound * along2);
    return ruled > 0 ? Vec2(ruled * gradientAlong(axes.eigenvectors().col(1))) : Vec2(Vec2::Zero());
  }

 private:
  struct Corner {
    Vec2 place, n;
  };

  // Of the normals' parts y = n . arc: (1 + g . place) y is affine in the place.
  Vec2 gradientAlong(const Vec2& arc) const {
    constexpr double kUnknown = 1e-3;  // share of the sum of squares: in a direction with less, g says nothing
    Mat3 affines = Mat3::Zero(), mixed = Mat3::Zero(), squares = Mat3::Zero();
    for (const Corner& c : corners_) {
      const Vec3 affine(1, c.place.x(), c.place.y()), product = c.n.dot(arc) * affine;
      affines += affine * affine.transpose();
      mixed += affine * product.transpose();
      squares += product * product.transpose();
    }
    const Mat3 left = squares - mixed.transpose() * affines.inverse() * mixed;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(left.block<2, 2>(1, 1));
    Vec2 g = Vec2::Zero();
    for (int k = 0; k < 2; ++k) {
      const Vec2 axis = axes.eigenvectors().col(k);
      if (axes.eigenvalues()[k] > kUnknown * squares.trace())
        g -= axis.dot(left.block<2, 1>(1, 0)) / axes.eigenvalues()[k] * axis;
    }
    return g;
  }

  std::vector<Corner> corners_;
};

class EdgeWeightFinder {
 public:
  EdgeWeightFinder(const TriangleMesh& mesh, const Neighbours& neighbours, const CornerNormals& corners)
      : mesh_(mesh), neighbours_(neighbours), corners_(corners), logs_(mesh.triangles.size(), {0, 0, 0}) {
    facet_normals_.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      facet_normals_.push_back((place(t, 1) - place(t, 0)).cross(place(t, 2) - place(t, 0)).normalized());
    }
    findTips();
  }

  EdgeWeights find() {
    for (const std::vector<std::size_t>& facet : facets()) weigh(facet);
    weighTips();
    EdgeWeights weights(logs_.size());
    bool all_even = true;
    for (std::size_t t = 0; t < weights.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        weights[t][i] = excessOf(logOfEdge(t, i));
        all_even = all_even && weights[t][i] == 0;
      }
    }
    return all_even ? EdgeWeights() : weights;
  }

 private:
  const Vec3& place(std::size_t t, std::size_t i) const {
    return mesh_.vertices[static_cast<std::size_t>(mesh_.triangles[t][i])];
  }
  bool isTip(std::size_t t, std::size_t i) const { return is_tip_[static_cast<std::size_t>(mesh_.triangles[t][i])]; }

  void findTips() {
    std::vector<std::vector<std::int32_t>> corners_at(mesh_.vertices.size());
    std::vector<bool> has_crease(mesh_.vertices.size());
    for (std::size_t t = 0; t < logs_.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto v = static_cast<std::size_t>(mesh_.triangles[t][i]);
        corners_at[v].push_back(static_cast<std::int32_t>(3 * t + i));
        if (corners_.sharp[t][i] || corners_.sharp[t][(i + 2) % 3]) has_crease[v] = true;
      }
    }
    is_tip_.resize(mesh_.vertices.size());
    for (std::size_t v = 0; v < is_tip_.size(); ++v)
      is_tip_[v] = !has_crease[v] && findConeTip(mesh_, corners_, corners_at[v], kLeastLean).has_value();
  }

  // The square of the most that the normal turns from corner to corner, tips apart.
  double turnOver(std::size_t t) const {
    double most2 = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = (i + 1) % 3;
      if (isTip(t, i) || isTip(t, k)) continue;
      most2 = std::max(most2, (corners_.normals[t][i] - corners_.normals[t][k]).squaredNorm());
    }
    return most2;
  }

  bool isFlatAcross(std::size_t t, std::size_t i) const {
    const std::int32_t other = neighbours_[t][i].triangle;
    if (other < 0 || corners_.sharp[t][i]) return false;
    const auto s = static_cast<std::size_t>(other);
    const double angle2 = (facet_normals_[t] - facet_normals_[s]).squaredNorm();
    return angle2 < kFlat * kFlat * std::max(turnOver(t), turnOver(s));
  }

  // The triangles of each facet that has more than one and lies among such: at least half of the sides across which the
  // surface turns. What lies in one plane by chance, in a scan, has no rulings.
  std::vector<std::vector<std::size_t>> facets() const {
    UnionFind sets(logs_.size());
    for (std::size_t t = 0; t < logs_.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (isFlatAcross(t, i)) sets.join(static_cast<std::int32_t>(t), neighbours_[t][i].triangle);
      }
    }
    std::vector<std::vector<std::size_t>> found(logs_.size());
    std::vector<std::size_t> facet_of(logs_.size());
    for (std::size_t t = 0; t < logs_.size(); ++t) {
      facet_of[t] = static_cast<std::size_t>(sets.find(static_cast<std::int32_t>(t)));
      found[facet_of[t]].push_back(t);
    }
    const auto isAmongFacets = [&](const std::vector<std::size_t>& facet) {
      int sides = 0, facets = 0;
      for (const std::size_t t : facet) {
        for (std::size_t i = 0; i < 3; ++i) {
          if (corners_.sharp[t][i]) continue;
          const std::size_t other = facet_of[static_cast<std::size_t>(neighbours_[t][i].triangle)];
          if (other == facet_of[t]) continue;
          ++sides;
          facets += found[other].size() > 1;
        }
      }
      return 2 * facets >= sides;
    };
    std::vector<std::vector<std::size_t>> kept;
    for (const auto& facet : found) {
      if (facet.size() > 1 && isAmongFacets(facet)) kept.push_back(facet);
    }
    return kept;
  }

  template <class Visit>
  void visitCorners(const std::vector<std::size_t>& facet, Visit&& visit) const {
    for (const std::size_t t : facet) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (!isTip(t, i)) visit(t, i);
      }
    }
  }

  void weigh(const std::vector<std::size_t>& facet) {
    const Vec3& origin = place(facet[0], 0);
    const Vec3 along = (place(facet[0], 1) - origin).normalized(), across = facet_normals_[facet[0]].cross(along);
    const auto inPlane = [&](const Vec3& v) { return Vec2(v.dot(along), v.dot(across)); };
    double size = 0;
    visitCorners(facet, [&](std::size_t t, std::size_t i) { size = std::max(size, (place(t, i) - origin).norm()); });
    const auto placeOf = [&](std::size_t t, std::size_t i) -> Vec2 { return inPlane(place(t, i) - origin) / size; };
    WeightFit fit;
    visitCorners(facet, [&](std::size_t t, std::size_t i) { fit.add(placeOf(t, i), inPlane(corners_.normals[t][i])); });
    const Vec2 g = fit.gradient();
    double least = 1, most = 1;
    visitCorners(facet, [&](std::size_t t, std::size_t i) {
      const double omega = 1 + g.dot(placeOf(t, i));
      least = std::min(least, omega);
      most = std::max(most, omega);
    });
    if (!(least * kMost > most)) return;
    visitCorners(facet, [&](std::size_t t, std::size_t i) { logs_[t][i] = math::log(1 + g.dot(placeOf(t, i))); });
  }

  void weighTips() {
    for (std::size_t t = 0; t < logs_.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (isTip(t, i)) logs_[t][i] = 0.5 * (logs_[t][(i + 1) % 3] + logs_[t][(i + 2) % 3]) + math::log(kTip);
      }
    }
  }

  // ln w; of a side of two facets their mean.
  double logOfEdge(std::size_t t, std::size_t i) const {
    const double here = logs_[t][i] - logs_[t][(i + 1) % 3];
    if (corners_.sharp[t][i]) return here;
    const auto& there = logs_[static_cast<std::size_t>(neighbours_[t][i].triangle)];
    const auto edge = static_cast<std::size_t>(neighbours_[t][i].edge);
    return 0.5 * (here + (there[(edge + 1) % 3] - there[edge]));
  }

  static float excessOf(double log) {
    if (std::abs(log) < kEven) return 0;
    const auto excess = static_cast<float>(math::expm1(std::abs(log)));
    return log > 0 ? excess : -excess;
  }

  const TriangleMesh& mesh_;
  const Neighbours& neighbours_;
  const CornerNormals& corners_;
  std::vector<Vec3> facet_normals_;
  std::vector<bool> is_tip_;                 // per vertex
  std::vector<std::array<double, 3>> logs_;  // per triangle and corner: of omega in its facet
};

}  // namespace

EdgeWeights findEdgeWeights(const TriangleMesh& mesh, const Neighbours& neighbours, const CornerNormals& corners) {
  PINCER_ASSERT(neighbours.size() == mesh.triangles.size());
  return EdgeWeightFinder(mesh, neighbours, corners).find();
}

}  // namespace pincer::contact
