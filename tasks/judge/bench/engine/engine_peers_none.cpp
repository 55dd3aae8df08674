#include "pincer/tasks/judge/bench/engine/bench_world.h"

namespace pincer::tasks {

std::vector<Contestant> enginePeers() { return {}; }
std::vector<Contestant> familyPeers() { return {}; }

}  // namespace pincer::tasks
