#include "pincer/tasks/app/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

namespace pincer::tasks {
namespace {

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::string coloured(std::string_view text, int colour) {
  if (!isTerminal(Stream::kOut) || !environment("NO_COLOR").empty()) return std::string(text);
  return fmt::format("\x1b[{}m{}\x1b[0m", colour, text);
}

}  // namespace

bool isTerminal(Stream stream) {
  return isatty(stream == Stream::kOut ? STDOUT_FILENO : STDERR_FILENO) == 1 && environment("TERM") != "dumb";
}

std::string good(std::string_view text) { return coloured(text, 32); }
std::string bad(std::string_view text) { return coloured(text, 31); }

}  // namespace pincer::tasks
