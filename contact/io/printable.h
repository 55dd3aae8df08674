// printable: text of others (file names, keys, values, names in meshes and sessions, strings of USB devices) as it may
// stand in a message or on a terminal: what it holds is seen, and nothing in it is obeyed.
//
// Valid UTF-8 stays as it is. Control characters (C0, DEL, C1), line and paragraph separators, marks that turn the
// direction of writing, and bytes that aren't UTF-8 are shown as C writes them: a backslash and n, t, x1b, u202e. A
// backslash stays as it is, so that text which was made printable before is not changed again.
#pragma once
#include <string>
#include <string_view>

namespace pincer {

// The longest key, value or name that a message repeats [characters]: a line of a
// terminal and a half; more tells nobody anything.
constexpr std::size_t kLongestEcho = 120;
// The longest message [characters]: some 25 lines of a terminal. The longest of ours has 700.
constexpr std::size_t kLongestMessage = 2000;

// One value on one line, at most `most` characters long; of a longer text the beginning, "..." and how long it was.
std::string printable(std::string_view text, std::size_t most = kLongestEcho);

// A path as somebody may copy it: whole, as far as any file system goes.
inline std::string printablePath(std::string_view path) { return printable(path, 4096); }

// A whole message: its line breaks stay. Of one longer than kLongestMessage the
// beginning and the end, where the remedy stands.
std::string printableMessage(std::string_view text);

}  // namespace pincer
