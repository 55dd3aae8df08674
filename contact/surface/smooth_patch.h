// smooth_patch: the patch over one triangle as surface_net.h makes it of
// SurfaceVariant::smooth, where no side is a crease.
#pragma once
#include <array>

#include "pincer/contact/surface/patch.h"

namespace pincer::contact {

// Corners [m] counter-clockwise seen from outside, unit normals at them; in one frame.
Patch smoothPatch(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals);

}  // namespace pincer::contact
