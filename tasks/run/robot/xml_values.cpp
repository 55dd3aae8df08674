#include "pincer/tasks/run/robot/xml_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "pincer/contact/elementary.h"
#include "pincer/tasks/run/files/spelling.h"

namespace pincer::tasks {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";  // between the numbers of an attribute

}  // namespace

Quat quatOfAxisAngle(const Vec3& axis, double angle) {
  const Vec3 v = math::sin(0.5 * angle) * axis;
  return {math::cos(0.5 * angle), v[0], v[1], v[2]};
}

const XmlElement* XmlValues::levelOf(std::string_view name) const {
  const auto at =
      std::find_if(levels_.begin(), levels_.end(), [&](const XmlElement* e) { return e->find(name) != nullptr; });
  return at == levels_.end() ? nullptr : *at;
}

void XmlValues::reject(std::string_view name, std::string_view problem) const {
  const XmlElement* level = levelOf(name);
  if (!level) element().reject(fmt::format("{} {}", name, problem));
  level->reject(fmt::format("{}=\"{:.60}\" {}", name, *level->find(name), problem));
}

std::string XmlValues::text(std::string_view name, const std::string& fallback) const {
  const XmlElement* level = levelOf(name);
  return level ? *level->find(name) : fallback;
}

std::string XmlValues::required(std::string_view name) const {
  const std::string value = text(name);
  if (value.empty()) element().reject(fmt::format("needs the attribute \"{}\".", name));
  return value;
}

bool XmlValues::boolean(std::string_view name, bool fallback) const {
  constexpr std::string_view kWords[] = {"false", "true"};  // by value
  return oneOf(name, kWords, fallback) == 1;
}

int XmlValues::oneOf(std::string_view name, std::span<const std::string_view> words, int fallback) const {
  const XmlElement* level = levelOf(name);
  if (!level) return fallback;
  const auto at = std::find(words.begin(), words.end(), *level->find(name));
  if (at == words.end())
    reject(name, fmt::format("is none of the words that go there.{}", suggestion(*level->find(name), words)));
  return static_cast<int>(at - words.begin());
}

double XmlValues::number(std::string_view name, double fallback) const {
  const std::vector<double> values = numbers(name, 1, 1);
  return values.empty() ? fallback : values[0];
}

double XmlValues::requiredNumber(std::string_view name) const {
  required(name);
  return number(name, 0);
}

int XmlValues::whole(std::string_view name, int fallback) const {
  const double value = number(name, fallback);
  if (!(std::abs(value) < 2147483648.0) || value != std::floor(value)) reject(name, "isn't a whole number of 32 bits.");
  return static_cast<int>(value);
}

std::vector<double> XmlValues::numbers(std::string_view name, std::size_t least, std::size_t most) const {
  const XmlElement* level = levelOf(name);
  if (!level) return {};
  const std::string& text = *level->find(name);
  std::vector<double> values;
  for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string::npos;
       at = text.find_first_not_of(kBlanks, at)) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    const std::size_t begin = text[at] == '+' ? at + 1 : at;
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data() + begin, text.data() + end, value);
    const bool is_number = error == std::errc() && stop == text.data() + end && std::isfinite(value);
    if (!is_number)
      reject(name, fmt::format("has \"{:.30}\", which isn't a finite number.", text.substr(at, end - at)));
    values.push_back(value);
    at = end;
  }
  if (values.size() < least || values.size() > most) {
    const std::string wanted = least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
    reject(name, fmt::format("has {} numbers where {} are wanted.", values.size(), wanted));
  }
  return values;
}

Vec3 XmlValues::vector(std::string_view name, const Vec3& fallback) const {
  const std::vector<double> v = numbers(name, 3, 3);
  return v.empty() ? fallback : Vec3(v[0], v[1], v[2]);
}

std::optional<Vec2> XmlValues::range(std::string_view name) const {
  const std::vector<double> v = numbers(name, 2, 2);
  if (v.empty()) return std::nullopt;
  return Vec2(v[0], v[1]);
}

}  // namespace pincer::tasks
