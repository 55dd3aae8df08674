#include <LinearMath/btAlignedAllocator.h>

#include <cstdlib>
#include <new>

#include "pincer/contact/surface/bullet_memory.h"

namespace pincer::contact {
namespace {

void* allocateOrThrow(std::size_t size) {
  if (void* block = std::malloc(size)) return block;
  throw std::bad_alloc();
}

}  // namespace

// Bullet's own are malloc and free as well, so that what was allocated before can be freed after.
void letBulletThrow() {
  static const bool once = (btAlignedAllocSetCustom(allocateOrThrow, std::free), true);
  static_cast<void>(once);
}

}  // namespace pincer::contact
