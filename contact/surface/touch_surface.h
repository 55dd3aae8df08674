// touch_surface: the up to three places at which one finger touches one surface: follow those that there are, look out
// for others, ease what comes and goes (follow.h, lookout.h, ease.h).
#pragma once
#include "pincer/contact/surface/follow.h"
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

// Contacts of a finger of radius `r` about `p_BC` that are nearer than `margin` [m]; the main one is told of wherever
// it is. Allocates nothing, throws nothing.
SurfaceContacts touchSurface(const FeltSurface& surface, const SurfaceSearch& search, const Vec3& p_BC, double r,
                             double margin, SurfaceTracker& tracker);

}  // namespace pincer::contact
