#include "pincer/tasks/judge/solve/problem_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>

#include "pincer/contact/io/input_file.h"
#include "pincer/contact/io/printable.h"

namespace pincer::tasks {
namespace {

// 512 MB bounds the memory that a mistaken file takes; chosen.
constexpr InputKind kProblemFile = {"a contact problem (a text file, docs/engine.md)", 512 * kMegabyte, true,
                                    "Split it into islands that don't share a body."};

// Words of a text, with their line.
class Words {
 public:
  explicit Words(const std::string& path) : path_(path), text_(readInputFile(path, kProblemFile)) {}

  std::string_view next() {
    skip();
    const std::size_t begin = at_;
    while (at_ < text_.size() && !isSpace(text_[at_])) ++at_;
    return std::string_view(text_).substr(begin, at_ - begin);
  }
  void expect(std::string_view word) {
    const std::string_view found = next();
    if (found != word) refuse(fmt::format("\"{}\" where `{}` was expected", printable(found), word));
  }
  double number(const char* what) { return parse<double>(what, "a finite number"); }
  int integer(const char* what, int least, int most) {
    const int value = parse<int>(what, "a whole number");
    if (value < least || value > most) refuse(fmt::format("{} {}; it must be {} to {}", what, value, least, most));
    return value;
  }
  bool ends() {
    skip();
    return at_ == text_.size();
  }
  [[noreturn]] void refuse(const std::string& problem) const {
    throw InputError(fmt::format("{}:{}: {}.", printable(path_), line_, problem));
  }

 private:
  static bool isSpace(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }
  void skip() {
    for (; at_ < text_.size() && isSpace(text_[at_]); ++at_) line_ += text_[at_] == '\n';
  }
  template <class Number>
  Number parse(const char* what, const char* kind) {
    const std::string_view word = next();
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(static_cast<double>(value)))
      refuse(fmt::format("{} \"{}\" isn't {}", what, printable(word), kind));
    return value;
  }

  std::string path_, text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

void readMatrix(Words& words, Eigen::MatrixXd& W) {
  const int rows = static_cast<int>(W.rows());
  words.expect("W");
  const int entries = words.integer("number of entries", 0, rows * (rows + 1) / 2);
  for (int k = 0; k < entries; ++k) {
    const int row = words.integer("row", 0, rows - 1), column = words.integer("column", 0, row);
    W(row, column) = W(column, row) = words.number("entry");
  }
}

}  // namespace

engine::DenseProblem readContactProblem(const std::string& path) {
  Words words(path);
  words.expect("contacts");
  const int contacts = words.integer("number of contacts", 1, kMostProblemContacts), rows = 3 * contacts;
  engine::DenseProblem problem;
  words.expect("mu");
  for (int i = 0; i < contacts; ++i) problem.mu.push_back(words.number("friction"));
  words.expect("q");
  problem.q.resize(rows);
  for (int row = 0; row < rows; ++row) problem.q[row] = words.number("velocity");
  problem.W = Eigen::MatrixXd::Zero(rows, rows);
  readMatrix(words, problem.W);
  if (!words.ends()) words.refuse("more than a contact problem has");
  return problem;
}

}  // namespace pincer::tasks
