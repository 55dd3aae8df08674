// A robot's ties and drives: couplings, tendons and drives of its scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/robot/robot_pose.h"
#include "pincer/tasks/run/robot/robot_scene_parts.h"

namespace pincer::tasks {
namespace {

using Terms = std::vector<std::pair<std::string, double>>;  // joint and factor

double referenceOf(const Robot& robot, const std::string& name) {
  for (const RobotBody& body : robot.bodies) {
    for (const RobotJoint& joint : body.joints) {
      if (joint.name == name) return joint.reference;
    }
  }
  return 0;
}

using Polynomial = std::vector<double>;  // factors of 1, z, z^2 ..

constexpr std::size_t kMostFactors = 5;  // of a scene's coupling

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial out(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) out[i + k] += a[i] * b[k];
  }
  return out;
}

// outer(inner(z)), without highest powers that have no factor.
Polynomial composed(const Polynomial& outer, const Polynomial& inner) {
  Polynomial out = {0};
  for (std::size_t k = outer.size(); k-- > 0;) {
    out = product(out, inner);
    out[0] += outer[k];
    while (out.size() > 1 && out.back() == 0) out.pop_back();
  }
  return out;
}

const RobotCoupling* couplingOf(const Robot& robot, const std::string& follower) {
  const auto found = std::find_if(robot.couplings.begin(), robot.couplings.end(),
                                  [&](const RobotCoupling& c) { return c.follower == follower; });
  return found == robot.couplings.end() ? nullptr : &*found;
}

// The coupling to the joint that follows none: a scene's followers aren't followed themselves.
RobotCoupling toTheFirst(const Robot& robot, const RobotCoupling& coupling) {
  RobotCoupling whole = coupling;
  std::size_t steps = 0;
  while (const RobotCoupling* next = couplingOf(robot, whole.leader)) {
    if (++steps > robot.couplings.size())
      rejectAt(coupling.place, fmt::format("<joint> makes \"{}\" follow itself. Let all follow one joint that is free.",
                                           coupling.follower));
    whole.polynomial = composed(whole.polynomial, next->polynomial);
    whole.leader = next->leader;
    if (whole.polynomial.size() > kMostFactors)
      rejectAt(
          coupling.place,
          fmt::format("<joint> follows \"{0}\", which follows \"{1}\": a polynomial of \"{1}\" with powers up to {2}, "
                      "and 4 is the most. Let it follow \"{1}\", with a polynomial near to that.",
                      coupling.leader, next->leader, whole.polynomial.size() - 1));
  }
  return whole;
}

void requireOneLeader(const Robot& robot, const RobotCoupling& coupling) {
  const RobotCoupling* first = couplingOf(robot, coupling.follower);
  if (first == &coupling) return;
  rejectAt(coupling.place, fmt::format("<joint> is the second that \"{}\" follows by: the first is at {}. Keep one.",
                                       coupling.follower, first->place));
}

// In powers of the leader's coordinate: the file's are of its way from where it is drawn, and give the follower's.
std::vector<double> shifted(const Robot& robot, const RobotCoupling& coupling) {
  const double shift = -referenceOf(robot, coupling.leader);
  std::vector<double> sum(coupling.polynomial.size(), 0.0), power = {1};
  for (const double factor : coupling.polynomial) {
    for (std::size_t k = 0; k < power.size() && k < sum.size(); ++k) sum[k] += factor * power[k];
    power.push_back(0);
    for (std::size_t k = power.size() - 1; k > 0; --k) power[k] = power[k - 1] + shift * power[k];
    power[0] *= shift;
  }
  sum[0] += referenceOf(robot, coupling.follower);
  while (sum.size() > 2 && sum.back() == 0) sum.pop_back();
  return sum;
}

void writeCouplings(SceneWriting& w) {
  if (w.posed.robot.couplings.empty()) return;
  w.json.key("couplings").beginArray();
  for (const RobotCoupling& coupling : w.posed.robot.couplings) {
    requireOneLeader(w.posed.robot, coupling);
    if (coupling.leader.empty()) rejectAt(coupling.place, "<joint> holds a joint still. Leave the joint out instead.");
    const RobotCoupling whole = toTheFirst(w.posed.robot, coupling);
    w.json.beginObject().key("joint").value(w.names.of("joint", whole.follower));
    w.json.key("follows").value(w.names.of("joint", whole.leader)).key("polynomial").beginArray();
    for (const double c : shifted(w.posed.robot, whole)) w.json.value(c);
    w.json.endArray().endObject();
  }
  w.json.endArray();
}

// A drive's coordinate: l = sum of factors times coordinates.
Terms termsOf(const Robot& robot, const RobotDrive& drive) {
  Terms terms = {{drive.joint, 1}};
  if (drive.joint.empty()) {
    terms = std::find_if(robot.tendons.begin(), robot.tendons.end(), [&](const RobotTendon& t) {
              return t.name == drive.tendon;
            })->joints;
  }
  for (auto& term : terms) term.second *= drive.gear;
  return terms;
}

bool isOfOneJoint(const RobotDrive& drive) { return !drive.joint.empty() && drive.gear == 1; }

const std::string& tendonName(SceneWriting& w, const RobotDrive& drive) {
  return w.names.of("tendon", drive.name + "_" + (drive.joint.empty() ? drive.tendon : drive.joint));
}

bool hasSpring(const RobotTendon& tendon) { return tendon.stiffness > 0 || tendon.damping > 0; }

void writeTendons(SceneWriting& w) {
  w.json.key("tendons").beginArray();
  for (const RobotTendon& tendon : w.posed.robot.tendons) {
    if (!hasSpring(tendon)) continue;
    w.json.beginObject().key("name").value(w.names.of("sprung tendon", tendon.name)).key("joints").beginObject();
    for (const auto& [joint, factor] : tendon.joints) w.json.key(w.names.of("joint", joint)).value(factor);
    w.json.endObject().endObject();
  }
  for (const RobotDrive& drive : w.posed.robot.drives) {
    if (isOfOneJoint(drive)) continue;
    w.json.beginObject().key("name").value(tendonName(w, drive)).key("joints").beginObject();
    for (const auto& [joint, factor] : termsOf(w.posed.robot, drive))
      w.json.key(w.names.of("joint", joint)).value(factor);
    w.json.endObject().endObject();
  }
  w.json.endArray();
}

// Mass that l feels of the robot as it is drawn: the sum of M_jj/c_j^2, MuJoCo's rule for a damping ratio.
double feltInertia(const Robot& robot, const RobotDrive& drive) {
  const std::vector<double> own = ownInertias(robot, bodyPoses(robot, drawnCoordinates(robot)));
  const Terms terms = termsOf(robot, drive);
  double sum = 0;
  auto at = own.begin();
  for (const RobotBody& body : robot.bodies) {
    for (const RobotJoint& joint : body.joints) {
      for (const auto& [name, factor] : terms) {
        if (name == joint.name && factor != 0) sum += *at / (factor * factor);
      }
      ++at;
    }
  }
  return sum;
}

// Where the joints' own springs are slack, as long as the file doesn't say another length.
double slackLength(const Robot& robot, const RobotTendon& tendon) {
  if (tendon.rest) return (*tendon.rest)[0];
  double length = 0;
  for (const RobotBody& body : robot.bodies) {
    for (const RobotJoint& joint : body.joints) {
      for (const auto& [name, factor] : tendon.joints) length += name == joint.name ? factor * joint.spring_rest : 0;
    }
  }
  return length;
}

// A spring and damper along a tendon: a drive that is told nothing.
void writeTendonSprings(SceneWriting& w) {
  for (const RobotTendon& tendon : w.posed.robot.tendons) {
    if (!hasSpring(tendon)) continue;
    w.json.beginObject().key("name").value(w.names.of("tendon's spring", tendon.name + "_spring"));
    w.json.key("tendon")
        .value(w.names.of("sprung tendon", tendon.name))
        .key("type")
        .value("affine")
        .key("gain")
        .value(0);
    w.json.key("offset")
        .value(tendon.stiffness * slackLength(w.posed.robot, tendon))
        .key("stiffness")
        .value(tendon.stiffness);
    w.json.key("damping").value(tendon.damping).endObject();
  }
}

// Range of all drives of a joint together: of its only one, where it drives that joint alone.
std::optional<Vec2> forcesOf(const Robot& robot, const RobotDrive& drive) {
  std::optional<Vec2> forces = drive.forces;
  if (drive.joint.empty()) return forces;
  for (const RobotBody& body : robot.bodies) {
    for (const RobotJoint& joint : body.joints) {
      if (joint.name != drive.joint || !joint.drive_forces || !isOnlyDriveOf(robot, joint)) continue;
      Vec2 range = *joint.drive_forces / drive.gear;
      if (drive.gear < 0) std::swap(range[0], range[1]);
      forces = forces ? Vec2(std::max((*forces)[0], range[0]), std::min((*forces)[1], range[1])) : range;
    }
  }
  return forces;
}

void writeLaw(SceneWriting& w, const RobotDrive& drive) {
  const double damping = drive.damping_ratio > 0
                             ? 2 * drive.damping_ratio * std::sqrt(drive.gain * feltInertia(w.posed.robot, drive))
                             : -drive.bias[2];
  if (drive.bias[1] > 0 || damping < 0) {
    rejectAt(
        drive.place,
        fmt::format(
            "drive \"{}\" pushes further what is off already: the second and third number of biasprm are at most 0.",
            drive.name));
  }
  w.json.key("type").value("affine").key("gain").value(drive.gain).key("offset").value(drive.bias[0]);
  w.json.key("stiffness").value(0 - drive.bias[1]).key("damping").value(damping);
  if (drive.controls)
    w.json.key("control").beginArray().value((*drive.controls)[0]).value((*drive.controls)[1]).endArray();
  if (const auto forces = forcesOf(w.posed.robot, drive))
    w.json.key("force").beginArray().value((*forces)[0]).value((*forces)[1]).endArray();
}

void writeDrives(SceneWriting& w) {
  const auto& drives = w.posed.robot.drives;
  w.json.key("drives").beginArray();
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const RobotDrive& drive = drives[i];
    w.json.beginObject().key("name").value(w.names.of("drive", drive.name));
    w.json.key(isOfOneJoint(drive) ? "joint" : "tendon");
    w.json.value(isOfOneJoint(drive) ? w.names.of("joint", drive.joint) : tendonName(w, drive));
    writeLaw(w, drive);
    const double control = w.posed.key && !w.posed.key->controls.empty() ? w.posed.key->controls[i] : 0;
    w.json.key("target")
        .value(drive.controls ? std::clamp(control, (*drive.controls)[0], (*drive.controls)[1]) : control)
        .endObject();
  }
  writeTendonSprings(w);
  w.json.endArray();
}

}  // namespace

bool isOnlyDriveOf(const Robot& robot, const RobotJoint& joint) {
  int of_it = 0, over_tendons = 0;
  for (const RobotDrive& drive : robot.drives) {
    of_it += drive.joint == joint.name;
    for (const RobotTendon& tendon : robot.tendons) {
      if (drive.tendon != tendon.name) continue;
      for (const auto& [name, factor] : tendon.joints) over_tendons += name == joint.name;
    }
  }
  return of_it == 1 && over_tendons == 0;
}

void writeTies(SceneWriting& writing) {
  writeCouplings(writing);
  writeTendons(writing);
  writeDrives(writing);
}

}  // namespace pincer::tasks
