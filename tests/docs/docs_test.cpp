// The documentation is true: its commands run, the files that it names are there, its lines are short, and
// the API reference builds without a warning.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tests {
namespace {

namespace fs = std::filesystem;
const fs::path kSource = PINCER_SOURCE_DIR;

std::vector<std::string> pages() {
  std::vector<std::string> found = {"README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(kSource / "docs")) {
    if (entry.path().extension() == ".md") found.push_back(fs::relative(entry.path(), kSource).string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) found.push_back((*it)[1]);
  return found;
}

// Commands of a page in their order: lines of code blocks, with those that a backslash continues, and code within
// lines; but for those with a placeholder in capitals.
std::vector<std::string> commandsOf(const std::string& page) {
  static const std::regex pattern(R"((?:\n    |\n\$ |`)(?:build/)?(pincer [a-z][^`#\n]*))"),
      placeholder(R"(\b[A-Z]{2,}\b|\.\.\.)");
  std::vector<std::string> commands;
  const std::string text = std::regex_replace(readFile(kSource / page), std::regex(R"(\\\n\s*)"), "");
  for (std::string command : matches('\n' + text, pattern)) {
    command.erase(command.find_last_not_of(" &") + 1);
    if (!std::regex_search(command, placeholder)) commands.push_back(command);
  }
  return commands;
}

// Some commands of the pages take minutes; the test runs less of the same.
struct Shorter {
  std::regex in_docs;
  std::string instead;
};
const std::vector<Shorter> kShorter = {
    {std::regex("^(pincer .*--view.*)$"), "$1 --help"},  // there may be no display
    // they wait, or for a service
    {std::regex("^(pincer devices emulate .*|pincer .*--devices haply.*)$"), "$1 --help"},
    {std::regex("^(pincer bench .*) --peers"), "$1"},  // other engines aren't built in
    {std::regex("^(pincer (bench|verify|stress)( .*)?)$"), "$1 --list"},
    {std::regex("^(pincer run sphere-pickup --object .*)$"), "$1 --repetitions 1 --friction 0.9 --condition cld+force"},
    {std::regex("^(pincer run findings.*)$"), "$1 --help"},
    {std::regex("^(pincer sweep (sphere|cylinder|manipulation|delay).*)$"), "$1 --help"},
    {std::regex("^(pincer run (smoothness|shape|repeated|backlash|delay)-.*)$"), "$1 --print-study"},
    {std::regex("^(pincer run .*)--participants [0-9]+(.*)$"), "$1--participants 1$2"},
    {std::regex(
         "^(pincer run (manipulation|[a-z]+-(discrimination|identification|localisation|alignment)|sphere-pickup)( "
         "--(seed|out|participants).*)?)$"),
     "$1 --help"},
};

// Where the page of `pincer share` wasn't bundled (no npm), it can't write one.
bool hasPage() { return fs::exists(fs::path(PINCER_BINARY_DIR) / "tasks/share/page/page.html"); }

std::string shortened(std::string command) {
  if (!hasPage()) command = std::regex_replace(command, std::regex("^(pincer share .*)$"), "$1 --help");
  for (const Shorter& shorter : kShorter) command = std::regex_replace(command, shorter.in_docs, shorter.instead);
  return command;
}

// A folder like a checkout after a build, with the files that the pages take for granted.
void furnish(const fs::path& folder) {
  fs::create_directories(folder / "build");
  fs::create_symlink(fs::path(PINCER_BINARY_DIR) / "pincer", folder / "build/pincer");
  for (const char* part : {"tasks", "docs"}) fs::create_symlink(kSource / part, folder / part);
  fs::copy_file(kSource / "tasks/scenes/files/star_knob.obj", folder / "part.obj");
  fs::copy_file(kSource / "tasks/scenes/files/gripper.xml", folder / "robot.xml");
  fs::copy_file(kSource / "tasks/scenes/files/arm.urdf", folder / "robot.urdf");
  const std::string scan =
      fmt::format("cd '{}' && build/pincer mesh convert part.obj scan.stl --units mm > furnish.log", folder.string());
  ASSERT_EQ(std::system(scan.c_str()), 0) << readFile(folder / "furnish.log");
}

class DocsPage : public testing::TestWithParam<std::string> {};

TEST_P(DocsPage, ShowsCommandsThatRun) {
  const TemporaryDirectory folder;
  furnish(folder.path());
  std::set<std::string> seen;
  for (const std::string& shown : commandsOf(GetParam())) {
    const std::string command = shortened(shown);
    if (!seen.insert(command).second) continue;
    const std::string line = fmt::format("cd '{}' && PATH=build:$PATH timeout 120 {} > command.log 2>&1 < /dev/null",
                                         folder.path(), command);
    const bool ok = std::system(line.c_str()) == 0;
    const std::string said = readFile(folder / "command.log");
    // a text may speak of `pincer sim` without a scene
    const bool is_mention = said.find(" is required") != std::string::npos;
    EXPECT_TRUE(ok || is_mention) << GetParam() << " shows: " << shown << "\nrun as: " << command << "\n"
                                  << said.substr(0, 2000);
  }
}

// `contact/mesh/lathe.h`, `docs/scenes.md`; a folder; a list as in `mesh_report.h` without a folder isn't looked for.
TEST_P(DocsPage, NamesFilesThatAreThere) {
  static const std::regex pattern(R"(`((?:contact|engine|grasp|devices|tasks|tests|docs|\.ci)/[A-Za-z0-9_./-]+)`)"),
      link(R"(\]\(([^)#:]+)\))");
  const std::string text = readFile(kSource / GetParam());
  for (const std::string& file : matches(text, pattern))
    EXPECT_TRUE(fs::exists(kSource / file)) << GetParam() << " names " << file;
  for (const std::string& file : matches(text, link)) {
    EXPECT_TRUE(fs::exists((kSource / GetParam()).parent_path() / file)) << GetParam() << " links to " << file;
  }
}

// Tables are as wide as what they show; pages of the reference are made by the program.
TEST_P(DocsPage, KeepsItsLinesTo110Characters) {
  if (GetParam().starts_with("docs/reference/")) return;
  std::istringstream text(readFile(kSource / GetParam()));
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == line.npos || line[begin] == '|') continue;
    // a byte of UTF-8 that begins no character
    const auto continues = [](unsigned char c) { return (c & 0xc0) == 0x80; };
    const auto length = static_cast<long>(line.size()) - std::count_if(line.begin(), line.end(), continues);
    EXPECT_LE(length, 110) << GetParam() << ":" << number << ": " << line.substr(0, 60);
  }
}

// Guides and explanations are true today; how it came about stands in the journal and the changelog.
TEST_P(DocsPage, TellsNoHistory) {
  if (GetParam().starts_with("docs/journal/") || GetParam() == "docs/changelog.md") return;
  static const std::regex history(
      "(used to be|formerly|previously|[Ss]ince then|it once |once was|turned out to|in the past)");
  for (const std::string& words : matches(readFile(kSource / GetParam()), history))
    ADD_FAILURE() << GetParam() << " tells history: " << words;
}

std::string pageTestName(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

// A decision tells what holds today; how it came about stands in docs/journal.
TEST(Decisions, AreHalfAPage) {
  constexpr int kHalfAPage = 300;  // words, of which a page of 11 points has some 600
  int found = 0;
  for (const auto& page : fs::directory_iterator(kSource / "docs/decisions")) {
    std::istringstream text(readFile(page.path()));
    int words = 0;
    for (std::string word; text >> word;)  // a table's bars are none
      words += std::any_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c); });
    EXPECT_LE(words, kHalfAPage) << page.path();
    ++found;
  }
  EXPECT_GE(found, 22);
}

// From docs/architecture.md to the equation, or the rule, in two hops: the page's row, then the file.
TEST(TwelveQuantities, StandInTheFilesThatTheirRowsName) {
  struct Quantity {
    const char *row, *file, *holds;
  };
  const std::string page = readFile(kSource / "docs/architecture.md");
  for (const Quantity& q : {Quantity{"friction cone", "engine/solve/cone.h", "|r_T| <= mu r_n"},
                            {"contact memory", "engine/state.h", "struct ContactMemory"},
                            {"order of a tick", "engine/world/stages.h", "predict"},
                            {"coupling's integration", "engine/model.h", "enum class AxisForm"},
                            {"patch equation", "contact/surface/patch.h", "S(u,v) ="},
                            {"pad place", "grasp/pad_place.h", "Vec2 placeOnPad("},
                            {"gate limits", "devices/gate/force_gate.h", "struct GateLimits"},
                            {"staircase rule", "tasks/lab/study/staircase.h", "p^n = 1/2"},
                            {"participant's limits", "tasks/lab/participants/body.h", "[m]"},
                            {"session table", "tasks/run/session/columns.h", "ColumnRange"},
                            {"scene key", "docs/reference/scene.md", "tick"},
                            {"device frame", "devices/usb/frame.h", "CRC-16"}}) {
    const std::size_t begin = page.find(std::string("\n| ") + q.row + " |");
    ASSERT_NE(begin, page.npos) << q.row;
    const std::string row = page.substr(begin + 1, page.find('\n', begin + 1) - begin - 1);
    EXPECT_NE(row.find('`' + std::string(q.file) + '`'), row.npos) << row;
    EXPECT_NE(readFile(kSource / q.file).find(q.holds), std::string::npos) << q.file << " lacks " << q.holds;
  }
}

INSTANTIATE_TEST_SUITE_P(All, DocsPage, testing::ValuesIn(pages()), pageTestName);

TEST(FirstScene, IsDrawnByItsProgram) {
  const TemporaryDirectory folder;
  const std::string line = fmt::format(
      "cd '{}' && '{}/pincer' sim '{}/docs/examples/braking_block.json' --out block.csv > log && /usr/bin/python3 "
      "'{}/docs/examples/plot_block.py' block.csv block.png 2>> log",
      folder.path(), PINCER_BINARY_DIR, kSource.string(), kSource.string());
  EXPECT_EQ(std::system(line.c_str()), 0) << readFile(folder / "log");
  EXPECT_TRUE(fs::exists(folder / "block.png"));
}

// A minute between two flat jaws; the scene says how it must hang (exit code 1 if it doesn't).
TEST(Examples, AMugHangsInItsGripper) {
  const TemporaryDirectory folder;
  const std::string line = fmt::format("'{}/pincer' sim '{}/docs/examples/mug_in_a_gripper.json' > '{}/log' 2>&1",
                                       PINCER_BINARY_DIR, kSource.string(), folder.path());
  EXPECT_EQ(std::system(line.c_str()), 0) << readFile(folder / "log");
}

// To renew a page: the command in its last line.
TEST(KeyReference, IsWhatTheProgramPrints) {
  const TemporaryDirectory folder;
  int found = 0;
  for (const auto& page : fs::directory_iterator(kSource / "docs/reference")) {
    const std::string line = fmt::format("'{}/pincer' schema {} --markdown > '{}/page.md'", PINCER_BINARY_DIR,
                                         page.path().stem().string(), folder.path());
    EXPECT_EQ(std::system(line.c_str()), 0) << line;
    EXPECT_EQ(readFile(page.path()), readFile(folder / "page.md")) << page.path();
    ++found;
  }
  EXPECT_EQ(found, 8);
}

TEST(ApiReference, IsBuiltWithoutAWarning) {
  const TemporaryDirectory folder;
  const std::string line = fmt::format(
      "cd '{}' && {{ cat docs/Doxyfile; echo 'OUTPUT_DIRECTORY = \"{}\"'; }} | doxygen - > '{}/doxygen.log' 2>&1",
      kSource.string(), folder.path(), folder.path());
  EXPECT_EQ(std::system(line.c_str()), 0) << readFile(folder / "doxygen.log").substr(0, 4000);
  EXPECT_TRUE(fs::exists(folder / "html/index.html"));
}

}  // namespace
}  // namespace pincer::tests
