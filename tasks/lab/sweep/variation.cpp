#include "pincer/tasks/lab/sweep/variation.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "pincer/contact/elementary.h"
#include "pincer/contact/error.h"

namespace pincer::tasks {
namespace {

[[noreturn]] void refuseVariation(const std::string& text, const std::string& why) {
  throw InputError(
      fmt::format("--vary {}: {} Write PATH=FROM:TO:N, PATH=FROM:TO:N:log or PATH=A,B,C; for example "
                  "sphere.material.mu_s=0.1:0.5:9",
                  text, why));
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
  if (word.empty() || *end != '\0' || !std::isfinite(value)) refuseVariation(text, fmt::format("\"{}\" isn't a number.", word));
  return value;
}

std::vector<double> rangeOf(const std::string& text, const std::vector<std::string>& parts) {
  const bool ratios = parts.size() == 4 && parts[3] == "log";
  if (parts.size() != 3 && !ratios) refuseVariation(text, "that isn't a range.");
  const double from = valueIn(text, parts[0]), to = valueIn(text, parts[1]), count = valueIn(text, parts[2]);
  if (!(count >= 2 && count <= 10'000) || count != std::floor(count)) refuseVariation(text, "N isn't a whole number from 2 to 10000.");
  if (ratios && !(from > 0 && to > 0)) refuseVariation(text, "equal ratios need positive ends.");
  std::vector<double> values;
  const int last = static_cast<int>(count) - 1;
  for (int i = 0; i <= last; ++i) {
    const double share = static_cast<double>(i) / last;
    values.push_back(i == last ? to : ratios ? from * math::exp(share * math::log(to / from)) : from + share * (to - from));
  }
  return values;
}

}  // namespace

Variation parseVariation(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size()) refuseVariation(text, "a path, = and values are needed.");
  Variation variation{text.substr(0, equals), {}};
  const std::string values = text.substr(equals + 1);
  if (values.find(':') != std::string::npos) {
    variation.values = rangeOf(text, partsOf(values, ':'));
  } else {
    for (const std::string& word : partsOf(values, ',')) variation.values.push_back(valueIn(text, word));
  }
  return variation;
}

std::vector<std::vector<double>> gridOf(const std::vector<Variation>& variations, std::size_t most) {
  std::vector<std::vector<double>> points{{}};
  for (const Variation& variation : variations) {
    std::vector<std::vector<double>> longer;
    if (points.size() * variation.values.size() > most) {
      throw InputError(fmt::format("sweep: that would be more than {} runs. Take fewer values.", most));
    }
    for (const std::vector<double>& point : points) {
      for (const double value : variation.values) {
        longer.push_back(point);
        longer.back().push_back(value);
      }
    }
    points = std::move(longer);
  }
  return points;
}

}  // namespace pincer::tasks
