// terminal: what the program may do to the terminal that it talks to: colour, a line that is drawn over.
#pragma once
#include <string>
#include <string_view>

namespace pincer::tasks {

enum class Stream { kOut, kError };

bool isTerminal(Stream stream);  // a person watches, not a file or a pipe; a "dumb" terminal doesn't count

// `text` in green or red where standard output is a terminal and NO_COLOR (https://no-color.org) is unset or empty;
// else `text` as it is.
std::string good(std::string_view text);
std::string bad(std::string_view text);

}  // namespace pincer::tasks
