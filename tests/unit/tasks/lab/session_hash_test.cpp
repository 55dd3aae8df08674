#include "pincer/tasks/lab/sessions/session_hash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::TemporaryDirectory;

struct Kept {
  TrialRecord trial;
  SampleRecord sample;
};

// Of a session with one trial and one sample that `change` has changed.
std::string hashWith(const std::function<void(Kept&)>& change) {
  Kept kept;
  kept.trial.outcome = "success";
  kept.sample.p_WB = {0.1, 0.2, 0.3};
  kept.sample.fingers[1].place_shown_L = {std::numeric_limits<double>::quiet_NaN(), 0};
  change(kept);
  const TemporaryDirectory directory;
  const std::string path = directory / "a.db";
  SessionWriter writer = SessionWriter::create(path, {}, {.block_when_full = true});
  writer.pushSample(kept.sample);
  writer.finishTrial(kept.trial);
  writer.close();
  return sessionHash(SessionReader(path));
}

TEST(SessionHash, SeesTheLastBitOfASample) {
  const std::string as_it_is = hashWith([](Kept&) {});
  EXPECT_EQ(as_it_is.size(), 16u);
  const auto next = [](double& x) { x = std::nextafter(x, 1.0); };
  EXPECT_NE(hashWith([&](Kept& k) { next(k.sample.p_WB[0]); }), as_it_is);
  EXPECT_NE(hashWith([&](Kept& k) { k.sample.fingers[1].gap = -std::numeric_limits<double>::denorm_min(); }), as_it_is);
  EXPECT_NE(hashWith([&](Kept& k) { k.sample.status = 1; }), as_it_is);
  EXPECT_NE(hashWith([&](Kept& k) { k.trial.outcome = "timeout"; }), as_it_is);
}

// Signs of two neighbours are the highest bits of what is added, where a product alone would have them cancel.
TEST(SessionHash, SeesTwoSignsChange) {
  const auto turn = [](Kept& k) {
    k.sample.p_WB[0] = -k.sample.p_WB[0];
    k.sample.p_WB[1] = -k.sample.p_WB[1];
  };
  EXPECT_NE(hashWith(turn), hashWith([](Kept&) {}));
}

TEST(SessionHash, LeavesMeasuredTimesOut) {
  const auto slow = [](Kept& k) {
    k.sample.tick_us = 12;
    k.trial.tick_us_median = 3;
    k.trial.tick_us_p999 = 4;
  };
  EXPECT_EQ(hashWith(slow), hashWith([](Kept&) {}));
}

// A run's own hash is taken while samples are written; that of a replay, or of a session gone on with, from the file.
TEST(SessionHash, WhileWritingIsThatOfTheFile) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.db";
  SessionWriter writer = SessionWriter::create(path, {}, {.block_when_full = true});
  SampleRecord sample;
  for (int i = 0; i < 10000; ++i) {
    sample.p_WB = {i * 0.1, i % 7 == 0 ? std::numeric_limits<double>::quiet_NaN() : -0.0, 1e-300 / (1 + i)};
    sample.status = static_cast<std::uint32_t>(i);
    sample.tick_us = i;
    writer.pushSample(sample);
  }
  writer.finishTrial({});
  EXPECT_FALSE(writer.samplesHash().has_value()) << "before the last is written";
  writer.close();
  ASSERT_TRUE(writer.samplesHash().has_value());
  const SessionReader session(path);
  EXPECT_EQ(sessionHash(session, writer.samplesHash()), sessionHash(session));
  EXPECT_NE(sessionHash(session, *writer.samplesHash() + 1), sessionHash(session));
}

TEST(SessionHash, OfASessionThatWasGoneOnWithIsReadFromTheFile) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.db";
  SessionWriter::create(path, {}, {.block_when_full = true}).abort("killed");
  SessionWriter writer = SessionWriter::resume(path, {.block_when_full = true});
  writer.close();
  EXPECT_FALSE(writer.samplesHash().has_value());
}

}  // namespace
}  // namespace pincer::tasks
