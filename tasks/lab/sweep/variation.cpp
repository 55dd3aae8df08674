#include "pincer/tasks/lab/sweep/variation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "pincer/contact/elementary.h"
#include "pincer/contact/error.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/files/file_limits.h"

namespace pincer::tasks {
namespace {

[[noreturn]] void refuseVariation(const std::string& text, const std::string& why) {
  throw InputError(
      fmt::format("--vary {}: {} Write PATH=FROM:TO:N, PATH=FROM:TO:N:log or PATH=A,B,C; for example "
                  "sphere.material.mu_s=0.1:0.5:9",
                  printable(text), why));
}

std::vector<std::string> partsOf(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  stream.exceptions(std::ios::badbit);  // else it takes a lack of memory for the end
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

double valueIn(const std::string& text, const std::string& word) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0' || !std::isfinite(value))
    refuseVariation(text, fmt::format("\"{}\" isn't a number.", printable(word)));
  return value;
}

// After the point, of the 15 digits that a double keeps of numbers as large as `largest`.
int decimalsOf(double largest) {
  const std::string written = fmt::format("{:.0e}", largest);  // "3e-01"
  return std::clamp(14 - std::atoi(written.c_str() + written.find('e') + 1), 0, 330);
}

std::vector<double> rangeOf(const std::string& text, const std::vector<std::string>& parts) {
  const bool ratios = parts.size() == 4 && parts[3] == "log";
  if (parts.size() != 3 && !ratios) refuseVariation(text, "that isn't a range.");
  const double from = valueIn(text, parts[0]), to = valueIn(text, parts[1]), count = valueIn(text, parts[2]);
  if (!(count >= 2 && count <= 10'000) || count != std::floor(count))
    refuseVariation(text, "N isn't a whole number from 2 to 10000.");
  if (ratios && !(from > 0 && to > 0)) refuseVariation(text, "equal ratios need positive ends.");
  std::vector<double> values;
  const int last = static_cast<int>(count) - 1;
  const int decimals = decimalsOf(std::max(std::abs(from), std::abs(to)));
  for (int i = 0; i <= last; ++i) {
    const double share = static_cast<double>(i) / last;
    const std::string written = ratios ? fmt::format("{:.12g}", from * math::exp(share * math::log(to / from)))
                                       : fmt::format("{:.{}f}", from + share * (to - from), decimals);
    values.push_back(i == 0 ? from : i == last ? to : std::strtod(written.c_str(), nullptr) + 0.0);
  }
  return values;
}

void checkPaths(const std::vector<std::string>& paths) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (std::find(paths.begin(), paths.begin() + static_cast<std::ptrdiff_t>(i), paths[i]) ==
        paths.begin() + static_cast<std::ptrdiff_t>(i))
      continue;
    throw InputError(fmt::format("sweep: {} is given twice. Name two numbers, or give all values at once: A,B,C",
                                 printable(paths[i])));
  }
}

void checkCount(std::size_t cases, std::size_t most) {
  if (cases > most) throw InputError(fmt::format("sweep: that would be more than {} runs. Take fewer values.", most));
}

std::vector<std::string> pathsOf(const std::vector<Variation>& variations) {
  std::vector<std::string> paths;
  for (const Variation& variation : variations) paths.push_back(variation.path);
  checkPaths(paths);
  return paths;
}

std::string_view withoutBlanks(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '"')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '"')) text.remove_suffix(1);
  return text;
}

std::vector<std::string> cellsOf(std::string_view line) {
  std::vector<std::string> cells;
  for (const std::string& cell : partsOf(std::string(line), ',')) cells.emplace_back(withoutBlanks(cell));
  return cells;
}

std::vector<double> caseOf(const std::string& file, std::int64_t line, const std::vector<std::string>& cells,
                           std::size_t columns) {
  if (cells.size() != columns)
    throw InputError(fmt::format("{}:{}: {} values under {} headings.", file, line, cells.size(), columns));
  std::vector<double> values;
  for (const std::string& cell : cells) {
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    if (cell.empty() || *end != '\0' || !std::isfinite(value))
      throw InputError(fmt::format("{}:{}: \"{}\" isn't a number.", file, line, printable(cell)));
    values.push_back(value);
  }
  return values;
}

}  // namespace

Variation parseVariation(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
    refuseVariation(text, "a path, = and values are needed.");
  Variation variation{text.substr(0, equals), {}};
  const std::string values = text.substr(equals + 1);
  if (values.find(':') != std::string::npos) {
    variation.values = rangeOf(text, partsOf(values, ':'));
  } else {
    for (const std::string& word : partsOf(values, ',')) variation.values.push_back(valueIn(text, word));
  }
  return variation;
}

SweepGrid crossed(const std::vector<Variation>& variations, std::size_t most) {
  SweepGrid grid{pathsOf(variations), {{}}};
  for (const Variation& variation : variations) {
    checkCount(grid.points.size() * variation.values.size(), most);
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& point : grid.points) {
      for (const double value : variation.values) {
        longer.push_back(point);
        longer.back().push_back(value);
      }
    }
    grid.points = std::move(longer);
  }
  return grid;
}

SweepGrid zipped(const std::vector<Variation>& variations, std::size_t most) {
  SweepGrid grid{pathsOf(variations), {}};
  std::size_t cases = 1;
  for (const Variation& variation : variations) cases = std::max(cases, variation.values.size());
  checkCount(cases, most);
  for (const Variation& variation : variations) {
    if (variation.values.size() == cases || variation.values.size() == 1) continue;
    throw InputError(fmt::format(
        "sweep: --zip takes lists of one length, and {} has {} values beside {}. Give as many, or one for all.",
        printable(variation.path), variation.values.size(), cases));
  }
  for (std::size_t i = 0; i < cases; ++i) {
    grid.points.emplace_back();
    for (const Variation& variation : variations)
      grid.points.back().push_back(variation.values[variation.values.size() == 1 ? 0 : i]);
  }
  return grid;
}

SweepGrid readCases(const std::string& path, std::size_t most) {
  InputFile file(path, kCasesFile);
  SweepGrid grid;
  std::string_view line;
  if (file.nextLine(line)) grid.paths = cellsOf(line);
  if (grid.paths.empty() || grid.paths.front().empty())
    throw InputError(fmt::format("{}:1: the first line names the numbers, as sphere.mass,duration", path));
  checkPaths(grid.paths);
  while (file.nextLine(line)) {
    if (withoutBlanks(line).empty()) continue;
    grid.points.push_back(caseOf(path, file.line(), cellsOf(line), grid.paths.size()));
    checkCount(grid.points.size(), most);
  }
  if (grid.points.empty()) throw InputError(fmt::format("{}: there is no case below the headings.", path));
  return grid;
}

}  // namespace pincer::tasks
