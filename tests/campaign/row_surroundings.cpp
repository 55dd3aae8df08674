// Surroundings: locales, missing variables and folders; and other processors, on which every bit must be the same.
#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#include "pincer/tests/campaign/inputs.h"
#include "pincer/tests/campaign/rows.h"
#include "pincer/tests/campaign/session_file.h"

namespace pincer::campaign {
namespace {

using Variables = std::vector<std::pair<std::string, std::optional<std::string>>>;

const std::vector<Variables>& surroundings() {
  static const std::vector<Variables> kSurroundings = {
      {{"LC_ALL", "de_DE.UTF-8"}, {"LOCPATH", "locales"}},
      {{"LC_ALL", "ar_SA.UTF-8"}, {"LOCPATH", "locales"}},
      {{"LC_ALL", "no_SUCH"}},
      {{"LC_ALL", ""}},
      {{"LC_ALL", "POSIX"}},
      {{"LANG", "C"}, {"LC_ALL", std::nullopt}},
      {{"LC_ALL", std::string(5000, 'x')}},
      {{"HOME", std::nullopt}},
      {{"HOME", "/nonexistent"}},
      {{"HOME", "/proc"}, {"XDG_CONFIG_HOME", "/proc"}, {"XDG_CACHE_HOME", "/proc"}},
      {{"TERM", std::nullopt}},
      {{"TERM", "no-such-terminal"}, {"COLUMNS", "0"}, {"LINES", "-1"}},
      {{"TMPDIR", "/nonexistent"}},
      {{"TMPDIR", ""}},
      {{"TZ", "No/Such/Zone"}},
      {{"TZ", "<\x1b[31m>5"}},
      {{"NO_COLOR", "1"}},
      {{"GNUTERM", "x11"}, {"GNUPLOT_LIB", "/nonexistent"}},
      {{"USER", std::nullopt}, {"LOGNAME", std::nullopt}, {"SHELL", std::nullopt}, {"PWD", std::nullopt}},
  };
  return kSurroundings;
}

const std::vector<std::vector<std::string>>& programs(const Ground& ground) {
  static const std::vector<std::vector<std::string>> kPrograms = {
      {"sim", "s4_pinch", "--duration", "0.5", "--out", "table.csv"},
      {"mesh", "info", ground.inputs() / "meshes/star_knob.obj", "--units", "mm"},
      {"export", pickupSession(ground), "--out", "csv"},
      {"export", studySession(ground), "--bids", "bids"},
      {"run", "delay-discrimination", "--print-study"},
      {"report", pickupSession(ground), "--json", "--html", "report.html"}};
  return kPrograms;
}

// Locales of decimal commas and other digits, in a folder of the campaign; where their sources are installed.
void makeLocales(const fs::path& folder) {
  static const bool once = [&] {
    fs::create_directories(folder);
    for (const char* name : {"de_DE", "ar_SA"}) {
      const std::string line =
          fmt::format("localedef -f UTF-8 -i {0} '{1}/{0}.UTF-8' > /dev/null 2>&1", name, folder.string());
      if (std::system(line.c_str()) != 0) continue;  // then the locale doesn't exist: that has to be borne as well
    }
    return true;
  }();
  static_cast<void>(once);
}

// Without lines that tell what ticks took.
std::string withoutTimes(const std::string& text) {
  std::string kept;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(" us") == line.npos && line.find("real time") == line.npos) kept += line + "\n";
  }
  return kept;
}

// All that was said and written.
std::string outputOf(const Ended& ended, const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    if (entry.is_regular_file() && extension != ".png" && extension != ".svg")
      files[fs::relative(entry.path(), folder)] = readFile(entry.path());
  }
  std::string all = withoutTimes(ended.out);
  for (const auto& [name, bytes] : files) all += name + "\n" + bytes;
  return all;
}

const std::string& usualOutput(Case& c, std::size_t program) {
  static std::map<std::size_t, std::string> kept;
  const auto found = kept.find(program);
  if (found != kept.end()) return found->second;
  Launch launch = c.pincer(programs(c.ground)[program]);
  launch.folder = c.ground.out / "usual";
  fs::remove_all(launch.folder);
  fs::create_directories(launch.folder);
  const Ended ended = run(launch);
  return kept[program] = outputOf(ended, launch.folder);
}

const std::vector<std::string>& tunings() {
  static const std::vector<std::string> kTunings = {"glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F,-AVX",
                                                    "glibc.cpu.hwcaps=-FMA,-FMA4", "glibc.cpu.hwcaps=-AVX2",
                                                    "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F,-AVX,-SSE4_1,-SSE4_2"};
  return kTunings;
}

void compareGoldenStates(Case& c, const std::string& tuning) {
  Launch launch = c.pincer({});
  launch.program = c.ground.pincer.parent_path() / "golden_state";
  launch.limit = 60;
  if (!fs::exists(launch.program)) return c.skip("there is no golden_state beside the program");
  const Ended usual = c.runUnjudged(launch);
  launch.environment.emplace_back("GLIBC_TUNABLES", tuning);
  const Ended tuned = c.run(launch, {.codes = {0}});
  c.count(Verdict::kFine, 0);
  if (tuned.out != usual.out)
    c.fault(Verdict::kWrong,
            fmt::format("golden state {} here, {} there", usual.out.substr(0, 40), tuned.out.substr(0, 40)));
}

void compareSessions(Case& c, const std::string& tuning, const std::vector<std::string>& arguments,
                     const fs::path& usual) {
  Launch launch = c.pincer(arguments);
  launch.limit = 60;
  launch.environment.emplace_back("GLIBC_TUNABLES", tuning);
  c.run(launch, {.codes = {0}});
  if (c.faulty()) return;
  if (contentOf(c.folder / "out/session.db") != contentOf(usual))
    c.fault(Verdict::kWrong, "the session differs from one on this processor");
}

void replayElsewhere(Case& c, const std::string& tuning) {
  Launch launch = c.pincer({"replay", pickupSession(c.ground)});
  launch.limit = 60;
  launch.environment.emplace_back("GLIBC_TUNABLES", tuning);
  c.run(launch, {.codes = {0}});
}

constexpr std::size_t kComparisons = 4;

}  // namespace

int allSurroundings(const Ground& ground) { return static_cast<int>(surroundings().size() * programs(ground).size()); }

void changeSurroundings(Case& c) {
  const std::size_t which = scattered(c.ground, c.number, surroundings().size() * programs(c.ground).size());
  const std::size_t program = which / surroundings().size();
  makeLocales(c.ground.inputs() / "locales");
  const std::string& usual = usualOutput(c, program);
  Launch launch = c.pincer(programs(c.ground)[program]);
  for (auto [name, value] : surroundings()[which % surroundings().size()]) {
    if (name == "LOCPATH") value = c.ground.inputs() / "locales";
    launch.environment.emplace_back(name, value);
  }
  // A report needs a place for its plots: it says so, and does nothing.
  const bool no_place =
      surroundings()[which % surroundings().size()][0].first == "TMPDIR" && programs(c.ground)[program][0] == "report";
  const Ended ended = c.run(launch, {.name = no_place ? "TMPDIR" : "", .codes = {no_place ? 3 : 0}});
  if (!c.faulty() && !no_place && outputOf(ended, c.folder) != usual)
    c.fault(Verdict::kWrong, "says or writes something else than in usual surroundings");
}

int allProcessors(const Ground&) { return static_cast<int>(tunings().size() * kComparisons); }

void changeProcessor(Case& c) {
  const std::string& tuning = tunings()[static_cast<std::size_t>(c.number) / kComparisons % tunings().size()];
  switch (static_cast<std::size_t>(c.number) % kComparisons) {
    case 0:
      return compareGoldenStates(c, tuning);
    case 1:
      return compareSessions(c, tuning, pickupArguments("out"), pickupSession(c.ground));
    case 2:
      return compareSessions(c, tuning, studyArguments("out"), studySession(c.ground));
    default:
      return replayElsewhere(c, tuning);
  }
}

}  // namespace pincer::campaign
