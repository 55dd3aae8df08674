#include "pincer/contact/assert.h"

#include <cstdio>
#include <cstdlib>

namespace pincer {

void endOnBrokenPromise(const char* file, int line, const char* condition, const char* message) noexcept {
  if (message) {
    std::fprintf(stderr, "%s:%d: %s (%s doesn't hold). The program that calls pincer has to guarantee it.\n", file,
                 line, message, condition);
  } else {
    std::fprintf(stderr, "%s:%d: %s doesn't hold. That is an error in pincer: please report it with what led to it.\n",
                 file, line, condition);
  }
  std::abort();
}

}  // namespace pincer
