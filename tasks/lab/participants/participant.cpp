#include "pincer/tasks/lab/participants/participant.h"

namespace pincer::tasks {

const char* nameOf(HandPhase phase) {
  constexpr std::array<const char*, kHandPhases> names = {"listen", "reach", "close", "read",   "squeeze",
                                                          "lift",   "hold",  "turn",  "return", "rest"};
  return names[static_cast<std::size_t>(phase)];
}

}  // namespace pincer::tasks
