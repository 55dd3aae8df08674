#include "pincer/tasks/run/robot/mjcf_grammar.h"

#include <array>

namespace pincer::tasks::mjcf {
namespace {

// Elements that may hold an element, separated by blanks.
constexpr std::string_view kBodies = "body worldbody frame replicate";
constexpr std::string_view kBodiesAndDefault = "body worldbody frame replicate default";

// Remedies that several rows share.
constexpr std::string_view kTransmission =
    "Drives act on joints and fixed tendons here, and at once. Leave the attribute out, or replace the transmission.";
constexpr std::string_view kActivation =
    "Drives here have no state of their own: use motor, position, velocity or general with dyntype=\"none\".";
constexpr std::string_view kSoft = "Bodies are rigid here: leave it out, or make it of rigid bodies.";

// Short names, for the rows.
constexpr Verdict kLooks = Verdict::kLooks, kIgnored = Verdict::kIgnored, kRefused = Verdict::kRefused,
                  kRead = Verdict::kRead;

// MJCF's elements: element, its parents, and the attributes that are read, looked at, ignored and refused.
constexpr std::array kRows = {
    GrammarRow{"mujoco", "mujoco", "", kRead, "model"},
    GrammarRow{"compiler", "compiler", "mujoco", kRead,
               "autolimits boundmass boundinertia settotalmass balanceinertia strippath angle eulerseq meshdir "
               "assetdir inertiafromgeom "
               "inertiagrouprange alignfree coordinate",
               "texturedir discardvisual usethread fusestatic saveinertial conflict", "", "fitaabb",
               "Geoms aren't fitted to meshes here."},
    GrammarRow{"lengthrange", "lengthrange", "compiler", kLooks},
    GrammarRow{"option", "option", "mujoco", kRead, "timestep gravity", "",
               "impratio tolerance ls_tolerance noslip_tolerance ccd_tolerance sleep_tolerance wind magnetic density "
               "viscosity o_margin o_solref "
               "o_solimp o_friction integrator cone jacobian solver iterations ls_iterations noslip_iterations "
               "ccd_iterations sdf_iterations "
               "sdf_initpoints actuatorgroupdisable"},
    GrammarRow{"flag", "flag", "option", kRead,
               "constraint equality frictionloss limit contact spring damper gravity clampctrl actuation", "",
               "warmstart filterparent refsafe sensor midphase eulerdamp autoreset nativeccd island multiccd override "
               "energy fwdinv "
               "invdiscrete sleep diagexact"},
    GrammarRow{"size", "size", "mujoco", kLooks},
    GrammarRow{"statistic", "statistic", "mujoco", kLooks},
    GrammarRow{"visual", "visual", "mujoco", kLooks},
    GrammarRow{"default", "default", "mujoco default", kRead, "class"},
    GrammarRow{"default_equality", "equality", "default", kRead, "active", "", "solref solimp"},
    GrammarRow{"default_tendon", "tendon", "default", kRead,
               "limited range frictionloss springlength stiffness damping", "group width material rgba user",
               "solreflimit solimplimit solreffriction solimpfriction margin"},
    GrammarRow{"extension", "extension", "mujoco", kLooks},
    GrammarRow{"asset", "asset", "mujoco", kRead},
    GrammarRow{"mesh", "mesh", "asset default", kRead, "name class file scale refpos refquat inertia vertex face",
               "content_type normal texcoord smoothnormal material", "maxhullvert", "builtin params",
               "Write the mesh to a file and name that."},
    GrammarRow{"plugin", "plugin", "mesh body worldbody frame replicate geom composite flexcomp", kRefused, "", "", "",
               "", "Plugins are programs of MuJoCo's."},
    GrammarRow{"hfield", "hfield", "asset", kRefused, "", "", "", "",
               "Height fields aren't known here: make it a mesh."},
    GrammarRow{"skin", "skin", "asset deformable", kLooks},
    GrammarRow{"texture", "texture", "asset", kLooks},
    GrammarRow{"material", "material", "asset default", kLooks},
    GrammarRow{"model", "model", "asset", kRefused, "", "", "", "",
               "Put the other model's bodies into this file by <include>."},
    GrammarRow{"worldbody", "worldbody", "mujoco", kRead, "name pos childclass quat axisangle xyaxes zaxis euler"},
    GrammarRow{"body", "body", kBodies, kRead, "name childclass pos quat axisangle xyaxes zaxis euler mocap gravcomp",
               "user simple", "sleep"},
    GrammarRow{"frame", "frame", kBodies, kRead, "name childclass pos quat axisangle xyaxes zaxis euler"},
    GrammarRow{"replicate", "replicate", kBodies, kRead, "count offset euler sep childclass"},
    GrammarRow{"inertial", "inertial", "body frame replicate", kRead,
               "pos quat mass diaginertia axisangle xyaxes zaxis euler fullinertia"},
    GrammarRow{"joint", "joint", "body frame replicate default", kRead,
               "name class type pos axis limited actuatorfrclimited stiffness range actuatorfrcrange ref springref "
               "armature damping frictionloss springdamper",
               "group user", "solreflimit solimplimit solreffriction solimpfriction actuatorgravcomp margin"},
    GrammarRow{"freejoint", "freejoint", "body frame", kRead, "name align", "group"},
    GrammarRow{"geom", "geom", kBodiesAndDefault, kRead,
               "name class type contype conaffinity condim group priority size friction mass density shellinertia "
               "fromto pos quat axisangle "
               "xyaxes zaxis euler mesh",
               "material rgba user", "solmix solref solimp margin gap fluidshape fluidcoef",
               "surfacevel adhesion hfield fitscale",
               "Surfaces here neither run nor stick by themselves, and shapes have sizes of their own."},
    GrammarRow{"attach", "attach", kBodies, kRefused, "", "", "", "",
               "Put the other model's bodies into this file by <include>."},
    GrammarRow{"site", "site", kBodiesAndDefault, kRead, "name class pos quat axisangle xyaxes zaxis euler fromto",
               "type group material size rgba user"},
    GrammarRow{"camera", "camera", kBodiesAndDefault, kLooks},
    GrammarRow{"light", "light", kBodiesAndDefault, kLooks},
    GrammarRow{"composite", "composite", kBodies, kRefused, "", "", "", "", kSoft},
    GrammarRow{"flexcomp", "flexcomp", kBodies, kRefused, "", "", "", "", kSoft},
    GrammarRow{"deformable", "deformable", "mujoco", kRefused, "", "", "", "", kSoft},
    GrammarRow{"contact", "contact", "mujoco", kRead},
    GrammarRow{"pair", "pair", "contact default", kRead, "name class geom1 geom2 condim friction", "",
               "solref solreffriction solimp gap margin", "adhesion", "Surfaces don't stick by themselves here."},
    GrammarRow{"exclude", "exclude", "contact", kRead, "name body1 body2"},
    GrammarRow{"tendon", "tendon", "mujoco", kRead},
    GrammarRow{"spatial", "spatial", "tendon", kRefused, "", "", "", "",
               "Tendons over sites aren't known here, only fixed ones."},
    GrammarRow{"fixed", "fixed", "tendon", kRead,
               "name class limited range frictionloss springlength stiffness damping", "group user",
               "solreflimit solimplimit solreffriction solimpfriction margin",
               "actuatorfrclimited actuatorfrcrange armature", "Give them to the joints, or the drive its forcerange."},
    GrammarRow{"fixed_joint", "joint", "fixed", kRead, "joint coef"},
    GrammarRow{"equality", "equality", "mujoco", kRead},
    GrammarRow{"connect", "connect", "equality", kRead, "name class active body1 body2 anchor site1 site2", "",
               "solref solimp"},
    GrammarRow{"weld", "weld", "equality", kRead, "name class active body1 body2 relpose anchor site1 site2", "",
               "solref solimp torquescale"},
    GrammarRow{"equality_joint", "joint", "equality", kRead, "name class active joint1 joint2 polycoef", "",
               "solref solimp"},
    GrammarRow{"equality_tendon", "tendon", "equality", kRefused, "", "", "", "", "Couple the joints one by one."},
    GrammarRow{"equality_flex", "flex", "equality", kRefused, "", "", "", "", kSoft},
    GrammarRow{"flexvert", "flexvert", "equality", kRefused, "", "", "", "", kSoft},
    GrammarRow{"flexstrain", "flexstrain", "equality", kRefused, "", "", "", "", kSoft},
    GrammarRow{"actuator", "actuator", "mujoco", kRead},
    GrammarRow{"general", "general", "actuator default", kRead,
               "name class ctrlrange ctrllimited forcelimited forcerange gear joint tendon gaintype biastype gainprm "
               "biasprm dyntype",
               "group user", "actlimited actrange actdim dynprm actearly lengthrange cranklength",
               "nsample interp delay damping armature jointinparent slidersite cranksite site refsite body input "
               "velrange ffrange",
               kTransmission},
    GrammarRow{"motor", "motor", "actuator default", kRead,
               "name class ctrlrange ctrllimited forcelimited forcerange gear joint tendon", "group user",
               "lengthrange cranklength",
               "nsample interp delay damping armature jointinparent slidersite cranksite site refsite", kTransmission},
    GrammarRow{
        "position", "position", "actuator default", kRead,
        "name class ctrlrange ctrllimited forcelimited forcerange gear joint tendon kp kv dampratio inheritrange",
        "group user", "lengthrange cranklength",
        "nsample interp delay damping armature jointinparent slidersite cranksite site refsite timeconst",
        kTransmission},
    GrammarRow{"velocity", "velocity", "actuator default", kRead,
               "name class ctrlrange ctrllimited forcelimited forcerange gear joint tendon kv", "group user",
               "lengthrange cranklength",
               "nsample interp delay damping armature jointinparent slidersite cranksite site refsite", kTransmission},
    GrammarRow{"intvelocity", "intvelocity", "actuator default", kRefused, "", "", "", "", kActivation},
    GrammarRow{"orientation", "orientation", "actuator default", kRefused, "", "", "", "", kTransmission},
    GrammarRow{"pid", "pid", "actuator default", kRefused, "", "", "", "", kActivation},
    GrammarRow{"damper", "damper", "actuator default", kRefused, "", "", "", "", "Give the joint its damping."},
    GrammarRow{"cylinder", "cylinder", "actuator default", kRefused, "", "", "", "", kActivation},
    GrammarRow{"muscle", "muscle", "actuator default", kRefused, "", "", "", "", kActivation},
    GrammarRow{"adhesion", "adhesion", "actuator default", kRefused, "", "", "", "",
               "Surfaces don't stick by themselves here."},
    GrammarRow{"dcmotor", "dcmotor", "actuator default", kRefused, "", "", "", "", kActivation},
    GrammarRow{"actuator_plugin", "plugin", "actuator", kRefused, "", "", "", "", "Plugins are programs of MuJoCo's."},
    GrammarRow{"sensor", "sensor", "mujoco", kIgnored},
    GrammarRow{"custom", "custom", "mujoco", kLooks},
    GrammarRow{"keyframe", "keyframe", "mujoco", kRead},
    GrammarRow{"key", "key", "keyframe", kRead, "name time qpos qvel ctrl", "", "act mpos mquat"},
};

}  // namespace

std::span<const GrammarRow> rows() { return kRows; }

}  // namespace pincer::tasks::mjcf
