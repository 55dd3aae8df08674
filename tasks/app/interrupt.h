// interrupt: one policy for signals, for all commands.
//
//   INT, TERM, HUP   the first sets a flag: what works for long looks at it, keeps what is whole, removes
//                    what isn't, and ends with exit code 5. One that comes 0.2 s later or more ends the
//                    program at once; sooner it is the same wish (`timeout` signals a program and its
//                    group). HUP stays ignored where it was (nohup)
//   PIPE, XFSZ       ignored: the write fails, and is reported like any other (a closed
//                    pipe, a file over the limit of its size)
#pragma once
#include <atomic>

namespace pincer::tasks {

// Once, at the start of the program. Before, a signal does what the system does by itself.
void handleSignals();

// True once the user wants the program to end.
const std::atomic<bool>& interruptFlag();

}  // namespace pincer::tasks
