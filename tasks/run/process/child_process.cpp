#include "pincer/tasks/run/process/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>
#include <thread>
#include <utility>

#include "pincer/tasks/run/process/interrupted.h"

namespace pincer::tasks {
namespace {

// Time between two looks at the child; chosen: short beside the second that it has to end.
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
  // Standard output into the pipe.
  explicit SpawnActions(int pipe_end) {
    must(posix_spawn_file_actions_init(&actions_));
    if (const int error = posix_spawn_file_actions_adddup2(&actions_, pipe_end, STDOUT_FILENO); error != 0) {
      posix_spawn_file_actions_destroy(&actions_);
      must(error);
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

std::vector<char*> environmentWithout(std::string_view beginning) {
  std::vector<char*> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    if (beginning.empty() || !std::string_view(*variable).starts_with(beginning)) variables.push_back(*variable);
  }
  variables.push_back(nullptr);
  return variables;
}

pid_t spawn(std::vector<std::string>& arguments, const SpawnActions& actions, std::string_view kept_from_it = {}) {
  const SpawnAttributes attributes;
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  must(posix_spawnp(&child, argv[0], actions.get(), attributes.get(), argv.data(),
                    environmentWithout(kept_from_it).data()));
  return child;
}

class Pipe {
 public:
  Pipe() { must(::pipe2(ends_, O_CLOEXEC) == 0 ? 0 : errno); }
  ~Pipe() {
    for (const int end : ends_) {
      if (end >= 0) ::close(end);
    }
  }
  Pipe(Pipe&&) = delete;
  int input() const { return ends_[1]; }
  int takeOutput() { return std::exchange(ends_[0], -1); }

 private:
  int ends_[2] = {-1, -1};
};

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> arguments, const std::string& directory, const char* log,
                           std::string_view kept_from_it)
    : child_(spawn(arguments, SpawnActions(directory, log), kept_from_it)) {}

ChildProcess::ChildProcess(std::vector<std::string> arguments) {
  Pipe pipe;
  child_ = spawn(arguments, SpawnActions(pipe.input()));
  heard_ = pipe.takeOutput();
}

ChildProcess::~ChildProcess() {
  if (heard_ >= 0) ::close(heard_);
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

int ChildProcess::wait(const std::function<bool()>& interrupted) {
  while (!ended()) {
    if (interrupted()) throw Interrupted();
    std::this_thread::sleep_for(kLook);
  }
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
}

bool ChildProcess::readLine(std::string& line, const std::function<bool()>& interrupted) {
  while (begun_.find('\n') == std::string::npos) {
    if (interrupted()) throw Interrupted();
    pollfd pipe{heard_, POLLIN, 0};
    constexpr int kWait = 20;  // [ms]
    if (::poll(&pipe, 1, kWait) <= 0) continue;
    char some[512];
    const ssize_t count = ::read(heard_, some, sizeof some);
    if (count < 0 && errno == EINTR) continue;
    if (count > 0) begun_.append(some, static_cast<std::size_t>(count));
    if (count <= 0 && begun_.empty()) return false;
    if (count <= 0) begun_ += '\n';
  }
  const std::size_t end = begun_.find('\n');
  line = begun_.substr(0, end);
  begun_.erase(0, end + 1);
  return true;
}

bool ChildProcess::ended() {
  if (child_ != 0 && ::waitpid(child_, &status_, WNOHANG) == child_) child_ = 0;
  return child_ == 0;
}

}  // namespace pincer::tasks
