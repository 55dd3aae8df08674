#include "pincer/tasks/lab/report/gnuplot.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/run/process/child_process.h"

namespace pincer::tasks {

namespace {

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string makeTemporaryDirectory() {
  std::error_code none;
  std::string path = (std::filesystem::temp_directory_path(none) / "pincer-plot-XXXXXX").string();
  if (none)
    throw InputError(
        "TMPDIR names no directory, and plots need one for a moment. Set TMPDIR to one that you may write, or unset "
        "it.");
  if (::mkdtemp(path.data())) return path;
  throw InputError(fmt::format("{}: can't make a temporary directory: {}. Set TMPDIR to one that you may write.", path,
                               std::strerror(errno)));
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
Gnuplot::Gnuplot(std::string program, const std::atomic<bool>* interrupted)
    : program_(program.find('/') == std::string::npos ? std::move(program)
                                                      : std::filesystem::absolute(program).string()),
      directory_(makeTemporaryDirectory()),
      interrupted_(interrupted) {}

Gnuplot::~Gnuplot() {
  try {
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
  } catch (const std::bad_alloc&) {  // the system clears its temporary directory
  }
}

std::string Gnuplot::plot(const Figure& figure) {
  return draw(figure,
              fmt::format("pngcairo noenhanced size {},{} font 'DejaVu Sans,20' linewidth 2 background '#ffffff'",
                          figure.width, figure.height),
              "png");
}

std::string Gnuplot::svg(const Figure& figure) {
  return draw(figure,
              fmt::format("svg noenhanced size {},{} fixed font 'DejaVu Sans,20' linewidth 2 background '#ffffff'",
                          figure.width, figure.height),
              "svg");
}

std::string Gnuplot::draw(const Figure& figure, const std::string& terminal, const char* ending) {
  for (const auto& [name, content] : figure.data) writeAtomically(directory_ + "/" + name, content);
  const std::string script = figure.name + ".gp", picture = fmt::format("{}.{}", figure.name, ending);
  writeAtomically(directory_ + "/" + script,
                  fmt::format("set terminal {}\nset output '{}'\n{}", terminal, picture, figure.script));
  const int status = run(script);
  std::string drawn = read(directory_ + "/" + picture);
  if (status == 0 && !drawn.empty()) return drawn;
  fail(figure, status, read(directory_ + "/log"));
}

void Gnuplot::fail(const Figure& figure, int status, const std::string& log) const {
  for (const char* empty :
       {"no valid points", "undefined!", "range is invalid", "must be > 0", "greater than 0 for log"}) {
    if (log.find(empty) != std::string::npos)
      throw NothingToDraw(fmt::format("figure {}: nothing can be drawn.", figure.name));
  }
  if (log.find("terminal type") != std::string::npos) {
    throw InputError(fmt::format(
        "{}: lacks the pngcairo or svg terminal. Install one that has both (Debian: apt-get install gnuplot-nox).",
        program_));
  }
  throw InputError(fmt::format(
      "{}: figure {} can't be drawn (status {}): {} The session itself is unharmed; `pincer export` has its tables.",
      program_, figure.name, status, complaintOf(log)));
}

int Gnuplot::run(const std::string& script_name) {
  try {
    // nobody's ~/.gnuplot, GNUTERM, GNUPLOT_LIB
    ChildProcess child({program_, "-d", script_name}, directory_, "log", "GNU");
    return child.wait([this] { return interrupted_ && *interrupted_; });
  } catch (const std::system_error& error) {
    throw InputError(
        fmt::format("{}: can't run the plotting program: {}. The report's pictures need gnuplot (Debian: apt-get "
                    "install gnuplot-nox); "
                    "the session itself is unharmed.",
                    program_, error.code().message()));
  }
}

}  // namespace pincer::tasks
