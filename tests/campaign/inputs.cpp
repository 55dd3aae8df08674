#include "pincer/tests/campaign/inputs.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace pincer::campaign {
namespace {

constexpr std::array<const char*, 5> kStudies = {"smoothness-discrimination", "shape-identification",
                                                 "repeated-localisation", "backlash-discrimination",
                                                 "delay-discrimination"};

void put(const fs::path& file, const std::string& bytes) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
}

Ended make(const Ground& ground, std::vector<std::string> arguments, std::optional<Blow> blow = {},
           const std::set<int>& codes = {0}) {
  Launch launch;
  launch.program = ground.pincer;
  launch.arguments = std::move(arguments);
  launch.folder = ground.inputs();
  launch.log = ground.inputs() / "log";
  launch.limit = 120;
  launch.blow = blow;
  Ended ended = run(launch);
  if (codes.contains(ended.exit_code) && (ended.signal == 0 || blow)) return ended;
  throw std::runtime_error(shellText(launch) + " failed, though nothing was done to it: " + ended.error);
}

constexpr const char* kTrajectoryScene = R"({
  "version": 1, "description": "A finger goes where a table says", "duration": 0.2,
  "bodies": [{"name": "ball", "shape": {"type": "sphere", "radius": 0.02}, "mass": 0.1, "position": [0, 0, 0.1], "material": {"mu_s": 0.5}}],
  "fingers": [{"name": "tip", "radius": 0.008, "trajectory": {"csv": "trajectory.csv"}}]
})";

constexpr const char* kRobot = R"(<mujoco model="arm">
  <compiler angle="radian"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body name="upper" pos="0 0 0.5">
      <joint name="shoulder" axis="0 1 0" range="-1.5 1.5" damping="0.1"/>
      <geom type="capsule" fromto="0 0 0 0 0 -0.2" size="0.02" mass="0.5"/>
      <body name="lower" pos="0 0 -0.2">
        <joint name="elbow" axis="0 1 0" range="0 2"/>
        <geom type="box" size="0.02 0.02 0.1" pos="0 0 -0.1" mass="0.3"/>
      </body>
    </body>
  </worldbody>
  <actuator><position name="bend" joint="elbow" kp="20" kv="0.5"/></actuator>
</mujoco>
)";

void makeTrajectory(const Ground& ground) {
  std::string table = "time,x,y,z\n";
  for (int i = 0; i <= 20; ++i) table += fmt::format("{},{},{},{}\n", 0.01 * i, -0.05 + 0.001 * i, 0.0005 * i, 0.1);
  put(trajectoryTable(ground), table);
  put(trajectoryScene(ground), kTrajectoryScene);
}

// A cube of 40 mm in units of 10 mm.
constexpr std::array<std::array<float, 3>, 8> kCorners = {
    {{-2, -2, -2}, {2, -2, -2}, {2, 2, -2}, {-2, 2, -2}, {-2, -2, 2}, {2, -2, 2}, {2, 2, 2}, {-2, 2, 2}}};
constexpr std::array<std::array<int, 3>, 12> kFaces = {{{0, 2, 1},
                                                        {0, 3, 2},
                                                        {4, 5, 6},
                                                        {4, 6, 7},
                                                        {0, 1, 5},
                                                        {0, 5, 4},
                                                        {1, 2, 6},
                                                        {1, 6, 5},
                                                        {2, 3, 7},
                                                        {2, 7, 6},
                                                        {3, 0, 4},
                                                        {3, 4, 7}}};

template <class T>
void append(std::string& bytes, T value, bool big_endian = false) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

std::string textStl() {
  std::string text = "solid cube\n";
  for (const auto& face : kFaces) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const int corner : face)
      text += fmt::format("  vertex {}\n", fmt::join(kCorners[static_cast<std::size_t>(corner)], " "));
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid cube\n";
}

std::string binaryStl() {
  std::string bytes(80, ' ');
  append(bytes, static_cast<std::uint32_t>(kFaces.size()));
  for (const auto& face : kFaces) {
    for (int i = 0; i < 3; ++i) append(bytes, 0.f);
    for (const int corner : face) {
      for (const float x : kCorners[static_cast<std::size_t>(corner)]) append(bytes, x);
    }
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string plyHeader(const char* format) {
  return fmt::format(
      "ply\nformat {} 1.0\ncomment a cube\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      format, kCorners.size(), kFaces.size());
}

std::string binaryPly(bool big_endian) {
  std::string bytes = plyHeader(big_endian ? "binary_big_endian" : "binary_little_endian");
  for (const auto& corner : kCorners) {
    for (const float x : corner) append(bytes, x, big_endian);
  }
  for (const auto& face : kFaces) {
    append(bytes, std::uint8_t{3});
    for (const int corner : face) append(bytes, static_cast<std::int32_t>(corner), big_endian);
  }
  return bytes;
}

std::string rowsOf(const char* vertex, const char* face, int first) {
  std::string text;
  for (const auto& corner : kCorners) text += fmt::format("{}{}\n", vertex, fmt::join(corner, " "));
  for (const auto& f : kFaces) text += fmt::format("{}{} {} {}\n", face, f[0] + first, f[1] + first, f[2] + first);
  return text;
}

void makeMeshes(const Ground& ground) {
  const fs::path folder = ground.inputs() / "meshes";
  put(folder / "cube.obj", "o cube\n" + rowsOf("v ", "f ", 1));
  put(folder / "cube.off", fmt::format("OFF\n{} {} 18\n", kCorners.size(), kFaces.size()) + rowsOf("", "3 ", 0));
  put(folder / "text.stl", textStl());
  put(folder / "binary.stl", binaryStl());
  put(folder / "text.ply", plyHeader("ascii") + rowsOf("", "3 ", 0));
  put(folder / "little.ply", binaryPly(false));
  put(folder / "big.ply", binaryPly(true));
  fs::copy_file(ground.source / "tasks/scenes/files/star_knob.obj", folder / "star_knob.obj");
}

// As people's: from devices, with every input kept. A second of it; then the recorded arms have
// no samples any more, and the trial ends.
void makePeoplesSession(const Ground& ground) {
  const std::string recording = readFile(recordingFile(ground));
  std::size_t end = 0;
  for (int rows = 0; rows < 12; ++rows) end = recording.find('\n', end) + 1;
  put(ground.inputs() / "short.csv", recording.substr(0, end));
  make(ground,
       {"run", "sphere-pickup", "--devices", "replay", "--recording", "short.csv", "--yes", "--repetitions", "1",
        "--friction", "0.9", "--condition", "force", "--sample-rate", "10", "--no-report", "--out", "people"},
       {}, {0, 1});
}

void makeKilledSession(const Ground& ground) {
  for (double after = 0.8 * ground.session_time; after > 0.01; after *= 0.7) {
    make(ground, pickupArguments("killed"), Blow{SIGKILL, after});
    if (fs::exists(ground.inputs() / "killed/session.db-wal")) return;
    fs::remove_all(ground.inputs() / "killed");
  }
  throw std::runtime_error("no session could be killed before it was complete");
}

// Of a processor, that programs which have ended took [s].
double timeOfPrograms() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void makeSessions(Ground& ground) {
  const double before = timeOfPrograms();
  make(ground, pickupArguments("pickup"));
  ground.session_time = timeOfPrograms() - before;
  make(ground, {"export", "pickup/session.db", "--trial", "1", "--out", "recording"});
  make(ground, studyArguments("study"));
  makePeoplesSession(ground);
  makeKilledSession(ground);
}

std::vector<fs::path> filesOf(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && (extension.empty() || entry.path().extension() == extension))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

void makeInputs(Ground& ground) {
  fs::remove_all(ground.inputs());
  fs::create_directories(ground.inputs() / "studies");
  fs::copy(ground.source / "tasks/scenes", ground.inputs() / "scenes", fs::copy_options::recursive);
  makeTrajectory(ground);
  makeMeshes(ground);
  for (const char* study : kStudies)
    put(ground.inputs() / "studies" / (study + std::string(".json")),
        make(ground, {"run", study, "--print-study"}).out);
  make(ground, {"run", "manipulation", "--write-study", "studies/manipulation.json"});
  put(calibrationFile(ground),
      "{\n  \"device\": \"ARM1\",\n  \"values\": {\"base_x\": 0.012, \"base_y\": 0, \"base_z\": 0, \"base_turn\": "
      "0.1}\n}\n");
  put(robotFile(ground), kRobot);
  makeSessions(ground);
}

std::vector<fs::path> sceneFiles(const Ground& ground) { return filesOf(ground.inputs() / "scenes", ".json"); }
std::vector<fs::path> studyFiles(const Ground& ground) { return filesOf(ground.inputs() / "studies", ".json"); }
std::vector<fs::path> meshFiles(const Ground& ground) { return filesOf(ground.inputs() / "meshes", ""); }
fs::path trajectoryScene(const Ground& ground) { return ground.inputs() / "trajectory/scene.json"; }
fs::path trajectoryTable(const Ground& ground) { return ground.inputs() / "trajectory/trajectory.csv"; }
fs::path pickupSession(const Ground& ground) { return ground.inputs() / "pickup/session.db"; }
fs::path killedSession(const Ground& ground) { return ground.inputs() / "killed/session.db"; }
fs::path peoplesSession(const Ground& ground) { return ground.inputs() / "people/session.db"; }
fs::path studySession(const Ground& ground) { return ground.inputs() / "study/session.db"; }
fs::path recordingFile(const Ground& ground) { return ground.inputs() / "recording/sample.csv"; }
fs::path calibrationFile(const Ground& ground) { return ground.inputs() / "calibration.json"; }
fs::path robotFile(const Ground& ground) { return ground.inputs() / "robot.xml"; }

std::vector<std::string> pickupArguments(const std::string& out) {
  return {"run",
          "sphere-pickup",
          "--repetitions",
          "2",
          "--friction",
          "0.9",
          "--friction",
          "0.6",
          "--condition",
          "force",
          "--mass",  // so light that it is up after a second or two: four times as many sessions in a campaign's time
          "0.01",
          "--sample-rate",
          "10",
          "--seed",
          "3",
          "--no-report",
          "--out",
          out};
}

std::vector<std::string> studyArguments(const std::string& out) {
  return {"run", "repeated-localisation", "--participants", "1", "--sample-rate", "10", "--no-report", "--out", out};
}

std::vector<std::string> resumedPickup(const std::string& out) {
  std::vector<std::string> arguments = pickupArguments(out);
  arguments.push_back("--resume");
  return arguments;
}

}  // namespace pincer::campaign
