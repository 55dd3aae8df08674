// gnuplot: runs the plotting program (Debian package gnuplot-nox) on one script, without a
// shell, in a temporary directory of its own.
//
// Errors: InputError if the program is missing (with the remedy) or rejects the script (with what
// it said); Interrupted, the program ended.
#pragma once
#include <atomic>
#include <string>
#include <utility>
#include <vector>

#include "pincer/contact/error.h"

namespace pincer::tasks {

// One picture: what a gnuplot script draws from data files that lie beside it.
struct Figure {
  std::string name;  // letters, digits, - and _; the file's name without extension
  std::string title, caption;
  std::string script;                                     // draws to the terminal that plot() sets
  int width = 1600, height = 900;                         // [pixels]; shown at half the size, sharp on fine screens
  std::vector<std::pair<std::string, std::string>> data;  // file name (.csv) and content
};

// Text as a string of gnuplot's: in single quotes, in which nothing is expanded; a single quote in it stands in double
// ones, joined by dots, since gnuplot 5.4 mistakes two in a row for the end. Control characters become blanks.
std::string gnuplotString(const std::string& text);

// The same for the label of a tic, which gnuplot takes for a format of its number.
std::string gnuplotTic(const std::string& text);

// A figure none of whose numbers can be drawn: no trial was finished yet, or none measured what it shows.
class NothingToDraw : public InputError {
 public:
  using InputError::InputError;
};

class Gnuplot {
 public:
  // A name to look up in PATH, or a path. A picture that isn't finished when `interrupted` (null:
  // never) comes true ends with Interrupted.
  explicit Gnuplot(std::string program = "gnuplot", const std::atomic<bool>* interrupted = nullptr);
  Gnuplot(Gnuplot&&) = delete;
  ~Gnuplot();
  // Throws NothingToDraw, or InputError with gnuplot's own complaint.
  std::string plot(const Figure& figure);  // the PNG's bytes
  std::string svg(const Figure& figure);   // the same picture, scalable

 private:
  std::string draw(const Figure& figure, const std::string& terminal, const char* ending);
  int run(const std::string& script_name);
  [[noreturn]] void fail(const Figure& figure, int status, const std::string& log) const;
  std::string program_, directory_;
  const std::atomic<bool>* interrupted_;
};

}  // namespace pincer::tasks
