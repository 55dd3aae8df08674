// Nearest point of a convex hull: within, on the nearest face; outside, on the
// nearest of the faces that look at the point.
//
// Where the point sees many faces, a walk from face to face finds the distance; then all faces that come as near, to
// round-off, are looked at in order, as all others are where it sees few: the answer is the same. With x the nearest
// point so far and n from x to p, no point y of a face is nearer to p than n.(p - y), so that faces count only if a
// corner of theirs lies on the plane through x across n.
#include <algorithm>
#include <array>
#include <limits>

#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/shape/direction.h"

namespace pincer::contact {
namespace {

// Measured, hulls of 8 to 1000 corners seen from .001 to 1 of their size: beyond both the walk takes four fifths (100
// corners) to a sixth (1000) of the time.
constexpr std::size_t kManyFaces = 150;
constexpr double kFar = 0.2;  // of the bounding radius

// A face's nearest point to `p`, which lies above the face's plane by `height`.
struct OnFace {
  Vec3 q;
  int edge = -1;     // of the loop; -1: the foot is in the face
  double along = 0;  // that edge, 0 to 1
};

OnFace nearestOnFace(const Polytope& hull, const Polytope::Face& face, const Vec3& p, double height) {
  const std::span<const int> loop = hull.cornersOf(face);
  const Vec3 foot = p - height * face.n;
  OnFace nearest{foot};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3& from = hull.vertices()[static_cast<std::size_t>(loop[k])];
    const Vec3 edge = hull.vertices()[static_cast<std::size_t>(loop[(k + 1) % loop.size()])] - from;
    if (face.n.cross(edge).dot(foot - from) >= 0) continue;
    const double t = std::min(std::max(edge.dot(foot - from) / edge.squaredNorm(), 0.0), 1.0);
    const Vec3 q = from + t * edge;
    const double distance2 = (foot - q).squaredNorm();
    if (distance2 < least) least = distance2, nearest = {q, static_cast<int>(k), t};
  }
  return nearest;
}

void offer(const Polytope& hull, const Polytope::Face& face, const Vec3& p, double height, NearestPoint& best) {
  const Vec3 q = nearestOnFace(hull, face, p, height).q;
  const auto [n, distance] = directionOf<Vec3>(p - q, face.n);
  if (distance < best.distance) best = {q, q == p - height * face.n ? face.n : n, distance};
}

// Looks at faces in their order, as `faceAt` numbers them.
template <class FaceAt>
void lookAt(const Polytope& hull, const Vec3& p, std::size_t count, FaceAt faceAt, NearestPoint& best) {
  for (std::size_t i = 0; i < count; ++i) {
    const Polytope::Face& face = hull.faces()[faceAt(i)];
    const double height = face.n.dot(p) - face.d;
    if (height > 0 && height < best.distance) offer(hull, face, p, height, best);
  }
}

// Seen from afar: the walk.
class FarSearch {
 public:
  FarSearch(const Polytope& hull, const Vec3& p) : hull_(hull), p_(p) {}

  // False: too many faces are as near to list them; `best` is as it was.
  bool find(const Polytope::Face& top, NearestPoint& best) {
    walk(static_cast<int>(&top - hull_.faces().data()));
    if (!gather()) return false;
    lookAt(
        hull_, p_, near_count_, [&](std::size_t i) { return static_cast<std::size_t>(near_[i]); }, best);
    return true;
  }

 private:
  // Takes a face that comes nearer than the one where the walk is.
  bool tryFace(int f) {
    const Polytope::Face& face = hull_.faces()[static_cast<std::size_t>(f)];
    const double height = face.n.dot(p_) - face.d;
    if (f == face_ || !(height > 0) || height * height >= least2_) return false;
    const OnFace on = nearestOnFace(hull_, face, p_, height);
    const double distance2 = (p_ - on.q).squaredNorm();
    if (!(distance2 < least2_)) return false;
    least2_ = distance2;
    face_ = f;
    at_ = on;
    return true;
  }

  // Faces that meet in a corner: each is beside two of its edges.
  template <class Visit>
  void facesAt(int vertex, Visit visit) const {
    for (const int e : hull_.edgesAt(vertex)) {
      visit(hull_.edges()[static_cast<std::size_t>(e)].left);
      visit(hull_.edges()[static_cast<std::size_t>(e)].right);
    }
  }

  // From a face to the one beside it, across an edge or around a corner, as long as that comes nearer. It ends at the
  // nearest point of all: where p isn't over any face that meets there, the solid is convex.
  void walk(int start) {
    tryFace(start);
    for (bool goes_on = true; goes_on && at_.edge >= 0;) {
      const Polytope::Face& face = hull_.faces()[static_cast<std::size_t>(face_)];
      const auto k = static_cast<std::size_t>(at_.edge);
      const std::span<const int> loop = hull_.cornersOf(face);
      goes_on = false;
      if (at_.along > 0 && at_.along < 1) {
        const Polytope::Edge& edge = hull_.edges()[static_cast<std::size_t>(hull_.edgesOf(face)[k])];
        goes_on = tryFace(edge.left == face_ ? edge.right : edge.left);
      } else {
        const int corner = loop[at_.along > 0 ? (k + 1) % loop.size() : k];
        facesAt(corner, [&](int f) { goes_on = tryFace(f) || goes_on; });
      }
    }
  }

  // All faces with a corner on the plane through the walk's end, in order; false: too many to list.
  bool gather() {
    const Vec3 n = (p_ - at_.q).normalized();
    // Corners of one face lie off its plane by as much.
    const double on_plane = n.dot(at_.q) - 4 * Polytope::kFlat * 2 * hull_.boundingRadius();
    bool fits = true;
    for (std::size_t v = 0; fits && v < hull_.vertices().size(); ++v) {
      if (n.dot(hull_.vertices()[v]) < on_plane) continue;
      facesAt(static_cast<int>(v), [&](int f) {
        fits = fits && near_count_ < near_.size();
        if (fits) near_[near_count_++] = f;
      });
    }
    std::sort(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(near_count_));
    return fits;
  }

  const Polytope& hull_;
  Vec3 p_;
  int face_ = -1;
  OnFace at_;
  double least2_ = std::numeric_limits<double>::infinity();
  std::array<int, 128> near_;  // a corner of a scanned part joins some ten faces, twice each; more are all looked at
  std::size_t near_count_ = 0;
};

}  // namespace

NearestPoint nearestPoint(const Convex& convex, const Vec3& p_BC) {
  const Polytope& hull = *convex.hull;
  const Polytope::Face* top = &hull.faces().front();
  double highest = -std::numeric_limits<double>::infinity();
  for (const Polytope::Face& face : hull.faces()) {
    const double height = face.n.dot(p_BC) - face.d;
    if (height > highest) highest = height, top = &face;
  }
  if (highest <= 0) return {p_BC - highest * top->n, top->n, highest};
  NearestPoint best{p_BC, top->n, std::numeric_limits<double>::infinity()};
  // A walk costs as much as a look at some forty faces; both ways give the same bits.
  const bool sees_many = hull.faces().size() > kManyFaces && highest > kFar * hull.boundingRadius();
  if (sees_many && FarSearch(hull, p_BC).find(*top, best)) return best;
  lookAt(
      hull, p_BC, hull.faces().size(), [](std::size_t i) { return i; }, best);
  return best;
}

}  // namespace pincer::contact
