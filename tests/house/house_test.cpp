// The house: who may include whom, and how large a page may be.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
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
    {"devices", {"devices"}},  // and the functions of analysis, as all do
    {"tasks", {"contact", "engine", "grasp", "devices", "tasks"}},
};

// Sine, logarithm ..: no geometry, a library of its own below all others.
const std::string kFunctions = "contact/elementary.h";

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

// The rooms of each folder and wing, from the bottom up: a room sees itself and those before it.
const std::map<std::string, std::vector<std::string>> kRooms = {
    {"contact", {"functions", "io", "mesh", "surface", "remesh", "curve", "shape"}},
    {"engine", {"motion", "solve", "tree", "world"}},
    {"grasp", {"coupling", "tick", "baseline", "passivity", "quality"}},
    {"devices", {"arm", "cld", "usb", "falcon", "haply", "weart", "gate", "window", "emulate"}},
    {"tasks", {"play", "run", "lab", "judge", "view", "share", "python", "app"}},
    {"tasks/run", {"process", "measure", "files", "robot", "session", "scene", "rollout", "tick", "servo"}},
    {"tasks/lab", {"participants", "study", "report", "finger", "experiments", "findings", "sessions", "sweep"}},
    {"tasks/app", {"commands"}},
    {"tasks/python", {"bindings"}},
    {"tasks/judge", {"exact", "solve", "verify", "stress", "bench", "peers"}},
};

// The path of an #include line of one of our headers, from the top folder; empty for other lines.
std::string includedBy(const std::string& line) {
  const std::string begin = "#include \"pincer/";
  if (line.rfind(begin, 0) != 0) return {};
  return line.substr(begin.size(), line.find('"', begin.size()) - begin.size());
}

// f(source, included): each include of one of our headers by a file under the folder; paths from the top folder.
template <class F>
void forEachInclude(const std::string& folder, F f) {
  const auto files = sourcesUnder(fs::path(PINCER_SOURCE_DIR) / folder);
  EXPECT_FALSE(files.empty()) << folder;
  for (const fs::path& file : files) {
    const std::string source = fs::relative(file, PINCER_SOURCE_DIR);
    for (const std::string& line : linesOf(file)) {
      if (const std::string included = includedBy(line); !included.empty()) f(source, included);
    }
  }
}

// The place in `rooms` of the room that `path` lies in; -1 directly in `folder`, nothing elsewhere.
std::optional<int> roomOf(const std::string& path, const std::string& folder, const std::vector<std::string>& rooms) {
  if (path.rfind(folder + "/", 0) != 0) return {};
  const std::string rest = path.substr(folder.size() + 1);
  const auto slash = rest.find('/');
  if (slash == std::string::npos) return -1;
  const auto room = std::find(rooms.begin(), rooms.end(), rest.substr(0, slash));
  EXPECT_NE(room, rooms.end()) << path << " lies in a room that kRooms doesn't know";
  return static_cast<int>(room - rooms.begin());
}

TEST(House, DependenciesRunOneWay) {
  for (const auto& [folder, seen] : kMaySee) {
    forEachInclude(folder, [&seen = seen](const std::string& source, const std::string& included) {
      if (included == kFunctions) return;
      EXPECT_TRUE(seen.count(included.substr(0, included.find('/')))) << source << " includes " << included;
    });
  }
}

// A header directly in a folder is seen by all of its rooms, a source there sees all of them.
TEST(House, ArrowsBetweenRoomsRunOneWay) {
  for (const auto& [folder, rooms] : kRooms) {
    forEachInclude(folder, [&folder = folder, &rooms = rooms](const std::string& source, const std::string& included) {
      const std::optional<int> from = roomOf(source, folder, rooms), to = roomOf(included, folder, rooms);
      if (!from || !to || *to < 0) return;
      const bool top_source = *from < 0 && fs::path(source).extension() == ".cpp";
      EXPECT_TRUE(top_source || *from >= *to) << source << " includes " << included;
    });
  }
}

TEST(House, EveryIncludeBeginsWithPincer) {
  for (const char* folder : {"contact", "engine", "grasp", "devices", "tasks", "tests"}) {
    for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / folder)) {
      for (const std::string& line : linesOf(file)) {
        EXPECT_EQ(line.rfind("#include \"", 0) == 0, !includedBy(line).empty()) << file << ": " << line;
      }
    }
  }
}

const std::set<std::string> kDoors = {"contact", "engine", "grasp", "tasks/run"};

// True of headers that a user includes: those directly in a library's folder. All below is private.
bool isPublic(const std::string& header) {
  const fs::path path(header);
  const std::string folder = path.parent_path();
  return path.extension() == ".h" && kDoors.count(folder);
}

std::set<std::string> publicHeaders() {
  std::set<std::string> headers;
  for (const std::string& folder : kDoors) {
    for (const auto& entry : fs::directory_iterator(fs::path(PINCER_SOURCE_DIR) / folder)) {
      const std::string name = folder + "/" + entry.path().filename().string();
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
  EXPECT_LE(listed.size(), 44u);
}

// In a library's folder nothing stands but its public headers and its CMakeLists.txt.
TEST(FrontDoor, HasNoSourcesInIt) {
  for (const std::string& folder : kDoors) {
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
  const std::map<std::string, std::size_t> most = {
      {"tasks/run/pincer.h", 40}, {"grasp/step.h", 17}, {"engine/step.h", 10}, {"contact/smooth_mesh.h", 5}};
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
      "contact/functions/invariants.h",    // asserts
      "contact/mesh/convex_pieces.h",      // scenes' bodies of convex pieces
      "contact/mesh/lathe.h",              // scenes' solids of revolution
      "contact/mesh/mesh_groups.h",        // scenes' named parts of a file
      "contact/mesh/mesh_pieces.h",        // `pincer mesh`
      "contact/mesh/mesh_writer.h",        // `pincer mesh`
      "contact/mesh/round_edges.h",        // `pincer mesh`
      "contact/remesh/simplify.h",         // `pincer mesh`
      "contact/surface/patch.h",           // the window draws patches
      "contact/surface/self_crossings.h",  // `pincer mesh check`
      "contact/surface/surface_net.h",     // measured by `pincer bench contact`
      "engine/motion/driven_motion.h",     // rotation vectors of imported robots
      "engine/motion/mass.h",              // densities of scenes
      "engine/world/island_sleep.h",       // what sleeps, in `pincer bench grasp`
      "engine/world/scratch.h",            // judges look into contacts: stress, verify, bench
      "engine/world/stage_clock.h",        // `pincer plan`
  };
  for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / "tasks")) {
    for (const std::string& line : linesOf(file)) {
      const std::string included = includedBy(line), folder = included.substr(0, included.find('/'));
      if (folder != "contact" && folder != "engine" && folder != "grasp") continue;
      if (included.rfind("contact/io/", 0) == 0) continue;  // whatever is read, written, shown
      EXPECT_TRUE(isPublic(included) || back_doors.count(included)) << file << " includes " << included;
    }
  }
}

// A participant knows what devices tell, and nothing of the world.
TEST(House, ParticipantsSeeOnlyDevices) {
  forEachInclude("tasks/lab/participants", [](const std::string& source, const std::string& included) {
    const bool allowed = included == kFunctions || included.rfind("devices/", 0) == 0 ||
                         included.rfind("tasks/lab/participants/", 0) == 0;
    EXPECT_TRUE(allowed) << source << " includes " << included;
  });
}

// A third-party library is named only in files whose names say so.
TEST(House, LibrariesStayInTheirFiles) {
  const std::map<std::string, std::string> home = {
      {"OpenMesh/", "_openmesh"}, {"LinearMath/", "_bullet"}, {"BulletCollision/", "_bullet"},
      {"sqlite3.h", "_sqlite"},   {"libusb.h", "_libusb"},    {"nlohmann/", ""},
      {"GLFW/", "_glfw"},         {"EGL/", "_egl"},           {"glad/", "_gl"},
      {"imgui", "_imgui"},        {"png.h", "_png"},          {"boost/", "_beast"},
      {"pybind11/", "_pybind11"}, {"hdf5.h", "_hdf5"},        {"zlib.h", "_zlib"},
      {"simdjson", "_simdjson"}};
  for (const auto& [folder, seen] : kMaySee) {
    for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / folder)) {
      for (const std::string& line : linesOf(file)) {
        if (line.rfind("#include <", 0) != 0) continue;
        for (const auto& [library, suffix] : home) {
          if (line.find(library) == std::string::npos) continue;
          // The module's helpers are templates over pybind11's types; nobody but the module sees them.
          const bool is_binding = file.string().find("tasks/python/bindings/") != std::string::npos;
          EXPECT_TRUE(is_binding || file.extension() != ".h") << file << ": " << line;
          EXPECT_NE(file.stem().string().find(suffix), std::string::npos) << file << ": " << line;
        }
      }
    }
  }
}

// fmt's print() throws where a stream can't be written (tasks/app/print.h).
TEST(House, NobodyPrintsWhatMayThrow) {
  for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / "tasks")) {
    if (file.filename() == "print.h") continue;
    for (const std::string& line : linesOf(file))
      EXPECT_EQ(line.find("fmt::print("), std::string::npos) << file << ": " << line;
  }
}

// The names of constants that stand at the left margin of a file, and so aren't members or locals.
std::set<std::string> constantsOf(const fs::path& file) {
  std::set<std::string> names;
  for (const std::string& line : linesOf(file)) {
    if (line.rfind("constexpr ", 0) != 0 && line.rfind("inline constexpr ", 0) != 0) continue;
    const std::string before = line.substr(0, std::min(line.find_first_of("={"), line.size()));
    const auto end = before.find_last_not_of(' '), begin = before.find_last_of(" >", end);
    if (end != std::string::npos && begin != std::string::npos) names.insert(before.substr(begin + 1, end - begin));
  }
  return names;
}

// Where sources are compiled several at once, a file's own kFewContacts (200) hid the solver's (60) from the files
// after it: walls of up to 200 contacts didn't come to rest, and other builds gave other bits.
TEST(House, ConstantsOfOneFileDontHideThoseOfHeaders) {
  for (const std::string folder : {"contact", "engine", "grasp", "devices"}) {
    std::set<std::string> shared;
    const auto files = sourcesUnder(fs::path(PINCER_SOURCE_DIR) / folder);
    for (const fs::path& file : files) {
      if (file.extension() == ".h") shared.merge(constantsOf(file));
    }
    EXPECT_FALSE(shared.empty()) << folder;
    for (const fs::path& file : files) {
      if (file.extension() == ".h") continue;
      for (const std::string& name : constantsOf(file)) EXPECT_EQ(shared.count(name), 0u) << file << ": " << name;
    }
  }
}

TEST(House, PagesStayShort) {
  for (const auto& [folder, seen] : kMaySee) {
    for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / folder))
      EXPECT_LE(linesOf(file).size(), 400u) << file;
  }
}

std::size_t columnsOf(const std::string& line) {
  return static_cast<std::size_t>(std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

// Of code and comments; texts in raw strings are as wide as what they are written for.
std::vector<std::string> widerThan(std::size_t columns, const fs::path& file) {
  std::vector<std::string> wide;
  std::string raw;  // what ends the raw string that the line begins in
  for (const std::string& line : linesOf(file)) {
    const std::size_t begin = line.find("R\"");
    const bool in_raw = !raw.empty() || begin != std::string::npos;
    if (!in_raw && columnsOf(line) > columns) wide.push_back(line);
    std::size_t from = 0;
    if (raw.empty() && begin != std::string::npos) {
      from = line.find('(', begin);
      raw = ")" + line.substr(begin + 2, from - begin - 2) + "\"";
    }
    if (!raw.empty() && line.find(raw, from) != std::string::npos) raw.clear();
  }
  return wide;
}

TEST(House, LinesOfCodeKeepTo120Columns) {
  for (const std::string folder : {"contact", "engine", "grasp", "devices", "tasks", "tests"}) {
    for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / folder)) {
      for (const std::string& line : widerThan(120, file)) ADD_FAILURE() << file << ": " << line;
    }
  }
}

// A comment has a subject: "Returns the ...", "True if ...", "The gap along the normal".
TEST(House, CommentsBeginWithTheirSubject) {
  int comments = 0;
  for (const std::string folder : {"contact", "engine", "grasp", "devices", "tasks", "tests"}) {
    for (const fs::path& file : sourcesUnder(fs::path(PINCER_SOURCE_DIR) / folder)) {
      for (const std::string& line : linesOf(file)) {
        const auto begin = line.find("// ");
        if (begin == line.npos || line.find_first_not_of(' ') != begin) continue;
        ++comments;
        for (const char* first : {"What ", "Whether ", "Those that ", "Of what "})
          EXPECT_NE(line.compare(begin + 3, std::strlen(first), first), 0) << file << ": " << line;
      }
    }
  }
  EXPECT_GT(comments, 5'000);  // of about 10,000
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
