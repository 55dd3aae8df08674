// tree_kinematics: where a tree's links are, and how its columns move them.
//
//   X_WL = X_WP X_PJ (turn or slide by q) X_LJ^-1;     w_L = w_P + sum of axis v,    v_i = share_i u of its column
//
// All in world axes, places from O, the first joint's, so that a tree far from the world's origin loses no digits.
#pragma once
#include <span>
#include <vector>

#include "pincer/engine/motion.h"
#include "pincer/engine/tree.h"

namespace pincer::engine {

// The links' carrier: pose and motion of its frame.
struct TreeBase {
  Pose X_WB;
  Motion motion;
  Vec3 a_W = Vec3::Zero(), alpha_W = Vec3::Zero();  // acceleration of its origin and of its turn [m/s^2, rad/s^2]
};

struct LinkPlace {
  Quat q_WL = Quat::Identity();
  Vec3 p_OL = Vec3::Zero(), p_OJ = Vec3::Zero();  // of the centre of mass, of the joint on the link
  Motion motion;                                  // of the centre of mass
};

// A coordinate's axis, and its rate over its column's.
struct CoordinatePlace {
  Vec3 axis_W = Vec3::UnitZ();
  double share = 1, share_rate = 0;  // and the derivative of that in time [1/s]
};

struct TreePlace {
  explicit TreePlace(const TreeModel& tree) : links(tree.links.size()), coordinates(tree.coordinates.size()) {}
  Vec3 p_WO = Vec3::Zero();
  std::vector<LinkPlace> links;
  std::vector<CoordinatePlace> coordinates;
};

// Places, axes and shares at q (q_count).
void placeLinks(const TreeModel& tree, const TreeBase& base, std::span<const double> q, TreePlace& place);
// Motions, and how shares change, at the columns' rates u. After placeLinks at the same q.
void moveLinks(const TreeModel& tree, const TreeBase& base, std::span<const double> q, std::span<const double> u,
               TreePlace& place);

Pose linkPose(const TreePlace& place, int link);  // X_WL

// q + step by columns: a ball turns by its three, what follows another one follows. `q` and `out` may be the same.
void growCoordinates(const TreeModel& tree, std::span<const double> q, std::span<const double> step,
                     std::span<double> out);

// Columns' rates of those of coordinates, and back; the latter after placeLinks.
void ratesOfColumns(const TreeModel& tree, std::span<const double> v, std::span<double> u);
void ratesOfCoordinates(const TreeModel& tree, const TreePlace& place, std::span<const double> u, std::span<double> v);

// The motion of a point at p_OX on a link that coordinate i moves, for a unit of the coordinate's rate.
inline Motion unitMotion(const TreeModel& tree, const TreePlace& place, std::size_t i, const Vec3& p_OX) {
  const Vec3& axis_W = place.coordinates[i].axis_W;
  const auto link = static_cast<std::size_t>(tree.coordinates[i].link);
  if (tree.links[link].kind == JointKind::kSlider) return {axis_W, Vec3::Zero()};
  return {axis_W.cross(p_OX - place.links[link].p_OJ), axis_W};
}

// f(coordinate) for all that move `link`, the outermost first.
template <class F>
void forEachCoordinateOf(const TreeModel& tree, int link, F f) {
  for (int l = link; l >= 0; l = tree.links[static_cast<std::size_t>(l)].parent) {
    const TreeLink& at = tree.links[static_cast<std::size_t>(l)];
    for (int k = coordinatesOf(at.kind) - 1; k >= 0; --k) f(static_cast<std::size_t>(at.first_v + k));
  }
}

// J += n . v at p_OX plus m . w of a link, by columns; nothing but those on the path of the link's tip changes.
void addJacobian(const TreeModel& tree, const TreePlace& place, int link, const Vec3& p_OX, const Vec3& n_W,
                 const Vec3& m_W, std::span<double> J);

// impulse += J^T of an impulse through a link's centre of mass and one that turns it, by columns.
void addWrench(const TreeModel& tree, const TreePlace& place, int link, const Vec3& f_W, const Vec3& moment_W,
               std::span<double> impulse);

}  // namespace pincer::engine
