#include "pincer/tasks/run/robot/urdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/robot/urdf_grammar.h"
#include "pincer/tasks/run/robot/urdf_parts.h"

namespace pincer::tasks {
namespace urdf {
namespace {

constexpr double kTick = 0.001;  // [s]: URDF says none; that of a scene

constexpr int kLongestMimic = 100;  // joints that follow one another: bounds the work on a mistaken file; chosen

using Names = std::map<std::string, const XmlElement*, std::less<>>;

// Joins links to a tree: bodies from the root on, those of one link in the order of their joints.
class TreeReader {
 public:
  TreeReader(const XmlElement& root, const ModelFolder& folder, Robot& robot, ImportNotes& notes)
      : root_(root), robot_(robot), notes_(notes), links_(folder, robot, notes) {}

  void read() {
    collect();
    const XmlElement& base = rootLink();
    addLinks(base);
    if (robot_.bodies.size() < by_name_.size()) rejectCircle();
    requireMasses();
    addCouplings();
  }

 private:
  void collect() {
    for (const XmlElement& child : root_.children) {
      if (child.tag == "link") addName(child, by_name_);
      if (child.tag == "joint") joints_.push_back(readJointHeader(child));
    }
    if (by_name_.empty()) root_.reject("has no <link>.");
    Names names;
    for (const Joint& joint : joints_) {
      addName(*joint.element, names);
      requireLink(joint, joint.parent);
      requireLink(joint, joint.child);
      const auto [at, is_first] = carried_by_.emplace(joint.child, &joint);
      if (!is_first)
        joint.element->reject(fmt::format(
            "\"{}\" holds link \"{}\", which joint \"{}\" holds already. URDF has trees only: write loops in MJCF, "
            "with <connect>.",
            joint.name, joint.child, at->second->name));
    }
  }

  static void addName(const XmlElement& element, Names& names) {
    const std::string name = XmlValues(element).required("name");
    const auto [at, is_new] = names.emplace(name, &element);
    if (!is_new)
      element.reject(
          fmt::format("is the second {} called \"{}\": the first is at {}.", element.tag, name, at->second->place()));
  }

  void requireLink(const Joint& joint, const std::string& name) const {
    if (by_name_.count(name)) return;
    std::vector<std::string_view> known;
    for (const auto& [link, element] : by_name_) known.push_back(link);
    joint.element->reject(fmt::format("\"{}\" names the link \"{}\", which the file doesn't have.{}", joint.name, name,
                                      suggestion(name, known)));
  }

  // The link that no joint holds.
  const XmlElement& rootLink() const {
    const XmlElement* found = nullptr;
    for (const XmlElement& child : root_.children) {
      if (child.tag != "link" || carried_by_.count(*child.find("name"))) continue;
      if (found)
        child.reject(
            fmt::format("\"{}\" is held by no joint, as \"{}\" at {} isn't. A robot has one such link: join "
                        "the others to it.",
                        *child.find("name"), *found->find("name"), found->place()));
      found = &child;
    }
    if (!found) rejectCircle();
    return *found;
  }

  // From any link that isn't part of the tree its joints lead round.
  [[noreturn]] void rejectCircle() const {
    std::set<std::string> tree;
    for (const RobotBody& body : robot_.bodies) tree.insert(body.name);
    const auto outside =
        std::find_if(joints_.begin(), joints_.end(), [&](const Joint& j) { return !tree.count(j.child); });
    std::set<std::string> seen;
    const Joint* at = &*outside;
    while (seen.insert(at->child).second) at = carried_by_.at(at->parent);
    at->element->reject(fmt::format(
        "\"{}\" closes a loop: link \"{}\" hangs on what hangs on it. URDF has trees only: write loops in MJCF, with "
        "<connect>.",
        at->name, at->child));
  }

  // The root and all that hangs on it, depth first.
  void addLinks(const XmlElement& base) {
    std::map<std::string, std::vector<const Joint*>, std::less<>> carries;  // by parent link
    for (const Joint& joint : joints_) carries[joint.parent].push_back(&joint);
    std::vector<std::pair<const XmlElement*, int>> open = {{&base, -1}};  // link, and its parent's body
    while (!open.empty()) {
      const auto [element, parent] = open.back();
      open.pop_back();
      addLink(*element, parent);
      const auto next = carries.find(robot_.bodies.back().name);
      if (next == carries.end()) continue;
      const int index = static_cast<int>(robot_.bodies.size()) - 1;
      for (auto joint = next->second.rbegin(); joint != next->second.rend(); ++joint)
        open.emplace_back(by_name_.find((*joint)->child)->second, index);
    }
  }

  void addLink(const XmlElement& element, int parent) {
    RobotBody body = links_.readLink(element);
    body.parent = parent;
    if (parent >= 0) {
      const Joint& joint = *carried_by_.at(body.name);
      body.X_PB = links_.readOrigin(*joint.element);
      body.joints = readAxes(joint);
      if (joint.type == JointType::kFloating) setFree(joint, body);
    }
    robot_.bodies.push_back(std::move(body));
  }

  // On what stands still a floating link is a body of the world.
  void setFree(const Joint& joint, RobotBody& body) const {
    while (body.parent >= 0) {
      const RobotBody& parent = robot_.bodies[static_cast<std::size_t>(body.parent)];
      if (!parent.joints.empty())
        joint.element->reject(
            fmt::format("\"{}\" is floating on link \"{}\", which moves. Let it float on the link that stands still.",
                        joint.name, joint.parent));
      body.X_PB = parent.X_PB * body.X_PB;
      body.parent = parent.parent;
    }
  }

  // Bodies that move, with what is fixed to them, have a mass, or carry one.
  void requireMasses() {
    std::vector<double> as_one, in_all;  // of a body with what is fixed to it, and with all that hangs on it
    for (const RobotBody& body : robot_.bodies) as_one.push_back(body.inertia.mass);
    in_all = as_one;
    for (std::size_t i = robot_.bodies.size(); i-- > 1;) {  // parents come first
      const RobotBody& body = robot_.bodies[i];
      if (body.parent < 0) continue;
      const auto parent = static_cast<std::size_t>(body.parent);
      in_all[parent] += in_all[i];
      if (body.joints.empty()) as_one[parent] += as_one[i];
    }
    for (std::size_t i = 1; i < robot_.bodies.size(); ++i) {
      const RobotBody& body = robot_.bodies[i];
      if (body.joints.empty() || as_one[i] > 0) continue;
      if (!(in_all[i] > 0)) rejectMassless(body);
      notes_.add("link without a mass that moves", "It weighs a microgram.", body.place);
    }
  }

  [[noreturn]] void rejectMassless(const RobotBody& body) const {
    const Joint& joint = *carried_by_.at(body.name);
    joint.element->reject(fmt::format(
        "\"{}\" moves no mass: neither link \"{}\" ({}) nor what hangs on it has an <inertial> with a mass above 0. "
        "Give it one, or make the joint of type fixed.",
        joint.name, body.name, body.place));
  }

  const Joint& leaderOf(const Joint& joint) const {
    const auto at =
        std::find_if(joints_.begin(), joints_.end(), [&](const Joint& j) { return j.name == joint.leader; });
    if (at != joints_.end() && at->type <= JointType::kPrismatic) return *at;
    std::vector<std::string_view> axes;
    for (const Joint& other : joints_) {
      if (other.type <= JointType::kPrismatic) axes.push_back(other.name);
    }
    onlyChild(*joint.element, "mimic")
        ->reject(fmt::format("follows \"{}\", which is no joint of one coordinate.{}", joint.leader,
                             suggestion(joint.leader, axes)));
  }

  // A joint that follows another follower is coupled to the first of them.
  void addCouplings() {
    for (const Joint& joint : joints_) {
      if (joint.leader.empty()) continue;
      const Joint* leader = &joint;
      double multiplier = 1, offset = 0;
      for (int steps = 0; !leader->leader.empty(); ++steps) {
        if (steps == kLongestMimic)
          onlyChild(*joint.element, "mimic")
              ->reject(fmt::format("makes \"{}\" follow itself, or through more than {} joints. Follow a joint that "
                                   "follows none.",
                                   joint.name, kLongestMimic));
        offset += multiplier * leader->offset;
        multiplier *= leader->multiplier;
        leader = &leaderOf(*leader);
      }
      robot_.couplings.push_back({joint.name, leader->name, {offset, multiplier}, joint.element->place()});
    }
  }

  const XmlElement& root_;
  Robot& robot_;
  ImportNotes& notes_;
  LinkReader links_;
  std::vector<Joint> joints_;
  Names by_name_;                                                // links
  std::map<std::string, const Joint*, std::less<>> carried_by_;  // by child link
};

// "${height}", "$(find package)".
bool holdsXacro(const XmlAttribute& attribute) {
  return attribute.value.find("${") != std::string::npos || attribute.value.find("$(") != std::string::npos;
}

void refuseXacro(const XmlElement& element, const std::string& path) {
  if (element.tag.rfind("xacro:", 0) == 0 || std::filesystem::path(path).extension() == ".xacro" ||
      std::any_of(element.attributes.begin(), element.attributes.end(), holdsXacro))
    element.reject(fmt::format("is written for xacro. Expand the file first: xacro {} > robot.urdf",
                               printable(std::filesystem::path(path).filename().string())));
  for (const XmlElement& child : element.children) refuseXacro(child, path);
}

}  // namespace
}  // namespace urdf

RobotImport readUrdf(const std::string& path, const std::vector<std::string>& allowed_folders) {
  const XmlElement root = readXml(path);
  if (root.tag != "robot") root.reject("isn't <robot>: this is no URDF file. MJCF files end in .xml.");
  urdf::refuseXacro(root, path);
  RobotImport result;
  checkGrammar({"URDF", urdf::rows(), {}, true}, root, result.notes);
  Robot& robot = result.robot;
  robot.name = XmlValues(root).text("name", std::filesystem::path(path).stem().string());
  robot.file = path;
  robot.tick = urdf::kTick;
  const ModelFolder folder(path, allowed_folders);
  urdf::TreeReader(root, folder, robot, result.notes).read();
  return result;
}

}  // namespace pincer::tasks
