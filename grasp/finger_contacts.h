// finger_contacts: which bodies each finger touches, in this tick.
#pragma once
#include "grasp/step.h"

namespace pincer::grasp {

// Adds a contact (finger's proxy on body) to scratch.world for every body within the contact margin, and writes each finger's gap to its
// nearest body and the direction of it. Geometry at the predicted middle of the tick. Advances the trackers in `state`.
void findFingerContacts(const GraspModel& model, GraspState& state, GraspScratch& scratch);

}  // namespace pincer::grasp
