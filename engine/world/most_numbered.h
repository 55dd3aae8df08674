// most_numbered: how many bodies, and how many driven points, a world can have.
#pragma once

namespace pincer::engine {

// contactId (contact.h) has so many bits for either number; beyond, contacts
// would share ids and take each other's memory.
constexpr int kNumberBits = 15;
constexpr int kMostNumbered = 1 << kNumberBits;

}  // namespace pincer::engine
