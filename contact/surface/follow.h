// follow: where a contact of a finger has gone, as a function of the finger's place, the contact's foot and the mesh;
// nothing is remembered.
//
//   contact' = walk(C, foot)      C  finger's centre [m], frame B
//
// As the variant of the surface has it: the shell's equation (shell_solver.h), its iteration as it was published
// (published_iteration.h), or the flat triangles (flat_contact.h). `cache` holds patches, which are functions of the
// mesh.
#pragma once
#include <optional>

#include "pincer/contact/surface/shell_solver.h"
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

struct SurfaceSeed;

struct FeltSurface {
  SurfaceVariant variant;
  const SurfaceNet& net;
  PatchCache& cache;
};

// The contact of a finger of radius `r` [m] about `C` that a walk from `start` leads to. Allocates nothing, throws
// nothing.
ShellContact follow(const FeltSurface& surface, const Vec3& C, double r, const Foot& start);

// The one that the slot's contact has become now that the centre has moved by `dC` to `C`: one Newton step beside where
// its foot has moved, as a rule; else a walk.
ShellContact followSlot(const FeltSurface& surface, const Vec3& C, double r, const Vec3& dC, const SurfaceSlot& slot);

// True if `contact`, under the surface, was come to from well above it: there the equation has solutions too.
bool isFarSide(const FeltSurface& surface, const Vec3& C, double r, const SurfaceSlot& from,
               const ShellContact& contact);

// Contact with the place that a search found, whatever the normal there.
ShellContact straightTo(const FeltSurface& surface, const Vec3& C, const SurfaceSeed& seed);

// If the slot's contact is on an open border: contact with that place as a wire, which faces everywhere.
std::optional<ShellContact> wireUnder(const FeltSurface& surface, const Vec3& C, double r, const SurfaceSlot& slot);

}  // namespace pincer::contact
