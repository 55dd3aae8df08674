// killed_at_call: a process of its own that is killed at its n-th system call, by ptrace(2). Moments between two calls
// differ in nothing that a file system keeps, so that all n are all moments.
#pragma once
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace pincer::tests {

enum class Ended { kKilled, kByItself, kNotTraced };

// Continues a stopped child to its next stop. False: it has ended.
inline bool goOn(pid_t child, int& status) {
  return ::ptrace(PTRACE_SYSCALL, child, nullptr, nullptr) == 0 && ::waitpid(child, &status, 0) == child &&
         WIFSTOPPED(status);
}

// Calls are those of the child's first thread, from 0, killed as it enters the call. `act` must not return.
template <class Act>
Ended killedAtCall(int call, const Act& act) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0) ::raise(SIGSTOP);
    act();
    ::_exit(1);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || !WIFSTOPPED(status)) return Ended::kNotTraced;
  bool runs = goOn(child, status);
  for (int stop = 0; runs && stop < 2 * call; ++stop)
    runs = goOn(child, status);  // each call stops twice: as it begins and as it ends
  if (!runs) return Ended::kByItself;
  ::kill(child, SIGKILL);
  while (!WIFSIGNALED(status) && ::waitpid(child, &status, 0) == child) {
  }
  return Ended::kKilled;
}

}  // namespace pincer::tests
