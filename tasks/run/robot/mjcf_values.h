// mjcf_values: the attributes of an MJCF element as what they must be: its own, or those of its
// class of defaults, or of that one's parents.
//
// A class inherits its parent's values whatever their order in the file. Every error names file
// and line of the element that has the value.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/contact/math.h"
#include "pincer/tasks/run/robot/xml_tree.h"

namespace pincer::tasks::mjcf {

struct Document;
struct Compiler;

class Values {
 public:
  explicit Values(const XmlElement& element) : levels_{&element} {}  // without defaults
  // Of an element of row `kind` ("joint", "geom", ...); `class_index` counts where the element names no class itself.
  Values(const Document& document, const XmlElement& element, std::string_view kind, int class_index);

  const XmlElement& element() const { return *levels_.front(); }
  bool has(std::string_view name) const { return levelOf(name) != nullptr; }
  std::string text(std::string_view name, const std::string& fallback = "") const;
  std::string required(std::string_view name) const;  // throws where it is missing or empty
  bool boolean(std::string_view name, bool fallback) const;
  // the index of the word
  int oneOf(std::string_view name, std::span<const std::string_view> words, int fallback) const;
  double number(std::string_view name, double fallback) const;
  int whole(std::string_view name, int fallback) const;
  // Between `least` and `most` finite numbers; empty where the attribute is missing.
  std::vector<double> numbers(std::string_view name, std::size_t least, std::size_t most) const;
  Vec3 vector(std::string_view name, const Vec3& fallback) const;
  std::optional<Vec2> range(std::string_view name) const;
  // The range, if `switch_name` is "true", or "auto" and the range rises and `autolimits`.
  std::optional<Vec2> limits(std::string_view name, std::string_view switch_name, bool autolimits) const;
  // quat, axisangle, xyaxes, zaxis or euler, of the nearest level that has one of them.
  Quat orientation(const Compiler& compiler) const;
  Pose pose(const Compiler& compiler) const { return {orientation(compiler), vector("pos", Vec3::Zero())}; }

  // Throws InputError at the element that has the value: "file:line: tag attribute="value" problem".
  [[noreturn]] void reject(std::string_view name, std::string_view problem) const;

 private:
  const XmlElement* levelOf(std::string_view name) const;
  Vec3 direction(std::string_view name, const double* v) const;
  Quat turnOf(std::string_view name, const Compiler& compiler) const;  // of one of the five ways to say it

  std::vector<const XmlElement*> levels_;  // the element, then its class's, then their parents'
};

}  // namespace pincer::tasks::mjcf
