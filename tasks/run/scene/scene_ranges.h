// scene_ranges: where every number of a scene may lie. Whatever is within its range can be computed with: no square or
// product of two of them overflows or vanishes, and a tick of such a scene ends in a finite state, or says by its
// status what was dropped (tests/unit/tasks/run/scene_ranges_test.cpp). Wider ranges than any use of worlds of the size
// of hands, narrower than double precision. A rule with `or_zero` also takes 0, which means that there is none.
#pragma once
#include <numbers>

#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks::ranges {

// Lengths: from a hundredth of a hair's width to a building; more is a mistaken unit, less is
// below what a contact's margin can tell apart.
constexpr double kShortestLength = 1e-6, kLongestLength = 100;  // [m]
constexpr double kLongestTip = 1;                               // of a finger [m]
constexpr double kFastest = 1e3;                                // [m/s]: three times the speed of sound
constexpr double kFastestSpin = 1e4;                            // [rad/s]: a turbine
constexpr double kLightest = 1e-9, kHeaviest = 1e6;             // [kg]: a microgram, a ship
constexpr double kLongestDuration = 1e6;                        // [s]: eleven days

// Lengths and places [m], by the ends above; turns [rad]: 100 are 16 full ones; directions [-]; times [s].
inline constexpr NumberRule kLength = {
    .min = kShortestLength, .max = kLongestLength, .remedy = "Lengths are in metres: 20 mm is 0.02."};
inline constexpr NumberRule kTipLength = {
    .min = kShortestLength, .max = kLongestTip, .remedy = "Lengths are in metres: 8 mm are 0.008."};
inline constexpr NumberRule kStraightLength = {
    .min = kShortestLength,
    .max = kLongestLength,
    .remedy = "Of the straight part between the caps, in metres; 0 gives a sphere.",
    .or_zero = true};
inline constexpr NumberRule kCoordinate = {
    .min = -kLongestLength, .max = kLongestLength, .remedy = "Positions are in metres: 20 mm is 0.02."};
inline constexpr NumberRule kTipCoordinate = {
    .min = -kLongestTip, .max = kLongestTip, .remedy = "Positions are in metres: 8 mm are 0.008."};
inline constexpr NumberRule kRotation = {.min = -100, .max = 100, .remedy = "An axis times an angle in radians."};
inline constexpr NumberRule kDirection = {.min = -1e6, .max = 1e6, .remedy = "A direction, of any length but 0."};
constexpr double kShortestDirection = 1e-6;  // [-]: a shorter vector tells no direction
inline constexpr NumberRule kTime = {.min = 0, .max = kLongestDuration, .remedy = "In seconds from the start."};

// The world.
inline constexpr NumberRule kGravity = {.min = -1e3, .max = 1e3, .remedy = "In m/s^2; on Earth [0, 0, -9.81]."};
inline constexpr NumberRule kTick = {.min = 1e-5, .max = 1e-2, .remedy = "In seconds; a haptic tick is 0.001."};
inline constexpr NumberRule kDuration = {.min = 0, .max = kLongestDuration, .min_open = true, .remedy = "In seconds."};
inline constexpr NumberRule kAccuracy = {
    .min = 0, .max = 1, .remedy = "In m/s, of contacts of many that move; usual: 1e-6; 0: exact."};
inline constexpr NumberRule kTolerance = {
    .min = 1e-14, .max = 1e-2, .remedy = "Of the solver's relative residual; usual: 1e-10."};
inline constexpr NumberRule kBudget = {
    .min = 1e-6, .max = 10, .remedy = "In seconds; half a tick leaves time for everything else."};
inline constexpr NumberRule kPositionTolerance = {
    .min = 1e-12, .max = 1, .remedy = "Position error per tick in metres; 1e-6 is a micrometre."};
inline constexpr NumberRule kContactMargin = {
    .min = 1e-6, .max = 1, .remedy = "In metres; 0.001 suits hand-sized bodies."};

// The camera.
inline constexpr NumberRule kYaw = {.min = -10, .max = 10, .remedy = "In radians: 0 looks along +y, 1.57 along -x."};
inline constexpr NumberRule kPitch = {.min = -1.5, .max = 1.5, .remedy = "In radians over the horizon."};
inline constexpr NumberRule kViewDistance = {
    .min = 1e-3, .max = 1e3, .remedy = "From the camera to its target, in metres."};

// Bodies.
inline constexpr NumberRule kMass = {
    .min = kLightest, .max = kHeaviest, .remedy = "Masses are in kilograms: 75 g is 0.075."};
inline constexpr NumberRule kDensity = {
    .min = 1e-3, .max = 1e5, .remedy = "Densities are in kg/m^3: water 1000, ABS plastic 1050, aluminium 2700."};
inline constexpr NumberRule kMoment = {
    .min = 1e-24, .max = 1e12, .remedy = "Moments of inertia are in kg m^2: a ball of 75 g and 20 mm has 1.2e-5."};
inline constexpr NumberRule kProduct = {
    .min = -1e12, .max = 1e12, .remedy = "Products of inertia are in kg m^2, minus the integrals of x y."};
inline constexpr NumberRule kVelocity = {.min = -kFastest, .max = kFastest, .remedy = "Velocities are in m/s."};
inline constexpr NumberRule kSpin = {
    .min = -kFastestSpin, .max = kFastestSpin, .remedy = "Angular velocities are in rad/s."};
inline constexpr NumberRule kFriction = {
    .min = 0, .max = 100, .remedy = "A friction coefficient can't be negative; typical: skin on plastic 0.6."};
inline constexpr NumberRule kRestitution = {
    .min = 0, .max = 1, .remedy = "0 doesn't bounce, 1 loses nothing; typical: plastic on wood 0.5."};
inline constexpr NumberRule kTorsionRadius = {
    .min = 0, .max = 1, .remedy = "In metres; 0 for a point contact, a fingertip's is about 0.0033."};
inline constexpr NumberRule kRollingRadius = {
    .min = 0, .max = 1, .remedy = "In metres; 0 rolls freely, a hundredth of a ball's radius is a soft floor."};
inline constexpr NumberRule kStribeckSpeed = {
    .min = 1e-6, .max = 100, .remedy = "In m/s: below it friction rises to mu_s; 0: it doesn't.", .or_zero = true};

// Joints and what drives them, of pivots in radians and N m, of sliders in metres and N.
inline constexpr NumberRule kJointPosition = {
    .min = -1e4, .max = 1e4, .remedy = "In radians for a pivot, in metres for a slider."};
inline constexpr NumberRule kJointDamping = {
    .min = 0, .max = 1e6, .remedy = "In N m s/rad for a pivot, N s/m for a slider."};
inline constexpr NumberRule kJointStiffness = {
    .min = 0, .max = 1e9, .remedy = "In N m/rad for a pivot, N/m for a slider; 0: no spring."};
inline constexpr NumberRule kJointFriction = {
    .min = 0, .max = 1e6, .remedy = "In N m for a pivot, N for a slider; 0: none."};
inline constexpr NumberRule kArmature = {
    .min = 1e-12,
    .max = 1e6,
    .remedy = "In kg m^2 for a pivot, kg for a slider; of a geared motor n^2 times its rotor's.",
    .or_zero = true};
// Couplings, tendons and drives; units by kind of joint and control. Chosen: wider than any use.
inline constexpr NumberRule kCoefficient = {
    .min = -1e6, .max = 1e6, .remedy = "A number of the polynomial c0 + c1 q + c2 q^2 + .."};
inline constexpr NumberRule kTendonShare = {
    .min = -1e3, .max = 1e3, .remedy = "The tendon's length grows by so much of the joint's way."};
inline constexpr NumberRule kDriveGain = {.min = -1e6, .max = 1e6, .remedy = "Force per unit of the control."};
inline constexpr NumberRule kDriveForce = {.min = -1e6, .max = 1e6, .remedy = "In N m on a pivot, N on a slider."};
inline constexpr NumberRule kDriveControl = {
    .min = -1e6,
    .max = 1e6,
    .remedy = "A place, a rate or a force: what the drive's type makes of it (docs/scenes.md)."};

// Shapes.
inline constexpr NumberRule kCreaseAngle = {
    .min = 1e-6, .max = std::numbers::pi, .remedy = "In radians; 40 degrees are 0.698."};
inline constexpr NumberRule kScale = {
    .min = 1e-6, .max = 1e6, .remedy = "The shape is made this many times larger; 1 keeps its size."};

// Fingers.
inline constexpr NumberRule kProxyMass = {
    .min = 1e-6, .max = 100, .remedy = "In kilograms; 0 gives a massless tip behind its spring.", .or_zero = true};
inline constexpr NumberRule kStiffness = {
    .min = 1e-3, .max = 1e6, .remedy = "In N/m; typical: 200 to 2000.", .or_zero = true};
inline constexpr NumberRule kDamping = {.min = 0, .max = 1e5, .remedy = "In N s/m; typical: 2 to 5."};
inline constexpr NumberRule kTwist = {.min = 1e-9,
                                      .max = 1e3,
                                      .remedy = "In N m/rad or N m s/rad; a fingertip has about 0.3 and 0.001.",
                                      .or_zero = true};
// Stiffness and damping of turning [N m/rad, N m s/rad]; stiffer than a fingertip's twist, as grippers are.
inline constexpr NumberRule kTurn = {.min = 1e-6,
                                     .max = 1e6,
                                     .remedy = "In N m/rad or N m s/rad; a gripper's finger has about 50 and 0.05.",
                                     .or_zero = true};
// Pads: lengths [m] up to a hand's, modulus [Pa] up to diamond's.
inline constexpr NumberRule kTaxelPitch = {.min = 1e-5, .max = 0.1, .remedy = "In metres; 0.002 is usual."};
inline constexpr NumberRule kPatch = {
    .min = kShortestLength, .max = 0.1, .remedy = "In metres; a fingertip's patch has 0.004 to 0.006."};
inline constexpr NumberRule kModulus = {.min = 100, .max = 1e12, .remedy = "In pascals; a fingertip has about 1e5."};
inline constexpr NumberRule kEffectiveRadius = {
    .min = kShortestLength, .max = 10, .remedy = "In metres; the tip's own when missing."};
// Arms [kg], and forces on them [N].
inline constexpr NumberRule kArmMass = {.min = 1e-4, .max = 100, .remedy = "In kilograms, at the tip."};
inline constexpr NumberRule kForce = {.min = -1e4, .max = 1e4, .remedy = "In newtons."};

// Expected values: compared, not computed with.
inline constexpr NumberRule kExpected = {.min = -1e30, .max = 1e30, .remedy = "In the quantity's unit."};
inline constexpr NumberRule kExpectedTolerance = {.min = 0, .max = 1e30, .remedy = "In the quantity's own unit."};

}  // namespace pincer::tasks::ranges
