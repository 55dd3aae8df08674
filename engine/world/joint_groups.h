// joint_groups: which bodies hang together by joints, when a model is built.
#pragma once
#include "pincer/engine/model.h"

namespace pincer::engine {

// Sorts the joints by the group that they belong to: the lowest body that moving bodies and joints connect them
// with. Drives name them by their new places.
void groupJoints(WorldModel& model);

// Notes which groups something may touch, and which have one coordinate. Throws InputError
// where contacts can't know a group's freedoms.
void checkGroups(WorldModel& model);

// The freedoms that a group's bodies have together, if no joint is redundant.
int freedomsOf(const WorldModel& model, const JointGroup& group);

}  // namespace pincer::engine
