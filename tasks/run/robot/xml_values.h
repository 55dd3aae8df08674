// xml_values: the attributes of an XML element as what they must be: numbers, words, vectors.
//
// An element may have others behind it that speak where it says nothing (classes of defaults, in MJCF). Every error
// names file and line of the element that has the value.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/contact/math.h"
#include "pincer/tasks/run/robot/xml_tree.h"

namespace pincer::tasks {

class XmlValues {
 public:
  explicit XmlValues(const XmlElement& element) : levels_{&element} {}

  const XmlElement& element() const { return *levels_.front(); }
  bool has(std::string_view name) const { return levelOf(name) != nullptr; }
  std::string text(std::string_view name, const std::string& fallback = "") const;
  std::string required(std::string_view name) const;  // throws where it is missing or empty
  bool boolean(std::string_view name, bool fallback) const;
  // the index of the word
  int oneOf(std::string_view name, std::span<const std::string_view> words, int fallback) const;
  double number(std::string_view name, double fallback) const;
  double requiredNumber(std::string_view name) const;  // throws where it is missing
  int whole(std::string_view name, int fallback) const;
  // Between `least` and `most` finite numbers; empty where the attribute is missing.
  std::vector<double> numbers(std::string_view name, std::size_t least, std::size_t most) const;
  Vec3 vector(std::string_view name, const Vec3& fallback) const;
  std::optional<Vec2> range(std::string_view name) const;

  // Throws InputError at the element that has the value: "file:line: tag attribute="value" problem".
  [[noreturn]] void reject(std::string_view name, std::string_view problem) const;

 protected:
  const XmlElement* levelOf(std::string_view name) const;

  std::vector<const XmlElement*> levels_;  // the element, then those behind it, the nearest first
};

// A turn by `angle` about an axis of length 1.
Quat quatOfAxisAngle(const Vec3& axis, double angle);

}  // namespace pincer::tasks
