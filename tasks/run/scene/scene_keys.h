// scene_keys: the words of the scene format, for its reader and for the test that
// compares them with docs/scene.schema.json.
#pragma once
#include <array>
#include <string_view>

namespace pincer::tasks::keys {

using Word = std::string_view;

// Keys that each object of a scene may have, and words of its choices. A size counts them.
inline constexpr std::array<Word, 19> kScene = {"version",  "description", "camera",    "gravity", "tick",
                                                "duration", "solver",      "robots",    "bodies",  "combination",
                                                "pairs",    "joints",      "couplings", "tendons", "drives",
                                                "frames",   "fingers",     "record",    "expect"};
inline constexpr std::array<Word, 4> kCamera = {"yaw", "pitch", "distance", "target"};
inline constexpr std::array<Word, 7> kRobot = {"name", "file", "keyframe", "start", "drives", "position", "rotation"};
inline constexpr std::array<Word, 8> kSolver = {"tolerance",          "accuracy",  "max_contacts", "contact_margin",
                                                "position_tolerance", "max_parts", "sleep",        "budget"};
inline constexpr std::array<Word, 13> kBody = {
    "name",     "shape",      "shapes",   "static",           "mass",    "density", "inertia", "position",
    "rotation", "trajectory", "velocity", "angular_velocity", "material"};
inline constexpr std::array<Word, 9> kPart = {"name", "shape",   "pieces",   "position", "rotation",
                                              "mass", "density", "material", "collides"};
inline constexpr std::array<Word, 4> kPieces = {"file", "units", "scale", "by_part"};
inline constexpr std::array<Word, 2> kCollides = {"as", "with"};
inline constexpr std::array<Word, 4> kInertia = {"center", "moments", "products", "rotation"};
inline constexpr std::array<Word, 2> kCombinations = {"geometric_mean", "maximum"};
inline constexpr std::array<Word, 1> kBodyTrajectory = {"keyframes"};
inline constexpr std::array<Word, 3> kBodyKeyframe = {"time", "position", "rotation"};
inline constexpr std::array<Word, 14> kJoint = {"name",    "type",     "body",        "to",        "point",
                                                "axis",    "limits",   "restitution", "stiffness", "rest",
                                                "damping", "friction", "armature",    "start"};
inline constexpr std::array<Word, 3> kCoupling = {"joint", "follows", "polynomial"};
inline constexpr std::array<Word, 2> kTendon = {"name", "joints"};
inline constexpr std::array<Word, 12> kDrive = {"name", "joint",  "tendon", "type",    "stiffness", "damping",
                                                "gain", "offset", "force",  "control", "target",    "trajectory"};
inline constexpr std::array<Word, 4> kDriveTypes = {"position", "velocity", "motor", "affine"};
inline constexpr std::array<Word, 1> kDriveTrajectory = {"keyframes"};
inline constexpr std::array<Word, 2> kDriveKeyframe = {"time", "value"};
inline constexpr std::array<Word, 4> kFrame = {"name", "body", "position", "rotation"};
inline constexpr std::array<Word, 4> kJointTypes = {"pivot", "slider", "ball", "weld"};
inline constexpr std::array<Word, 3> kPair = {"bodies", "touch", "material"};
inline constexpr std::array<Word, 6> kMaterial = {"mu_s",           "mu_d",           "restitution",
                                                  "torsion_radius", "rolling_radius", "stribeck_speed"};
inline constexpr std::array<Word, 23> kFinger = {"name",
                                                 "radius",
                                                 "shape",
                                                 "method",
                                                 "mass",
                                                 "stiffness",
                                                 "damping",
                                                 "locked",
                                                 "force",
                                                 "position",
                                                 "rotation",
                                                 "trajectory",
                                                 "arm",
                                                 "patch_radius",
                                                 "modulus",
                                                 "effective_radius",
                                                 "twist_stiffness",
                                                 "twist_damping",
                                                 "turn_stiffness",
                                                 "turn_damping",
                                                 "taxels",
                                                 "on",
                                                 "material"};
inline constexpr std::array<Word, 3> kAxes = {"x", "y", "z"};  // that may be locked
inline constexpr std::array<Word, 3> kTaxels = {"rows", "columns", "pitch"};
inline constexpr std::array<Word, 2> kPerDirection = {"normal", "tangential"};
inline constexpr std::array<Word, 2> kArm = {"mass", "damping"};
inline constexpr std::array<Word, 4> kFingerShapeTypes = {"sphere", "capsule", "ellipsoid", "pad"};
inline constexpr std::array<Word, 2> kSphereTip = {"type", "radius"};
inline constexpr std::array<Word, 3> kCapsuleTip = {"type", "radius", "half"};
inline constexpr std::array<Word, 2> kEllipsoidTip = {"type", "semi_axes"};
inline constexpr std::array<Word, 6> kPadTip = {"type", "points", "file", "units", "scale", "rounding"};
inline constexpr std::array<Word, 2> kTrajectory = {"keyframes", "csv"};
inline constexpr std::array<Word, 3> kKeyframe = {"time", "position", "rotation"};
inline constexpr std::array<Word, 2> kRecord = {"interval", "quantities"};
inline constexpr std::array<Word, 7> kExpectation = {"quantity",  "time",    "relation", "value",
                                                     "tolerance", "because", "hash"};
// An expectation of the whole state's hash instead of a quantity.
inline constexpr std::array<Word, 3> kHashExpectation = {"hash", "time", "because"};

// Types of shape, then the keys of each.
inline constexpr std::array<Word, 9> kShapeTypes = {"sphere",     "box",  "capsule", "cylinder", "cylinder_with_flat",
                                                    "half_space", "dish", "mesh",    "convex"};
inline constexpr std::array<Word, 2> kSphere = {"type", "radius"};
inline constexpr std::array<Word, 2> kBox = {"type", "size"};
inline constexpr std::array<Word, 3> kCapsule = {"type", "radius", "length"};
inline constexpr std::array<Word, 3> kCylinder = {"type", "radius", "length"};
inline constexpr std::array<Word, 4> kCylinderWithFlat = {"type", "radius", "length", "flat_distance"};
inline constexpr std::array<Word, 3> kHalfSpace = {"type", "normal", "point"};
inline constexpr std::array<Word, 2> kDish = {"type", "radius"};
inline constexpr std::array<Word, 10> kMesh = {"type",  "file",     "part",         "units",        "scale",
                                               "lathe", "segments", "crease_angle", "file_normals", "shading"};
inline constexpr std::array<Word, 6> kConvex = {"type", "points", "file", "part", "units", "scale"};

}  // namespace pincer::tasks::keys
