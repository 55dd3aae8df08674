// A session keeps every bit of a person's hands, and no byte that isn't one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "pincer/tasks/run/session/database.h"
#include "pincer/tasks/run/session/input_codec.h"
#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::errorOf;
using tests::TemporaryDirectory;

// Any bits, NaN with a payload, negative zero and infinity among them; now and then what was there before.
std::vector<InputRecord> anyInputs(int count, unsigned seed) {
  std::mt19937_64 random(seed);
  const double special[] = {std::bit_cast<double>(0x7ff8dead'beef0001u), -0.0, std::numeric_limits<double>::infinity(),
                            1e-320};
  std::vector<InputRecord> inputs;
  InputRecord record;
  for (int k = 0; k < count; ++k) {
    forEachColumn(record, [&]<class Field>(const ColumnName&, Field& field) {
      if (random() % 3 == 0) return;
      if constexpr (std::is_floating_point_v<Field>) {
        field = random() % 4 == 0 ? special[random() % 4] : std::bit_cast<double>(random());
      } else {
        field = static_cast<Field>(random());
      }
    });
    record.trial = 7;
    record.tick = 1000 + k;
    inputs.push_back(record);
  }
  return inputs;
}

InputChunk packed(const std::vector<InputRecord>& inputs) {
  InputPacker packer;
  for (const InputRecord& input : inputs) packer.add(input);
  return packer.take();
}

TEST(InputCodec, GivesBackEveryBit) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const auto inputs = anyInputs(20, seed);
    const auto back = unpackInputs(packed(inputs));
    ASSERT_EQ(back.size(), inputs.size());
    for (std::size_t k = 0; k < inputs.size(); ++k)
      ASSERT_EQ(wordsOf(back[k]), wordsOf(inputs[k])) << "seed " << seed << ", record " << k;
  }
}

// A hand that rests: a tick is its mask of 10 bytes, and its number and time.
TEST(InputCodec, WhatStandsStillCostsNothing) {
  std::vector<InputRecord> inputs(1000);
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    inputs[k].tick = static_cast<std::int64_t>(k);
    inputs[k].time = 1e-3 * static_cast<double>(k);
    inputs[k].p_WB = {0.1, 0.2, 0.3};
  }
  EXPECT_LE(packed(inputs).data.value.size(), 1000u * (10 + 3 + 9) + 100);
}

TEST(InputCodec, FindsAnyChangedByte) {
  const InputChunk chunk = packed(anyInputs(3, 1));
  for (std::size_t i = 0; i < chunk.data.value.size(); ++i) {
    InputChunk damaged = chunk;
    damaged.data.value[i] = static_cast<char>(damaged.data.value[i] ^ 1 << i % 8);
    EXPECT_NE(errorOf([&] { unpackInputs(damaged); }).find("trial 8, ticks 1000 to 1002, are damaged"),
              std::string::npos)
        << "byte " << i;
  }
  InputChunk moved = chunk;
  moved.first_tick = 0;
  EXPECT_NE(errorOf([&] { unpackInputs(moved); }), "");
}

TEST(SessionInputs, ComeBackTrialByTrialInOrder) {
  const TemporaryDirectory dir;
  auto inputs = anyInputs(3000, 3);
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    inputs[k].trial = static_cast<std::int64_t>(k / 1000);
    inputs[k].tick = static_cast<std::int64_t>(k % 1000);
    inputs[k].time = 1e-3 * static_cast<double>(k % 1000);
    inputs[k].phase %= 10;
    inputs[k].cut %= 9;
  }
  auto writer = SessionWriter::create(dir / "a.db", {}, {.block_when_full = true, .ring_capacity = 64});
  for (std::int64_t trial = 0; trial < 3; ++trial) {
    HandsRecord hands;
    hands.trial = trial;
    hands.oldest_sample = 1.0 / 3;
    writer.addHands(hands);
    for (std::size_t k = 0; k < 1000; ++k)
      ASSERT_TRUE(writer.pushInput(inputs[static_cast<std::size_t>(trial) * 1000 + k]));
    TrialRecord row;
    row.trial = trial;
    writer.finishTrial(row);
  }
  writer.close();
  const SessionReader reader(dir / "a.db");
  ASSERT_EQ(reader.hands().size(), 3u);
  EXPECT_EQ(reader.hands()[2].oldest_sample, 1.0 / 3);
  EXPECT_TRUE(std::isnan(reader.hands()[2].fingers[1].base_turn));
  for (std::int64_t trial = 0; trial < 3; ++trial) {
    const auto back = reader.inputs(trial);
    ASSERT_EQ(back.size(), 1000u);
    for (std::size_t k = 0; k < 1000; ++k)
      ASSERT_EQ(wordsOf(back[k]), wordsOf(inputs[static_cast<std::size_t>(trial) * 1000 + k]));
  }
}

void makeOld(const std::string& path) {
  Database database(path, Database::Mode::kWrite);
  database.run("DROP TABLE input; DROP TABLE hands; PRAGMA user_version = 2");
  database.close();
}

TEST(SessionInputs, ASessionOfTheFormatBeforeIsReadAndGoesOn) {
  const TemporaryDirectory dir;
  {
    auto writer = SessionWriter::create(dir / "a.db", {});
    writer.finishTrial({});
    writer.abort("interrupted");
  }
  makeOld(dir / "a.db");
  {
    const SessionReader old(dir / "a.db");
    EXPECT_FALSE(old.keepsInputs());
    EXPECT_EQ(old.trials().size(), 1u);
    EXPECT_TRUE(old.hands().empty());
    EXPECT_TRUE(old.inputs(0).empty());
  }
  auto writer = SessionWriter::resume(dir / "a.db");
  InputRecord input;
  input.trial = 1;
  writer.pushInput(input);
  writer.close();
  EXPECT_EQ(SessionReader(dir / "a.db").inputs(1).size(), 1u);
}

// Of format 3: without what the tips weigh.
TEST(SessionInputs, SessionsOfFormat3AreReadAndResumed) {
  const TemporaryDirectory dir;
  HandsRecord hands;
  hands.fingers[1].peak_force = 8;
  hands.fingers[1].tip_mass = 0.07;
  TrialRecord trial;
  {
    auto writer = SessionWriter::create(dir / "a.db", {});
    writer.addHands(hands);
    writer.finishTrial(trial);
    writer.abort("interrupted");
  }
  {
    Database old(dir / "a.db", Database::Mode::kWrite);
    for (const char* column :
         {"f0_tip_mass_kg", "f0_tip_damping_Ns_per_m", "f1_tip_mass_kg", "f1_tip_damping_Ns_per_m"}) {
      old.run(fmt::format("ALTER TABLE hands DROP COLUMN \"{}\"", column));
    }
    old.run("PRAGMA user_version = 3");
  }
  const auto expectHands = [&](std::size_t count) {
    const std::vector<HandsRecord> read = SessionReader(dir / "a.db").hands();
    ASSERT_EQ(read.size(), count);
    EXPECT_EQ(read[0].fingers[1].peak_force, 8);
    EXPECT_TRUE(std::isnan(read[0].fingers[1].tip_mass));
    EXPECT_TRUE(std::isnan(read[0].fingers[0].tip_damping));
    EXPECT_EQ(read.back().fingers[1].tip_mass == 0.07, count > 1) << "told again";
  };
  expectHands(1);
  auto writer = SessionWriter::resume(dir / "a.db");
  hands.trial = trial.trial = 1;
  writer.addHands(hands);
  writer.finishTrial(trial);
  writer.close();
  expectHands(2);
}

TEST(SessionInputs, AFormatThatIsYetToComeIsRefused) {
  const TemporaryDirectory dir;
  SessionWriter::create(dir / "a.db", {}).close();
  Database(dir / "a.db", Database::Mode::kWrite).run("PRAGMA user_version = 99");
  EXPECT_NE(
      errorOf([&] { SessionReader(dir / "a.db"); }).find("has session format 99, this pincer reads formats 2 to 6"),
      std::string::npos);
}

}  // namespace
}  // namespace pincer::tasks
