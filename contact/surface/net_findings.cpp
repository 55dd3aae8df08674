#include <limits>

#include "pincer/contact/surface/surface_net.h"

namespace pincer::contact {

namespace {

// (Su x Sv) . N is positive wherever the control points' differences spread too
// little to turn it: most patches need no grid.
bool surelyFlatEnough(const Patch& p) {
  const std::array<Vec3, 6> u = {p.b210 - p.b300, p.b120 - p.b210, p.b030 - p.b120,
                                 p.b111 - p.b201, p.b021 - p.b111, p.b012 - p.b102};
  const std::array<Vec3, 6> v = {p.b201 - p.b300, p.b111 - p.b210, p.b021 - p.b120,
                                 p.b102 - p.b201, p.b012 - p.b111, p.b003 - p.b102};
  Vec3 u0 = Vec3::Zero(), v0 = Vec3::Zero();
  for (std::size_t i = 0; i < 6; ++i) {
    u0 += u[i] / 6;
    v0 += v[i] / 6;
  }
  double du2 = 0, dv2 = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    du2 = std::max(du2, (u[i] - u0).squaredNorm());
    dv2 = std::max(dv2, (v[i] - v0).squaredNorm());
  }
  const double du = std::sqrt(du2), dv = std::sqrt(dv2);
  const Vec3 cross = u0.cross(v0);
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3* n : {&p.n200, &p.n020, &p.n002, &p.n110, &p.n011, &p.n101}) least = std::min(least, cross.dot(*n));
  return least > du * v0.norm() + dv * u0.norm() + du * dv;
}

bool folds(const Patch& patch) {
  constexpr int kGrid = 6;  // parts of an edge
  if (surelyFlatEnough(patch)) return false;
  for (int i = 0; i <= kGrid; ++i) {
    for (int j = 0; i + j <= kGrid; ++j) {
      const PatchPoint x = evaluate(patch, static_cast<double>(i) / kGrid, static_cast<double>(j) / kGrid);
      if (!(x.Su.cross(x.Sv).dot(x.N) > 0)) return true;
    }
  }
  return false;
}

}  // namespace

// Where one end outweighs the other by w the middle normal is (w + 1/w) / 2 long, and at the lighter
// end the normal turns w times as fast.
double concaveCurvature(const Patch& patch, int edge) {
  constexpr double kEven = 1e-7;  // of the length's square
  const auto p = edgeCurve(patch, edge);
  const auto n = edgeNormals(patch, edge);
  const Vec3 d = p[3] - p[0];
  const double mean = -(n[2] - n[0]).dot(d) / d.squaredNorm(), length2 = n[1].squaredNorm();
  return length2 > 1 + kEven ? mean * (std::sqrt(length2) + std::sqrt(length2 - 1)) : mean;
}

void NetInspector::see(std::int32_t triangle, const Patch& patch) {
  if (folds(patch)) folded_.push_back(triangle);
  for (int i = 0; i < 3; ++i) sharpest_ = std::max(sharpest_, concaveCurvature(patch, i));
  for (const Vec3& p : controlPoints(patch)) radius2_ = std::max(radius2_, p.squaredNorm());
}

NetFindings NetInspector::findings() const {
  return {folded_, sharpest_ > 0 ? 1 / sharpest_ : std::numeric_limits<double>::infinity(), std::sqrt(radius2_)};
}

}  // namespace pincer::contact
