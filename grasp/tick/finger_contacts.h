// finger_contacts: which bodies each finger touches, in this tick.
#pragma once
#include "pincer/grasp/tick/scratch.h"

namespace pincer::grasp {

// Adds a contact (finger's proxy on body) to scratch.world for every body within the contact margin, and writes the finger's gap to its
// nearest body and the direction of it. Geometry at the predicted middle of the tick. Advances the finger's trackers in `state`.
void findFingerContacts(const GraspModel& model, int finger, GraspState& state, GraspScratch& scratch);

// Contacts of one finger at X_WF with one body at X_WB, in the body's frame; p_BT its own points there.
contact::FingerContacts fingerOnBody(const GraspModel& model, GraspState& state, contact::PatchCache& patches, int finger, int body,
                                     const Pose& X_WB, const Pose& X_WF, double margin);

}  // namespace pincer::grasp
