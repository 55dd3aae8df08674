// Whatever is within the ranges of a scene (tasks/run/scene/scene_ranges.h) can be computed with: random scenes
// whose numbers lie at the ends of their ranges or log-evenly between are refused with file and line, or run to a
// finite state or to one that the status flags.
#include "pincer/tasks/run/scene/scene_ranges.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <regex>

#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::draws;
using tests::errorOf;
using tests::RandomNumbers;
using tests::TemporaryDirectory;

class RandomScene {
 public:
  explicit RandomScene(std::uint64_t seed) : random_(seed) {}

  std::string text() {
    std::string bodies = body(0), fingers;
    for (int i = random_.below(4); i > 0; --i) bodies += ",\n" + body(i);
    for (int i = random_.below(3); i > 0; --i) fingers += (fingers.empty() ? "" : ",\n") + finger();
    std::string gravity = one() ? fmt::format("\"gravity\": {},\n", vector(ranges::kGravity)) : "";
    const std::string solver =
        one() ? fmt::format(
                    "\"solver\": {{\"contact_margin\": {}, \"tolerance\": {}{}}},\n", number(ranges::kContactMargin),
                    number(ranges::kTolerance),
                    one() ? "" : ", \"max_parts\": 4, \"position_tolerance\": " + number(ranges::kPositionTolerance))
              : "";
    tick_ = random_.below(3) == 0 ? std::pow(10.0, random_.uniform(-5, -2)) : 1e-3;
    return fmt::format("{{\"version\": 1, \"tick\": {}, \"duration\": {},\n{}{}\"bodies\": [\n{}\n]{}{}}}", tick_,
                       100 * tick_, gravity, solver, bodies,
                       fingers.empty() ? "" : ",\n\"fingers\": [\n" + fingers + "\n]", one() ? "" : joint());
  }

 private:
  bool one() { return random_.below(2) == 0; }

  double magnitude(double low, double high) { return std::exp(random_.uniform(std::log(low), std::log(high))); }

  // At an end of the range, log-evenly in it, or (half of them) as in scenes that people write.
  std::string number(const NumberRule& rule, double usual = 0) {
    if (usual != 0 && one()) return fmt::format("{}", std::clamp(usual * random_.uniform(0.5, 2), rule.min, rule.max));
    if (rule.or_zero && random_.below(8) == 0) return "0";
    const double least = rule.min > 0 ? rule.min : 1e-12 * rule.max;
    const int choice = random_.below(6);
    if (choice == 0) return fmt::format("{}", rule.max);
    if (choice == 1) return fmt::format("{}", rule.min_open ? least : rule.min);
    return fmt::format("{}", (rule.min < 0 && one() ? -1 : 1) * magnitude(least, rule.max));
  }
  std::string vector(const NumberRule& rule, double usual = 0) {
    return fmt::format("[{}, {}, {}]", number(rule, usual), number(rule, usual), number(rule, usual));
  }
  std::string place() { return vector(ranges::kCoordinate, 0.02); }

  std::string shape() {
    switch (random_.below(9)) {
      case 0:
        return fmt::format(R"({{"type": "sphere", "radius": {}}})", number(ranges::kLength, 0.02));
      case 1:
        return fmt::format(R"({{"type": "box", "size": {}}})", vector(ranges::kLength, 0.02));
      case 2:
        return fmt::format(R"({{"type": "capsule", "radius": {}, "length": {}}})", number(ranges::kLength, 0.02),
                           number(ranges::kStraightLength, 0.02));
      case 3:
        return fmt::format(R"({{"type": "cylinder", "radius": {}, "length": {}}})", number(ranges::kLength, 0.02),
                           number(ranges::kLength, 0.02));
      case 4:
        return fmt::format(R"({{"type": "cylinder_with_flat", "radius": {}, "length": {}, "flat_distance": {}}})",
                           number(ranges::kLength, 0.02), number(ranges::kLength, 0.02), number(ranges::kLength, 0.01));
      case 5:
        return fmt::format(R"({{"type": "half_space", "normal": {}, "point": {}}})", vector(ranges::kDirection),
                           place());
      case 6:
        return fmt::format(R"({{"type": "dish", "radius": {}}})", number(ranges::kLength, 0.1));
      case 7:
        return fmt::format(R"({{"type": "mesh", "lathe": [[0, {}], [{}, {}], [0, {}]], "segments": 12}})",
                           number(ranges::kCoordinate, -0.02), number(ranges::kLength, 0.02),
                           number(ranges::kCoordinate, 0.01), number(ranges::kCoordinate, 0.02));
      default:
        return fmt::format(R"({{"type": "convex", "points": [{}, {}, {}, {}, {}]}})", place(), place(), place(),
                           place(), place());
    }
  }

  std::string material() {
    return fmt::format(
        R"({{"mu_s": {}, "restitution": {}, "torsion_radius": {}, "rolling_radius": {}, "stribeck_speed": {}}})",
        number(ranges::kFriction, 0.5), number(ranges::kRestitution, 0.3), number(ranges::kTorsionRadius, 0.003),
        number(ranges::kRollingRadius, 0.001), number(ranges::kStribeckSpeed, 0.01));
  }

  std::string body(int i) {
    const std::string solid = shape();
    const bool support = solid.find("half_space") != std::string::npos, dish = solid.find("dish") != std::string::npos;
    if (support) return fmt::format(R"({{"name": "b{}", "shape": {}, "material": {}}})", i, solid, material());
    std::string text = fmt::format(R"({{"name": "b{}", "shape": {}, "position": {}, "rotation": {}, "material": {})", i,
                                   solid, place(), vector(ranges::kRotation), material());
    if (dish) return text + "}";
    switch (random_.below(4)) {
      case 0:
        return text + R"(, "static": true})";
      case 1:
        return text +
               fmt::format(
                   R"(, "trajectory": {{"keyframes": [{{"time": 0, "position": {}}}, {{"time": {}, "position": {}, "rotation": {}}}]}}}})",
                   place(), number({1e-6, 1e6}, 0.1), place(), vector(ranges::kRotation, 1));
      case 2:
        return text + fmt::format(R"(, "density": {}, "velocity": {}}})", number(ranges::kDensity, 1000),
                                  vector(ranges::kVelocity));
      default:
        return text + fmt::format(R"(, "mass": {}, "velocity": {}, "angular_velocity": {}}})",
                                  number(ranges::kMass, 0.1), vector(ranges::kVelocity, 0.1), vector(ranges::kSpin, 1));
    }
  }

  std::string finger() {
    std::string text = fmt::format(
        R"({{"mass": {}, "stiffness": {}, "damping": {}, "twist_stiffness": {}, "twist_damping": {}, "force": {})",
        number(ranges::kProxyMass, 0.01), number(ranges::kStiffness, 1000), number(ranges::kDamping, 5),
        number(ranges::kTwist, 0.3), number(ranges::kTwist, 0.001), vector(ranges::kForce, 1));
    text += one() ? fmt::format(R"(, "radius": {})", number(ranges::kTipLength, 0.008)) : "";
    text += one() ? fmt::format(R"(, "patch_radius": {})", number(ranges::kPatch, 0.004))
                  : fmt::format(R"(, "modulus": {}, "effective_radius": {})", number(ranges::kModulus, 1e5),
                                number(ranges::kEffectiveRadius, 0.01));
    if (one())
      text += fmt::format(R"(, "taxels": {{"rows": {}, "columns": 64, "pitch": {}}})", one() ? 2 : 64,
                          number(ranges::kTaxelPitch, 2e-3));
    if (one()) return text + fmt::format(R"(, "position": {}}})", place());
    return text +
           fmt::format(
               R"(, "trajectory": {{"keyframes": [{{"time": 0, "position": {}}}, {{"time": {}, "position": {}}}]}}}})",
               place(), number({1e-6, 1e6}, 0.1), place());
  }

  std::string joint() {
    constexpr std::array<std::string_view, 4> kinds = {"pivot", "slider", "ball", "weld"};
    const auto kind = kinds[static_cast<std::size_t>(random_.below(4))];
    const std::string damping = kind == "pivot" || kind == "slider"
                                    ? fmt::format(R"(, "damping": {})", number(ranges::kJointDamping, 0.01))
                                    : "";
    return fmt::format(R"(, "joints": [{{"type": "{}", "body": "b0", "axis": {}, "point": {}{}}}])", kind,
                       vector(ranges::kDirection, 1), place(), damping);
  }

  RandomNumbers random_;
  double tick_ = 1e-3;
};

bool isFinite(const grasp::GraspState& state) {
  for (const auto& body : state.world.bodies) {
    if (!body.X_WI.p.allFinite() || !body.X_WI.q.coeffs().allFinite() || !body.v_W.allFinite() || !body.L_W.allFinite())
      return false;
  }
  return std::all_of(state.world.points.begin(), state.world.points.end(),
                     [](const auto& p) { return p.p_W.allFinite() && p.v_W.allFinite(); });
}

struct Fate {
  bool refused = false, flagged = false;
};

Fate runOne(const std::string& text) {
  const std::regex with_line("^random\\.json:[0-9]+: ");
  std::optional<Simulation> simulation;
  const std::string said = errorOf([&] { simulation.emplace(parseScene(text, "random.json")); });
  if (!said.empty()) {
    EXPECT_TRUE(std::regex_search(said, with_line)) << said << "\n" << text;
    return {true, false};
  }
  for (int tick = 0; tick < 100; ++tick) {
    const engine::StepReport report = simulation->tick();
    if ((report.status & engine::kStateNotFinite) != 0) return {false, true};
    if (isFinite(simulation->state())) continue;
    ADD_FAILURE() << "not finite after tick " << tick << ", and no status says so:\n" << text;
    break;
  }
  return {};
}

TEST(SceneRanges, WhatIsAcceptedRunsToAFiniteStateOrAFlag) {
  int refused = 0, flagged = 0, ran = 0;
  for (int n = 0; n < draws(250, 80); ++n) {
    const std::string text = RandomScene(static_cast<std::uint64_t>(n)).text();
    const Fate fate = runOne(text);
    refused += fate.refused;
    flagged += fate.flagged;
    ran += !fate.refused && !fate.flagged;
    if (HasFailure()) break;
  }
  RecordProperty("refused", refused);
  RecordProperty("flagged", flagged);
  fmt::print("refused {}, flagged {}, ran {}\n", refused, flagged, ran);
  EXPECT_GT(ran, draws(250, 80) / 4);
}

std::string sceneOf(const std::string& body, const std::string& rest = "") {
  return fmt::format("{{\"version\": 1, \"duration\": 1,\n\"bodies\": [\n{}]{}}}", body, rest);
}

TEST(SceneRanges, AbsurdValuesAreRefusedWithTheirLine) {
  const auto said = [](const std::string& text) { return errorOf([&] { parseScene(text, "s.json"); }); };
  const auto expect = [&](const std::string& text, const std::string& part) {
    EXPECT_TRUE(said(text).starts_with("s.json:") && said(text).find(part) != std::string::npos) << said(text);
  };
  const std::string ball = R"({"shape": {"type": "sphere", "radius": 0.02}, "mass": 0.1})";
  expect(sceneOf(R"({"shape": {"type": "sphere", "radius": 1e-12}, "mass": 0.1})"),
         "radius = 1e-12 is out of range [1e-06, 100]");
  expect(
      sceneOf(R"({"shape": {"type": "convex", "points": [[0,0,0],[1e-12,0,0],[0,1e-12,0],[0,0,1e-12]]}, "mass": 0.1})"),
      "has a shape of 1e-12 m, which is out of range");
  expect(sceneOf(R"({"shape": {"type": "sphere", "radius": 0.02}, "mass": 1e-300})"),
         "mass = 1e-300 is out of range [1e-09, 1000000]");
  expect(sceneOf(R"({"shape": {"type": "sphere", "radius": 1e-6}, "density": 1e-3})"),
         "density = 0.001 makes a mass of");
  expect(sceneOf(ball, R"(, "fingers": [{"position": [0, 0, 1], "stiffness": 1e-300}])"),
         "stiffness = 1e-300 is out of range 0 or [0.001,");
  expect(sceneOf(ball, R"(, "fingers": [{"position": [0, 0, 1], "radius": 5}])"),
         "radius = 5 is out of range [1e-06, 1]");
  expect(sceneOf(ball, R"(, "solver": {"contact_margin": 50})"), "contact_margin = 50 is out of range");
  expect(sceneOf(R"({"shape": {"type": "sphere", "radius": 0.02}, "mass": 0.1, "material": {"mu_s": 1e300}})"),
         "mu_s = 1e+300 is out of range");
  expect(sceneOf(ball, R"(, "joints": [{"type": "pivot", "body": "body0", "axis": [1e-200, 0, 0]}])"), "has no length");
  expect(
      sceneOf(
          ball,
          R"(, "fingers": [{"trajectory": {"keyframes": [{"time": 0, "position": [0, 0, 0]}, {"time": 1e-5, "position": [1, 0, 0]}]}}])"),
      "faster than 1000 per second");
  expect(
      sceneOf(
          ball,
          R"(, "fingers": [{"trajectory": {"keyframes": [{"time": 0, "position": [0, 0, 0]}, {"time": 1e-300, "position": [0, 0, 0]}]}}])"),
      "at least 1e-06 s are needed");
}

TEST(SceneRanges, ATrajectoryOf1e300MetresIsRefusedWithItsLine) {
  const TemporaryDirectory folder;
  const auto said = [&](const std::string& rows) {
    std::ofstream(folder / "path.csv") << "time,x,y,z\n" << rows;
    return errorOf([&] { readTrajectoryCsv(folder / "path.csv"); });
  };
  EXPECT_NE(said("0,0,0,0\n1,1e300,0,0\n").find("path.csv:3: 1e300 is out of range [-100, 100]"), std::string::npos);
  EXPECT_NE(said("0,0,0,0\n1e-5,99,0,0\n").find("path.csv:3: from time 0 to 1e-05 it would go 99 in 1e-05 s"),
            std::string::npos);
  EXPECT_NE(said("0,0,0,0\n1e300,0,0,0\n").find("path.csv:3: 1e300 is out of range"), std::string::npos);
  EXPECT_NE(said("0,0,0,0\n1,nan,0,0\n").find("path.csv:3: \"nan\" isn't a finite number"), std::string::npos);
}

// A mistake that shows only when the world is built is told with its line as well.
TEST(SceneRanges, WhatIsRefusedLateIsRefusedWithItsLine) {
  const std::string two = R"({"name": "a", "shape": {"type": "sphere", "radius": 0.02}, "mass": 0.1},
{"name": "b", "shape": {"type": "sphere", "radius": 0.02}, "mass": 0.1, "position": [0, 0, 1]})";
  const Scene scene = parseScene(sceneOf(two,
                                         ",\n\"joints\": [{\"type\": \"pivot\", \"body\": \"a\", \"to\": \"b\"}],\n"
                                         "\"fingers\": [{\"position\": [0, 0, 2]}]"),
                                 "s.json");
  const std::string said = errorOf([&] { buildWorld(scene); });
  EXPECT_TRUE(said.starts_with("s.json:5: the 2 bodies joined with")) << said;
}

}  // namespace
}  // namespace pincer::tasks
