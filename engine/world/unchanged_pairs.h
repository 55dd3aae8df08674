// unchanged_pairs: contacts of two bodies that are those of the last attempt at a tick, or at a part of it, to the bit.
//
// A pair's contacts, what they ask for, and their rows are a function of where its bodies are and how fast, of what its
// contacts remember, and of the lengths of this part of the tick and of the last one. Where all of these are what they
// were, and the solve left the answer as it found it, the contacts are copied, or stay in their places as long as no
// other one comes between them. Memory, no heuristic: answers are the same bits with it and without. It pays in heaps:
// worlds with a broad phase, without hollows and trees.
#pragma once
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// How a body moves in this part of the tick, before contacts: its velocities, and its pose in the middle.
using BodyCourse = std::array<double, 19>;
inline BodyCourse courseOf(const BodyScratch& body) {
  const Motion &s = body.start, &f = body.free;
  const Vec3& p = body.X_WI_mid.p;
  const Quat& q = body.X_WI_mid.q;
  return {s.v_W.x(), s.v_W.y(), s.v_W.z(), s.w_W.x(), s.w_W.y(), s.w_W.z(), f.v_W.x(), f.v_W.y(), f.v_W.z(), f.w_W.x(),
          f.w_W.y(), f.w_W.z(), p.x(),     p.y(),     p.z(),     q.w(),     q.x(),     q.y(),     q.z()};
}

// Notes, after it was predicted, whether a body's course is the one that the last attempt's contacts were found for.
//   before  its course before that;   lone  nothing but itself, gravity and forces say where it goes
void noteCourse(const BodyCourse& before, bool lone, const WorldScratch& scratch, BodyScratch& body);

// Begins, once all is predicted, without contacts, those of the last attempt put aside.
//   again  something woke up: contacts of points stay, for what wakes is where it slept, and a second look, from where
//          the first one ended, would be another one by round-off
void beginContacts(const WorldState& state, bool again, WorldScratch& scratch);
// Begins without contacts, those of the last attempt forgotten.
void forgetContacts(WorldScratch& scratch);

// Adds the pair's contacts as they were. False where they have to be found.
bool keepContacts(const WorldModel& model, const WorldState& state, const BodyPair& pair, WorldScratch& scratch);
// Once all pairs of bodies were looked at, before anything else adds contacts.
void takeKept(WorldScratch& scratch);

// Fills the rows of contact i, one that was kept; first_row[i + 1] is known.
void keepRows(double longer, WorldScratch& scratch, int i);

// Notes what all contacts remember.
void noteMemories(const WorldState& state, WorldScratch& scratch);
// Once they are solved.
void noteSolved(const WorldState& state, WorldScratch& scratch);

}  // namespace pincer::engine
