// Names that would do something where they come out: in a terminal, a shell, a
// spreadsheet, a page, a BIDS data set, a plot.
#include <fmt/format.h>

#include <algorithm>

#include "pincer/tests/campaign/inputs.h"
#include "pincer/tests/campaign/rows.h"
#include "pincer/tests/campaign/session_file.h"
#include "pincer/tests/campaign/tables.h"

namespace pincer::campaign {
namespace {

const std::vector<std::string>& hostileTexts() {
  static const std::vector<std::string> kTexts = {"\"quoted\"",
                                                  "it's",
                                                  "$(touch pwned)",
                                                  "`touch pwned`",
                                                  "; touch pwned",
                                                  "| touch pwned",
                                                  "<script>alert(1)</script>",
                                                  "<b>bold</b>",
                                                  "&amp;",
                                                  "=1+1",
                                                  "+1+1",
                                                  "-1+1",
                                                  "@SUM(A1)",
                                                  "=HYPERLINK(\"http://x\")",
                                                  "a,b;c",
                                                  "a\tb",
                                                  "a\nb",
                                                  "a\r\nb",
                                                  "\x1b[31mred\x1b[0m",
                                                  "\x07",
                                                  "\xc2\x9b"
                                                  "31m",
                                                  "%s%n",
                                                  "{}",
                                                  "{0}",
                                                  "\\",
                                                  "\\n",
                                                  "'; DROP TABLE trial;--",
                                                  "../../up",
                                                  "a b",
                                                  "\xe2\x80\xae"
                                                  "txt",
                                                  "\xff\xfe",
                                                  "set output",
                                                  "@{!touch pwned}",
                                                  "\" ; system(\"touch pwned\") #"};
  return kTexts;
}

std::string sqlText(const std::string& text) {
  std::string hex;
  for (const char c : text) hex += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return "CAST(x'" + hex + "' AS TEXT)";
}

std::string jsonText(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') out += '\\';
    out += byte < 0x20 ? fmt::format("\\u{:04x}", byte) : std::string(1, c);
  }
  return out + "\"";
}

void requireNothingObeyed(Case& c) {
  for (const auto& entry : fs::recursive_directory_iterator(c.folder)) {
    if (entry.path().filename() == "pwned") c.fault(Verdict::kWrong, "a name was obeyed as a command");
  }
}

void requireTables(Case& c) {
  for (const auto& entry : fs::recursive_directory_iterator(c.folder)) {
    const std::string extension = entry.path().extension();
    if (extension != ".csv" && extension != ".tsv") continue;
    const std::string problem = problemOfTable(readFile(entry.path()), extension == ".csv" ? ',' : '\t');
    if (!problem.empty()) c.fault(Verdict::kWrong, entry.path().filename().string() + ": " + problem);
  }
}

void requirePages(Case& c, const std::string& text) {
  for (const auto& entry : fs::recursive_directory_iterator(c.folder)) {
    const std::string extension = entry.path().extension();
    if (extension != ".html" && extension != ".svg") continue;
    const std::string page = readFile(entry.path());
    if (text.find('<') != text.npos && page.find(text) != page.npos)
      c.fault(Verdict::kWrong, entry.path().filename().string() + " holds a name as markup");
  }
}

// Texts of a session that a person or a device gave, or somebody who edited it.
void sessionWith(Case& c, const std::string& text) {
  static const std::vector<Column> kTexts = {{"session", "devices_json"},
                                             {"session", "version"},
                                             {"session", "build"},
                                             {"session", "started_utc"},
                                             {"session", "state"},
                                             {"trial", "outcome"},
                                             {"trial", "condition"},
                                             {"trial", "cause"},
                                             {"event", "kind"},
                                             {"event", "detail"},
                                             {"reading", "kind"},
                                             {"reading", "decision"},
                                             {"session", "participants_hash"}};
  fs::copy_file(pickupSession(c.ground), c.folder / "session.db");
  const int harmed = 1 + c.below(2);
  for (int n = 0; n < harmed; ++n) damage(c.folder / "session.db", c.anyOf(kTexts), sqlText(text), c.chance(0.5));
  const int way = c.below(5);
  if (way < 2) c.run(c.pincer({"export", "session.db", "--out", "csv"}), {.name = "session.db"});
  if (way == 2 || way == 3) c.run(c.pincer({"export", "session.db", "--bids", "bids"}), {.name = "session.db"});
  if (way == 4) c.run(c.pincer({"report", "session.db"}), {.name = "session.db"});
}

void sceneWith(Case& c, const std::string& text) {
  const std::string name = jsonText(text);
  c.write("scene.json", fmt::format(R"({{"version": 1, "description": {0}, "duration": 0.05,
  "bodies": [{{"name": {1}, "shape": {{"type": "sphere", "radius": 0.02}}, "mass": 0.1, "position": [0, 0, 0.1]}}],
  "record": {{"interval": 0.01, "quantities": [{2}]}},
  "expect": [{{"quantity": "ball.p_z", "time": "end", "value": 5, "tolerance": 1, "because": {0}}}]}})",
                                    name, c.chance(0.5) ? name : "\"ball\"", c.chance(0.3) ? name : "\"ball.p_z\""));
  c.run(c.pincer({"sim", "scene.json", "--out", "table.csv"}), {.name = "scene.json"});
}

// Names of files can't hold NUL and '/'.
void fileWith(Case& c, std::string text) {
  std::replace(text.begin(), text.end(), '/', '_');
  const int way = c.below(6);
  const bool mesh = way < 3;
  const std::string file = text + (mesh ? ".obj" : ".json");
  fs::copy_file(mesh ? c.ground.inputs() / "meshes/cube.obj" : c.ground.inputs() / "scenes/s4_pinch.json",
                c.folder / file);
  const std::string in = "./" + file;
  if (way == 0) c.run(c.pincer({"mesh", "convert", in, "./" + text + ".stl", "--units", "cm", "--repair"}));
  if (way == 1)
    c.run(c.pincer({"run", "sphere-pickup", "--object", in, "--size", "0.04", "--repetitions", "1", "--friction", "0.9",
                    "--condition", "force", "--sample-rate", "10", "--out", "./" + text}));
  if (way == 2) c.run(c.pincer({"mesh", "info", in, "--units", "m"}));
  if (way == 3) c.run(c.pincer({"sim", in, "--duration", "0.05", "--out", "./" + text + ".csv"}));
  if (way == 4) c.run(c.pincer({"sweep", in, "--vary", "duration=0.01,0.02", "--out", "./" + text}));
  if (way == 5) c.run(c.pincer({"sim", "./" + text + "-missing.json"}));
}

}  // namespace

void useHostileNames(Case& c) {
  const std::string& text = c.anyOf(hostileTexts());
  const auto way = c.number % 3;
  if (way == 0) sessionWith(c, text);
  if (way == 1) sceneWith(c, text);
  if (way == 2) fileWith(c, text);
  requireNothingObeyed(c);
  requireTables(c);
  requirePages(c, text);
}

}  // namespace pincer::campaign
