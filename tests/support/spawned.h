// spawned: the program pincer in a process of its own: its streams, limits, signals and memory as a test wants them.
#pragma once
#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

namespace pincer::tests {

struct Spawned {
  int exit_code = -1;  // -1: ended by a signal
  int signal = 0;
  std::string out, error;
};

struct SpawnOptions {
  std::vector<std::string> environment = {};   // NAME=VALUE, besides this process's
  std::vector<int> closed = {};                // of 0, 1 and 2
  std::string out_path = {}, error_path = {};  // where these go; empty: they are kept
  std::function<void()> prepare = {};          // in the child before the program begins; async-signal-safe
  std::function<void(pid_t)> meanwhile = {};   // in this process, once it runs
};

// `arguments` without the program's name.
Spawned spawnPincer(const std::vector<std::string>& arguments, const SpawnOptions& options = {});

}  // namespace pincer::tests
