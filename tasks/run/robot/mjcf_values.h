// mjcf_values: the attributes of an MJCF element as what they must be: its own, or those of its
// class of defaults, or of that one's parents.
//
// A class inherits its parent's values whatever their order in the file.
#pragma once
#include <optional>
#include <string_view>

#include "pincer/tasks/run/robot/xml_values.h"

namespace pincer::tasks::mjcf {

struct Document;
struct Compiler;

class Values : public XmlValues {
 public:
  explicit Values(const XmlElement& element) : XmlValues(element) {}  // without defaults
  // Of an element of row `kind` ("joint", "geom", ...); `class_index` counts where the element names no class itself.
  Values(const Document& document, const XmlElement& element, std::string_view kind, int class_index);

  // The range, if `switch_name` is "true", or "auto" and the range rises and `autolimits`.
  std::optional<Vec2> limits(std::string_view name, std::string_view switch_name, bool autolimits) const;
  // quat, axisangle, xyaxes, zaxis or euler, of the nearest level that has one of them.
  Quat orientation(const Compiler& compiler) const;
  Pose pose(const Compiler& compiler) const { return {orientation(compiler), vector("pos", Vec3::Zero())}; }

 private:
  Vec3 direction(std::string_view name, const double* v) const;
  Quat turnOf(std::string_view name, const Compiler& compiler) const;  // of one of the five ways to say it
};

}  // namespace pincer::tasks::mjcf
