// bullet_memory: Bullet takes what malloc gives for granted, and would write to address zero where it gives nothing.
#pragma once

namespace pincer::contact {

// From now on Bullet's allocations throw std::bad_alloc. Before whatever of Bullet allocates.
void letBulletThrow();

}  // namespace pincer::contact
