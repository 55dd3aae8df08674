#include "pincer/tasks/lab/sweep/sweep_store.h"

#include <fmt/format.h>

#include <filesystem>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/contact/io/part_file.h"
#include "pincer/tasks/lab/sweep/sweep_parts.h"
#include "pincer/tasks/run/session/build_info.h"
#include "pincer/tasks/run/session/database.h"
#include "pincer/tasks/run/session/session_lock.h"

namespace pincer::tasks {
namespace {

constexpr std::int64_t kSweepId = 0x504e5357;  // "PNSW", in SQLite's header
constexpr std::int64_t kSweepFormat = 1;       // of sweep.db's tables; others are refused

std::string fileOf(const std::string& directory) { return directory + "/sweep.db"; }

std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

// Columns are numbered, as two paths may differ in their case only; the view `named` has the names.
std::string columnsOf(const SweepTable& table, const char* type) {
  std::string text;
  for (std::size_t i = 0; i < table.parameters.size(); ++i) text += fmt::format(", p{}{}", i, type);
  for (std::size_t i = 0; i < table.measures.size(); ++i) text += fmt::format(", m{}{}", i, type);
  return text;
}

std::string namedView(const SweepTable& table) {
  std::string text = "CREATE VIEW named AS SELECT \"case\"";
  for (std::size_t i = 0; i < table.parameters.size(); ++i)
    text += fmt::format(", p{} AS {}", i, quoted(table.parameters[i]));
  for (std::size_t i = 0; i < table.measures.size(); ++i)
    text += fmt::format(", m{} AS {}", i, quoted(table.measures[i]));
  return text + ", state_hash, error FROM result";
}

void insertNames(Database& d, const char* table, const std::vector<std::string>& names,
                 const std::vector<bool>& plotted) {
  Statement insert(d, fmt::format("INSERT INTO {} VALUES (?, ?, ?)", table));
  for (std::size_t i = 0; i < names.size(); ++i) {
    insert.bind(0, static_cast<std::int64_t>(i));
    insert.bind(1, std::string_view(names[i]));
    insert.bind(2, static_cast<std::int64_t>(i < plotted.size() && plotted[i]));
    insert.step();
  }
}

void makeTables(Database& d, const std::string& definition, const SweepShard& shard, const SweepTable& table) {
  d.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", kSweepId, kSweepFormat));
  d.run("CREATE TABLE sweep (what TEXT, definition TEXT, cases INTEGER, shard INTEGER, shards INTEGER, made_by TEXT)");
  d.run("CREATE TABLE parameter (number INTEGER PRIMARY KEY, name TEXT, plotted INTEGER)");
  d.run("CREATE TABLE measure (number INTEGER PRIMARY KEY, name TEXT, plotted INTEGER)");
  d.run(fmt::format("CREATE TABLE result (\"case\" INTEGER PRIMARY KEY{}, state_hash TEXT, error TEXT)",
                    columnsOf(table, " REAL")));
  d.run(namedView(table));
  Statement insert(d, "INSERT INTO sweep VALUES (?, ?, ?, ?, ?, ?)");
  SessionInfo here;
  tellBuild(here);
  insert.bind(0, std::string_view(table.what));
  insert.bind(1, std::string_view(definition));
  insert.bind(2, static_cast<std::int64_t>(table.points.size()));
  insert.bind(3, static_cast<std::int64_t>(shard.index));
  insert.bind(4, static_cast<std::int64_t>(shard.count));
  insert.bind(5, std::string_view(fmt::format("{}, {}, {}", programOf(here), here.build, here.c_library)));
  insert.step();
  insertNames(d, "parameter", table.parameters, {});
  insertNames(d, "measure", table.measures, table.plotted);
}

class ResultInsert {
 public:
  ResultInsert(const Database& d, const SweepTable& table) : insert_(d, sqlOf(table)), points_(table.points) {}

  void add(std::size_t point, const CaseResult& result) {
    int column = 0;
    insert_.bind(column++, static_cast<std::int64_t>(point));
    for (const double value : points_[point]) insert_.bind(column++, value);
    for (const double value : result.values) insert_.bind(column++, value);
    insert_.bind(column++, std::string_view(result.state_hash));
    insert_.bind(column++, std::string_view(result.error));
    insert_.step();
  }

 private:
  static std::string sqlOf(const SweepTable& table) {
    std::string marks = "?, ?, ?";
    for (std::size_t i = 0; i < table.parameters.size() + table.measures.size(); ++i) marks += ", ?";
    return fmt::format("INSERT INTO result VALUES ({})", marks);
  }
  Statement insert_;
  const std::vector<std::vector<double>>& points_;
};

std::vector<std::string> namesIn(const Database& d, const char* table, std::vector<bool>* plotted) {
  std::vector<std::string> names;
  Statement select(d, fmt::format("SELECT name, plotted FROM {} ORDER BY number", table));
  while (select.step()) {
    names.push_back(select.text(0));
    if (plotted) plotted->push_back(select.integer(1) != 0);
  }
  return names;
}

void readResults(const Database& d, SweepTable& table) {
  Statement select(
      d, fmt::format("SELECT \"case\"{}, state_hash, error FROM result ORDER BY \"case\"", columnsOf(table, "")));
  while (select.step()) {
    const auto point = static_cast<std::size_t>(select.integer(0));
    if (point >= table.points.size())
      throw InputError(
          fmt::format("{}: case {} of {} can't be. The file is damaged.", d.path(), point, table.points.size()));
    int column = 1;
    std::vector<double> values;
    for (std::size_t i = 0; i < table.parameters.size(); ++i) values.push_back(select.real(column++));
    table.points[point] = std::move(values);
    CaseResult& result = table.results[point];
    result = {true, {}, "", ""};
    for (std::size_t i = 0; i < table.measures.size(); ++i) result.values.push_back(select.real(column++));
    result.state_hash = select.text(column++);
    result.error = select.text(column);
  }
}

constexpr std::int64_t kMostCases = 1'000'000;  // more than any sweep has: a damaged file doesn't take all memory

StoredSweep read(const Database& d, const std::string& directory) {
  if (d.integer("PRAGMA application_id") != kSweepId)
    throw InputError(d.path() + ": is no sweep that `pincer sweep --out` wrote.");
  if (d.integer("PRAGMA user_version") != kSweepFormat)
    throw InputError(d.path() + ": was written by another version of pincer. Run the sweep again.");
  StoredSweep sweep;
  sweep.directory = directory;
  Statement row(d, "SELECT what, definition, cases, shard, shards FROM sweep");
  if (!row.step()) throw InputError(d.path() + ": holds no sweep. It is damaged; run the sweep again.");
  sweep.table.what = row.text(0);
  sweep.definition = row.text(1);
  const std::int64_t cases = row.integer(2);
  if (cases < 0 || cases > kMostCases)
    throw InputError(fmt::format("{}: {} cases can't be. The file is damaged.", d.path(), cases));
  sweep.shard = {static_cast<int>(row.integer(3)), static_cast<int>(row.integer(4))};
  sweep.table.parameters = namesIn(d, "parameter", nullptr);
  sweep.table.measures = namesIn(d, "measure", &sweep.table.plotted);
  sweep.table.points.resize(static_cast<std::size_t>(cases));
  sweep.table.results.resize(static_cast<std::size_t>(cases));
  readResults(d, sweep.table);
  return sweep;
}

std::string shardText(const SweepShard& shard) {
  return shard.count == 1 ? "the whole" : fmt::format("shard {}/{}", shard.index, shard.count);
}

// Cases that the shard has and that aren't done.
std::size_t openCases(const StoredSweep& sweep) {
  std::size_t open = 0;
  for (std::size_t i = 0; i < sweep.table.results.size(); ++i)
    open += sweep.shard.has(i) && !sweep.table.results[i].done ? 1 : 0;
  return open;
}

}  // namespace

class SweepStore::Impl {
 public:
  Impl(const std::string& directory, SweepJob& job, const SweepShard& shard, bool resume)
      : directory_(directory), definition_(job.definition), shard_(shard), lock_(fileOf(directory)) {
    job.table.results.resize(job.table.points.size());
    const bool is_there = std::filesystem::exists(fileOf(directory));
    if (is_there)
      takeUp(job, resume);
    else
      writeSweepStore(directory, definition_, shard_, job.table);
    database_ = std::make_unique<Database>(fileOf(directory), Database::Mode::kWrite);
    database_->run("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL");
    insert_ = std::make_unique<ResultInsert>(*database_, job.table);
  }

  void add(std::size_t point, const CaseResult& result) { insert_->add(point, result); }

  void finish(const SweepTable& table) {
    close();
    writeSweepStore(directory_, definition_, shard_, table);
  }

  void close() {
    insert_.reset();
    if (!database_) return;
    database_->run("PRAGMA journal_mode = DELETE");  // one plain file
    database_->close();
    database_.reset();
  }

 private:
  void takeUp(SweepJob& job, bool resume) {
    if (!resume)
      throw InputError(fmt::format("{}: a sweep is there already. Go on with it by --resume, or choose another folder.",
                                   fileOf(directory_)));
    const StoredSweep there = readSweep(directory_);
    if (there.definition != definition_) {
      throw InputError(
          fmt::format("{}: is another sweep, or was made by another build of pincer. Choose another folder, or give "
                      "the same command "
                      "to the same build.",
                      fileOf(directory_)));
    }
    if (there.shard.index != shard_.index || there.shard.count != shard_.count)
      throw InputError(fmt::format("{}: is {}, not {}. Each shard has a folder of its own.", fileOf(directory_),
                                   shardText(there.shard), shardText(shard_)));
    job.table.results = there.table.results;
  }

  std::string directory_, definition_;
  SweepShard shard_;
  SessionLock lock_;
  std::unique_ptr<Database> database_;
  std::unique_ptr<ResultInsert> insert_;
};

SweepStore::SweepStore(const std::string& directory, SweepJob& job, const SweepShard& shard, bool resume) {
  makeDirectory(directory);
  impl_ = std::make_unique<Impl>(directory, job, shard, resume);
}

SweepStore::~SweepStore() {
  try {
    impl_->close();
  } catch (const std::exception&) {  // what was committed is safe in the log beside the file
  }
}

void SweepStore::add(std::size_t point, const CaseResult& result) { impl_->add(point, result); }
void SweepStore::finish(const SweepTable& table) { impl_->finish(table); }

StoredSweep readSweep(const std::string& directory) {
  const Database d(fileOf(directory), Database::Mode::kRead);
  return read(d, directory);
}

void writeSweepStore(const std::string& directory, const std::string& definition, const SweepShard& shard,
                     const SweepTable& table) {
  PartFile part(fileOf(directory));
  part.release();
  {
    Database d(part.name(), Database::Mode::kWrite);
    d.run("PRAGMA synchronous = FULL; BEGIN");
    makeTables(d, definition, shard, table);
    ResultInsert insert(d, table);
    for (std::size_t i = 0; i < table.results.size(); ++i) {
      if (table.results[i].done) insert.add(i, table.results[i]);
    }
    d.run("COMMIT");
  }
  placeWritten(part.name(), fileOf(directory));
}

StoredSweep mergeSweeps(const std::vector<std::string>& directories) {
  StoredSweep whole = readSweep(directories.at(0));
  const int count = whole.shard.count;
  std::vector<std::string> from(static_cast<std::size_t>(count));
  for (const std::string& directory : directories) {
    StoredSweep part = readSweep(directory);
    if (part.definition != whole.definition)
      throw InputError(fmt::format("{} and {}: aren't shards of one sweep, or were made by different builds of pincer.",
                                   directories[0], directory));
    if (part.shard.count != count || part.shard.index < 1 || part.shard.index > count)
      throw InputError(fmt::format("{} is {}, but {} is one of {}. Merge shards of one division.", directory,
                                   shardText(part.shard), directories[0], count));
    std::string& first = from[static_cast<std::size_t>(part.shard.index - 1)];
    if (!first.empty())
      throw InputError(
          fmt::format("{} is there twice: in {} and in {}. Leave one out.", shardText(part.shard), first, directory));
    first = directory;
    if (const std::size_t open = openCases(part); open > 0)
      throw InputError(fmt::format("{}: {} lacks {} of its cases. Give its command again with --resume.", directory,
                                   shardText(part.shard), open));
    for (std::size_t i = 0; i < part.table.results.size(); ++i) {
      if (!part.shard.has(i)) continue;
      whole.table.points[i] = std::move(part.table.points[i]);
      whole.table.results[i] = std::move(part.table.results[i]);
    }
  }
  std::string missing;
  for (int i = 0; i < count; ++i) {
    if (from[static_cast<std::size_t>(i)].empty())
      missing += fmt::format("{}{}/{}", missing.empty() ? "" : ", ", i + 1, count);
  }
  if (!missing.empty())
    throw InputError(fmt::format("shards are missing: {}. Run them, and give all folders.", missing));
  whole.shard = {};
  return whole;
}

}  // namespace pincer::tasks
