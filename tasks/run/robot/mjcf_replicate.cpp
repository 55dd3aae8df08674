#include "pincer/tasks/run/robot/mjcf_replicate.h"

#include <fmt/format.h>

#include "pincer/tasks/run/robot/mjcf_values.h"

namespace pincer::tasks::mjcf {
namespace {

std::size_t elementsOf(const XmlElement& element) {
  std::size_t count = 1;
  for (const XmlElement& child : element.children) count += elementsOf(child);
  return count;
}

void addToNames(XmlElement& element, const std::string& suffix) {
  for (XmlElement& child : element.children) {
    for (XmlAttribute& attribute : child.attributes) {
      if (attribute.name == "name") attribute.value += suffix;
    }
    addToNames(child, suffix);
  }
}

class Copier {
 public:
  explicit Copier(const Compiler& compiler) : compiler_(compiler) {}

  // Inner ones first: the outer copies then take them along, as MuJoCo names them.
  void expand(XmlElement& element) {
    std::vector<XmlElement> children;
    for (XmlElement& child : element.children) {
      expand(child);
      if (child.tag == "replicate") {
        append(child, children);
      } else {
        children.push_back(std::move(child));
      }
    }
    element.children = std::move(children);
  }

 private:
  void append(const XmlElement& element, std::vector<XmlElement>& out) {
    const Values values(element);
    const int count = values.whole("count", 0);
    if (count < 1) values.element().reject("needs a count of 1 or more.");
    const Pose step = {values.has("euler") ? values.orientation(compiler_) : Quat::Identity(),
                       values.vector("offset", Vec3::Zero())};
    copied_ += static_cast<std::size_t>(count) * elementsOf(element);
    if (copied_ > kMostXmlElements)
      element.reject(fmt::format("makes too many copies: a robot has at most {} elements of them.", kMostXmlElements));
    const std::size_t digits = std::to_string(count).size();  // as MuJoCo: of 10 copies, too, the first is 00
    Pose X;
    for (int i = 0; i < count; ++i, X = X * step) {
      const std::string number = fmt::format("{:0{}}", i, digits);
      out.push_back(copyAt(element, X, values.text("sep") + number));
    }
  }

  static XmlElement copyAt(const XmlElement& element, const Pose& X, const std::string& suffix) {
    XmlElement frame = element;
    frame.tag = "frame";
    frame.attributes = {{"pos", fmt::format("{} {} {}", X.p.x(), X.p.y(), X.p.z())},
                        {"quat", fmt::format("{} {} {} {}", X.q.w(), X.q.x(), X.q.y(), X.q.z())}};
    if (const std::string* name = element.find("childclass")) frame.attributes.push_back({"childclass", *name});
    addToNames(frame, suffix);
    return frame;
  }

  const Compiler& compiler_;
  std::size_t copied_ = 0;
};

}  // namespace

void writeCopiesOut(const Compiler& compiler, XmlElement& element) { Copier(compiler).expand(element); }

}  // namespace pincer::tasks::mjcf
