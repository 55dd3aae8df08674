// text_lines: the words and numbers of a text file, line by line, and the errors that name a line.
//
// A line ends with LF or CRLF; words are separated by blanks and tabs; a UTF-8 byte order mark at the start is skipped.
// Where the format has them, "#" starts a comment and a backslash at the end of a line continues it (Wavefront, "Object
// Files (.obj)", appendix B1 of the manual).
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/contact/mesh/mesh_file.h"

namespace pincer::contact {

struct LineRules {
  bool comments = false;
  bool continued = false;
};

class TextLines {
 public:
  // `file` must outlive this object.
  TextLines(MeshFile& file, LineRules rules);

  // Moves on to the next line that has words; false at the end of the file.
  bool next();
  const std::vector<std::string_view>& words() const { return words_; }
  std::int32_t line() const { return line_; }
  // Where the next line begins, and how many bytes there are from there on.
  std::size_t position() const { return position_; }
  std::size_t bytesLeft() const { return file_.bytes().size() - position_; }

  // Throws InputError "name:line: message" for the current line. A defect on a last line without an end says so.
  [[noreturn]] void fail(const std::string& message) const;

  // The value of a word. Throw InputError naming `what` unless it is a finite number, an integer of 64 bits.
  double number(std::string_view word, std::string_view what) const;
  std::int64_t integer(std::string_view word, std::string_view what) const;

 private:
  std::string_view takeLine();
  void splitLine(std::string_view line);
  [[noreturn]] void failAsNumber(std::string_view word, std::string_view what, bool out_of_range) const;

  MeshFile& file_;
  LineRules rules_;
  std::vector<std::string_view> words_;
  std::size_t position_ = 0;
  std::int32_t line_ = 0;
  std::int32_t lines_joined_ = 0;
  bool last_line_is_open_ = false;
};

}  // namespace pincer::contact
