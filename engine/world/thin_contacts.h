// thin_contacts: of many points in one plane between the same two, four: feet of a stool, boxes of a pad, halves of a
// box. More carry nothing that these don't, cost the solver, and share the load as chance has it.
#pragma once
#include <cstddef>

#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// Of scratch.contacts from `first` on, which are of the same two bodies, or of a point and a body: keeps up to four of
// each plane and material, the deepest and those on which the two would land first if they rocked (point_choice.h), in
// their order. Among equally deep ones the outermost count. Those that `state` remembers stay for as long as no other
// is much better.
void thinContacts(const WorldState& state, std::size_t first, WorldScratch& scratch);

}  // namespace pincer::engine
