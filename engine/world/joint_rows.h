// joint_rows: stops, dry friction and drives at their limits, as contacts of three rows (t1, t2, n) like all others.
//
//   stop    n: the coordinate, phi = q - lower or upper - q, mu = 0, e = 0 or the joint's.
//           t1, t2: of a mover of its own, W_tt = W_nn
//   brake   t1: the coordinate, or a drive's l.   t2, n: of a mover of its own, W_nn = w, q_n = -w h F, mu = 1
//   drive   a brake with F half its range and a third column 1/sqrt(m^) in t1;  q_t1 = l'_free - l' - p / m^
//
// Coulomb's law has u_n = 0 for a brake that holds and for one that slips (de Saxce's shift cancels there), so r_n =
// h F whatever t1 does, and |r_t1| <= h F opposes the slip: a box by the cone. A brake that holds is anchored as any
// contact that sticks is: it doesn't creep. A drive's r_t1 is p + m^ (l' - l'+) within its limits; what the middle
// of its range is acts as a constant force.
//
// Left out where certain: a stop that the coordinate doesn't reach; the friction of a joint that goes on in one
// direction, a constant force; a drive that stays within its limits (it is in M^), or beyond them (a constant force);
// the friction of a joint that held with half of it to spare, and on whose links nothing pushed (not in a tree with
// loops): its column is locked, for rigid bodies that touch and stuck joints would ask for more than forces can tell.
// All of that is looked at after the solve, and where it was wrong the row is put in and all is solved again. In an
// impact there are stops only: friction and drives give nothing in no time.
#pragma once
#include "pincer/engine/state.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// The most that there can be at once.
int jointRowsOf(const WorldModel& model);

// Sizes the rows and drives of a scratch.
void sizeJointRows(const WorldModel& model, WorldScratch& scratch);

// At the start of a part of a tick: which rows are sure to be needed, and the laws of drives and constant
// forces without them. Before predictTrees.
void startJointRows(const WorldModel& model, const WorldState& state, WorldScratch& scratch);

// After predictTrees: puts the rows that are wanted among the contacts, in place of those that are there.
void putJointRows(const WorldModel& model, const WorldState& state, WorldScratch& scratch);

// Adds the stops that are hit in this part of the tick to scratch.impact_pairs.
void noteStopHits(const WorldModel& model, WorldScratch& scratch);

// When the joint hits the stop [s] after the start of this part of the tick, on the way that the
// solved contacts give; infinity if it doesn't.
double timeOfStop(const WorldModel& model, const WorldState& state, const WorldScratch& scratch,
                  const JointRowScratch& row);

// After the solve: true if something that was left out has to be put in.
bool reviseJointRows(const WorldModel& model, const WorldState& state, WorldScratch& scratch);

// Adds an impulse along a row's coordinate or drive to those of the tree, by columns.
void addAlong(const WorldModel& model, const JointRowScratch& row, double impulse, TreeScratch& s);
// The row in terms of the tree's columns, scaled as A is; returns its outermost column.
int scaledRow(const WorldModel& model, const JointRowScratch& row, TreeScratch& s);

// Notes for the next tick what drives and friction did.
void rememberJointRows(const WorldModel& model, WorldState& state, WorldScratch& scratch);

}  // namespace pincer::engine
