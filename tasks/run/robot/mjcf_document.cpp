#include "pincer/tasks/run/robot/mjcf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/robot/mjcf_replicate.h"
#include "pincer/tasks/run/robot/mjcf_values.h"

namespace pincer::tasks::mjcf {
namespace {

constexpr int kMostIncludes = 100;  // files of one robot: bounds what a mistaken one reads; chosen

// Puts the elements of included files where they are included.
class Includer {
 public:
  Includer(const ModelFolder& folder, const std::string& main) : folder_(folder), open_{real(main)} {}

  void expand(XmlElement& element) {
    std::vector<XmlElement> children;
    for (XmlElement& child : element.children) {
      if (child.tag == "include") {
        append(child, children);
      } else {
        expand(child);
        children.push_back(std::move(child));
      }
    }
    element.children = std::move(children);
  }

 private:
  static std::string real(const std::string& path) {
    std::error_code error;
    return std::filesystem::weakly_canonical(path, error).string();
  }

  void append(const XmlElement& include, std::vector<XmlElement>& out) {
    const std::string* name = include.find("file");
    if (!name || include.attributes.size() != 1) include.reject("needs the attribute \"file\", and no other.");
    const std::string path = folder_.find(include, "", *name);
    if (std::find(open_.begin(), open_.end(), real(path)) != open_.end())
      include.reject(fmt::format("includes {}, which includes this one. Take one of the two out.", *name));
    if (!seen_.insert(real(path)).second)
      include.reject(fmt::format("includes {} a second time. MJCF allows one.", *name));
    if (seen_.size() > kMostIncludes)
      include.reject(fmt::format("is one include too many: a robot has at most {}.", kMostIncludes));
    XmlElement root = readXml(path);
    refuseText(root);
    open_.push_back(real(path));
    expand(root);
    open_.pop_back();
    for (XmlElement& child : root.children) out.push_back(std::move(child));
  }

  const ModelFolder& folder_;
  std::vector<std::string> open_;  // from the main file to this one
  std::set<std::string> seen_;
};

void readCompilerElement(const XmlElement& element, Compiler& c) {
  const Values values(element);
  constexpr std::string_view kAngles[] = {"radian", "degree"};  // by Compiler::degrees
  c.degrees = values.oneOf("angle", kAngles, c.degrees) == 1;
  constexpr std::string_view kCoordinates[] = {"local", "global"};
  if (values.oneOf("coordinate", kCoordinates, 0) == 1)
    values.reject("coordinate", "isn't known since MuJoCo 2.3.4. Let an older MuJoCo save the file in local ones.");
  if (values.boolean("alignfree", false))
    values.reject("alignfree", "isn't known here: frames of free bodies stay as they are drawn.");
  c.autolimits = values.boolean("autolimits", c.autolimits);
  c.balance_inertia = values.boolean("balanceinertia", c.balance_inertia);
  c.strip_path = values.boolean("strippath", c.strip_path);
  c.euler_order = values.text("eulerseq", c.euler_order);
  const bool is_order = c.euler_order.size() == 3 && c.euler_order.find_first_not_of("xyzXYZ") == std::string::npos;
  if (!is_order)
    element.reject(
        fmt::format("has eulerseq=\"{}\". Three of x, y, z; capital letters turn about fixed axes.", c.euler_order));
  c.mesh_folder = values.text("meshdir", values.text("assetdir", c.mesh_folder));
  constexpr std::string_view kFromGeoms[] = {"false", "true", "auto"};  // by InertiaFromGeoms
  c.inertia_from_geoms = static_cast<InertiaFromGeoms>(
      values.oneOf("inertiafromgeom", kFromGeoms, static_cast<int>(c.inertia_from_geoms)));
  const std::vector<double> groups = values.numbers("inertiagrouprange", 2, 2);
  if (!groups.empty()) {
    c.first_inertia_group = static_cast<int>(groups[0]);
    c.last_inertia_group = static_cast<int>(groups[1]);
  }
  c.least_mass = values.number("boundmass", c.least_mass);
  c.least_inertia = values.number("boundinertia", c.least_inertia);
  c.total_mass = values.number("settotalmass", c.total_mass);
}

// Actuators of all kinds change one and the same default.
std::string defaultKind(const XmlElement& element) {
  const GrammarRow* row = rowOf("default", element.tag);
  const bool is_actuator = rowOf("actuator", element.tag) != nullptr;
  return is_actuator ? "actuator" : std::string(row->name);
}

class ClassReader {
 public:
  explicit ClassReader(std::vector<DefaultClass>& classes) : classes_(classes) { classes_.push_back({"main", -1, {}}); }

  void read(const XmlElement& element, int parent) {
    const int index = classOf(element, parent);
    for (const XmlElement& child : element.children) {
      if (child.tag == "default") {
        read(child, index);
      } else if (rowOf("default", child.tag)->verdict == Verdict::kRead) {
        classes_[static_cast<std::size_t>(index)].elements[defaultKind(child)].push_back(child);
      }
    }
  }

 private:
  int classOf(const XmlElement& element, int parent) {
    const std::string* name = element.find("class");
    if (parent < 0) {
      if (name) classes_[0].name = *name;
      return 0;
    }
    if (!name || name->empty())
      element.reject("needs the attribute \"class\": only the outermost one may go without a name.");
    const auto same = [&](const DefaultClass& c) { return c.name == *name; };
    if (std::any_of(classes_.begin(), classes_.end(), same))
      element.reject(fmt::format("is the second class called \"{}\".", *name));
    classes_.push_back({*name, parent, {}});
    return static_cast<int>(classes_.size()) - 1;
  }

  std::vector<DefaultClass>& classes_;
};

}  // namespace

std::vector<const XmlElement*> sections(const Document& document, std::string_view tag) {
  std::vector<const XmlElement*> found;
  for (const XmlElement& child : document.root.children) {
    if (child.tag == tag) found.push_back(&child);
  }
  return found;
}

int classNamed(const Document& document, const std::string& name, const XmlElement& element) {
  const auto at = std::find_if(document.classes.begin(), document.classes.end(),
                               [&](const DefaultClass& c) { return c.name == name; });
  if (at != document.classes.end()) return static_cast<int>(at - document.classes.begin());
  std::vector<std::string_view> names;
  for (const DefaultClass& c : document.classes) names.push_back(c.name);
  element.reject(fmt::format("is of class \"{}\", and no <default> has that name.{}", name, suggestion(name, names)));
}

Document readDocument(const std::string& path, const std::vector<std::string>& allowed_folders) {
  Document document{path, readXml(path), {}, {}, ModelFolder(path, allowed_folders), {}};
  if (document.root.tag != "mujoco")
    document.root.reject("isn't <mujoco>: this is no MJCF file. URDF files end in .urdf.");
  Includer(document.folder, path).expand(document.root);
  checkGrammar({"MJCF", rows(), "default"}, document.root, document.notes);
  for (const XmlElement* element : sections(document, "compiler")) readCompilerElement(*element, document.compiler);
  for (XmlElement& child : document.root.children) {
    if (child.tag == "worldbody") writeCopiesOut(document.compiler, child);
  }
  ClassReader classes(document.classes);
  for (const XmlElement* element : sections(document, "default")) classes.read(*element, -1);
  return document;
}

}  // namespace pincer::tasks::mjcf
