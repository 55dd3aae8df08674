// play_hash: what both scenes of the page that computes come to; the same bits from every build (tasks/play/build).
#include <cstdio>

#include "pincer/tasks/play/play_session.h"

int main() {
  for (const char* scene : {"pickup", "pinch"}) {
    const auto hash = static_cast<unsigned long long>(pincer::tasks::hashOfScript(scene, pincer::tasks::kScriptTicks));
    std::printf("%s %016llx\n", scene, hash);
  }
}
