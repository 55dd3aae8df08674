// Bodies of several shapes in scene files: what they weigh, what they are called, and one line of
// complaint for each thing that can be wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

const std::string kBallPart = R"("shape": {"type": "sphere", "radius": 0.01})";

std::string sceneOfParts(const std::string& body, const std::string& parts) {
  return R"({"version": 1, "duration": 0.1, "bodies": [{"name": "thing", )" + body + R"("shapes": [)" + parts + "]}]}";
}

TEST(SceneShapes, HaveTheirPosesMaterialsAndShares) {
  const Scene scene = parseScene(
      sceneOfParts(R"("mass": 0.3, "material": {"mu_s": 0.7}, )",
                   "{" + kBallPart + R"(, "name": "left", "position": [-0.02, 0, 0], "mass": 0.2}, {)" + kBallPart +
                       R"(, "position": [0.02, 0, 0], "rotation": [0, 0, 1],
                                                                     "material": {"mu_s": 0.2}, "collides": {"as": 2, "with": 4}})"),
      "s.json");
  const std::vector<engine::ColliderSpec>& shapes = scene.bodies.at(0).shapes;
  ASSERT_EQ(shapes.size(), 2u);
  EXPECT_EQ(shapes[0].name, "left");
  EXPECT_EQ(shapes[1].name, "shape1");
  EXPECT_EQ(shapes[1].X_BS.p, Vec3(0.02, 0, 0));
  EXPECT_EQ(shapes[1].bits.as, 2u);
  EXPECT_EQ(shapes[1].bits.with, 4u);
  const engine::WorldModel world = buildWorld(scene).world;
  EXPECT_EQ(world.colliders[0].material.mu_s, 0.7);
  EXPECT_EQ(world.colliders[1].material.mu_s, 0.2);
  EXPECT_NEAR(world.bodies[0].X_BI.p.x(), -0.02 / 3, 1e-15);  // (0.1 - 0.2) x 20 mm / 0.3
}

TEST(SceneShapes, WeighByDensityOrByTheirOwnMasses) {
  const double ball = 4.0 / 3 * std::acos(-1.0) * 1e-6;
  const auto massOf = [](const std::string& body, const std::string& parts) {
    return buildWorld(parseScene(sceneOfParts(body, parts), "s.json")).world.bodies[0].mass;
  };
  EXPECT_NEAR(massOf(R"("density": 1000, )", "{" + kBallPart + "}, {" + kBallPart + "}"), 2000 * ball, 1e-15);
  EXPECT_NEAR(massOf(R"("density": 1000, )", "{" + kBallPart + R"(, "mass": 0.5}, {)" + kBallPart + "}"),
              0.5 + 1000 * ball, 1e-15);
  EXPECT_NEAR(massOf("", "{" + kBallPart + R"(, "mass": 0.5}, {)" + kBallPart + R"(, "density": 1000})"),
              0.5 + 1000 * ball, 1e-15);
}

TEST(SceneShapes, AnInertiaIsTakenAsGiven) {
  const std::string body =
      R"({"version": 1, "duration": 1, "bodies": [{"mass": 0.1, )" + kBallPart +
      R"(, "inertia": {"center": [0, 0, 0.005], "moments": [1e-5, 2e-5, 2.5e-5], "products": [1e-6, 0, 0]}}]})";
  const engine::BodyModel model = buildWorld(parseScene(body, "s.json")).world.bodies[0];
  const Mat3 R = model.X_BI.q.toRotationMatrix(), I = R * model.moments.asDiagonal() * R.transpose();
  EXPECT_NEAR(I(0, 1), 1e-6, 1e-18);
  EXPECT_NEAR(I(2, 2), 2.5e-5, 1e-18);
  EXPECT_EQ(model.X_BI.p, Vec3(0, 0, 0.005));
}

// Two cubes of a file whose vertices they don't share, a centimetre apart.
TEST(SceneShapes, PiecesOfAFileAreItsPartsThatHangTogether) {
  const tests::TemporaryDirectory folder;
  std::ofstream out(folder / "pieces.obj");
  for (int piece = 0; piece < 2; ++piece) {
    for (int k = 0; k < 8; ++k)
      out << "v " << (k & 1 ? 10 : 0) + 20 * piece << ' ' << (k & 2 ? 10 : 0) << ' ' << (k & 4 ? 10 : 0) << '\n';
    const int n = 8 * piece;
    for (const auto& f : {std::array{1, 3, 4, 2}, std::array{5, 6, 8, 7}, std::array{1, 2, 6, 5},
                          std::array{3, 7, 8, 4}, std::array{1, 5, 7, 3}, std::array{2, 4, 8, 6}})
      out << "f " << f[0] + n << ' ' << f[1] + n << ' ' << f[2] + n << ' ' << f[3] + n << '\n';
  }
  out.close();
  const std::string parts = R"({"name": "block", "pieces": {"file": "pieces.obj", "units": "mm"}, "mass": 0.2})";
  const Scene scene = parseScene(sceneOfParts("", parts), folder / "s.json");
  ASSERT_EQ(scene.bodies[0].shapes.size(), 2u);
  EXPECT_EQ(scene.bodies[0].shapes[1].name, "block-1");
  EXPECT_NEAR(scene.bodies[0].shapes[1].mass, 0.1, 1e-15);
  EXPECT_LT((buildWorld(scene).world.bodies[0].X_BI.p - Vec3(0.015, 0.005, 0.005)).norm(), 1e-15);
}

// A cup whose wall has a thickness, open above, and a block as its handle: two objects of one file.
void writeCup(const std::string& path, bool has_floor = true) {
  std::ofstream out(path);
  out << "o Cup\n";
  constexpr int kSides = 6;
  for (const auto& [radius, z] : {std::pair{20, 0}, {20, 40}, {16, 40}, {16, 4}}) {
    for (int i = 0; i < kSides; ++i)
      out << "v " << radius * math::cos(2 * M_PI * i / kSides) << ' ' << radius * math::sin(2 * M_PI * i / kSides)
          << ' ' << z << '\n';
  }
  for (int k = 0; k < 3 * kSides; k += kSides) {
    for (int i = 0; i < kSides; ++i) {
      const int a = k + i + 1, b = k + (i + 1) % kSides + 1;
      out << "f " << a << ' ' << b << ' ' << b + kSides << ' ' << a + kSides << '\n';
    }
  }
  out << "f 6 5 4 3 2 1\n";
  if (has_floor) out << "f 19 20 21 22 23 24\n";
  out << "o Handle\n";
  for (int k = 0; k < 8; ++k)
    out << "v " << (k & 1 ? 35 : 20) << ' ' << (k & 2 ? 3 : -3) << ' ' << (k & 4 ? 30 : 10) << '\n';
  out << "f 25 27 28 26\nf 29 30 32 31\nf 25 26 30 29\nf 27 31 32 28\nf 25 29 31 27\nf 26 28 32 30\n";
}

// Each fingertip of a robot had its hull built anew, which was most of what loading it took.
TEST(SceneShapes, EqualHullsAreBuiltOnce) {
  const auto body = [](const std::string& name, const std::string& height) {
    return R"({"name": ")" + name + R"(", "mass": 1, "shape": {"type": "convex",
      "points": [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, )" +
           height + "]]}}";
  };
  const Scene scene = parseScene(R"({"version": 1, "duration": 0.1, "bodies": [)" + body("a", "0.1") + ", " +
                                     body("b", "0.2") + ", " + body("c", "0.1") + "]}",
                                 "s.json");
  const auto hull = [&](std::size_t i) { return std::get<contact::Convex>(scene.bodies[i].shape).hull; };
  EXPECT_EQ(hull(0), hull(2));
  EXPECT_NE(hull(0), hull(1));
  EXPECT_EQ(hull(1)->boundingRadius(), 0.2);
}

TEST(SceneShapes, ANamedPartOfAFileIsAShapeOfItsOwn) {
  const tests::TemporaryDirectory folder;
  writeCup(folder / "cup.obj");
  const std::string
      cup = R"({"shape": {"type": "mesh", "file": "cup.obj", "units": "mm", "part": "Cup"}, "mass": 0.2}, )",
      handle = R"({"shape": {"type": "convex", "file": "cup.obj", "units": "mm", "part": "Handle"}, )"
               R"("mass": 0.02})";
  const Scene scene = parseScene(sceneOfParts("", cup + handle), folder / "s.json");
  ASSERT_EQ(scene.bodies[0].shapes.size(), 2u);
  EXPECT_EQ(std::get<contact::Mesh>(scene.bodies[0].shapes[0].shape).surface->triangles().triangles.size(), 44u);
  EXPECT_EQ(std::get<contact::Convex>(scene.bodies[0].shapes[1].shape).hull->faces().size(), 6u);
  const double x = buildWorld(scene).world.bodies[0].X_BI.p.x();
  EXPECT_NEAR(x, 0.02 * 0.0275 / 0.22, 1e-12) << "the cup's middle is on its axis, the handle's 27.5 mm from it";
}

TEST(SceneShapes, SayWhatIsWrongWithNamedParts) {
  const tests::TemporaryDirectory folder;
  writeCup(folder / "cup.obj");
  writeCup(folder / "open.obj", false);
  const auto complaint = [&](const std::string& parts) {
    const std::string text = tests::errorOf([&] { parseScene(sceneOfParts("", parts), folder / "s.json"); });
    const std::size_t at = text.find("s.json:1: ");
    return at == std::string::npos ? text : text.substr(at + 10);
  };
  const auto has = [&](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos ? testing::AssertionSuccess() : testing::AssertionFailure() << text;
  };
  EXPECT_TRUE(has(complaint(R"({"shape": {"type": "mesh", "file": "cup.obj", "units": "mm", "part": "Handel"}})"),
                  "cup.obj: no part of it is called \"Handel\". Did you mean \"Handle\"?"));
  EXPECT_TRUE(has(complaint(R"({"shape": {"type": "mesh", "file": "open.obj", "units": "mm", "part": "Cup"}})"),
                  "open.obj, part \"Cup\""));
  EXPECT_TRUE(has(complaint(R"({"pieces": {"file": "cup.obj", "units": "mm", "by_part": true}})"),
                  "part \"Cup\" isn't convex"));
  EXPECT_TRUE(
      has(complaint(R"({"shape": {"type": "convex", "points": [], "part": "Cup"}})"), "goes with \"file\" only"));
}

// A name parts what vertices don't: a bar of two halves that share four vertices is two pieces by name, one otherwise.
TEST(SceneShapes, PiecesByPartAreTheNamedOnes) {
  const tests::TemporaryDirectory folder;
  std::ofstream out(folder / "bar.obj");
  for (int k = 0; k < 12; ++k)
    out << "v " << 10 * (k / 4) << ' ' << (k & 1 ? 10 : 0) << ' ' << (k & 2 ? 10 : 0) << '\n';
  for (int n = 0; n < 8; n += 4) {
    out << "g half" << n / 4 << '\n';
    for (const auto& f : {std::array{1, 3, 4, 2}, std::array{5, 6, 8, 7}, std::array{1, 2, 6, 5},
                          std::array{3, 7, 8, 4}, std::array{1, 5, 7, 3}, std::array{2, 4, 8, 6}})
      out << "f " << f[0] + n << ' ' << f[1] + n << ' ' << f[2] + n << ' ' << f[3] + n << '\n';
  }
  out.close();
  const auto shapesOf = [&](const std::string& more) {
    const std::string parts =
        R"({"name": "bar", "pieces": {"file": "bar.obj", "units": "mm")" + more + R"(}, "mass": 0.2})";
    return parseScene(sceneOfParts("", parts), folder / "s.json").bodies[0].shapes.size();
  };
  EXPECT_EQ(shapesOf(""), 1u);
  EXPECT_EQ(shapesOf(R"(, "by_part": false)"), 1u);
  EXPECT_EQ(shapesOf(R"(, "by_part": true)"), 2u);
}

TEST(SceneShapes, OfTheManualAreRead) {
  const std::string manual = tests::readFile(PINCER_SOURCE_DIR "/docs/scenes.md");
  const std::size_t begin = manual.find("```jsonc\n", manual.find("## Bodies of several shapes")) + 9;
  Simulation simulation(parseScene(manual.substr(begin, manual.find("```", begin) - begin), "docs/scenes.md"));
  while (simulation.ticks() < simulation.scene().ticks()) EXPECT_EQ(simulation.tick().status, engine::kStepOk);
  EXPECT_GT(simulation.bodyPose(1).p.z(), 0.01) << "it lies on its head, and leans on the handle's end";
}

TEST(SceneShapes, SayWhatIsWrongWithThem) {
  const auto complaint = [](const std::string& body, const std::string& parts) {
    return tests::errorOf([&] { buildWorld(parseScene(sceneOfParts(body, parts), "s.json")); });
  };
  const std::string mass = R"("mass": 1, )", ball = "{" + kBallPart + "}";
  EXPECT_EQ(complaint(mass, ""), "s.json:1: bodies[0].shapes is empty. Give the body one shape or more.");
  EXPECT_EQ(complaint(mass + kBallPart + ", ", ball),
            "s.json:1: bodies[0].shape doesn't go with \"shapes\". Keep one of the two.");
  EXPECT_EQ(complaint("", ball),
            "s.json:1: bodies[0] lacks the key \"mass\" [kg] (or \"density\" [kg/m^3], or \"static\": true).");
  EXPECT_EQ(complaint(mass, "{" + kBallPart + R"(, "name": "a"}, {)" + kBallPart + R"(, "name": "a"})"),
            "s.json:1: bodies[0].shapes[1].name = \"a\" is the second shape of this body called \"a\".");
  EXPECT_EQ(complaint(R"("static": true, )", "{" + kBallPart + R"(, "mass": 1})"),
            "s.json:1: bodies[0].shapes[0].mass = 1 doesn't go with a body that never moves. Remove the key.");
  EXPECT_EQ(complaint(mass, "{" + kBallPart + R"(, "mass": 2})"),
            "s.json:1: body \"thing\": its shapes' masses come to 2 kg, its own is 1. Leave one of them out, or let "
            "what is left be positive for "
            "shapes without a mass.");
  EXPECT_EQ(complaint(mass + R"("inertia": {"moments": [1, 1, 3]}, )", ball).substr(0, 50),
            "s.json:1: body \"thing\": principal moments of inert");
}

}  // namespace
}  // namespace pincer::tasks
