// Surroundings that nobody asked the program to heed, and names that a terminal would obey.
#include <gtest/gtest.h>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/support/spawned.h"
#include "pincer/tests/support/synthetic_session.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::Spawned;
using tests::spawnPincer;
using tests::TemporaryDirectory;

std::string sessionIn(const TemporaryDirectory& directory) {
  const std::string path = directory / "a.db";
  auto writer = SessionWriter::create(path, tests::SyntheticSession::info(), {.block_when_full = true});
  tests::SyntheticSession({.repetitions = 1}).writeTo(writer);
  writer.close();
  return path;
}

TEST(Surroundings, AnothersGnutermIsKeptFromPlots) {
  const TemporaryDirectory directory;
  const Spawned ended = spawnPincer({"report", sessionIn(directory), "--html", directory / "a.html"},
                                    {.environment = {"GNUTERM=x11", "GNUPLOT_LIB=/nonexistent"}});
  EXPECT_EQ(ended.exit_code, kExitOk) << ended.error;
}

TEST(Surroundings, ATmpdirThatIsNoneIsNamed) {
  const TemporaryDirectory directory;
  const Spawned ended = spawnPincer({"report", sessionIn(directory), "--html", directory / "a.html"},
                                    {.environment = {"TMPDIR=/nonexistent"}});
  EXPECT_EQ(ended.exit_code, kExitBadInput);
  EXPECT_NE(ended.error.find("TMPDIR names no directory"), std::string::npos) << ended.error;
}

TEST(CommandLine, AFlagTakesNoNumberThatNoTypeHolds) {
  for (const char* flag : {"--json=99999999999999999999", "--no-report=18446744073709551616", "--json=2"}) {
    const Spawned ended = spawnPincer({"run", "sphere-pickup", flag});
    EXPECT_EQ(ended.exit_code, kExitUsage) << flag;
    EXPECT_NE(ended.error.find("See `pincer run sphere-pickup --help`"), std::string::npos) << ended.error;
  }
}

TEST(Messages, TheSessionsPathIsShownNotObeyed) {
  const TemporaryDirectory directory;
  const Spawned ended = spawnPincer({"run", "sphere-pickup", "--repetitions", "1", "--friction", "0.9", "--condition",
                                     "force", "--no-report", "--out", directory / "a\r\x1b[31mb"});
  EXPECT_EQ(ended.exit_code, kExitOk) << ended.error;
  EXPECT_EQ((ended.out + ended.error).find_first_of("\r\x1b"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("a\\r\\x1b[31mb/session.db"), std::string::npos) << ended.out;
}

}  // namespace
}  // namespace pincer::tasks
