#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "pincer/tasks/run/session/database.h"
#include "pincer/tasks/run/session/input_codec.h"
#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/fuzz/choices.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/input_on_disk.h"
#include "pincer/tests/fuzz/targets.h"
#include "pincer/tests/support/synthetic_session.h"

namespace pincer::fuzz {
namespace {

using namespace tasks;

struct Column {
  std::string table, name;
};

// A sound session with a row in every table, made once.
struct SoundSession {
  std::string bytes;
  std::vector<Column> columns;
};

void writePersonsTrial(SessionWriter& out) {
  HandsRecord hands;
  hands.trial = 7;
  out.addHands(hands);
  for (std::int64_t tick = 0; tick < 40; ++tick) {
    InputRecord input;
    input.trial = 7;
    input.tick = tick;
    out.pushInput(input);
  }
  TrialRecord trial;
  trial.trial = 7;
  trial.outcome = "success";
  out.finishTrial(trial);
  ResponseRecord response;
  response.trial = 7;
  response.outcome = "answered";
  out.finishResponse(response);
  out.addReading({});
  out.addSurvey({});
}

SoundSession makeSoundSession() {
  const InputOnDisk file("sound.db");
  {
    SessionWriter out = SessionWriter::create(file.path(), tests::SyntheticSession::info());
    tests::SyntheticPlan plan;
    plan.repetitions = 1, plan.conditions = {"force"}, plan.frictions = {0.6}, plan.rate = 10;
    tests::SyntheticSession(plan).writeTo(out);
    writePersonsTrial(out);
    out.close();
  }
  SoundSession sound{tests::readFile(file.path()), {}};
  Database database(file.path(), Database::Mode::kRead);
  Statement columns(database,
                    "SELECT m.name, c.name FROM sqlite_master m, pragma_table_info(m.name) c WHERE m.type = 'table'");
  while (columns.step()) sound.columns.push_back({columns.text(0), columns.text(1)});
  return sound;
}

const SoundSession& sound() {
  static const SoundSession kSound = makeSoundSession();
  return kSound;
}

// Bytes of the file, at a few places.
void patch(std::string& file, Choices& choices) {
  while (!choices.empty()) {
    const std::size_t at = 256 * 256 * choices.below(4) + choices.below(65536);
    std::size_t k = 0;
    for (const std::uint8_t byte : choices.take(1 + choices.below(16)))
      file[(at + k++) % file.size()] = static_cast<char>(byte);
  }
}

// A value of any type, as SQL.
std::string drawValue(Choices& choices) {
  constexpr const char* kValues[] = {"NULL",  "0",    "-1",    "9223372036854775807", "-9223372036854775808",
                                     "1e308", "-0.5", "9e999", "zeroblob(40)",        "'success'",
                                     "''",    "'nan'"};
  const std::size_t which = choices.below(std::size(kValues) + 2);
  if (which < std::size(kValues)) return kValues[which];
  std::string hex;
  for (const std::uint8_t byte : choices.take(choices.below(40))) hex += fmt::format("{:02x}", byte);
  return which % 2 == 0 ? fmt::format("x'{}'", hex) : fmt::format("CAST(x'{}' AS TEXT)", hex);
}

// Cells of tables. A value that the table itself forbids changes nothing.
void changeCells(const std::string& path, Choices& choices) {
  Database database(path, Database::Mode::kWrite);
  while (!choices.empty()) {
    const Column& column = sound().columns[choices.below(sound().columns.size())];
    const std::size_t row = choices.below(4);
    const std::string where = row == 0 ? "" : fmt::format(" WHERE rowid = {}", row);
    const std::string value = drawValue(choices);
    readsOrRefuses(
        [&] { database.run(fmt::format("UPDATE {} SET {} = {}{}", column.table, column.name, value, where)); });
  }
  readsOrRefuses([&] { database.close(); });
}

// Each kind of row by itself: a table that is refused keeps nobody from the others.
void readAll(const SessionReader& session) {
  session.complete();
  session.warning();
  readsOrRefuses([&] { session.trials(); });
  readsOrRefuses([&] { session.responses(); });
  readsOrRefuses([&] { session.events(); });
  readsOrRefuses([&] { session.readings(); });
  readsOrRefuses([&] { session.survey(); });
  readsOrRefuses([&] { session.forEachSample({.trial = {}, .stride = 3}, [](const SampleRecord&) {}); });
  if (!session.keepsInputs()) return;
  readsOrRefuses([&] {
    for (const HandsRecord& hands : session.hands()) session.inputs(hands.trial);
  });
}

}  // namespace

void session(Bytes input) {
  static const InputOnDisk file("session.db");
  Choices choices(input);
  std::string bytes = sound().bytes;
  const bool by_cells = choices.below(2) == 0;
  if (!by_cells) patch(bytes, choices);
  for (const char* log : {"session.db-wal", "session.db-shm", "session.db-journal"})
    std::filesystem::remove(file.beside(log));
  file.write(bytes);
  if (by_cells) readsOrRefuses([&] { changeCells(file.path(), choices); });
  readsOrRefuses([&] { readAll(SessionReader(file.path())); });
}

// The bytes with a sound check: who damages a file by hand can compute it too.
void replay_log(Bytes input) {
  InputChunk chunk;
  Choices choices(input);
  chunk.ticks = static_cast<std::int64_t>(choices.below(64));
  const Bytes rest = choices.take(input.size());
  chunk.data.value.assign(rest.begin(), rest.end());
  chunk.check = checkOf(chunk);
  readsOrRefuses([&] {
    const std::vector<InputRecord> records = unpackInputs(chunk);
    demand(records.size() == static_cast<std::size_t>(chunk.ticks), "a chunk has as many records as it says");
    InputPacker packer;
    for (const InputRecord& record : records) {
      if (!packer.takes(record)) return;
      packer.add(record);
    }
    if (packer.empty()) return;
    const std::vector<InputRecord> again = unpackInputs(packer.take());
    for (std::size_t i = 0; i < records.size(); ++i)
      demand(wordsOf(again[i]) == wordsOf(records[i]), "records that are packed and unpacked again are the same bits");
  });
}

}  // namespace pincer::fuzz
