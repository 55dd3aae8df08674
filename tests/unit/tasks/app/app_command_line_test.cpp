// The command line: exit codes, one-line complaints, and output for machines that parses.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "pincer/engine/world/stage_clock.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/scene/tick_times.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::AppResult;
using tests::contains;
using tests::runPincer;

const std::string kScenes = PINCER_SOURCE_DIR "/tasks/scenes/";

int linesOf(const std::string& text) { return static_cast<int>(std::count(text.begin(), text.end(), '\n')); }

TEST(CommandLine, HelpsEverywhereWithAnExample) {
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{{},
                                                                                       {"run"},
                                                                                       {"run", "sphere-pickup"},
                                                                                       {"report"},
                                                                                       {"export"},
                                                                                       {"share"},
                                                                                       {"manual"},
                                                                                       {"completion"},
                                                                                       {"sim"},
                                                                                       {"plan"},
                                                                                       {"bench"},
                                                                                       {"bench", "contact"},
                                                                                       {"bench", "engine"},
                                                                                       {"mesh"},
                                                                                       {"mesh", "info"},
                                                                                       {"mesh", "check"},
                                                                                       {"mesh", "convert"},
                                                                                       {"mesh", "round-edges"},
                                                                                       {"mesh", "simplify"},
                                                                                       {"mesh", "subdivide"},
                                                                                       {"sweep"}}) {
    std::vector<std::string> arguments = command;
    arguments.push_back("--help");
    const AppResult help = runPincer(arguments);
    EXPECT_EQ(help.exit_code, kExitOk);
    EXPECT_TRUE(contains(help.out, "pincer ")) << help.out;
    EXPECT_EQ(help.error, "");
    EXPECT_TRUE(contains(help.out, "Example")) << help.out;
  }
  EXPECT_EQ(runPincer({"--version"}).out.substr(0, 7), "pincer ");
}

TEST(CommandLine, ComplainsAboutUsageInOneLine) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {"simulate"},
                                             {"sim"},
                                             {"run", "sphere-dropping"},
                                             {"run"},
                                             {"sim", "s.json", "--durations", "1"},
                                             {"sim", "s.json", "--duration", "-1"},
                                             {"mesh", "info", "x.obj"},
                                             {"mesh", "info", "x.obj", "--units", "furlong"},
                                             {"plan", "s.json", "--ticks", "many"}}) {
    const AppResult wrong = runPincer(arguments);
    EXPECT_EQ(wrong.exit_code, kExitUsage);
    EXPECT_EQ(wrong.out, "");
    EXPECT_EQ(linesOf(wrong.error), 1) << wrong.error;
    EXPECT_TRUE(contains(wrong.error, "--help")) << wrong.error;
  }
}

TEST(CommandLine, KnowsWhichCommandWasMeant) {
  const AppResult top = runPincer({"smi", "s4_pinch"}), below = runPincer({"mesh", "cheek", "part.obj"}),
                  far = runPincer({"xyzzy"});
  EXPECT_EQ(top.exit_code, kExitUsage);
  EXPECT_TRUE(contains(top.error, "\"smi\" isn't a command of pincer. Did you mean \"sim\"?")) << top.error;
  EXPECT_TRUE(contains(below.error, "Did you mean \"check\"? See `pincer mesh --help`")) << below.error;
  EXPECT_TRUE(contains(far.error, "sim") && contains(far.error, "verify")) << far.error;  // all there are
  EXPECT_EQ(linesOf(top.error), 1);
}

// An option that isn't there was "not expected", whatever it was close to.
TEST(CommandLine, KnowsWhichOptionWasMeant) {
  const AppResult typed = runPincer({"run", "delay-discrimination", "--partcipants", "2"}),
                  with_value = runPincer({"sim", "s4_pinch", "--duraton=2"}), far = runPincer({"sim", "--xyzzyplugh"});
  EXPECT_EQ(typed.exit_code, kExitUsage);
  EXPECT_TRUE(contains(typed.error,
                       "\"--partcipants\" isn't an option of pincer run delay-discrimination. Did you mean "
                       "\"--participants\"? See `pincer run delay-discrimination --help`."))
      << typed.error;
  EXPECT_TRUE(contains(with_value.error, "Did you mean \"--duration\"?")) << with_value.error;
  EXPECT_TRUE(contains(far.error, "isn't an option of pincer sim. See")) << far.error;
  EXPECT_EQ(linesOf(typed.error), 1);
}

TEST(CommandLine, NamesFlagsWithoutTheirValues) {
  const std::string help = runPincer({"sim", "--help"}).out;
  EXPECT_TRUE(contains(help, "--no-keys "));
  EXPECT_FALSE(contains(help, "{false}"));
}

// Every line of an --help that names a command or an option is in the manual, a page per command.
TEST(ManualCommand, HasAPageForEveryCommandOfHelp) {
  const tests::TemporaryDirectory folder;
  ASSERT_EQ(runPincer({"manual", "--out", folder / "man"}).exit_code, kExitOk);
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{}, {"sim"}, {"mesh", "check"}, {"run", "manipulation"}}) {
    std::string file = "pincer";
    for (const std::string& word : command) file += "-" + word;
    const std::string page = tests::readFile(folder / ("man/" + file + ".1"));
    std::vector<std::string> asked = command;
    asked.push_back("--help");
    std::istringstream lines(runPincer(asked).out);
    int options = 0;
    for (std::string line; std::getline(lines, line);) {
      const std::size_t at = line.find("--");
      if (line.rfind("  -", 0) != 0 || at == line.npos) continue;
      ++options;
      std::string option;
      for (const char c : line.substr(at, line.find_first_of(" {", at) - at))
        option += c == '-' ? "\\-" : std::string(1, c);
      EXPECT_TRUE(contains(page, option)) << file << " lacks " << option;
    }
    EXPECT_GE(options, 2) << file;  // the program's own; its commands have more
  }
}

TEST(CompletionCommand, IsAScriptThatItsShellReads) {
  const tests::TemporaryDirectory folder;
  std::ofstream(folder / "completion") << runPincer({"completion", "bash"}).out;
  const std::string offers = "bash -c 'source \"" + (folder / "completion") +
                             "\"; COMP_WORDS=(pincer mesh chec) COMP_CWORD=2; _pincer; echo ${COMPREPLY[*]}' > \"" +
                             (folder / "offered") + "\"";
  ASSERT_EQ(std::system(offers.c_str()), 0);
  EXPECT_EQ(tests::readFile(folder / "offered"), "check\n");
  EXPECT_EQ(runPincer({"completion", "csh"}).exit_code, kExitUsage);
}

TEST(CommandLine, ReportsBadInputAndUnwritableOutput) {
  EXPECT_EQ(runPincer({"sim", "/nowhere/s.json"}).exit_code, kExitBadInput);
  EXPECT_TRUE(contains(runPincer({"sim", "/nowhere/s.json"}).error, "/nowhere/s.json"));
  EXPECT_EQ(runPincer({"mesh", "info", "/nowhere/m.obj", "--units", "m"}).exit_code, kExitBadInput);
  const AppResult unwritable = runPincer({"sim", kScenes + "s4_pinch_098.json", "--out", "/nowhere/out.csv"});
  EXPECT_EQ(unwritable.exit_code, kExitBadInput);
  EXPECT_TRUE(contains(unwritable.error, "/nowhere/out.csv")) << unwritable.error;
  EXPECT_EQ(runPincer({"sim", kScenes + "s4_pinch.json", "--duration", "0.0005"}).exit_code, kExitUsage);
}

// A plain file would take the pipe's place: the file is renamed into it once it is whole.
TEST(SimCommand, DoesNotWriteOverAPipeOrDevice) {
  const tests::TemporaryDirectory directory;
  const std::string pipe = directory / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const AppResult result = runPincer({"sim", kScenes + "s4_pinch_098.json", "--out", pipe});
  EXPECT_EQ(result.exit_code, kExitBadInput);
  EXPECT_TRUE(contains(result.error, "pipe, not a file")) << result.error;
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(SimCommand, ChecksExpectations) {
  const AppResult good = runPincer({"sim", kScenes + "s4_pinch_098.json"});
  EXPECT_EQ(good.exit_code, kExitOk) << good.out;
  const tests::TemporaryDirectory directory;
  std::ofstream(directory / "s.json") << R"({"version": 1, "duration": 0.1, "bodies": [
    {"name": "ball", "shape": {"type": "sphere", "radius": 0.02}, "mass": 1}],
    "expect": [{"quantity": "ball.p_z", "time": "end", "value": 0, "tolerance": 1e-3, "because": "it floats"}]})";
  const AppResult failed = runPincer({"sim", directory / "s.json"});
  EXPECT_EQ(failed.exit_code, kExitCheckFailed);
  EXPECT_TRUE(contains(failed.out, "FAILS ball.p_z")) << failed.out;
  EXPECT_TRUE(contains(failed.out, "because it floats")) << failed.out;
  // its time doesn't come
  EXPECT_EQ(runPincer({"sim", directory / "s.json", "--duration", "0.01"}).exit_code, kExitOk);
}

TEST(SimCommand, WritesCsvAndJson) {
  const tests::TemporaryDirectory directory;
  const std::string csv = directory / "out.csv";
  const AppResult result = runPincer(
      {"sim", kScenes + "s4_pinch_098.json", "--duration", "0.01", "--every", "0.002", "--out", csv, "--json"});
  ASSERT_EQ(result.exit_code, kExitOk) << result.error;
  std::ifstream in(csv);
  const std::string table{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(linesOf(table), 7);  // heading, 0, 2, ..., 10 ms
  EXPECT_TRUE(contains(table, "time [s],sphere.p_z [m],")) << table;
  const JsonValue json = parseJson(result.out, "stdout");
  EXPECT_EQ(json.at("ticks").number(), 10);
  EXPECT_EQ(json.at("bodies").array()[0].at("name").text(), "sphere");
  EXPECT_EQ(json.find("tick_us"), nullptr);
  const AppResult timed = runPincer({"sim", kScenes + "s4_pinch_098.json", "--duration", "0.01", "--json", "--timing"});
  EXPECT_GT(parseJson(timed.out, "stdout").at("tick_us").at("median").number(), 0);
  EXPECT_FALSE(json.at("expectations").array()[0].at("reached").boolean());
}

// Numbers that no run could mean: it would take years, or is no number.
TEST(CommandLine, NumbersOutOfRangeAreMistakesOfUsage) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"sim", "s4_pinch", "--duration", "1e12"},
           {"sim", "s4_pinch", "--duration", "nan"},
           {"sim", "s4_pinch", "--duration", "inf"},
           {"sim", "s4_pinch", "--every", "1e-400"},
           {"sim", "s4_pinch", "--duration", "0.0005"},
           {"sim", "heavy_top", "--out", "x.csv", "--every", "0.00015"},
           {"plan", "s4_pinch", "--ticks", "1e30"},
           {"mesh", "info", "x.obj", "--units", "m", "--density", "nan"},
           {"mesh", "check", "x.obj", "--finger-radius", "inf"},
           {"mesh", "convert", "x.obj", "y.obj", "--size", "1e300"},
           {"mesh", "round-edges", "x.obj", "y.obj", "--radius", "nan"},
           {"run", "sphere-pickup", "--mass", "nan"},
           {"run", "sphere-pickup", "--participants", "0"},
           {"run", "sphere-pickup", "--repetitions", "-3"},
           {"run", "delay-discrimination", "--participants", "0"},
           {"run", "delay-discrimination", "--sample-rate", "3"},
           {"run", "delay-discrimination", "--resume"},
           {"run", "sphere-pickup", "--resume"},
           {"run", "sphere-pickup", "--devices", "mouse"},
           {"run", "sphere-pickup", "--devices", "replay"},
           {"run", "findings", "--experiments", "0"},
           {"run", "findings", "--only", "nothing-of-that-name"},
           {"sweep", "s4_pinch", "--vary", "sphere.mass=much"},
           {"sweep", "s4_pinch", "--vary", "sphere.mass=1,2", "--vary", "sphere.mass=3,4"},
           {"replay", "x.db", "--at", "nan"},
           {"export", "x.db", "--every", "0"},
           {"verify", "--only", "nothing-of-that-name"},
           {"devices", "calibrate", "A1", "--set", "base_x"},
           {"devices", "calibrate", "A1", "--set", "base_x=nan"},
           {"devices", "list", "--timeout", "nan"}}) {
    const AppResult wrong = runPincer(arguments);
    std::string line;
    for (const std::string& argument : arguments) line += argument + " ";
    EXPECT_EQ(wrong.exit_code, kExitUsage) << line << ": " << wrong.error;
    EXPECT_FALSE(contains(wrong.error, "..")) << wrong.error;
  }
  const AppResult long_one = runPincer({"sim", "s4_pinch", "--duration", "1e12"});
  EXPECT_TRUE(contains(long_one.error, "--duration: 1e12 is out of range (0, 1000000]. In seconds")) << long_one.error;
}

TEST(CommandLine, SpeaksOfOneThingAsOfOne) {
  const AppResult one = runPincer({"sim", "s4_pinch", "--duration", "0.001"});
  EXPECT_TRUE(contains(one.out, "\n1 tick of 1 ms")) << one.out;
  EXPECT_FALSE(contains(one.out, "1 ticks")) << one.out;
}

TEST(RunCommand, LeavesASessionThatReportAndExportRead) {
  const tests::TemporaryDirectory directory;
  const std::string out = directory / "first";
  const std::vector<std::string> command = {"run",         "sphere-pickup", "--condition",   "cld+force",
                                            "--friction",  "0.9",           "--repetitions", "1",
                                            "--no-report", "--json",        "--out",         out};
  const AppResult result = runPincer(command);
  ASSERT_EQ(result.exit_code, kExitOk) << result.error;
  EXPECT_EQ(parseJson(result.out, "stdout").at("trials").number(), 1);
  const AppResult again = runPincer(command);
  EXPECT_EQ(again.exit_code, kExitBadInput);  // a session is never overwritten
  const AppResult tables = runPincer({"export", out + "/session.db", "--every", "100"});
  EXPECT_EQ(tables.exit_code, kExitOk) << tables.error;
  EXPECT_TRUE(std::filesystem::exists(out + "/csv/trial.csv"));
}

TEST(RunCommand, RefusesBadOptionsBeforeItWritesAnything) {
  const tests::TemporaryDirectory directory;
  const std::string out = directory / "first";
  EXPECT_EQ(runPincer({"run", "sphere-pickup", "--mass", "-1", "--out", out}).exit_code, kExitUsage);
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(runPincer({"run", "sphere-pickup", "--object", "/nowhere/cow.obj", "--out", out}).exit_code, kExitBadInput);
  const AppResult both = runPincer(
      {"run", "sphere-pickup", "--object", "/nowhere/cow.obj", "--units", "m", "--size", "0.06", "--out", out});
  EXPECT_EQ(both.exit_code, kExitBadInput) << "--size prevails over --units: " << both.error;
  EXPECT_EQ(runPincer({"run", "sphere-pickup", "--size", "0.06", "--out", out}).exit_code, kExitUsage);
  EXPECT_EQ(runPincer({"run", "sphere-pickup", "--shading", "smoothish", "--out", out}).exit_code, kExitUsage);
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(PlanCommand, NamesFormsAndMeasuresStages) {
  const AppResult text = runPincer({"plan", kScenes + "pickup.json", "--ticks", "200"});
  ASSERT_EQ(text.exit_code, kExitOk) << text.error;
  EXPECT_TRUE(contains(text.out, "sphere r 20 mm, 75 g; rotation: spherical top, exact")) << text.out;
  EXPECT_TRUE(contains(text.out, "thumb - sphere")) << text.out;
  const JsonValue json =
      parseJson(runPincer({"plan", kScenes + "s1_tumbling_box.json", "--ticks", "100", "--json"}).out, "stdout");
  EXPECT_EQ(json.at("stages").array().size(), engine::kStageCount + 1u);
  EXPECT_EQ(json.at("ticks").number(), 100);
}

TEST(MeshCommand, MeasuresATetrahedron) {
  const tests::TemporaryDirectory directory;
  const std::string obj = directory / "tetra.obj";
  std::ofstream(obj) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const JsonValue json =
      parseJson(runPincer({"mesh", "info", obj, "--units", "cm", "--density", "6000", "--json"}).out, "stdout");
  EXPECT_NEAR(json.at("volume").number(), 1e-6 / 6, 1e-20);
  EXPECT_NEAR(json.at("mass").at("mass").number(), 1e-3, 1e-17);
  EXPECT_NEAR(json.at("mass").at("p_BBcm").vector().x(), 0.0025, 1e-16);
  EXPECT_TRUE(json.at("closed").boolean());
}

// In a process of its own, for the flag stays up.
[[noreturn]] void interruptARun() {
  handleSignals();
  std::raise(SIGINT);
  std::string program = "pincer", command = "sim", scene = kScenes + "s4_pinch.json";
  std::array<char*, 3> argv = {program.data(), command.data(), scene.data()};
  std::exit(runApp(3, argv.data()));
}

// Figures of the exact scene hold, whatever its times are here; files are written, one row per run.
TEST(BenchEngine, MeasuresASceneAndWritesItsTables) {
  const tests::TemporaryDirectory directory;
  const AppResult r =
      runPincer({"bench", "engine", "--only", "s2", "--rounds", "1", "--json", "--out", directory.path()});
  const JsonValue records = parseJson(r.out, "stdout");
  const JsonValue& error = records.array().at(0);
  EXPECT_EQ(error.at("name").text(), "s2/slide-to-roll");
  EXPECT_EQ(error.at("metric").text(), "pincer at 1 ms: position at 1 s, error");
  EXPECT_TRUE(error.at("ok").boolean()) << r.out;
  EXPECT_EQ(linesOf(tests::readFile(directory / "runs.csv")), 1 + 6 + 3);  // a ladder of six steps, three tolerances
  EXPECT_TRUE(std::filesystem::exists(directory / "s2_slide-to-roll.png"));
}

TEST(BenchEngine, ListsItsScenes) {
  const AppResult r = runPincer({"bench", "engine", "--list"});
  EXPECT_EQ(r.exit_code, kExitOk);
  for (const char* name : {"s1/tumbling-box\n", "s6/mass-ratio-1e4\n", "s9/latency\n", "more/capsule-pinch-20x\n"}) {
    EXPECT_TRUE(contains(r.out, name)) << r.out;
  }
}

TEST(Interrupt, EndsARunCleanlyWithItsOwnExitCode) {
  EXPECT_EXIT(interruptARun(), ::testing::ExitedWithCode(kExitInterrupted), "");
}

TEST(JsonWriter, WritesWhatAStrictReaderReads) {
  JsonWriter json;
  json.beginObject()
      .key("a \"quoted\"\n")
      .value(0.1)
      .key("nan")
      .value(std::nan(""))
      .key("list")
      .beginArray()
      .value(1)
      .value(true)
      .value(Vec3(1, 2, 3));
  json.endArray().key("empty").beginObject().endObject().endObject();
  const JsonValue read = parseJson(json.text(), "writer");
  EXPECT_EQ(read.at("a \"quoted\"\n").number(), 0.1);
  EXPECT_EQ(read.at("nan").kind(), JsonValue::Kind::kNull);
  EXPECT_EQ(read.at("list").array()[2].vector(), Vec3(1, 2, 3));
}

TEST(TickTimes, GivesQuantilesByNearestRank) {
  TickTimes times(100);
  for (int i = 100; i >= 1; --i) times.add(i);
  EXPECT_EQ(times.quantile(0.5), 50);
  EXPECT_EQ(times.quantile(0.999), 100);
  EXPECT_EQ(times.quantile(1), 100);
  EXPECT_EQ(times.quantile(0), 1);
  EXPECT_TRUE(std::isnan(TickTimes(0).quantile(0.5)));
}

TEST(ProgressLine, ShowsShareAndRemainingTime) {
  EXPECT_EQ(progressLine("sim", 1, 2, 10), "sim [###############---------------]  50 %, 10 s left");
  EXPECT_EQ(progressLine("sim", 0, 2, 10), "sim [------------------------------]   0 %");
  EXPECT_EQ(progressLine("sim", 2, 2, 10), "sim [##############################] 100 %, 0 s left");
}

}  // namespace
}  // namespace pincer::tasks
