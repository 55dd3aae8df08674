// island_bias: makes what the touching contacts of an island ask for the motion of its bodies.
//
//   minimise over z  sum_i w_i^2 |A_i z + b_i|^2,   b_i <- -A_i z
//
//   A_i  of ContactProblem: how contact i's velocity follows the movers' scaled velocities z [kg^-1/2]
//   b_i  bias of contact i [m/s]: along the normal it corrects the gap, along the tangents the stick
//        offset. Of sliding contacts the normal alone
//   w_i  10 along normals, 1 along the rest [-], as in stick_bias.h
//
// Around loops of bodies (balls in a box) gaps and offsets can ask for what no motion gives. Rigid contacts then press
// against each other without limit, and the solver finds no answer because there is none. What is left here can be had:
// by the motion z, at which all of these contacts stay shut. Of hundreds of contacts a few steps are taken per tick:
// what is left is fitted again in the next one. So it is with a rod between two pads, too, which two contacts each
// hold, and with two soft fingers, none of which turns: they may ask one thing for two twists about nearly one axis,
// and their torsions would wind each other up to the limit of friction. Where the contacts don't contradict each other
// b stays what it is. Pairs alone are made consistent by stick_bias.h, at less cost. Source: conjugate gradients on the
// normal equations (M. Hestenes, E. Stiefel, J. Res. Natl. Bur. Stand. 49 (1952) 409-436, section 10).
#pragma once
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// Which contacts push, and which of them stick.
enum class PushingBy : std::uint8_t {
  kLastTick,  // those that did in the last tick, but for what closes in this one
  kImpulses,  // those that `r` has in their cones
  // those that `r` has in their cones, all of them as if they stuck: of a point in a groove that locks (wedge.h)
  kWedged,
};

// True if the problem's contacts may contradict each other: around a loop of bodies, or by torsion.
bool mayContradict(const ContactProblem& problem);

// True if contacts that push ask for next to nothing, whichever of their rows take part: then a fit changes nothing.
// The problem's sides aren't read.
bool askForNothing(const ContactProblem& problem, const double* r, std::span<const int> order,
                   const std::vector<Contact>& contacts);

// Where mayContradict(problem): fits bias_C and the stick offsets of the island's contacts, and corrects problem.q
// through `q`. `r`: impulses of the last tick, or the best that were found in this one; `order`: which of `contacts`
// the problem's are; `memory` is working memory. True if it changed anything. Allocates nothing.
//   offset_rate  bias_T = offset_rate (offset_T + h v_start_T / 2) [1/s]
bool fitIslandBiases(PushingBy pushing, double h, double offset_rate, const ContactProblem& problem, const double* r,
                     double* q, std::span<const int> order, std::vector<Contact>& contacts, SolverScratch& memory);

// After it, the same of velocities `u` [m/s] at the impulses `r`, of contacts that a tree carries along: joints keep
// faces parallel that hold one thing, which asks more of it than it has freedoms, and a tick's chords don't agree on
// where its arc ends. What no motion gives goes out of q, up to
//   h^2 |w|^2 (|v| + |w x p|) / 24, of the bodies on both sides     w, v, p  of a body, and from its centre to the
//                          contact: chord and arc of both; up to 0.1 rad per tick
// or it would be added to friction within the thing, tick by tick, until a face lets go (a box in two coupled jaws,
// swung by 2 rad: 2 mm). Nothing changes if that is exceeded, or nothing turns.
void fitToTurn(double h, double offset_rate, const ContactProblem& problem, const double* r, const double* u, double* q,
               std::span<const int> order, std::vector<Contact>& contacts, SolverScratch& memory);

// Where the solver found an answer only for q + `give`: what the contacts ask for, and q, become what they get.
void giveWay(double h, double offset_rate, const ContactProblem& problem, const double* give, double* q,
             std::span<const int> order, std::vector<Contact>& contacts);

}  // namespace pincer::engine
