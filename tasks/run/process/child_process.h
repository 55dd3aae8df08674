// child_process: another program, without a shell. It never outlives the object that stands for it.
#pragma once
#include <sys/types.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace pincer::tasks {

class ChildProcess {
 public:
  // Starts arguments[0], looked up in PATH unless it holds a slash, in `directory`; it reads nothing and says
  // everything into the file `log` there. Of the environment it gets no variables whose names begin with
  // `kept_from_it`. Throws std::system_error where it can't be started.
  ChildProcess(std::vector<std::string> arguments, const std::string& directory, const char* log,
               std::string_view kept_from_it = {});
  // Likewise, here; what it says on standard output is read with readLine(), on standard
  // error it says it where this program does.
  explicit ChildProcess(std::vector<std::string> arguments);
  ~ChildProcess();  // ends it: SIGTERM, and after a second SIGKILL
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t process() const { return child_; }

  // Waits for its end. Returns its exit code, or 128 + the signal that ended it.
  // Throws Interrupted once `interrupted` says so.
  int wait(const std::function<bool()>& interrupted);
  // Waits for its next line, without the line's end. False: it has no more to say. Throws Interrupted.
  bool readLine(std::string& line, const std::function<bool()>& interrupted);

 private:
  bool ended();  // asks the system

  pid_t child_ = 0;
  int status_ = 0;
  int heard_ = -1;     // the pipe's end
  std::string begun_;  // of what was heard: after the last whole line
};

}  // namespace pincer::tasks
