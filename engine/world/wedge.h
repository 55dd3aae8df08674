// wedge: a driven point between two walls of one body that lock it.
//
//   2 alpha = pi - angle(n_1, n_2)                  opening of the groove
//   mu > tan(alpha)                                 it locks: f_1 + f_2 = 0 has solutions,
//                                                   and any pull is held by squeezing enough
//   (f_1 + f_2) . b < 0.1 * 2 sin(alpha) S          it holds the point by squeezing: mu <- tan(alpha) / 2
//
//   n_i, f_i   normals and forces of the last tick;  S  the lesser normal force [N]
//   b = (n_1 + n_2)/|n_1 + n_2|,  out of the groove
//
// Rigid walls that lock may squeeze by any amount, whatever pressed the point in: a problem with many answers, of which
// the one that never lets go is none that skin and plastic know. There the squeeze is what the point was pressed in
// with, S <= P / (2 sin(alpha)), and it comes out when pulled by P tan(phi - alpha) / tan(phi + alpha), phi = atan(mu),
// never more than the press P (both walls springs of one stiffness in all directions). We let go where the pull begins.
// Pressed in, friction is that of both walls: sliding along the groove takes mu P / sin(alpha). Source: K. L. Johnson,
// Contact Mechanics, Cambridge 1985, section 7.2 (that stick depends on how the load came); the rule is ours.
#pragma once
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// True if `problem` is a point's between walls and has no answer: none was found, or one (`r`) that squeezes by more
// than a thousand times what the speeds ask for. In a groove that locks, walls that contradict each other by some um/s
// (one lands while the point sticks at the other) have none (point_problem.h). island_bias.h makes them agree.
bool isWedged(const ContactProblem& problem, const double* r, const SolveResult& result);

// Lowers Contact::mu of recalled contacts, sorted by id, where walls hold a point by squeezing. Allocates nothing.
void loosenWedges(WorldScratch& scratch);

}  // namespace pincer::engine
