// tree_inertia: the inertia of a tree by columns.
//
//   M = T^T M_q T,     M_q,ij = s_i . I^c_j s_j (i on the path of j) + armature,     T = dv/du, the shares
//
//   s_j    motion of coordinate j
//   I^c_j  inertia of its link and all outboard of it, each about its own joint, so that a fingertip
//          at the end of a long arm keeps its digits
//
// Source: R. Featherstone, Rigid Body Dynamics Algorithms, 2008, section 6.2 (composite rigid bodies).
#pragma once
#include <span>
#include <vector>

#include "pincer/engine/tree/tree_kinematics.h"

namespace pincer::engine {

// Inertia of a link and all outboard of it about its joint.
struct CompositeInertia {
  double mass = 0;
  Vec3 first = Vec3::Zero();   // mass times the centre from the joint [kg m]
  Mat3 second = Mat3::Zero();  // [kg m^2]
};

// Fills `M` (TreeModel::entries), packed as sparse_ldl.h wants it. `composite`: one per link, scratch.
void fillInertia(const TreeModel& tree, const TreePlace& place, std::span<CompositeInertia> composite,
                 std::span<double> M);

}  // namespace pincer::engine
