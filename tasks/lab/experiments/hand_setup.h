// hand_setup: the fingertips of a pinching hand and what couples them to their arms, shared by both manipulation tasks.
#pragma once

namespace pincer::tasks {

struct HandSetup {
  double finger_radius = 8e-3;       // [m], 0.002 .. 0.02
  double coupling_stiffness = 1000;  // of finger and proxy [N/m], 50 .. 3500 (what the arm renders stably)
  double coupling_damping = 5;       // [N s/m], 0 .. 30
  // of the pads about their contact normals [N m/rad], 0 .. 10; rigid ones (0 and no damping) slip in nearly
  // every tick where arms tremble (docs/grasp.md)
  double twist_stiffness = 0.3;
  double twist_damping = 1e-3;  // [N m s/rad], 0 .. 1
};

}  // namespace pincer::tasks
