// finger_contacts: which bodies each finger touches, in this tick.
#pragma once
#include "pincer/grasp/tick/scratch.h"

namespace pincer::grasp {

// Adds a contact (finger's proxy on body) to scratch.world for every shape of a body within the contact margin, and
// writes the finger's gap to its nearest body and the direction of it. Geometry at the predicted middle of the tick.
// Advances the finger's trackers in `state`.
void findFingerContacts(const GraspModel& model, int finger, GraspState& state, GraspScratch& scratch);

// Contacts of a finger at X_WF with a shape at X_WS, in the shape's frame; p_BT its own points there.
contact::FingerContacts fingerOnShape(const FingerModel& finger, const contact::Shape& shape, const Pose& X_WS,
                                      const Pose& X_WF, double margin, contact::FingerTracker& tracker,
                                      contact::PatchCache& patches);

}  // namespace pincer::grasp
