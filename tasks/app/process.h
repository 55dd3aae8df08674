// process: what the program settles with the system before anything else, and what it says when there is no other way.
#pragma once
#include <string_view>

namespace pincer::tasks {

// Once, first thing in main():
// - file descriptors 0, 1 and 2 are open, so that no session, opened next, gets one of them and with it the program's
//   messages. Those that were closed can neither be read nor written: what is printed there fails as on a full disk;
// - signals (interrupt.h);
// - what sayWhenMemoryEnds() says.
void prepareProcess();

// From now on the program says so and ends with exit code 3, in place of SIGABRT, where memory ends in a place that
// can't throw. main() comes too late for constants that are made before it.
void sayWhenMemoryEnds() noexcept;

// "pincer: <what>\n" on standard error, from any state of the program: allocates nothing, throws nothing.
void complain(std::string_view what) noexcept;

// The sentence for when memory ends, and what to do.
inline constexpr std::string_view kNotEnoughMemory =
    "not enough memory. Close other programs, allow this one more (ulimit -v), or give it less at once. Of a session "
    "that ran, finished "
    "trials "
    "are kept: go on with --resume.";

// While it lives, what is printed on standard output goes to standard error: for
// libraries that talk there of their own accord.
class StandardOutputAside {
 public:
  StandardOutputAside();
  ~StandardOutputAside();
  StandardOutputAside(const StandardOutputAside&) = delete;
  StandardOutputAside& operator=(const StandardOutputAside&) = delete;

 private:
  int kept_ = -1;
};

}  // namespace pincer::tasks
