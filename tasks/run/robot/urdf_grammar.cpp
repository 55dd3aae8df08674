#include "pincer/tasks/run/robot/urdf_grammar.h"

#include <array>

namespace pincer::tasks::urdf {
namespace {

// Remedies and reasons that several rows share.
constexpr std::string_view kControllers = "Drives are given by the scene.";
constexpr std::string_view kSimulators = "Materials of contacts are given by the scene.";
constexpr std::string_view kSolid = "Make it a box, a cylinder, a sphere, a capsule or a mesh.";

// Short names, for the rows.
constexpr Verdict kLooks = Verdict::kLooks, kIgnored = Verdict::kIgnored, kRefused = Verdict::kRefused,
                  kRead = Verdict::kRead;

// URDF's elements: element, its parents, and the attributes that are read, looked at, ignored and refused.
constexpr std::array kRows = {
    GrammarRow{"robot", "robot", "", kRead, "name", "version"},
    GrammarRow{"material", "material", "robot", kLooks},
    GrammarRow{"transmission", "transmission", "robot", kIgnored, "", "", "", "", kControllers},
    GrammarRow{"ros2_control", "ros2_control", "robot", kIgnored, "", "", "", "", kControllers},
    GrammarRow{"gazebo", "gazebo", "robot", kIgnored, "", "", "", "", kSimulators},
    GrammarRow{"mujoco", "mujoco", "robot", kIgnored},
    GrammarRow{"sensor", "sensor", "robot", kIgnored},
    GrammarRow{"loop_joint", "loop_joint", "robot", kRefused, "", "", "", "",
               "URDF has no loops: write the robot in MJCF, with <connect>."},
    GrammarRow{"link", "link", "robot", kRead, "name", "type"},
    GrammarRow{"contact", "contact", "link", kIgnored, "", "", "", "", kSimulators},
    GrammarRow{"inertial", "inertial", "link", kRead},
    GrammarRow{"mass", "mass", "inertial", kRead, "value"},
    GrammarRow{"inertia", "inertia", "inertial", kRead, "ixx ixy ixz iyy iyz izz"},
    GrammarRow{"visual", "visual", "link", kLooks},
    GrammarRow{"collision", "collision", "link", kRead, "name", "group"},
    GrammarRow{"verbose", "verbose", "collision", kLooks},
    GrammarRow{"collision_material", "material", "collision", kLooks},
    GrammarRow{"origin", "origin", "inertial collision joint", kRead, "xyz rpy quat_xyzw"},
    GrammarRow{"geometry", "geometry", "collision", kRead},
    GrammarRow{"box", "box", "geometry", kRead, "size"},
    GrammarRow{"cylinder", "cylinder", "geometry", kRead, "radius length"},
    GrammarRow{"capsule", "capsule", "geometry", kRead, "radius length"},
    GrammarRow{"sphere", "sphere", "geometry", kRead, "radius"},
    GrammarRow{"mesh", "mesh", "geometry", kRead, "filename scale"},
    GrammarRow{"plane", "plane", "geometry", kRefused, "", "", "", "", kSolid},
    GrammarRow{"joint", "joint", "robot", kRead, "name type", "", "dont_collapse"},
    GrammarRow{"parent", "parent", "joint", kRead, "link"},
    GrammarRow{"child", "child", "joint", kRead, "link"},
    GrammarRow{"axis", "axis", "joint", kRead, "xyz"},
    GrammarRow{"dynamics", "dynamics", "joint", kRead, "damping friction"},
    GrammarRow{"limit", "limit", "joint", kRead, "lower upper", "", "effort velocity acceleration deceleration jerk",
               "", "Drives are given by the scene, with their \"force\"."},
    GrammarRow{"mimic", "mimic", "joint", kRead, "joint multiplier offset"},
    GrammarRow{"calibration", "calibration", "joint", kIgnored},
    GrammarRow{"safety_controller", "safety_controller", "joint", kIgnored, "", "", "", "", kControllers},
};

}  // namespace

std::span<const GrammarRow> rows() { return kRows; }

}  // namespace pincer::tasks::urdf
