#include "pincer/tests/campaign/program_run.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace pincer::campaign {
namespace {

constexpr int kNotStarted = 125;  // exit code of a child that could not become the program

void limitTo(__rlimit_resource what, rlim_t most) {
  const rlimit limit{most, most};
  ::setrlimit(what, &limit);
}

// A root without these rights is refused like any owner of the files.
void giveUpRightsOverFiles() {
  for (const int right : {CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH, CAP_FOWNER}) ::prctl(PR_CAPBSET_DROP, right, 0, 0, 0);
}

void openAs(int stream, const char* path, int flags) {
  const int file = ::open(path, flags, 0644);
  if (file < 0) ::_exit(kNotStarted);
  if (file != stream) {
    ::dup2(file, stream);
    ::close(file);
  }
}

void breakPipe(int stream) {
  int ends[2];
  if (::pipe(ends) != 0) ::_exit(kNotStarted);
  ::dup2(ends[1], stream);
  ::close(ends[0]);
  ::close(ends[1]);
}

void setUp(int stream, Stream kind, const std::string& kept_at) {
  const int access = stream == 0 ? O_RDONLY : O_WRONLY;
  switch (kind) {
    case Stream::kNothing:
      return openAs(stream, "/dev/null", access);
    case Stream::kKept:
      return openAs(stream, kept_at.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
    case Stream::kFull:
      return openAs(stream, "/dev/full", access);
    case Stream::kBrokenPipe:
      return breakPipe(stream);
    case Stream::kClosed:
      return;  // last, by closeStreams
  }
}

void closeStreams(const Launch& l) {
  if (l.in == Stream::kClosed) ::close(0);
  if (l.out == Stream::kClosed) ::close(1);
  if (l.error == Stream::kClosed) ::close(2);
}

void setLimits(const Launch& l) {
  if (l.most_memory > 0) limitTo(RLIMIT_AS, static_cast<rlim_t>(l.most_memory) << 20);
  if (l.largest_file > 0) limitTo(RLIMIT_FSIZE, static_cast<rlim_t>(l.largest_file));
  limitTo(RLIMIT_CORE, 0);
  if (l.owner_rights) giveUpRightsOverFiles();
}

[[noreturn]] void become(const Launch& l, std::vector<char*>& arguments) {
  ::setpgid(0, 0);
  if (::chdir(l.folder.c_str()) != 0) ::_exit(kNotStarted);
  for (const int signal : {SIGHUP, SIGINT, SIGTERM, SIGPIPE}) std::signal(signal, SIG_DFL);
  setUp(0, l.in, "");
  setUp(1, l.out, l.log / "stdout");
  setUp(2, l.error, l.log / "stderr");
  for (const auto& [name, value] : l.environment)
    value ? ::setenv(name.c_str(), value->c_str(), 1) : ::unsetenv(name.c_str());
  setLimits(l);
  closeStreams(l);
  ::execvp(arguments[0], arguments.data());
  ::_exit(kNotStarted);
}

std::string beginningOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(kMostText, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

// True once the program has ended, false at the time `until`.
bool awaitEnd(int handle, double until) {
  pollfd asked{handle, POLLIN, 0};
  for (;;) {
    const double left = until - now();
    const int came = ::poll(&asked, 1, static_cast<int>(std::max(0.0, 1e3 * left + 0.5)));
    if (came > 0) return true;
    if (came == 0) return false;
    if (errno != EINTR) throw std::runtime_error("poll failed");
  }
}

// The longest that a thread of the process has stood ready without getting a processor [s]; 0 where the kernel doesn't
// tell.
double waitedForProcessor(pid_t process) {
  double longest = 0;
  std::error_code ended;
  const std::filesystem::path threads = "/proc/" + std::to_string(process) + "/task";
  for (std::filesystem::directory_iterator thread(threads, ended), end; !ended && thread != end;
       thread.increment(ended)) {
    double ran = 0, waited = 0;  // [ns]
    if (std::ifstream(thread->path() / "schedstat") >> ran >> waited) longest = std::max(longest, 1e-9 * waited);
  }
  return longest;
}

std::string quoted(const std::string& text) {
  const bool plain =
      !text.empty() &&
      text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:") == text.npos;
  if (plain) return text;
  std::string out = "$'";
  for (const char c : text.substr(0, 300)) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\'' || c == '\\') out += '\\';
    if (byte >= 0x20 && byte < 0x7f) {
      out += c;
    } else {
      constexpr char kHex[] = "0123456789abcdef";
      out += {'\\', 'x', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return out + (text.size() > 300 ? "'...(" + std::to_string(text.size()) + " bytes)" : "'");
}

}  // namespace

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

RunningProgram::RunningProgram(const Launch& launch) : launch_(launch), began_(now()) {
  std::filesystem::create_directories(launch.log);
  std::vector<char*> arguments{launch_.program.data()};
  for (std::string& argument : launch_.arguments) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  process_ = ::fork();
  if (process_ < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
  if (process_ == 0) become(launch_, arguments);
  handle_ = static_cast<int>(::syscall(SYS_pidfd_open, process_, 0));  // glibc 2.36 declares its own for C only
  if (handle_ < 0) throw std::runtime_error(std::string("pidfd_open: ") + std::strerror(errno));
}

RunningProgram::RunningProgram(RunningProgram&& other) noexcept
    : launch_(std::move(other.launch_)),
      process_(std::exchange(other.process_, -1)),
      handle_(std::exchange(other.handle_, -1)),
      began_(other.began_) {}

RunningProgram::~RunningProgram() {
  if (process_ < 0) return;
  ::kill(-process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
  ::close(handle_);
}

bool RunningProgram::endsWithin(double time) const {
  for (double until = began_ + time;;) {
    if (awaitEnd(handle_, until)) return true;
    const double later = began_ + time + waitedForProcessor(process_);
    if (later <= until) return false;
    until = later;
  }
}

Ended RunningProgram::wait() {
  Ended e;
  bool over = false;
  if (launch_.blow && !(over = endsWithin(launch_.blow->after))) {
    e.struck = true;
    ::kill(process_, launch_.blow->signal);
  }
  over = over || endsWithin(launch_.limit);
  if (!over) {
    e.stopped = true;
    ::kill(process_, launch_.stop_signal);
    over = awaitEnd(handle_, now() + launch_.grace);
  }
  e.hung = !over;
  if (e.hung) ::kill(-process_, SIGKILL);
  int status = 0;
  rusage usage{};
  ::wait4(process_, &status, 0, &usage);
  ::kill(-process_, SIGKILL);  // what it left behind
  e.seconds = now() - began_;
  e.peak_memory = usage.ru_maxrss;
  if (WIFSIGNALED(status)) e.signal = WTERMSIG(status);
  if (WIFEXITED(status)) e.exit_code = WEXITSTATUS(status);
  if (launch_.out == Stream::kKept) e.out = beginningOf(launch_.log / "stdout");
  if (launch_.error == Stream::kKept) e.error = beginningOf(launch_.log / "stderr");
  ::close(handle_);
  process_ = -1;
  return e;
}

Ended run(const Launch& launch) { return RunningProgram(launch).wait(); }

std::string shellText(const Launch& launch) {
  std::string text;
  for (const auto& [name, value] : launch.environment) {
    if (name.ends_with("DISPLAY")) continue;  // never set for any case
    text += (value ? name + "=" + quoted(*value) : "env -u " + name) + " ";
  }
  text += quoted(launch.program);
  for (const std::string& argument : launch.arguments) text += " " + quoted(argument);
  if (launch.in == Stream::kClosed) text += " <&-";
  if (launch.out == Stream::kClosed) text += " >&-";
  if (launch.error == Stream::kClosed) text += " 2>&-";
  if (launch.out == Stream::kFull) text += " > /dev/full";
  if (launch.error == Stream::kFull) text += " 2> /dev/full";
  if (launch.out == Stream::kBrokenPipe) text += " | true";
  return text;
}

}  // namespace pincer::campaign
