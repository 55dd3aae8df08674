#include "tasks/measure/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>
#include <thread>

#include "tasks/measure/interrupted.h"

namespace pincer::tasks {
namespace {

constexpr auto kLook = std::chrono::milliseconds(2);
constexpr int kLooksBeforeKill = 500;  // a second

void must(int error) {
  if (error != 0) throw std::system_error(error, std::generic_category());
}

class SpawnActions {
 public:
  SpawnActions(const std::string& directory, const char* log) {
    must(posix_spawn_file_actions_init(&actions_));
    try {
      must(posix_spawn_file_actions_addchdir_np(&actions_, directory.c_str()));
      must(posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0));
      must(posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, log, O_WRONLY | O_CREAT | O_TRUNC, 0600));
      must(posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO));
    } catch (...) {
      posix_spawn_file_actions_destroy(&actions_);
      throw;
    }
  }
  SpawnActions(SpawnActions&&) = delete;
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

// The child doesn't ignore what this program does (tasks/app/interrupt.h).
class SpawnAttributes {
 public:
  SpawnAttributes() {
    must(posix_spawnattr_init(&attributes_));
    sigset_t usual;
    sigemptyset(&usual);
    for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM, SIGHUP}) sigaddset(&usual, signal);
    posix_spawnattr_setsigdefault(&attributes_, &usual);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF);
  }
  SpawnAttributes(SpawnAttributes&&) = delete;
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> arguments, const std::string& directory, const char* log) {
  const SpawnActions actions(directory, log);
  const SpawnAttributes attributes;
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  must(posix_spawnp(&child_, argv[0], actions.get(), attributes.get(), argv.data(), environ));
}

ChildProcess::~ChildProcess() {
  if (child_ == 0) return;
  ::kill(child_, SIGTERM);
  for (int look = 0; look < kLooksBeforeKill; ++look) {
    if (ended()) return;
    std::this_thread::sleep_for(kLook);
  }
  ::kill(child_, SIGKILL);
  while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

int ChildProcess::wait(const std::atomic<bool>& interrupted) {
  while (!ended()) {
    throwIf(interrupted);
    std::this_thread::sleep_for(kLook);
  }
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
}

bool ChildProcess::ended() {
  if (child_ != 0 && ::waitpid(child_, &status_, WNOHANG) == child_) child_ = 0;
  return child_ == 0;
}

}  // namespace pincer::tasks
