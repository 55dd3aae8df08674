#include "tasks/report/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "contact/error.h"
#include "contact/file/atomic_file.h"

namespace pincer::tasks {

namespace {

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string makeTemporaryDirectory() {
  std::string path = (std::filesystem::temp_directory_path() / "pincer-plot-XXXXXX").string();
  if (::mkdtemp(path.data())) return path;
  throw InputError(
      fmt::format("{}: can't make a temporary directory: {}. Set TMPDIR to one that you may write.", path, std::strerror(errno)));
}

// The lines of a log that say what is wrong: those with a place in a script. Between them gnuplot repeats the script.
std::string complaintOf(const std::string& log) {
  std::string complaint;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("\" line ") != std::string::npos) complaint += (complaint.empty() ? "" : "; ") + line;
  }
  return complaint.empty() ? "it said nothing." : complaint + ".";
}

// The child starts in `directory`, reads nothing and says everything into `log`.
class SpawnActions {
 public:
  SpawnActions(const std::string& directory, const char* log) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addchdir_np(&actions_, directory.c_str());
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, log, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
  }
  SpawnActions(SpawnActions&&) = delete;
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

}  // namespace

std::string gnuplotString(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'.\"'\".'";
    } else {
      quoted += (c >= 0 && c < ' ') || c == 0x7f ? ' ' : c;
    }
  }
  return quoted + "'";
}

std::string gnuplotTic(const std::string& text) {
  std::string label;
  for (const char c : text) label.append(c == '%' ? 2 : 1, c);
  return gnuplotString(label);
}

// The child runs elsewhere, so a relative path must be made absolute; a bare name is looked up in PATH.
Gnuplot::Gnuplot(std::string program)
    : program_(program.find('/') == std::string::npos ? std::move(program) : std::filesystem::absolute(program).string()),
      directory_(makeTemporaryDirectory()) {}

Gnuplot::~Gnuplot() {
  std::error_code ignored;
  std::filesystem::remove_all(directory_, ignored);
}

std::string Gnuplot::plot(const Figure& figure) {
  return draw(
      figure,
      fmt::format("pngcairo noenhanced size {},{} font 'DejaVu Sans,20' linewidth 2 background '#ffffff'", figure.width, figure.height),
      "png");
}

std::string Gnuplot::svg(const Figure& figure) {
  return draw(
      figure,
      fmt::format("svg noenhanced size {},{} fixed font 'DejaVu Sans,20' linewidth 2 background '#ffffff'", figure.width, figure.height),
      "svg");
}

std::string Gnuplot::draw(const Figure& figure, const std::string& terminal, const char* ending) {
  for (const auto& [name, content] : figure.data) writeAtomically(directory_ + "/" + name, content);
  const std::string script = figure.name + ".gp", picture = fmt::format("{}.{}", figure.name, ending);
  writeAtomically(directory_ + "/" + script, fmt::format("set terminal {}\nset output '{}'\n{}", terminal, picture, figure.script));
  const int status = run(script);
  std::string drawn = read(directory_ + "/" + picture);
  if (status == 0 && !drawn.empty()) return drawn;
  fail(figure, status, read(directory_ + "/log"));
}

void Gnuplot::fail(const Figure& figure, int status, const std::string& log) const {
  for (const char* empty : {"no valid points", "undefined!", "range is invalid", "must be > 0", "greater than 0 for log"}) {
    if (log.find(empty) != std::string::npos) throw NothingToDraw(fmt::format("figure {}: nothing can be drawn.", figure.name));
  }
  if (log.find("terminal type") != std::string::npos) {
    throw InputError(
        fmt::format("{}: lacks the pngcairo or svg terminal. Install one that has both (Debian: apt-get install gnuplot-nox).", program_));
  }
  throw InputError(
      fmt::format("{}: figure {} can't be drawn (status {}): {} The session itself is unharmed; `pincer export` has its tables.", program_,
                  figure.name, status, complaintOf(log)));
}

int Gnuplot::run(const std::string& script_name) {
  const SpawnActions actions(directory_, "log");
  std::string program = program_, defaults = "-d", script = script_name;  // -d: nobody's ~/.gnuplot
  char* arguments[] = {program.data(), defaults.data(), script.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, program_.c_str(), actions.get(), nullptr, arguments, environ);
  if (error != 0) {
    throw InputError(
        fmt::format("{}: can't run the plotting program: {}. The report's pictures need gnuplot (Debian: apt-get install gnuplot-nox); "
                    "the session itself is unharmed.",
                    program_, std::strerror(error)));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace pincer::tasks
