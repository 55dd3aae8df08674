// The house: who may include whom, and how large a page may be.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>> kMaySee = {
    {"contact", {"contact"}},
    {"engine", {"contact", "engine"}},
    {"grasp", {"contact", "engine", "grasp"}},
    {"devices", {"devices"}},
    {"tasks", {"contact", "engine", "grasp", "devices", "tasks"}},
};

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
        if (included.empty()) continue;
        EXPECT_TRUE(seen.count(included.substr(0, included.find('/')))) << file << " includes " << included;
      }
    }
  }
}

// What a user includes: the headers that stand directly in a library's folder. All below is private.
bool isPublic(const std::string& header) {
  const fs::path path(header);
  const std::string folder = path.parent_path();
  return path.extension() == ".h" && (folder == "contact" || folder == "engine" || folder == "grasp");
}

std::set<std::string> publicHeaders() {
  std::set<std::string> headers;
  for (const char* folder : {"contact", "engine", "grasp"}) {
    for (const auto& entry : fs::directory_iterator(fs::path(PINCER_SOURCE_DIR) / folder)) {
      const std::string name = std::string(folder) + "/" + entry.path().filename().string();
      if (isPublic(name)) headers.insert(name);
    }
  }
  return headers;
}

// Everything that including `header` pulls in, itself among it.
void pullIn(const std::string& header, std::set<std::string>& seen) {
  if (!seen.insert(header).second) return;
  for (const std::string& line : linesOf(fs::path(PINCER_SOURCE_DIR) / header)) {
    if (const std::string included = includedBy(line); !included.empty()) pullIn(included, seen);
  }
}

TEST(FrontDoor, ListsWhatStandsInIt) {
  std::set<std::string> listed;
  bool in_list = false;
  for (const std::string& line : linesOf(fs::path(PINCER_SOURCE_DIR) / "CMakeLists.txt")) {
    if (line == "set(public_headers") in_list = true;
    if (!in_list || line.find('#') != std::string::npos) continue;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      const std::string header = word.substr(0, word.find(')'));
      if (isPublic(header)) listed.insert(header);
    }
    if (line.find(')') != std::string::npos) break;
  }
  EXPECT_EQ(listed, publicHeaders());
  EXPECT_LE(listed.size(), 29u);
}

// In a library's folder nothing stands but its public headers and its CMakeLists.txt.
TEST(FrontDoor, HasNoSourcesInIt) {
  for (const char* folder : {"contact", "engine", "grasp"}) {
    for (const auto& entry : fs::directory_iterator(fs::path(PINCER_SOURCE_DIR) / folder))
      EXPECT_NE(entry.path().extension(), ".cpp") << entry.path();
  }
}

TEST(FrontDoor, LeadsToNothingPrivate) {
  for (const std::string& header : publicHeaders()) {
    std::set<std::string> pulled;
    pullIn(header, pulled);
    for (const std::string& included : pulled) EXPECT_TRUE(isPublic(included)) << header << " pulls in " << included;
  }
}

// A user pays for each in every source. What has to grow says why here.
TEST(FrontDoor, StepPullsInFewHeaders) {
  const std::map<std::string, std::size_t> most = {{"grasp/step.h", 15}, {"engine/step.h", 8}, {"contact/smooth_mesh.h", 4}};
  for (const auto& [header, count] : most) {
    std::set<std::string> pulled;
    pullIn(header, pulled);
    EXPECT_LE(pulled.size(), count) << header;
  }
}

// The private headers that tasks/ may include, and why: what a user has no use for. Shrinks, or says why it grows.
TEST(FrontDoor, TasksUseOnlyNamedBackDoors) {
  const std::set<std::string> back_doors = {
      "contact/curve/curve.h",             // experiments in the plane
      "contact/mesh/lathe.h",              // scenes' solids of revolution
      "contact/mesh/mesh_pieces.h",        // `pincer mesh`
      "contact/mesh/mesh_writer.h",        // `pincer mesh`
      "contact/mesh/round_edges.h",        // `pincer mesh`
      "contact/surface/patch.h",           // the window draws patches
      "contact/surface/self_crossings.h",  // `pincer mesh check`
      "contact/surface/surface_net.h",     // measured by `pincer bench contact`
      "engine/motion/mass.h",              // densities of scenes
      "engine/world/island_sleep.h",       // what sleeps, in `pincer bench grasp`
      "engine/world/scratch.h",            // judges look into contacts: stress, verify, bench
      "engine/world/stage_clock.h",        // `pincer plan`
  };
  for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / "tasks")) {
    for (const std::string& line : linesOf(file)) {
      const std::string included = includedBy(line), folder = included.substr(0, included.find('/'));
      if (folder != "contact" && folder != "engine" && folder != "grasp") continue;
      EXPECT_TRUE(isPublic(included) || back_doors.count(included)) << file << " includes " << included;
    }
  }
}

// A participant knows what devices tell, and nothing of the world.
TEST(House, ParticipantsSeeOnlyDevices) {
  for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / "tasks/participants")) {
    for (const std::string& line : linesOf(file)) {
      const std::string included = includedBy(line);
      const bool allowed = included.empty() || included.rfind("devices/", 0) == 0 || included.rfind("tasks/participants/", 0) == 0;
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
