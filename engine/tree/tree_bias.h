// tree_bias: the forces that a tree's motion takes, by Newton and Euler, link by link.
//
//   tau = M u' + C
//   C = T^T (sum over links of J^T (m (a - g), I alpha + w x I w) - what is applied),  a and alpha at u' = 0
//
// Source: R. Featherstone, Rigid Body Dynamics Algorithms, 2008, section 5.3.
#pragma once
#include <span>
#include <vector>

#include "pincer/engine/tree/tree_kinematics.h"

namespace pincer::engine {

// A push on a link through its centre of mass, and one that turns it.
struct LinkForce {
  Vec3 f_W = Vec3::Zero();    // [N]
  Vec3 tau_W = Vec3::Zero();  // [N m]
};

struct LinkBias {
  Vec3 a_W, alpha_W;   // acceleration of the centre of mass less gravity, and of the turn
  Vec3 f_W, moment_W;  // that the joint carries; the moment about the joint
};

// C by columns, after placeLinks, and moveLinks at the same u. `forces`: one per link,
// or none. `links`: one per link, scratch.
void fillBias(const TreeModel& tree, const TreePlace& place, const TreeBase& base, const Vec3& gravity_W,
              std::span<const LinkForce> forces, std::span<const double> u, std::span<LinkBias> links,
              std::span<double> C);

}  // namespace pincer::engine
