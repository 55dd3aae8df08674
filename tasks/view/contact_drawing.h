// contact_drawing: contacts of a snapshot as things to draw.
//
//   place    a ball and the normal; of a tip that touches at several places a ball each, larger for more force
//   patch    of a soft pad a disc: its area is shared out like the force. Of a flat tip the outline of its places
//   force    an arrow along the force on the finger; cone: of friction, its half opening is atan(mu)
//
// Sticking green, slipping red.
#pragma once
#include "pincer/tasks/view/scene_drawing.h"

namespace pincer::tasks {

struct ContactLook {
  MarkMeshes marks;
  int cone = 0;                  // its mesh
  double metres_per_newton = 0;  // of force arrows
};

void addContacts(const Snapshot& snapshot, const ViewChoice& choice, const ContactLook& look, DrawList& list);

// Newtons beside the arrows. Forces between the same two things are written as their sum; those of the body `selected`
// (-1: none) one by one, of a tip with several contacts with the share of its force.
std::vector<ViewLabel> contactLabels(const Snapshot& snapshot, const ContactLook& look, int selected = -1);

// Of the normal force of the contact's finger: 1 for its only contact, and for one of two bodies.
double shareOfFinger(const Snapshot& snapshot, const ContactSnapshot& contact);

}  // namespace pincer::tasks
