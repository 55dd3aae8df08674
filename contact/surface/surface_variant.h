// surface_variant: the one place where the variants of shading part.
#pragma once
#include "pincer/contact/surface/shell_solver.h"
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

// The contact of a finger of radius `r` [m] about `C` that is followed from `start`, as `variant` has it. Allocates nothing, throws nothing.
ShellContact followContact(SurfaceVariant variant, const SurfaceNet& net, PatchCache& cache, const Vec3& C, double r, const Foot& start);

}  // namespace pincer::contact
