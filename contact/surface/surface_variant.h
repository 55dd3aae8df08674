// surface_variant: the one place where the variants of shading part.
#pragma once
#include <string>

#include "contact/surface/shell_solver.h"
#include "contact/surface/surface_contact.h"

namespace pincer::contact {

// The contact for centre `C` that is followed from `start`, as `variant` has it. Allocates nothing, throws nothing.
ShellContact followContact(SurfaceVariant variant, const SurfaceNet& net, PatchCache& cache, const Vec3& C, const Foot& start);

// Throws InputError naming `source` where `variant` can't be had.
void requireVariant(SurfaceVariant variant, const std::string& source);

}  // namespace pincer::contact
