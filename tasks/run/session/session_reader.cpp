#include <filesystem>
#include <set>

#include "pincer/contact/error.h"
#include "pincer/contact/io/part_file.h"
#include "pincer/tasks/run/session/input_codec.h"
#include "pincer/tasks/run/session/session_lock.h"
#include "pincer/tasks/run/session/table.h"
#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

namespace {

// A part of it beside its place; before format 5 sessions were made at their place, and a kill
// could leave the beginnings of one there.
[[noreturn]] void refuseBeginnings(const std::string& path) {
  throw InputError(path +
                   ": the session was killed while it was being made and holds no trial. Delete it, if it is there, "
                   "and run again without --resume.");
}

void requireFile(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    if (hasPart(path)) refuseBeginnings(path);
    throw InputError(path + ": there is no such file. Give the path of a session.");
  }
  if (!std::filesystem::is_regular_file(path, ignored))
    throw InputError(path + ": is not a file. Give the path of a session.");
  if (std::filesystem::file_size(path, ignored) == 0) refuseBeginnings(path);
}

std::unique_ptr<Database> openSession(const std::string& path) {
  requireFile(path);
  auto database = std::make_unique<Database>(path, Database::Mode::kRead);
  const std::int64_t application = database->integer("PRAGMA application_id");
  const std::int64_t format = database->integer("PRAGMA user_version");
  const bool empty = database->integer("SELECT count(*) FROM sqlite_master") == 0;
  if (empty && format == 0 && (application == 0 || application == kApplicationId)) refuseBeginnings(path);
  if (application != kApplicationId) {
    throw InputError(path +
                     ": is not a pincer session (its application id isn't \"PNCR\"). Give the path of a file that "
                     "`pincer run` wrote.");
  }
  if (format < kOldestFormat || format > kFormat) {
    throw InputError(
        fmt::format("{}: has session format {}, this pincer reads formats {} to {}. Use the pincer that wrote it.",
                    path, format, kOldestFormat, kFormat));
  }
  return database;
}

template <class Record>
std::vector<Record> readAll(const Database& database, std::int64_t format, const std::string& condition = "") {
  std::vector<Record> records;
  Statement rows(database, fmt::format("{} {} ORDER BY rowid", selectSql<Record>(format), condition));
  while (rows.step()) records.push_back(readRow<Record>(rows));
  return records;
}

template <class Record>
Record readOnly(const Database& database, std::int64_t format) {
  std::vector<Record> rows = readAll<Record>(database, format);
  if (rows.size() == 1) return std::move(rows.front());
  throw InputError(fmt::format(
      "{}: table {} has {} rows in place of one. The file is damaged, or something else than pincer changed it. "
      "Take a copy of before.",
      database.path(), tableName<Record>(), rows.size()));
}

std::string whereTrial(std::optional<std::int64_t> trial) {
  return trial ? fmt::format("WHERE trial = {}", *trial) : "";
}

// Of each number the first: formats before 5 let two programs write a session at once.
template <class Record>
std::vector<Record> firstOfEach(std::vector<Record> records) {
  std::set<std::int64_t> seen;
  std::erase_if(records, [&](const Record& record) { return !seen.insert(record.trial).second; });
  return records;
}

// Packed values pass no cell.
void requirePossible(const InputRecord& record) {
  forEachColumn(record, [&]<class Field>(const ColumnName& name, const Field& field) {
    const ColumnRange range = name.rangeOf<Field>();
    if (range.holds(static_cast<double>(field))) return;
    throw InputError(fmt::format(
        "the inputs of trial {}, tick {}, are damaged: {} = {} isn't {}. Take a copy of the session from before.",
        record.trial + 1, record.tick, name.text(), field, wordsOf(range, "number")));
  });
}

std::vector<InputRecord> unpackedAt(const std::string& path, const InputChunk& chunk) {
  try {
    std::vector<InputRecord> inputs = unpackInputs(chunk);
    for (const InputRecord& input : inputs) requirePossible(input);
    return inputs;
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
}

std::string doubledText(const Database& database) {
  std::string numbers;
  std::int64_t count = 0;
  for (const char* table : {"trial", "response"}) {
    Statement rows(database,
                   fmt::format("SELECT trial FROM {} GROUP BY trial HAVING count(*) > 1 ORDER BY trial", table));
    for (; rows.step(); ++count) {
      if (count < 10) numbers += fmt::format("{}{}", count > 0 ? ", " : "", rows.integer(0) + 1);
    }
  }
  if (count == 0) return "";
  return fmt::format(
      "Two programs wrote this session at once: trial{} {}{} {} there more than once. Only the first of each counts "
      "here; what {} samples, "
      "events and readings hold is mixed.",
      count == 1 ? "" : "s", numbers, count > 10 ? ", ..." : "", count == 1 ? "is" : "are",
      count == 1 ? "its" : "their");
}

}  // namespace

SessionReader::SessionReader(const std::string& path) : database_(openSession(path)) {
  format_ = database_->integer("PRAGMA user_version");
  info_ = readOnly<SessionInfo>(*database_, format_);
  progress_ = readOnly<SessionProgress>(*database_, format_);
}

SessionReader::SessionReader(SessionReader&&) noexcept = default;
SessionReader::~SessionReader() = default;

void SessionReader::heed(const std::atomic<bool>& interrupted) { database_->heed(interrupted); }

const std::string& SessionReader::path() const { return database_->path(); }
bool SessionReader::complete() const { return progress_.state == kStateComplete; }
std::string SessionReader::doubledTrials() const { return doubledText(*database_); }

std::string SessionReader::warning() const {
  const std::int64_t trials = database_->integer(
      "SELECT (SELECT count(DISTINCT trial) FROM trial) + (SELECT count(DISTINCT trial) FROM response)");
  std::vector<std::string> sentences;
  const auto unfinished = [&](const std::string& why) {
    sentences.push_back(fmt::format("This session was not completed{} It holds {} finished trials.", why, trials));
  };
  if (progress_.state == kStateRunning) {
    const std::string writer = sessionWriterOf(path());
    const char* alone = format_ < kFirstLockedFormat ? ": it still runs or was killed." : ": its program was killed.";
    unfinished(writer.empty() ? alone : fmt::format(": it still runs ({}).", writer));
  } else if (!complete()) {
    unfinished(fmt::format(" ({}).", state()));
  }
  if (samplesDropped() > 0)
    sentences.push_back(fmt::format("{} samples were lost because the disk was too slow.", samplesDropped()));
  if (std::string doubled = doubledTrials(); !doubled.empty()) sentences.push_back(std::move(doubled));
  return fmt::format("{}", fmt::join(sentences, " "));
}

std::vector<TrialRecord> SessionReader::trials() const {
  return firstOfEach(readAll<TrialRecord>(*database_, format_));
}
std::vector<ResponseRecord> SessionReader::responses() const {
  return firstOfEach(readAll<ResponseRecord>(*database_, format_));
}
std::vector<EventRecord> SessionReader::events(std::optional<std::int64_t> trial) const {
  return readAll<EventRecord>(*database_, format_, whereTrial(trial));
}
std::vector<ReadingRecord> SessionReader::readings(std::optional<std::int64_t> trial) const {
  return readAll<ReadingRecord>(*database_, format_, whereTrial(trial));
}

std::vector<SurveyRecord> SessionReader::survey() const {
  constexpr std::int64_t kFirstWithSurvey = 6;  // format that brought the table
  return format_ >= kFirstWithSurvey ? readAll<SurveyRecord>(*database_, format_) : std::vector<SurveyRecord>();
}

std::vector<HandsRecord> SessionReader::hands() const {
  return keepsInputs() ? firstOfEach(readAll<HandsRecord>(*database_, format_)) : std::vector<HandsRecord>();
}

std::vector<InputRecord> SessionReader::inputs(std::int64_t trial) const {
  std::vector<InputRecord> inputs;
  forEachInput(trial, [&](const InputRecord& input) { inputs.push_back(input); });
  return inputs;
}

void SessionReader::forEachInput(std::int64_t trial, const std::function<void(const InputRecord&)>& take) const {
  if (!keepsInputs()) return;
  Statement rows(*database_, fmt::format("{} {} ORDER BY rowid", selectSql<InputChunk>(format_), whereTrial(trial)));
  while (rows.step()) {
    for (const InputRecord& input : unpackedAt(path(), readRow<InputChunk>(rows))) take(input);
  }
}

void SessionReader::forEachSample(const SampleFilter& filter,
                                  const std::function<void(const SampleRecord&)>& take) const {
  if (filter.stride < 1)
    throw InputError(fmt::format("sample stride {} is out of range [1, inf). Use 1 for every sample.", filter.stride));
  Statement rows(*database_,
                 fmt::format("{} {} ORDER BY rowid", selectSql<SampleRecord>(format_), whereTrial(filter.trial)));
  for (std::int64_t k = 0; rows.step(); ++k) {
    if (k % filter.stride == 0) take(readRow<SampleRecord>(rows));
  }
}

}  // namespace pincer::tasks
