// tree_motion: trees in a tick, between what the engine knows of bodies and what trees know of their
// coordinates (engine/tree/tree_course.h).
//
//   gained = M^^-1 (sum over links J^T (impulse, moment) + impulses along joints),   u+ = u_free + gained
//
// Links are bodies to all else: their motions at the start, without contact at the end, and at the end stand
// in BodyScratch, their poses in the state.
#pragma once
#include <span>

#include "pincer/engine/state.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// [rad]: of what turns so far in a part of a tick, its middle doesn't show the way
constexpr double kFarTurn = 0.5;

// All that acts on a tree in this part of the tick but contacts and joints' rows.
TreePush pushOn(const WorldScratch& scratch, const TreeModel& tree, const TreeScratch& s);

// Free courses; links' places in the middle and motions. After drives and constant forces are set
// (joint_rows.h) and driven bodies are predicted.
void predictTrees(const WorldModel& model, const WorldState& state, WorldScratch& scratch);
// Predicts an impact, in which no time passes: M without drives, springs and dampers.
void predictTreeImpacts(const WorldModel& model, const WorldState& state, WorldScratch& scratch);

// Applies the gathered impulses on links and joints to the trees; links' own impulses get what their joints answer.
void gatherTrees(const WorldModel& model, WorldScratch& scratch);

// To the end of this part of the tick.
void advanceTrees(const WorldModel& model, WorldState& state, WorldScratch& scratch);

// True if something of a tree turns so far in this part of the tick that its middle
// doesn't show how it goes. After gatherTrees.
bool treesTurnFar(const WorldModel& model, const WorldState& state, const WorldScratch& scratch);

// After an impact: the velocities of what was struck.
void strikeTrees(const WorldModel& model, WorldState& state, WorldScratch& scratch);

// Place and motion of a link `t` after the start of this part of the tick, once its contacts are solved.
struct LinkMoment {
  Pose X_WI;
  Motion motion;
};
LinkMoment linkAt(const WorldModel& model, const WorldState& state, WorldScratch& scratch, int body, double t);

// Makes room for trees in a state whose bodies are placed, reads their coordinates and rates off these, and puts the
// links where the joints hold them. Throws InputError where a coordinate isn't where the one that it follows has it.
void readTrees(const WorldModel& model, WorldState& state);

// Energies of the coordinates' armatures and of their springs [J].
double armatureEnergy(const WorldModel& model, const WorldState& state);
double springEnergy(const WorldModel& model, const WorldState& state);

}  // namespace pincer::engine
