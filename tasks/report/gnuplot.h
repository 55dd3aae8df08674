// gnuplot: runs the plotting program (Debian package gnuplot-nox) on one script, without a shell, in a temporary directory of its own.
//
// Errors: InputError if the program is missing (with the remedy) or rejects the script (with what it said); Interrupted, the program ended.
#pragma once
#include <atomic>
#include <string>
#include <utility>
#include <vector>

namespace pincer::tasks {

// One picture: what a gnuplot script draws from data files that lie beside it.
struct Figure {
  std::string name;  // letters, digits, - and _; the file's name without extension
  std::string title, caption;
  std::string script;                                     // draws to the terminal that plot() sets
  int width = 1600, height = 900;                         // [pixels]; shown at half the size, sharp on fine screens
  std::vector<std::pair<std::string, std::string>> data;  // file name (.csv) and content
};

// Text as gnuplot's single-quoted string; line ends become spaces.
std::string gnuplotString(const std::string& text);

class Gnuplot {
 public:
  // A name to look up in PATH, or a path. A picture that isn't finished when `interrupted` (null: never) comes true ends with Interrupted.
  explicit Gnuplot(std::string program = "gnuplot", const std::atomic<bool>* interrupted = nullptr);
  Gnuplot(Gnuplot&&) = delete;
  ~Gnuplot();
  std::string plot(const Figure& figure);  // the PNG's bytes
  std::string svg(const Figure& figure);   // the same picture, scalable

 private:
  std::string draw(const Figure& figure, const std::string& terminal, const char* ending);
  int run(const std::string& script_name);
  std::string program_, directory_;
  const std::atomic<bool>* interrupted_;
};

}  // namespace pincer::tasks
