#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/process.h"

namespace {

// Before the constants of this program and of its libraries are made, some of which allocate: OpenMesh's, CLI11's.
using Beginning = void (*)(int, char**, char**);
[[gnu::section(".preinit_array"), gnu::used]] const Beginning kFirst = [](int, char**, char**) {
  pincer::tasks::sayWhenMemoryEnds();
};

}  // namespace

int main(int argc, char** argv) {
  pincer::tasks::prepareProcess();
  return pincer::tasks::runApp(argc, argv);
}
