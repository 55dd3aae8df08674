// A power cut at any moment of a session: made from the log of all its writes and fsyncs
// (tests/campaign/call_log_preload.cpp). What was synchronised is there, what wasn't is not; then every trial that was
// finished before the next one began is in the file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "pincer/tasks/run/session/database.h"
#include "pincer/tests/support/spawned.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::TemporaryDirectory;

constexpr int kTrials = 4;

struct Call {
  std::string what;  // "write", "cut", "sync", "unlink"
  unsigned long inode = 0;
  std::size_t offset = 0, size = 0;  // of a write; of a cut `size` is the new length
  std::string path, bytes;
};

std::vector<Call> callsIn(const std::string& log) {
  std::vector<Call> calls;
  std::ifstream file(log, std::ios::binary);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    Call call;
    words >> call.what;
    if (call.what != "unlink") words >> call.inode;
    if (call.what == "write") words >> call.offset;
    if (call.what == "write" || call.what == "cut") words >> call.size;
    words >> std::ws;
    std::getline(words, call.path);
    if (call.what == "write") {
      call.bytes.resize(call.size);
      file.read(call.bytes.data(), static_cast<std::streamsize>(call.size));
    }
    calls.push_back(std::move(call));
  }
  return calls;
}

// The bytes of one file now, and those that a power cut would leave.
struct Image {
  std::string now, durable;

  void take(const Call& call) {
    if (call.what == "write") {
      now.resize(std::max(now.size(), call.offset + call.size));
      now.replace(call.offset, call.size, call.bytes);
    } else if (call.what == "cut") {
      now.resize(call.size);
    } else {
      durable = now;
    }
  }
};

// A session's file and SQLite's log beside it, as they are after each call.
class Disk {
 public:
  void take(const Call& call) {
    if (call.what == "unlink") {
      if (call.path.ends_with("-wal")) log_ = 0;
      return;
    }
    if (call.path.ends_with("-shm")) return;  // an index, made again by whoever opens the file
    images_[call.inode].take(call);
    (call.path.ends_with("-wal") ? log_ : main_) = call.inode;
  }
  void writeTo(const std::string& path, bool durable) const {
    put(path, main_, durable);
    put(path + "-wal", log_, durable);
    std::filesystem::remove(path + "-shm");
  }

 private:
  void put(const std::string& path, unsigned long inode, bool durable) const {
    const auto found = images_.find(inode);
    std::filesystem::remove(path);
    if (found != images_.end())
      std::ofstream(path, std::ios::binary) << (durable ? found->second.durable : found->second.now);
  }

  std::map<unsigned long, Image> images_;
  unsigned long main_ = 0, log_ = 0;
};

struct Content {
  std::int64_t finished = 0;  // trials, from 0 on
  std::int64_t begun = -1;    // the last trial of which anything is there
  std::string integrity;
};

Content contentOf(const std::string& path) {
  Database database(path, Database::Mode::kRead);
  Content content;
  content.integrity = database.text("PRAGMA integrity_check");
  content.finished = database.integer("SELECT count(*) FROM trial");
  content.begun = database.integer(
      "SELECT max(coalesce((SELECT max(trial) FROM sample), -1), coalesce((SELECT max(trial) FROM event), -1))");
  return content;
}

std::vector<Call> callsOfASession(const TemporaryDirectory& folder) {
  const auto ended = tests::spawnPincer(
      {"run", "sphere-pickup", "--repetitions", "2", "--friction", "0.9", "--friction", "0.6", "--condition", "force",
       "--sample-rate", "10", "--seed", "3", "--no-report", "--out", folder / "out"},
      {.environment = {"LD_PRELOAD=" PINCER_BINARY_DIR "/call_log.so", "PINCER_CALL_LOG=" + (folder / "calls")}});
  EXPECT_EQ(ended.exit_code, 0) << ended.error;
  std::vector<Call> calls = callsIn(folder / "calls");
  std::erase_if(calls, [](const Call& call) { return call.path.find("session.db") == std::string::npos; });
  return calls;
}

bool isOfTheSession(const std::string& path) {
  return path.ends_with("/session.db") || path.ends_with("/session.db-wal");
}

// Remains of a power cut, over all moments of the session.
struct Judged {
  int moments = 0;
  int early = 0;  // at which a trial had begun while one before it was not yet durable
  int damaged = 0;
  std::int64_t finished = 0, begun = -1;  // at the end, durable; ever
};

// `syncs_lost`: of a disk that says it has synchronised what a running session writes, and hasn't.
Judged judge(const std::vector<Call>& calls, bool syncs_lost) {
  const TemporaryDirectory folder;
  Disk disk;
  Judged judged;
  bool runs = false;
  for (const Call& call : calls) {
    runs = runs || call.path.ends_with("/session.db-wal");
    if (syncs_lost && runs && call.what == "sync") continue;
    disk.take(call);
    if (!isOfTheSession(call.path)) continue;  // its part file, before it has its name
    disk.writeTo(folder / "now.db", false);
    disk.writeTo(folder / "durable.db", true);
    const Content now = contentOf(folder / "now.db"), durable = contentOf(folder / "durable.db");
    ++judged.moments;
    judged.damaged += durable.integrity != "ok";
    judged.early += now.begun > durable.finished;
    judged.finished = durable.finished;
    judged.begun = std::max(judged.begun, now.begun);
  }
  return judged;
}

TEST(PowerCut, LeavesEveryTrialThatWasFinishedBeforeTheNextBegan) {
  const TemporaryDirectory folder;
  const Judged judged = judge(callsOfASession(folder), false);
  EXPECT_GT(judged.moments, 20);
  EXPECT_EQ(judged.early, 0);
  EXPECT_EQ(judged.damaged, 0);
  EXPECT_EQ(judged.finished, kTrials);
  EXPECT_EQ(judged.begun, kTrials - 1);
}

TEST(PowerCut, IsNoticedOnADiskThatDoesntSynchronise) {
  const TemporaryDirectory folder;
  EXPECT_GT(judge(callsOfASession(folder), true).early, 0) << "else the test above would hold of any program";
}

}  // namespace
}  // namespace pincer::tasks
