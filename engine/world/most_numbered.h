// most_numbered: how many bodies, and how many driven points, a world can have.
#pragma once

namespace pincer::engine {

// A power of two: contactId (scratch.h) has 15 bits for either number; beyond, contacts would share ids and take each other's memory.
constexpr int kMostNumbered = 1 << 15;

}  // namespace pincer::engine
