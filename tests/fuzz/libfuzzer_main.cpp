// libfuzzer_main: the entry that libFuzzer calls, for the one target that the build names.
#include "pincer/tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  pincer::fuzz::PINCER_FUZZ_TARGET({bytes, size});
  return 0;
}
