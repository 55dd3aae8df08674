// revolved: meshes of round things: a profile turned about the z axis.
#pragma once
#include <span>
#include <vector>

#include "pincer/tasks/view/draw_list.h"

namespace pincer::tasks {

// A place of the profile: distance from the axis and height, and the normal there. Two of the same
// place with different normals are an edge.
struct ProfilePoint {
  double r, z;
  double n_r, n_z;
};
using Profile = std::vector<ProfilePoint>;

// Adds an arc about (0, z) with radius `r`, from `from` to `to` [rad], 0 at the equator, pi/2 at the
// top; `inside`: normals towards its centre.
void addArc(Profile& profile, double z, double r, double from, double to, int parts, bool inside = false);

// The profile, from top to bottom on the outside, turned about z.
ViewMesh revolve(const Profile& profile, int segments);

}  // namespace pincer::tasks
