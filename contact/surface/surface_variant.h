// surface_variant: the one place where the variants of shading part.
#pragma once
#include <array>
#include <string_view>

#include "contact/surface/shell_solver.h"
#include "contact/surface/surface_contact.h"

namespace pincer::contact {

// The contact of a finger of radius `r` [m] about `C` that is followed from `start`, as `variant` has it. Allocates nothing, throws nothing.
ShellContact followContact(SurfaceVariant variant, const SurfaceNet& net, PatchCache& cache, const Vec3& C, double r, const Foot& start);

// As scenes and the command line name them: smooth, facet, force, smooth_published.
constexpr std::array<std::string_view, 4> kSurfaceVariantNames = {"smooth", "facet", "force", "smooth_published"};

}  // namespace pincer::contact
