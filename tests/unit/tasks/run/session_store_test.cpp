#include "pincer/tasks/run/session_store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/session/columns.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/session_samples.h"
#include "pincer/tests/support/synthetic_session.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::errorOf;
using tests::samplesOf;
using tests::SyntheticSession;
using tests::TemporaryDirectory;

// Different bits in every field of any record, as its column allows; NaN among them.
template <class Record>
Record filled(std::int64_t seed) {
  Record record;
  std::int64_t k = seed * 1000;
  forEachColumn(record, [&]<class Field>(const ColumnName& name, Field& field) {
    ++k;
    if constexpr (std::is_arithmetic_v<Field> && !std::is_same_v<Field, std::uint64_t>) {
      const ColumnRange range = name.rangeOf<Field>();
      if (std::isfinite(range.min)) {
        field =
            static_cast<Field>(range.min + std::fmod(static_cast<double>(k), std::min(1e6, range.max - range.min) + 1));
        return;
      }
    }
    if constexpr (std::is_same_v<Field, std::string>) {
      field = "text \"" + std::to_string(k) + "\", ä\nline";
    } else if constexpr (std::is_floating_point_v<Field>) {
      field =
          k % 7 == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(k) / 3 * (k % 2 ? 1e-9 : -1e12);
    } else {
      field = static_cast<Field>(k);
    }
  });
  return record;
}

// Equal to the bit, except that all NaN are alike.
template <class Record>
void expectSame(const Record& a, const Record& b) {
  std::vector<std::string> as, bs;
  const auto print = [](std::vector<std::string>& into) {
    return [&into]<class Field>(const ColumnName& name, const Field& field) {
      if constexpr (std::is_same_v<Field, std::string>) {
        into.push_back(name.text() + "=" + field);
      } else if constexpr (std::is_floating_point_v<Field>) {
        into.push_back(name.text() + "=" +
                       (field != field ? "nan" : std::to_string(std::bit_cast<std::uint64_t>(field))));
      } else {
        into.push_back(name.text() + "=" + std::to_string(field));
      }
    };
  };
  forEachColumn(a, print(as));
  forEachColumn(b, print(bs));
  EXPECT_EQ(as, bs);
}

TEST(SessionStore, GivesBackEveryFieldToTheBit) {
  const TemporaryDirectory dir;
  SessionInfo info = filled<SessionInfo>(1);
  info.seed = std::numeric_limits<std::uint64_t>::max();  // beyond SQLite's integers
  {
    auto writer = SessionWriter::create(dir / "a.db", info);
    for (std::int64_t k = 0; k < 5; ++k) ASSERT_TRUE(writer.pushSample(filled<SampleRecord>(k)));
    writer.addEvent(filled<EventRecord>(7));
    writer.finishTrial(filled<TrialRecord>(9));
    writer.close();
  }
  const SessionReader reader(dir / "a.db");
  EXPECT_TRUE(reader.complete());
  EXPECT_EQ(reader.state(), "complete");
  EXPECT_EQ(reader.warning(), "");
  EXPECT_EQ(reader.startedUtc().size(), std::strlen("2026-01-01T00:00:00Z"));
  expectSame(reader.info(), info);
  const auto samples = samplesOf(reader);
  ASSERT_EQ(samples.size(), 5u);
  for (std::int64_t k = 0; k < 5; ++k) expectSame(samples[static_cast<std::size_t>(k)], filled<SampleRecord>(k));
  ASSERT_EQ(reader.events().size(), 1u);
  expectSame(reader.events()[0], filled<EventRecord>(7));
  ASSERT_EQ(reader.trials().size(), 1u);
  expectSame(reader.trials()[0], filled<TrialRecord>(9));
}

TEST(SessionStore, KeepsResponsesToTheBit) {
  const TemporaryDirectory dir;
  {
    auto writer = SessionWriter::create(dir / "a.db", {});
    writer.pushSample(filled<SampleRecord>(1));
    for (std::int64_t k = 0; k < 3; ++k) writer.finishResponse(filled<ResponseRecord>(k));
    {  // each is durable, with what was pushed before, once finishResponse has returned
      const SessionReader running(dir / "a.db");
      EXPECT_EQ(running.responses().size(), 3u);
      EXPECT_EQ(samplesOf(running).size(), 1u);
      EXPECT_NE(running.warning().find("holds 3 finished trials"), std::string::npos) << running.warning();
    }
    writer.close();
  }
  const SessionReader reader(dir / "a.db");
  for (std::int64_t k = 0; k < 3; ++k)
    expectSame(reader.responses()[static_cast<std::size_t>(k)], filled<ResponseRecord>(k));
}

TEST(SessionStore, NamesColumnsWithUnits) {
  std::vector<std::string> names;
  const SampleRecord sample;
  forEachColumn(sample, [&](const ColumnName& name, const auto&) { names.push_back(name.text()); });
  for (const char* expected :
       {"time_s", "p_WB_z_m", "q_WB_w", "v_WB_x_m_per_s", "f0_normal_N", "f1_place_shown_L_y_m", "tick_us"}) {
    EXPECT_NE(std::find(names.begin(), names.end(), expected), names.end()) << expected;
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end()) << "a column name occurs twice";
}

TEST(SessionStore, IsOnePlainFileOnceClosed) {
  const TemporaryDirectory dir;
  auto writer = SessionWriter::create(dir / "a.db", {});
  writer.pushSample({});
  writer.close();
  EXPECT_NO_THROW(writer.close());
  const auto files = std::distance(std::filesystem::directory_iterator(dir.path()), {});
  EXPECT_EQ(files, 1);
}

// Far more samples than the ring holds, as fast as they come: the pusher waits instead of losing any.
TEST(SessionStore, LosesNoSampleWhenItMayWait) {
  const TemporaryDirectory dir;
  constexpr std::int64_t kSamples = 20'000;
  auto writer = SessionWriter::create(dir / "a.db", {}, {.block_when_full = true, .ring_capacity = 64});
  for (std::int64_t k = 0; k < kSamples; ++k) {
    SampleRecord s;
    s.tick = k;
    ASSERT_TRUE(writer.pushSample(s));
  }
  writer.close();
  std::int64_t next = 0;
  SessionReader(dir / "a.db").forEachSample({}, [&](const SampleRecord& s) { ASSERT_EQ(s.tick, next++); });
  EXPECT_EQ(next, kSamples);
}

TEST(SessionStore, CountsAndReportsWhatItLostInRealTime) {
  const TemporaryDirectory dir;
  auto writer = SessionWriter::create(dir / "a.db", {}, {.ring_capacity = 2});
  std::uint64_t refused = 0;
  for (int k = 0; k < 10'000; ++k) refused += !writer.pushSample({});
  EXPECT_EQ(writer.droppedSamples(), refused);
  writer.close();
  const SessionReader reader(dir / "a.db");
  EXPECT_EQ(reader.samplesDropped(), static_cast<std::int64_t>(refused));
  EXPECT_EQ(samplesOf(reader).size() + refused, 10'000u);
  EXPECT_EQ(reader.warning().empty(), refused == 0);
}

TEST(SessionStore, StreamsOneTrialWithAStride) {
  const TemporaryDirectory dir;
  auto writer = SessionWriter::create(dir / "a.db", {});
  for (std::int64_t k = 0; k < 30; ++k) {
    SampleRecord s;
    s.trial = k / 10;
    s.tick = k;
    writer.pushSample(s);
  }
  writer.addEvent({0, 0, "tone", ""});
  writer.addEvent({1, 1, "slip", ""});
  writer.close();
  const SessionReader reader(dir / "a.db");
  std::vector<std::int64_t> ticks;
  for (const auto& s : samplesOf(reader, {.trial = 1, .stride = 4})) ticks.push_back(s.tick);
  EXPECT_EQ(ticks, (std::vector<std::int64_t>{10, 14, 18}));
  EXPECT_EQ(samplesOf(reader, {.trial = 5}).size(), 0u);
  ASSERT_EQ(reader.events(1).size(), 1u);
  EXPECT_EQ(reader.events(1)[0].kind, "slip");
  EXPECT_THROW(samplesOf(reader, {.stride = 0}), InputError);
}

TEST(SessionStore, SaysThatItWasLeftOrAborted) {
  const TemporaryDirectory dir;
  { auto writer = SessionWriter::create(dir / "left.db", {}); }
  const SessionReader left(dir / "left.db");
  EXPECT_EQ(left.state(), "aborted: the program left without closing the session");
  EXPECT_FALSE(left.complete());

  auto writer = SessionWriter::create(dir / "stopped.db", {});
  writer.finishTrial({});
  writer.abort("interrupted (Ctrl-C)");
  EXPECT_FALSE(writer.pushSample({}));
  EXPECT_THROW(writer.addEvent({}), InputError);
  const SessionReader stopped(dir / "stopped.db");
  EXPECT_EQ(stopped.state(), "aborted: interrupted (Ctrl-C)");
  EXPECT_NE(stopped.warning().find("interrupted (Ctrl-C)). It holds 1 finished trial"), std::string::npos)
      << stopped.warning();
}

TEST(SessionStore, RefusesToOverwriteAndNamesTheRemedy) {
  const TemporaryDirectory dir;
  SessionWriter::create(dir / "a.db", {}).close();
  const std::string before = tests::readFile(dir / "a.db");
  const std::string error = errorOf([&] { SessionWriter::create(dir / "a.db", {}); });
  EXPECT_NE(error.find(dir / "a.db"), std::string::npos) << error;
  EXPECT_NE(error.find("never overwritten"), std::string::npos) << error;
  EXPECT_EQ(tests::readFile(dir / "a.db"), before);
}

TEST(SessionStore, NamesAMissingDirectory) {
  const TemporaryDirectory dir;
  const std::string error = errorOf([&] { SessionWriter::create(dir / "no/a.db", {}); });
  EXPECT_NE(error.find("Make its directory first"), std::string::npos) << error;
}

// /proc takes no files, not even from root.
TEST(SessionStore, NamesAnUnwritablePath) {
  const std::string error = errorOf([&] { SessionWriter::create("/proc/a.db", {}); });
  EXPECT_NE(error.find("/proc/a.db: can't create the session"), std::string::npos) << error;
}

TEST(SessionStore, ReaderRefusesWhatIsNoSession) {
  const TemporaryDirectory dir;
  EXPECT_NE(errorOf([&] { SessionReader(dir / "none.db"); }).find("no such file"), std::string::npos);
  EXPECT_NE(errorOf([&] { SessionReader{dir.path()}; }).find("not a file"), std::string::npos);
  std::ofstream(dir / "text.db") << std::string(5000, 'x');
  EXPECT_NE(errorOf([&] { SessionReader(dir / "text.db"); }).find("no SQLite database"), std::string::npos);
  std::ofstream(dir / "empty.db").close();
  EXPECT_NE(errorOf([&] { SessionReader(dir / "empty.db"); }).find("killed while it was being made"),
            std::string::npos);
}

// Any text survives, whatever its bytes: zeros, quotes, broken UTF-8.
TEST(SessionStore, KeepsTextWhateverItsBytes) {
  const TemporaryDirectory dir;
  std::mt19937 random(1);
  std::vector<EventRecord> events(200);
  for (EventRecord& e : events) {
    e.detail.resize(random() % 40);
    for (char& c : e.detail) c = static_cast<char>(random());
  }
  auto writer = SessionWriter::create(dir / "a.db", {});
  for (const EventRecord& e : events) writer.addEvent(e);
  writer.close();
  const auto back = SessionReader(dir / "a.db").events();
  ASSERT_EQ(back.size(), events.size());
  for (std::size_t k = 0; k < events.size(); ++k) EXPECT_EQ(back[k].detail, events[k].detail);
}

}  // namespace
}  // namespace pincer::tasks
