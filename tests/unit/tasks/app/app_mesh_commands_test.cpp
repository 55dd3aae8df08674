// `pincer mesh`: exit codes, names of findings, files written, and every command of docs/meshes.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh/mesh_writer.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::AppResult;
using tests::contains;
using tests::runPincer;

constexpr double kMillimetre = 1e-3;

// A cube of 40 mm without its bottom, and a whole one, written in millimetres.
void writeSamples(const std::string& open, const std::string& whole) {
  contact::TriangleMesh cube = contact::box(Vec3::Constant(0.02));
  contact::writeMesh(whole, cube, {.metres_per_unit = kMillimetre});
  cube.triangles.erase(cube.triangles.begin(), cube.triangles.begin() + 2);
  contact::writeMesh(open, cube, {.metres_per_unit = kMillimetre});
}

TEST(MeshCheckCommand, SaysByItsExitCodeWhetherAMeshIsFit) {
  const tests::TemporaryDirectory directory;
  writeSamples(directory / "open.obj", directory / "whole.obj");
  EXPECT_EQ(runPincer({"mesh", "check", directory / "whole.obj", "--units", "mm"}).exit_code, kExitOk);
  const AppResult open = runPincer({"mesh", "check", directory / "open.obj", "--units", "mm"});
  EXPECT_EQ(open.exit_code, kExitCheckFailed);
  EXPECT_TRUE(contains(open.out, "! boundary-edges: ") && contains(open.out, "--fill-holes 4")) << open.out;
  const AppResult metres = runPincer({"mesh", "check", directory / "whole.obj"});
  EXPECT_EQ(metres.exit_code, kExitCheckFailed);
  EXPECT_TRUE(contains(metres.out, "wrong-scale") && contains(metres.out, "--units mm (40 mm)")) << metres.out;
  std::ofstream(directory / "cut.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n";
  EXPECT_EQ(runPincer({"mesh", "check", directory / "cut.obj"}).exit_code, kExitBadInput);
}

TEST(MeshCheckCommand, NamesFindingsForPrograms) {
  const tests::TemporaryDirectory directory;
  writeSamples(directory / "open.obj", directory / "whole.obj");
  const JsonValue json =
      parseJson(runPincer({"mesh", "check", directory / "open.obj", "--units", "mm", "--json"}).out, "stdout");
  EXPECT_FALSE(json.at("fit").boolean());
  EXPECT_EQ(json.at("boundary_edges").number(), 4);
  EXPECT_EQ(json.at("findings").array()[0].at("name").text(), "boundary-edges");
  EXPECT_TRUE(json.at("findings").array()[0].at("unfit").boolean());
}

TEST(MeshCheckCommand, MeasuresHollowsAgainstTheFinger) {
  const tests::TemporaryDirectory directory;
  const std::string file = directory / "torus.obj";
  contact::writeMesh(file, contact::torus(0.02, 0.015, 48, 32));  // the hole's hollow has a radius of about 5 mm
  EXPECT_FALSE(contains(runPincer({"mesh", "check", file, "--finger-radius", "3"}).out, "tight-hollow"));
  const AppResult large = runPincer({"mesh", "check", file, "--finger-radius", "8"});
  EXPECT_TRUE(contains(large.out, "- tight-hollow: a finger of 8 mm")) << large.out;
  EXPECT_EQ(large.exit_code, kExitOk) << "good to know, no more";
}

TEST(MeshConvertCommand, KeepsWhatItConvertsAndScales) {
  const tests::TemporaryDirectory directory;
  const std::string in = directory / "ball.obj", out = directory / "ball.ply";
  contact::writeMesh(in, contact::icosphere(0.02, 2), {.metres_per_unit = kMillimetre});
  ASSERT_EQ(runPincer({"mesh", "convert", in, out, "--units", "mm", "--to-units", "cm"}).exit_code, kExitOk);
  const contact::TriangleMesh back = contact::readMesh(out, {.metres_per_unit = 0.01});
  EXPECT_EQ(back.triangles, contact::icosphere(0.02, 2).triangles);
  EXPECT_NEAR(back.vertices[7].norm(), 0.02, 1e-15);
  ASSERT_EQ(runPincer({"mesh", "convert", in, directory / "large.obj", "--size", "0.1"}).exit_code, kExitOk);
  const contact::MeshReport report = contact::inspect(contact::readMesh(directory / "large.obj"));
  EXPECT_NEAR((report.box_max - report.box_min).maxCoeff(), 0.1, 1e-15);
  EXPECT_EQ(runPincer({"mesh", "convert", in, in}).exit_code, kExitBadInput) << "the input is not overwritten";
}

TEST(MeshConvertCommand, ListsEveryRepairAndLeavesSoundFilesByteForByte) {
  const tests::TemporaryDirectory directory;
  writeSamples(directory / "open.obj", directory / "whole.obj");
  const AppResult repaired = runPincer({"mesh", "convert", directory / "open.obj", directory / "closed.obj", "--units",
                                        "mm", "--repair", "--fill-holes", "4"});
  ASSERT_EQ(repaired.exit_code, kExitOk) << repaired.error;
  EXPECT_TRUE(contains(repaired.out, "* filled-holes: filled 1 hole with 2 triangles")) << repaired.out;
  EXPECT_EQ(runPincer({"mesh", "check", directory / "closed.obj", "--units", "mm"}).exit_code, kExitOk);

  ASSERT_EQ(runPincer({"mesh", "convert", directory / "whole.obj", directory / "plain.obj", "--units", "mm"}).exit_code,
            kExitOk);
  const AppResult sound = runPincer({"mesh", "convert", directory / "whole.obj", directory / "again.obj", "--units",
                                     "mm", "--repair", "--weld", "1"});
  EXPECT_TRUE(contains(sound.out, "nothing to repair")) << sound.out;
  EXPECT_EQ(tests::readFile(directory / "again.obj"), tests::readFile(directory / "plain.obj"));
  EXPECT_EQ(runPincer({"mesh", "convert", directory / "whole.obj", directory / "x.obj", "--weld", "1"}).exit_code,
            kExitUsage)
      << "needs --repair";
}

// Two tetrahedra apart, the second one inside out and smaller: closed, of positive volume,
// and of no inertia that a solid could have.
constexpr const char* kFlippedPiece =
    "v 0 0 0\nv 0.01 0 0\nv 0 0.01 0\nv 0 0 0.01\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    "v 1 0 0\nv 1.009 0 0\nv 1 0.009 0\nv 1 0 0.009\nf 5 6 7\nf 5 8 6\nf 5 7 8\nf 6 8 7\n";

TEST(MeshInfoCommand, DoesNotGiveUpOnAFlippedPiece) {
  const tests::TemporaryDirectory directory;
  const std::string file = directory / "flipped.obj";
  std::ofstream(file) << kFlippedPiece;
  const AppResult info = runPincer({"mesh", "info", file, "--units", "m"});
  EXPECT_EQ(info.exit_code, kExitOk) << info.error;
  EXPECT_TRUE(contains(info.out, file)) << info.out;
  EXPECT_TRUE(contains(info.out, "flipped-component")) << info.out;
  EXPECT_TRUE(contains(info.out, "no mass: parts of the surface are turned inside out")) << info.out;
  const AppResult json = runPincer({"mesh", "info", file, "--units", "m", "--json"});
  EXPECT_EQ(json.exit_code, kExitOk) << json.error;
  EXPECT_FALSE(contains(json.out, "principal_moments")) << json.out;
  const AppResult check = runPincer({"mesh", "check", file, "--units", "m"});
  EXPECT_EQ(check.exit_code, kExitCheckFailed) << check.error;
}

TEST(MeshConvertCommand, SaysByItsExitCodeThatARepairLeftTheMeshOpen) {
  const tests::TemporaryDirectory directory;
  const std::string open = directory / "open.obj", out = directory / "out.obj";
  std::ofstream(open) << "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";
  const AppResult repaired = runPincer({"mesh", "convert", open, out, "--units", "mm", "--repair"});
  EXPECT_EQ(repaired.exit_code, kExitCheckFailed) << repaired.out << repaired.error;
  EXPECT_TRUE(std::filesystem::exists(out));
  EXPECT_TRUE(contains(repaired.out, "boundary-edges")) << repaired.out;
  EXPECT_EQ(runPincer({"mesh", "convert", open, out, "--units", "mm"}).exit_code, kExitOk) << "nothing was promised";
  EXPECT_EQ(runPincer({"mesh", "convert", open, out, "--units", "mm", "--repair", "--fill-holes", "10"}).exit_code,
            kExitOk);
}

TEST(MeshRoundEdgesCommand, WritesNormalsThatMakeItSmooth) {
  const tests::TemporaryDirectory directory;
  writeSamples(directory / "open.obj", directory / "whole.obj");
  const std::string out = directory / "round.obj";
  const AppResult result =
      runPincer({"mesh", "round-edges", directory / "whole.obj", out, "--units", "mm", "--radius", "1.5"});
  ASSERT_EQ(result.exit_code, kExitOk) << result.error;
  EXPECT_TRUE(contains(result.out, "rounded 12 edges, 8 corners and 0 tips to 1.5 mm")) << result.out;
  const contact::MeshReport report = contact::inspect(contact::readMesh(out, {.metres_per_unit = kMillimetre}));
  EXPECT_TRUE(report.closed && report.file_normals && report.crease_edges == 0);
  const AppResult large =
      runPincer({"mesh", "round-edges", directory / "whole.obj", out, "--units", "mm", "--radius", "30"});
  EXPECT_EQ(large.exit_code, kExitBadInput);
  EXPECT_TRUE(contains(large.error, "--radius 19.8")) << large.error;
}

TEST(MeshSimplifyCommand, MakesAPartOfAScan) {
  const tests::TemporaryDirectory directory;
  const std::string scan = directory / "scan.obj", part = directory / "part.obj", fine = directory / "fine.obj";
  // 30,000 triangles
  contact::writeMesh(scan, contact::gridBox(Vec3::Constant(0.02), 50), {.metres_per_unit = kMillimetre});
  const AppResult check = runPincer({"mesh", "check", scan, "--units", "mm"});
  EXPECT_TRUE(contains(check.out, "many-triangles") && contains(check.out, "`pincer mesh simplify`")) << check.out;
  const AppResult result = runPincer({"mesh", "simplify", scan, part, "--units", "mm"});
  ASSERT_EQ(result.exit_code, kExitOk) << result.error;
  EXPECT_TRUE(contains(result.out, ": 12 of 30000 triangles")) << result.out;
  ASSERT_EQ(runPincer({"mesh", "subdivide", part, fine, "--units", "mm", "--levels", "2"}).exit_code, kExitOk);
  const contact::MeshReport report = contact::inspect(contact::readMesh(fine, {.metres_per_unit = kMillimetre}));
  EXPECT_EQ(report.triangles, 12 * 16);
  EXPECT_EQ(report.crease_edges, 12 * 4);
}

TEST(MeshConvertCommand, OneBadPolygonIsLeftOutUnderRepair) {
  const tests::TemporaryDirectory directory;
  writeSamples(directory / "open.obj", directory / "whole.obj");
  const std::string bad = directory / "bad.obj", out = directory / "out.obj";
  std::ofstream(bad) << tests::readFile(directory / "whole.obj") << "f 1 2 99\n";
  EXPECT_EQ(runPincer({"mesh", "convert", bad, out, "--units", "mm"}).exit_code, kExitBadInput);
  const AppResult check = runPincer({"mesh", "check", bad, "--units", "mm"});
  EXPECT_EQ(check.exit_code, kExitCheckFailed);
  EXPECT_TRUE(contains(check.out, "! bad-faces: 1 face can't be used") && contains(check.out, "uses vertex 99"))
      << check.out;
  const AppResult repaired = runPincer({"mesh", "convert", bad, out, "--units", "mm", "--repair"});
  EXPECT_EQ(repaired.exit_code, kExitOk) << repaired.out;
  EXPECT_TRUE(contains(repaired.out, "left-out-faces: left out 1 face")) << repaired.out;
}

std::vector<std::string> commandsOf(const std::string& page) {
  std::istringstream in(tests::readFile(page));
  std::vector<std::string> commands;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("    pincer ", 0) == 0) commands.push_back(line.substr(0, line.find('#')));
  }
  return commands;
}

TEST(MeshesPage, EveryCommandRuns) {
  const tests::TemporaryDirectory directory;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(directory.path());
  writeSamples("scan.stl", "part.obj");
  const std::vector<std::string> commands = commandsOf(PINCER_SOURCE_DIR "/docs/meshes.md");
  EXPECT_GE(commands.size(), 8u);
  for (const std::string& command : commands) {
    std::istringstream words(command);
    std::vector<std::string> arguments{std::istream_iterator<std::string>(words), {}};
    arguments.erase(arguments.begin());
    const AppResult result = runPincer(arguments);
    // the scan lacks its bottom
    const bool stays_open = contains(command, "--repair") && !contains(command, "--fill-holes");
    EXPECT_EQ(result.exit_code, stays_open ? kExitCheckFailed : kExitOk) << command << "\n" << result.error;
  }
  std::filesystem::current_path(before);
}

// The names as the sources write them.
std::set<std::string> findingNames() {
  std::set<std::string> names;
  const std::regex finding("\\{\\s*\"([a-z-]+)\",\\s*(true|false)");
  for (const char* file :
       {"/contact/mesh/mesh_findings.cpp", "/contact/mesh/mesh_report.cpp", "/tasks/app/commands/mesh_check.cpp"}) {
    const std::string text = tests::readFile(std::string(PINCER_SOURCE_DIR) + file);
    for (std::sregex_iterator it(text.begin(), text.end(), finding), end; it != end; ++it) names.insert((*it)[1]);
  }
  return names;
}

TEST(MeshesPage, ExplainsEveryFinding) {
  const std::string page = tests::readFile(PINCER_SOURCE_DIR "/docs/meshes.md");
  EXPECT_EQ(findingNames().size(), 23u);
  for (const std::string& name : findingNames()) EXPECT_TRUE(contains(page, "| `" + name + "` |")) << name;
}

}  // namespace
}  // namespace pincer::tasks
