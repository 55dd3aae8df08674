// The house: who may include whom, and how large a page may be.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>> kMaySee = {
    {"contact", {"contact"}},
    {"engine", {"contact", "engine"}},
    {"grasp", {"contact", "engine", "grasp"}},
    {"devices", {"devices"}},  // and the functions of analysis, as all do
    {"tasks", {"contact", "engine", "grasp", "devices", "tasks"}},
};

// Sine, logarithm ..: no geometry, a library of its own below all others.
const std::string kFunctions = "contact/functions/elementary.h";

std::vector<fs::path> sourcesUnder(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    if (extension == ".h" || extension == ".cpp") files.push_back(entry.path());
  }
  return files;
}

std::vector<std::string> linesOf(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// The quoted path of an #include line, empty for other lines.
std::string includedBy(const std::string& line) {
  if (line.rfind("#include \"", 0) != 0) return {};
  return line.substr(10, line.find('"', 10) - 10);
}

TEST(House, DependenciesRunOneWay) {
  for (const auto& [folder, seen] : kMaySee) {
    const auto files = sourcesUnder(fs::path(PINCER_SOURCE_DIR) / folder);
    EXPECT_FALSE(files.empty()) << folder;
    for (const fs::path& file : files) {
      for (const std::string& line : linesOf(file)) {
        const std::string included = includedBy(line);
        if (included.empty() || included == kFunctions) continue;
        EXPECT_TRUE(seen.count(included.substr(0, included.find('/')))) << file << " includes " << included;
      }
    }
  }
}

TEST(House, FunctionsSeeNothingElse) {
  for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / "contact/functions")) {
    for (const std::string& line : linesOf(file)) {
      const std::string included = includedBy(line);
      EXPECT_TRUE(included.empty() || included.rfind("contact/functions/", 0) == 0) << file << " includes " << included;
    }
  }
}

// A participant knows what devices tell, and nothing of the world.
TEST(House, ParticipantsSeeOnlyDevices) {
  for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / "tasks/participants")) {
    for (const std::string& line : linesOf(file)) {
      const std::string included = includedBy(line);
      const bool allowed =
          included.empty() || included == kFunctions || included.rfind("devices/", 0) == 0 || included.rfind("tasks/participants/", 0) == 0;
      EXPECT_TRUE(allowed) << file << " includes " << included;
    }
  }
}

// A third-party library is named only in files whose names say so.
TEST(House, LibrariesStayInTheirFiles) {
  const std::map<std::string, std::string> home = {{"OpenMesh/", "_openmesh"}, {"LinearMath/", "_bullet"}, {"BulletCollision/", "_bullet"},
                                                   {"sqlite3.h", "_sqlite"},   {"libusb.h", "_libusb"},    {"nlohmann/", ""},
                                                   {"GLFW/", "_glfw"},         {"EGL/", "_egl"},           {"glad/", "_gl"},
                                                   {"imgui", "_imgui"},        {"png.h", "_png"}};
  for (const auto& [folder, seen] : kMaySee) {
    for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / folder)) {
      for (const std::string& line : linesOf(file)) {
        if (line.rfind("#include <", 0) != 0) continue;
        for (const auto& [library, suffix] : home) {
          if (line.find(library) == std::string::npos) continue;
          EXPECT_NE(file.extension(), ".h") << file << ": " << line;
          EXPECT_NE(file.stem().string().find(suffix), std::string::npos) << file << ": " << line;
        }
      }
    }
  }
}

TEST(House, PagesStayShort) {
  for (const auto& [folder, seen] : kMaySee) {
    for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / folder)) EXPECT_LE(linesOf(file).size(), 400u) << file;
  }
}

TEST(House, NothingElseStandsAtTheTop) {
  const std::set<std::string> agreed = {"contact", "engine",         "grasp",     "devices", "tasks", "tests",
                                        "docs",    "CMakeLists.txt", "README.md", "LICENSE", "out"};
  for (const auto& entry : fs::directory_iterator(PINCER_SOURCE_DIR)) {
    const std::string name = entry.path().filename();
    if (name[0] == '.' || name.rfind("build", 0) == 0) continue;
    EXPECT_TRUE(agreed.count(name)) << name;
  }
}

}  // namespace
