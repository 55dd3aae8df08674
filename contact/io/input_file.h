// input_file: how the program reads every file that it is given: a regular file of a
// size that its kind allows, and nothing else.
//
// A directory, pipe, socket or device is refused by name and never waited for (so /dev/stdin is taken only where a file
// is redirected to it: a pipe has no size that could be checked, and what went wrong in it could not be named by its
// lines). The size is counted while reading, because a file may grow and a file of the kernel says that it has none. A
// NUL byte in a text is refused with its line: parsers take it for the text's end.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "pincer/contact/error.h"

namespace pincer {

// A kind of file: its name in messages and its limits. docs/limits.md lists all kinds.
struct InputKind {
  std::string_view name;    // "a scene (a JSON file, docs/scenes.md)"
  std::size_t most_bytes;   // a larger file is refused
  bool is_text;             // holds no NUL byte
  std::string_view remedy;  // where it is too large: a sentence
};

constexpr std::size_t kMegabyte = std::size_t{1} << 20;  // [bytes]

// The longest line of a table [bytes]: 500 columns of 130 characters; without a
// bound a file without line ends would be one.
constexpr std::size_t kLongestTableLine = std::size_t{1} << 16;

// A file that was checked and is open for reading.
class InputFile {
 public:
  // Throws InputError: there is none, it isn't a regular file, it can't be opened, it is too large.
  InputFile(const std::string& path, const InputKind& kind);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  // All that is left. Throws InputError: too large, unreadable, a NUL byte in a text.
  std::string readAll();

  // The next line without its end (LF or CRLF), valid until the next call; false at the end of the file. Throws as
  // above, and for a line longer than kLongestTableLine.
  bool nextLine(std::string_view& line);
  std::int64_t line() const { return line_; }  // of the last one, from 1

 private:
  bool fill();  // appends to buffer_; false at the end of the file
  [[noreturn]] void refuse(const std::string& problem) const;

  std::string path_;
  InputKind kind_;
  int file_ = -1;
  std::size_t size_ = 0;  // as the file system has it: a hint
  std::size_t read_ = 0;  // so far
  std::string buffer_;
  std::size_t position_ = 0;  // in buffer_, of the next line
  std::int64_t line_ = 0;
};

std::string readInputFile(const std::string& path, const InputKind& kind);

// Throws InputError "name:line: ..." if the text holds a NUL byte; `first_line` is the number of the text's first line.
void refuseNul(std::string_view text, const std::string& name, std::int64_t first_line = 1);

// Throws InputError unless `path` is a regular file, for libraries that open files by themselves.
void requireRegularFile(const std::string& path, std::string_view kind_name);

}  // namespace pincer
