// obj_lines: the words of a text file, line by line, and the errors that name a line.
//
// A line ends with LF or CRLF; "#" starts a comment; a backslash at the end of a line continues it; words are separated by blanks and
// tabs; a UTF-8 byte order mark at the start is skipped. Source: Wavefront, "Object Files (.obj)", appendix B1 of the manual.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pincer::contact {

class ObjLines {
 public:
  // `text` must outlive this object; `name` stands for the file in messages.
  ObjLines(std::string_view text, std::string name);

  // Moves on to the next line that has words; false at the end of the file.
  bool next();
  const std::vector<std::string_view>& words() const { return words_; }
  int line() const { return line_; }

  // Throw InputError "name:line: message", for the current line or an earlier one. A defect on a last line without an end says so.
  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void failAt(int line, const std::string& message) const;

  // The value of a word. Throw InputError naming `what` unless it is a finite number, an integer of 32 bits.
  double number(std::string_view word, std::string_view what) const;
  std::int32_t integer(std::string_view word, std::string_view what) const;

 private:
  void splitLine(std::string_view line);

  std::string_view rest_;
  std::string name_;
  std::vector<std::string_view> words_;
  int line_ = 0;
  int lines_joined_ = 0;
  bool last_line_is_open_ = false;  // the current line is the file's last and has no line end
};

// A word of the file as it may stand in a message: at most 40 characters, unprintable ones as "?".
std::string inQuotes(std::string_view word);

}  // namespace pincer::contact
