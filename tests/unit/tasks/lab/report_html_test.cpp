#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/report/report.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/synthetic_session.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::errorOf;
using tests::readFile;
using tests::SyntheticSession;
using tests::TemporaryDirectory;

constexpr const char* kPngSignature = "\x89PNG\r\n\x1a\n";

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

void writeSession(const std::string& path) {
  auto writer = SessionWriter::create(path, SyntheticSession::info(5), {.block_when_full = true});
  SyntheticSession({.seed = 5, .repetitions = 2, .frictions = {0.3, 0.9}, .rate = 100}).writeTo(writer);
  writer.close();
}

// Every link to a trial has a row to go to.
void expectLinksToTrials(const std::string& html, int expected) {
  const std::string link = "href=\"#trial-";
  int links = 0;
  for (std::size_t at = html.find(link); at != std::string::npos; at = html.find(link, at + 1), ++links) {
    const std::size_t name = at + link.size();
    EXPECT_TRUE(has(html, "id=\"trial-" + html.substr(name, html.find('"', name) - name) + "\""));
  }
  EXPECT_EQ(links, expected);
}

TEST(Report, HoldsTheTableAndEveryFigureAndNeedsNothingElse) {
  const TemporaryDirectory dir;  // its path holds a space
  writeSession(dir / "a.db");
  const ReportFiles files = writeReport(SessionReader(dir / "a.db"), dir / "it's a report.html");
  const std::string html = readFile(files.html);
  for (const char* figure : {"squeezes", "time", "trial_force", "trial_cld_force", "tactor_cld_force", "tick_times"}) {
    EXPECT_TRUE(has(html, std::string("id=\"figure-") + figure + "\"")) << figure;
    const std::string beside = dir / (std::string("it's a report_figures/") + figure);
    EXPECT_EQ(readFile(beside + ".png").substr(0, 8), kPngSignature) << figure;
    EXPECT_NE(readFile(beside + ".svg").find("</svg>"), std::string::npos) << figure;
    EXPECT_GT(count(readFile(beside + ".csv"), "\n"), 2) << figure;
  }
  EXPECT_EQ(files.figures.size(), 6u);
  EXPECT_EQ(count(html, "src=\"data:image/png;base64,iVBORw0KGgo"), 6);  // the signature in base64
  EXPECT_EQ(count(html, "src="), 6);
  EXPECT_FALSE(has(html, "figure-tactor_force\""));  // its tactors were parked: an empty plot
  EXPECT_FALSE(has(html, "http"));
  EXPECT_FALSE(has(html, "<script"));
  EXPECT_FALSE(has(html, "@import"));
  for (const char* fact :
       {"seed", "CLD + force", "force only", "g++ 12.2.0 -O2 &amp; &lt;tests&gt;", "complete", "All trials"}) {
    EXPECT_TRUE(has(html, fact)) << fact;
  }
  EXPECT_FALSE(has(html, "class=\"warning\""));
  EXPECT_FALSE(has(html, "Play the session")) << "nobody made such a page";
  expectLinksToTrials(html, 3);  // two conditions, two figures where the tactors moved
}

TEST(Report, LeadsFromEachTrialToWhereAPagePlaysIt) {
  const TemporaryDirectory dir;
  writeSession(dir / "a.db");
  const std::string html = readFile(
      writeReport(SessionReader(dir / "a.db"), dir / "r.html", {.replay = {.name = "a & b.html", .trials = {1, 4}}})
          .html);
  EXPECT_TRUE(has(html, "<a href=\"a &amp; b.html\">Play the session</a>"));
  EXPECT_TRUE(has(html, "<tr id=\"trial-2\"><td><a href=\"a &amp; b.html#shown=1\">2</a></td>"));
  EXPECT_TRUE(has(html, "<tr id=\"trial-5\"><td><a href=\"a &amp; b.html#shown=2\">5</a></td>"));
  EXPECT_TRUE(has(html, "<tr id=\"trial-1\"><td>1</td>")) << "the page doesn't have it";
  EXPECT_EQ(count(html, "#shown="), 2);
}

TEST(Report, SaysThatTheSessionWasNotCompleted) {
  const TemporaryDirectory dir;
  SessionWriter::create(dir / "a.db", {}).abort("interrupted");
  const std::string html = readFile(writeReport(SessionReader(dir / "a.db"), dir / "r.html").html);
  EXPECT_TRUE(has(html, "class=\"warning\""));
  EXPECT_TRUE(has(html, "aborted: interrupted"));
}

TEST(Report, IsMadeOfAnEmptySessionToo) {
  const TemporaryDirectory dir;
  SessionWriter::create(dir / "a.db", {}).close();
  const ReportFiles files = writeReport(SessionReader(dir / "a.db"), dir / "r.html");
  EXPECT_TRUE(files.figures.empty());
  EXPECT_TRUE(has(readFile(files.html), "No trial was finished"));
}

// A trial without samples, tactors that aren't measured, one trial per cell: nothing to
// draw here and there, and still a report.
TEST(Report, CopesWithWhatWasNotMeasured) {
  const TemporaryDirectory dir;
  auto writer = SessionWriter::create(dir / "a.db", {});
  SampleRecord s;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  s.trial = 1;
  for (FingerRecord& f : s.fingers) f.place_shown_L = {kNaN, kNaN};
  writer.pushSample(s);
  TrialRecord t;
  t.condition = "force";
  writer.finishTrial(t);
  t.trial = 1;
  t.condition = "it's <new>";
  t.offset_at_squeeze = t.grip_ratio = kNaN;
  writer.finishTrial(t);
  writer.close();
  const ReportFiles files = writeReport(SessionReader(dir / "a.db"), dir / "r.html");
  EXPECT_EQ(files.figures.size(), 4u);  // squeezes, time, and the second trial's two; no tick was timed
  const std::string html = readFile(files.html);
  EXPECT_TRUE(has(html, "it's &lt;new&gt;"));
  EXPECT_TRUE(has(html, "measure the tactors"));
}

TEST(Report, NamesAMissingGnuplotAndLeavesNothing) {
  const TemporaryDirectory dir;
  writeSession(dir / "a.db");
  const std::string error =
      errorOf([&] { writeReport(SessionReader(dir / "a.db"), dir / "r.html", {.gnuplot = "no-such-gnuplot"}); });
  EXPECT_TRUE(has(error, "no-such-gnuplot")) << error;
  EXPECT_TRUE(has(error, "apt-get install gnuplot-nox")) << error;
  EXPECT_FALSE(std::filesystem::exists(dir / "r.html"));
  EXPECT_FALSE(std::filesystem::exists(dir / "r_figures"));
}

TEST(Report, TellsWhatGnuplotSaid) {
  Gnuplot gnuplot;
  Figure figure;
  figure.name = "wrong";
  figure.script = "plot 'absent.csv'\n";
  EXPECT_TRUE(has(errorOf([&] { gnuplot.plot(figure); }), "absent.csv"));
}

TEST(Report, NamesAnUnwritablePlace) {
  const TemporaryDirectory dir;
  SessionWriter::create(dir / "a.db", {}).close();
  EXPECT_TRUE(has(errorOf([&] { writeReport(SessionReader(dir / "a.db"), "/proc/r.html"); }), "/proc/r_figures"));
}

// Names are drawn as they are: nothing in them is run, expanded, or ends a string.
TEST(Report, HostileNamesAreDrawnAsTheyAre) {
  const TemporaryDirectory dir;
  const std::vector<std::string> names = {"a''b",         "\"\"",   "x\",\"y",  "100 %d %s", "`touch ran`$(touch ran)",
                                          "{a}_b^c@d\\n", "é <b>&", "=1+1\n\tz"};
  auto writer = SessionWriter::create(dir / "a.db", SyntheticSession::info(1));
  for (std::size_t k = 0; k < names.size(); ++k) {
    TrialRecord t;
    t.trial = static_cast<std::int64_t>(k);
    t.condition = names[k];
    t.mu_s = 0.5;
    t.task = k % 2 ? "sphere-pickup" : "cylinder-alignment";
    t.error = 0.1;
    t.outcome = "success";
    writer.finishTrial(t);
  }
  writer.close();
  const ReportFiles files = writeReport(SessionReader(dir / "a.db"), dir / "r.html");
  EXPECT_TRUE(files.not_drawn.empty());
  const std::string html = readFile(files.html),
                    drawn = readFile(dir / "r_figures/squeezes.svg") + readFile(dir / "r_figures/alignment.svg");
  for (const char* shown :
       {"a''b", "x\",\"y", "100 %d %s", "`touch ran`$(touch ran)", "{a}_b^c@d\\n", "é &lt;b>&amp;", "=1+1  z"}) {
    EXPECT_TRUE(has(drawn, shown)) << shown;
  }
  EXPECT_TRUE(has(html, "x&quot;,&quot;y") && has(html, "é &lt;b&gt;&amp;"));
  EXPECT_FALSE(std::filesystem::exists(dir / "ran"));
}

TEST(Gnuplot, SaysThatThereIsNothingToDrawAndDoesNotBlameItsVersion) {
  Gnuplot gnuplot;
  Figure figure;
  figure.name = "empty";
  figure.data = {{"empty.csv", "x,y\n1,nan\n2,nan\n"}};
  figure.script = "set datafile separator comma\nset datafile missing 'nan'\nplot 'empty.csv' skip 1 using 1:2\n";
  EXPECT_THROW(gnuplot.plot(figure), NothingToDraw);
  figure.script = "plot nonsense(x)\n";
  const std::string error = errorOf([&] { gnuplot.plot(figure); });
  EXPECT_TRUE(has(error, "undefined function")) << error;
  EXPECT_FALSE(has(error, "newer")) << error;
}

TEST(GnuplotString, CanNotBeLeftByAQuoteOrALineEnd) {
  EXPECT_EQ(gnuplotString("it's"), "'it'.\"'\".'s'");
  EXPECT_EQ(gnuplotString(std::string("a\nb\0c\x1b", 6)), "'a b c '");
  EXPECT_EQ(gnuplotTic("100 %d"), "'100 %%d'");
}

}  // namespace
}  // namespace pincer::tasks
