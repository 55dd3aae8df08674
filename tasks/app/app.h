// app: the program `pincer`: finds the subcommand, runs it, and turns what went wrong into a sentence and an exit code.
#pragma once

namespace pincer::tasks {

// Exit codes of the program, the same for every subcommand.
enum ExitCode : int {
  kExitOk = 0,
  kExitCheckFailed = 1,  // an expectation or a bound wasn't met
  kExitUsage = 2,        // the command line itself
  kExitBadInput = 3,     // a file or a value in it; an output that can't be written
  kExitDevice = 4,       // a device is missing or failed
  kExitInterrupted = 5,  // Ctrl-C: finished cleanly, but before the end
};

int runApp(int argc, char** argv);

}  // namespace pincer::tasks
