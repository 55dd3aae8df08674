// shell_solver: the surface point over whose normal a fingertip's centre lies, followed from where it was last.
//
//   C = S(u,v) + h N(u,v)      three equations for u, v, h
//
//   Newton on a face:  R = C - S, h = R.N / N.N, T = R - h N, A = Su + h Nu, B = Sv + h Nv, X = B x N, det = A.X,
//                      du = T.X / det, dv = T.(N x A) / det
//   C  fingertip centre, S  surface point [m], N  normal [-], T  residual: what is left across the normal [m]; frame B
//
// Safeguards: where det < 0.1 (Su x Sv).N (near the centre of a concave curvature) or the step leads away from T by
// more than acos 0.2, it goes along T instead, with the gain 1 / (1 + |kappa h|), kappa the curvature that way; a step
// that raises |T| is halved. Crossing a smooth edge: the step is cut at the edge and goes on from the same point of the
// neighbour. On an edge or vertex that both sides' steps leave, the contact is the edge point or vertex (shell_edge.h).
//
// Source of the equation: A. J. Doxon et al., Presence 20(6), 2011; of Newton's form and
// the feature states: this project's design.
#pragma once
#include <cstdint>

#include "pincer/contact/surface/shell_contact.h"
#include "pincer/contact/surface/surface_net.h"

namespace pincer::contact {

// Walks from `start` to a solution for centre `C`. Allocates nothing, throws nothing.
ShellContact solveShell(const SurfaceNet& net, PatchCache& cache, const Vec3& C, const Foot& start);

// The solution beside the place to which `start` moves with a centre that has moved by `dC` [m], over smooth edges as
// on the flat mesh, if one Newton step leads there; else not converged. What most ticks need: one look at one patch.
ShellContact solveShellBeside(const SurfaceNet& net, PatchCache& cache, const Vec3& C, const Foot& start,
                              const FootMotion& motion, const Vec3& dC);

// The contact with the tangent plane at `foot`, whatever its residual: what is held where there is no solution.
ShellContact tangentContact(const SurfaceNet& net, PatchCache& cache, const Vec3& C, const Foot& foot);

}  // namespace pincer::contact
