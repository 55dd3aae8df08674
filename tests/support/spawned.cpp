#include "pincer/tests/support/spawned.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tests {
namespace {

std::vector<char*> pointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

void sendTo(const std::string& path, int stream) {
  const int file = ::open(path.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0644);
  ::dup2(file, stream);
  if (file != stream) ::close(file);
}

}  // namespace

Spawned spawnPincer(const std::vector<std::string>& arguments, const SpawnOptions& options) {
  const TemporaryDirectory directory;
  const std::string out = options.out_path.empty() ? directory / "out" : options.out_path;
  const std::string error = options.error_path.empty() ? directory / "error" : options.error_path;
  std::vector<std::string> words = arguments, variables = options.environment;
  words.insert(words.begin(), PINCER_BINARY_DIR "/pincer");
  for (char** variable = environ; *variable; ++variable) variables.emplace_back(*variable);
  const std::vector<char*> argv = pointersTo(words), envp = pointersTo(variables);
  const pid_t child = ::fork();
  if (child == 0) {
    sendTo(out, STDOUT_FILENO);
    sendTo(error, STDERR_FILENO);
    for (const int stream : options.closed) ::close(stream);
    if (options.prepare) options.prepare();
    ::execve(argv[0], argv.data(), envp.data());
    ::_exit(127);
  }
  if (options.meanwhile) options.meanwhile(child);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  Spawned spawned{WIFEXITED(status) ? WEXITSTATUS(status) : -1, WIFSIGNALED(status) ? WTERMSIG(status) : 0, "", ""};
  if (options.out_path.empty()) spawned.out = readFile(out);
  if (options.error_path.empty()) spawned.error = readFile(error);
  return spawned;
}

}  // namespace pincer::tests
