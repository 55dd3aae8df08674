#include <filesystem>

#include "contact/error.h"
#include "tasks/session/input_codec.h"
#include "tasks/session/session_store.h"
#include "tasks/session/table.h"

namespace pincer::tasks {

namespace {

std::unique_ptr<Database> openSession(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw InputError(path + ": there is no such file. Give the path of a session.");
  if (!std::filesystem::is_regular_file(path, ignored)) throw InputError(path + ": is not a file. Give the path of a session.");
  auto database = std::make_unique<Database>(path, Database::Mode::kRead);
  if (database->integer("PRAGMA application_id") != kApplicationId) {
    throw InputError(path +
                     ": is not a pincer session (its application id isn't \"PNCR\"). Give the path of a file that `pincer run` wrote.");
  }
  const std::int64_t format = database->integer("PRAGMA user_version");
  if (format < kOldestFormat || format > kFormat) {
    throw InputError(fmt::format("{}: has session format {}, this pincer reads formats {} to {}. Use the pincer that wrote it.", path,
                                 format, kOldestFormat, kFormat));
  }
  if (database->integer("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = 'session'") == 0) {
    throw InputError(path + ": the session was killed while it was being made and holds nothing. Delete it and run again.");
  }
  return database;
}

template <class Record>
std::vector<Record> readAll(const Database& database, const std::string& condition, const std::string& select = selectSql<Record>()) {
  std::vector<Record> records;
  Statement rows(database, fmt::format("{} {} ORDER BY rowid", select, condition));
  while (rows.step()) records.push_back(readRow<Record>(rows));
  return records;
}

// Columns that an older format lacks are read as what the arm didn't tell.
std::string selectHands(std::int64_t format) {
  std::string sql = selectSql<HandsRecord>();
  if (format >= 4) return sql;
  for (const std::string& column : columnsSinceFormat4()) sql.replace(sql.find('"' + column + '"'), column.size() + 2, "NULL");
  return sql;
}

std::string whereTrial(std::optional<std::int64_t> trial) { return trial ? fmt::format("WHERE trial = {}", *trial) : ""; }

}  // namespace

SessionReader::SessionReader(const std::string& path) : database_(openSession(path)) {
  Statement row(*database_, selectSql<SessionInfo>());
  if (!row.step()) throw InputError(path + ": table session is empty. The file is damaged.");
  info_ = readRow<SessionInfo>(row);
  state_ = database_->text("SELECT state FROM session");
  started_utc_ = database_->text("SELECT started_utc FROM session");
  samples_dropped_ = database_->integer("SELECT samples_dropped FROM session");
  format_ = database_->integer("PRAGMA user_version");
}

SessionReader::SessionReader(SessionReader&&) noexcept = default;
SessionReader::~SessionReader() = default;

void SessionReader::heed(const std::atomic<bool>& interrupted) { database_->heed(interrupted); }

const std::string& SessionReader::path() const { return database_->path(); }
bool SessionReader::complete() const { return state_ == kStateComplete; }

std::string SessionReader::warning() const {
  const std::int64_t trials = database_->integer("SELECT (SELECT count(*) FROM trial) + (SELECT count(*) FROM response)");
  std::string text;
  if (state_ == kStateRunning) {
    text = fmt::format("This session was not completed: it still runs or was killed. It holds {} finished trials.", trials);
  } else if (!complete()) {
    text = fmt::format("This session was not completed ({}). It holds {} finished trials.", state_, trials);
  }
  if (samples_dropped_ > 0)
    text += fmt::format("{}{} samples were lost because the disk was too slow.", text.empty() ? "" : " ", samples_dropped_);
  return text;
}

std::vector<TrialRecord> SessionReader::trials() const { return readAll<TrialRecord>(*database_, ""); }
std::vector<ResponseRecord> SessionReader::responses() const { return readAll<ResponseRecord>(*database_, ""); }
std::vector<EventRecord> SessionReader::events(std::optional<std::int64_t> trial) const {
  return readAll<EventRecord>(*database_, whereTrial(trial));
}
std::vector<ReadingRecord> SessionReader::readings(std::optional<std::int64_t> trial) const {
  return readAll<ReadingRecord>(*database_, whereTrial(trial));
}

std::vector<HandsRecord> SessionReader::hands() const {
  return keepsInputs() ? readAll<HandsRecord>(*database_, "", selectHands(format_)) : std::vector<HandsRecord>();
}

std::vector<InputRecord> SessionReader::inputs(std::int64_t trial) const {
  std::vector<InputRecord> inputs;
  forEachInput(trial, [&](const InputRecord& input) { inputs.push_back(input); });
  return inputs;
}

void SessionReader::forEachInput(std::int64_t trial, const std::function<void(const InputRecord&)>& take) const {
  if (!keepsInputs()) return;
  Statement rows(*database_, fmt::format("{} {} ORDER BY rowid", selectSql<InputChunk>(), whereTrial(trial)));
  while (rows.step()) {
    try {
      for (const InputRecord& input : unpackInputs(readRow<InputChunk>(rows))) take(input);
    } catch (const InputError& error) {
      throw InputError(path() + ": " + error.what());
    }
  }
}

void SessionReader::forEachSample(const SampleFilter& filter, const std::function<void(const SampleRecord&)>& take) const {
  if (filter.stride < 1) throw InputError(fmt::format("sample stride {} is out of range [1, inf). Use 1 for every sample.", filter.stride));
  Statement rows(*database_, fmt::format("{} {} ORDER BY rowid", selectSql<SampleRecord>(), whereTrial(filter.trial)));
  for (std::int64_t k = 0; rows.step(); ++k) {
    if (k % filter.stride == 0) take(readRow<SampleRecord>(rows));
  }
}

}  // namespace pincer::tasks
