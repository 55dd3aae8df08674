#include <algorithm>

#include "pincer/devices/falcon/falcon_packet.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {

void falcon_packet(Bytes input) {
  using namespace devices::falcon;
  AnswerReader reader;
  std::int64_t garbled = 0;
  while (!input.empty()) {
    const std::size_t length = std::min<std::size_t>(input[0], input.size() - 1);
    const auto answer = reader.read(input.subspan(1, length));
    input = input.subspan(1 + length);
    if (answer)
      for (const int counts : answer->counts) demand(counts >= -32768 && counts <= 32767, "counts have 16 bits");
    if (answer) demand(answer->buttons < 16 && answer->homed < 8, "four buttons, three encoders");
    demand(reader.garbled() >= garbled, "what is garbled is counted");
    garbled = reader.garbled();
  }
}

}  // namespace pincer::fuzz
