// drive_rows: drives in a tick, and what their limits make of them: a part of M, a
// constant force, or a brake (joint_rows.h).
//
//   r = clamp(p + m^ (l' - l'+)),   h lower_force <= r <= h upper_force        m^, p: engine/tree/drive_law.h
#pragma once
#include "pincer/engine/state.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

bool isLimited(const DriveModel& drive);

// The control that the drive takes of what it is told: at the ends of its range it stands.
DriveInput withinControls(const DriveModel& drive, const DriveInput& told);

// Place of a control that goes from `before` to `end` in `left`, after a share of that: on the cubic with both rates.
DriveInput controlAt(const DriveInput& before, const DriveInput& end, double left, double share);

// At the start of a part of a tick: the drive's law, and what the tree feels of it by itself.
void startDrive(const WorldModel& model, const WorldState& state, const TreeDrive& own, WorldScratch& scratch,
                DriveTick& out);

// Its law where the tree is without it, and its row where one is wanted.
void putDrive(const WorldModel& model, const WorldState& state, int slot, JointRowScratch& row, WorldScratch& scratch);

// After the solve: its force. True if it isn't where it was taken to be, and gets a row.
bool reviseDrive(const WorldModel& model, const WorldState& state, JointRowScratch& row, WorldScratch& scratch);

// Notes for the next tick what it did.
void rememberDrive(const WorldModel& model, const JointRowScratch& row, WorldState& state, WorldScratch& scratch);

}  // namespace pincer::engine
