// pad_query: where a flat-faced fingertip touches a shape, as a patch of points.
//
// On a solid the facets are laid over each other (pad_contacts.h). A mesh is felt as its smooth surface: the points are
// those of its flat triangles where these are the surface, and else the pad's deepest place, the deepest of each edge
// of the facet that faces the surface, and those that lie downhill of its corners (the far rim of a hollow).
#pragma once
#include "pincer/contact/finger_query.h"

namespace pincer::contact {

// Of a finger that is a PadTip or a CapsuleTip with a solid: what the two share. False if there is none within the
// margin (of a capsule with a body that isn't convex, too): one nearest place is all there is to find.
bool touchOnFacets(const Shape& solid, const FingerShape& finger, const Pose& X_BF, double margin,
                   FingerTracker& tracker, PatchCache& cache, FingerContacts& found);

// As queryFinger, of a finger that is a PadTip.
FingerContacts queryPad(const Shape& shape, const FingerShape& finger, const Pose& X_BF, double margin,
                        FingerTracker& tracker, PatchCache& cache);

}  // namespace pincer::contact
