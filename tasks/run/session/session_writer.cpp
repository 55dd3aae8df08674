#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <mutex>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>
#include <variant>

#include "pincer/contact/error.h"
#include "pincer/contact/io/part_file.h"
#include "pincer/tasks/run/session/input_codec.h"
#include "pincer/tasks/run/session/record_hash.h"
#include "pincer/tasks/run/session/ring.h"
#include "pincer/tasks/run/session/session_file.h"
#include "pincer/tasks/run/session/session_lock.h"
#include "pincer/tasks/run/session/table.h"
#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

namespace {

// leaves 30 of the promised 50 ms for the transaction itself
constexpr auto kBatchPeriod = std::chrono::milliseconds(20);
// 64 MB of log: a trial never gets there, so the log is folded in between trials
constexpr int kCheckpointPages = 16384;

// All that a session may consist of.
std::array<std::string, 4> filesOfSession(const std::string& path) {
  return {path, path + "-wal", path + "-shm", path + "-journal"};
}

// The file's entry on the session. Throws InputError, which says what is wrong with one that can't be gone on with.
SessionInfo infoOfUnfinished(const std::string& path) {
  const SessionReader session(path);
  if (session.complete()) throw InputError(path + ": the session is complete; there is nothing to go on with.");
  const std::string doubled = session.doubledTrials();
  if (!doubled.empty())
    throw InputError(path + ": can't be gone on with. " + doubled + " `pincer report` and `pincer export` read it.");
  return session.info();
}

}  // namespace

class SessionWriter::Impl {
 public:
  using FinishedTrial = std::variant<TrialRecord, ResponseRecord, SurveyRecord>;

  // Of a session whose file is there; `earlier`: what the file says of it, if another program may have begun it.
  Impl(SessionLock lock, const std::string& path, const SessionOptions& options,
       const std::optional<SessionInfo>& earlier = {})
      : options_(options),
        is_whole_(!earlier),
        ring_(options.ring_capacity),
        inputs_(options.ring_capacity),
        lock_(std::move(lock)),
        database_(path, Database::Mode::kWrite) {
    openForWriting(database_, options.max_pages);
    database_.run(fmt::format("PRAGMA wal_autocheckpoint = {}; PRAGMA synchronous = NORMAL", kCheckpointPages));
    database_.run("BEGIN IMMEDIATE");
    upgradeTables(database_);
    if (earlier) tellWhoGoesOn(database_, *earlier);
    removeUnfinished(database_);
    database_.run(fmt::format("UPDATE session SET state = '{}'; COMMIT", kStateRunning));
    statements_.emplace(database_);
    begin();
  }
  ~Impl() { abort("the program left without closing the session"); }

  bool push(const SampleRecord& sample) noexcept { return pushInto(ring_, sample); }
  bool push(const InputRecord& input) noexcept { return pushInto(inputs_, input); }
  std::uint64_t dropped() const noexcept { return ring_.dropped(); }

  void addEvent(const EventRecord& event) {
    const std::lock_guard lock(mutex_);
    throwIfEnded();
    events_.push_back(event);
  }

  void addReading(const ReadingRecord& reading) {
    const std::lock_guard lock(mutex_);
    throwIfEnded();
    readings_.push_back(reading);
  }

  void addHands(const HandsRecord& hands) {
    const std::lock_guard lock(mutex_);
    throwIfEnded();
    hands_.push_back(hands);
  }

  void finish(FinishedTrial trial) {
    std::unique_lock lock(mutex_);
    throwIfEnded();
    trial_ = std::move(trial);
    wake_.notify_one();
    done_.wait(lock, [this] { return !trial_ || ended_; });
    throwIfEnded();
  }

  void close() {
    join();
    if (failure_) std::rethrow_exception(failure_);
    if (closed_) return;
    try {
      endWith(kStateComplete, "");
      database_.text("PRAGMA journal_mode = DELETE");
      database_.close();
      lock_.reset();
    } catch (...) {
      failed();
      std::rethrow_exception(failure_);
    }
    closed_ = true;
  }

  void abort(std::string_view why) noexcept {
    join();
    if (closed_ || failure_) return;
    giveUp(why, nullptr);
  }

  std::optional<std::uint64_t> samplesHash() const {
    return closed_ && is_whole_ ? std::optional(samples_.bits()) : std::nullopt;
  }

 private:
  struct Statements {
    explicit Statements(const Database& d)
        : sample(d, insertSql<SampleRecord>()),
          event(d, insertSql<EventRecord>()),
          reading(d, insertSql<ReadingRecord>()),
          hands(d, insertSql<HandsRecord>()),
          input(d, insertSql<InputChunk>()),
          trial(d, insertSql<TrialRecord>()),
          response(d, insertSql<ResponseRecord>()),
          survey(d, insertSql<SurveyRecord>()) {}
    void insert(const TrialRecord& record) { insertRow(trial, record); }
    void insert(const ResponseRecord& record) { insertRow(response, record); }
    void insert(const SurveyRecord& record) { insertRow(survey, record); }
    Statement sample, event, reading, hands, input, trial, response, survey;
  };
  struct Batch {
    std::vector<EventRecord> events;
    std::vector<ReadingRecord> readings;
    std::vector<HandsRecord> hands;
    std::optional<FinishedTrial> trial;
    bool last = false;
  };

  // Starts the thread; without one the file would say "running" for ever.
  void begin() {
    try {
      thread_ = std::thread([this] { work(); });
    } catch (...) {
      failed();
      std::rethrow_exception(failure_);
    }
  }

  void work() noexcept {
    try {
      for (bool last = false; !last && !ended_;) {
        const Batch batch = awaitBatch();
        last = batch.last;
        write(batch);
        settle(batch);
      }
    } catch (...) {
      failed();
    }
  }

  Batch awaitBatch() {
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, kBatchPeriod, [this] { return trial_ || stopping_ || space_wanted_; });
    space_wanted_ = false;
    return {std::exchange(events_, {}), std::exchange(readings_, {}), std::exchange(hands_, {}), trial_, stopping_};
  }

  void write(const Batch& batch) {
    if (batch.trial) database_.run("PRAGMA synchronous = FULL");  // the log is flushed to the disk with this commit
    database_.run("BEGIN");
    ring_.drain([this](const SampleRecord& sample) {
      insertRow(statements_->sample, sample);
      addValues(sample, samples_);
    });
    for (const HandsRecord& hands : batch.hands) insertRow(statements_->hands, hands);
    writeInputs();
    for (const EventRecord& event : batch.events) insertRow(statements_->event, event);
    for (const ReadingRecord& reading : batch.readings) insertRow(statements_->reading, reading);
    if (batch.trial) {
      std::visit([this](const auto& trial) { statements_->insert(trial); }, *batch.trial);
      database_.run(fmt::format("UPDATE session SET samples_dropped = {}", dropped()));
    }
    database_.run("COMMIT");
    if (batch.trial) database_.run("PRAGMA wal_checkpoint(PASSIVE); PRAGMA synchronous = NORMAL");
  }

  // After the samples: the input of a tick is pushed before its sample, so that no sample is kept whose input isn't.
  void writeInputs() {
    inputs_.drain([this](const InputRecord& input) {
      if (!packer_.takes(input)) insertRow(statements_->input, packer_.take());
      packer_.add(input);
    });
    if (!packer_.empty()) insertRow(statements_->input, packer_.take());
  }

  template <class Record>
  bool pushInto(Ring<Record>& ring, const Record& record) noexcept {
    if (ended_.load(std::memory_order_relaxed)) return false;
    if (options_.block_when_full && ring.full()) awaitSpace();
    return ring.push(record);
  }

  void settle(const Batch& batch) {
    const std::lock_guard lock(mutex_);
    if (batch.trial) trial_.reset();
    done_.notify_all();
  }

  void awaitSpace() {
    std::unique_lock lock(mutex_);
    space_wanted_ = true;
    wake_.notify_one();
    done_.wait(lock, [this] { return (!ring_.full() && !inputs_.full()) || ended_; });
  }

  // In a handler: gives up because of what was caught.
  void failed() noexcept {
    try {
      throw;
    } catch (const std::bad_alloc&) {
      giveUp("not enough memory", std::current_exception());
    } catch (const std::exception& error) {
      giveUp(error.what(), nullptr);
    }
  }

  // Marks the file; if even that fails, it stays "running", which a reader reports as well. Needs no memory. `failure`:
  // what the next call throws; null: InputError that says why.
  void giveUp(std::string_view why, std::exception_ptr failure) noexcept {
    const LastWords words;
    const char* said = "The session is marked as aborted; trials finished before are kept.";
    try {
      database_.rollBack();
      endWith(kStateAborted, why);
    } catch (const std::exception&) {
      database_.rollBack();
      said = "The session could not even be marked as aborted and stays \"running\"; trials finished before are kept.";
    }
    try {
      if (!failure) throw InputError(fmt::format("{}{} {}", why, why.ends_with('.') ? "" : ".", said));
    } catch (const std::exception&) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    failure_ = failure;
    ended_ = true;
    done_.notify_all();
  }

  void endWith(std::string_view state, std::string_view why) {
    database_.run("PRAGMA synchronous = FULL");
    Statement update(database_, "UPDATE session SET state = ? || ?, samples_dropped = ?");
    update.bind(0, state);
    update.bind(1, why);
    update.bind(2, static_cast<std::int64_t>(dropped()));
    update.step();
    statements_.reset();
  }

  void join() noexcept {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_one();
    if (thread_.joinable()) thread_.join();
    ended_ = true;
  }

  void throwIfEnded() const {
    if (failure_) std::rethrow_exception(failure_);
    if (ended_) throw std::logic_error("SessionWriter: used after close() or abort()");
  }

  SessionOptions options_;
  bool is_whole_;        // from its first sample
  Fingerprint samples_;  // the writer thread's, until it is joined
  SampleRing ring_;
  InputRing inputs_;
  InputPacker packer_;               // the writer thread's
  std::optional<SessionLock> lock_;  // outlives the database
  Database database_;                // the writer thread's, until it is joined
  std::optional<Statements> statements_;
  std::mutex mutex_;  // guards events_ .. failure_
  std::condition_variable wake_, done_;
  std::vector<EventRecord> events_;
  std::vector<ReadingRecord> readings_;
  std::vector<HandsRecord> hands_;
  std::optional<FinishedTrial> trial_;
  bool stopping_ = false, space_wanted_ = false;
  std::exception_ptr failure_;
  std::atomic<bool> ended_{false};
  bool closed_ = false;
  std::thread thread_;
};

SessionWriter SessionWriter::create(const std::string& path, const SessionInfo& info, const SessionOptions& options) {
  const std::array<std::string, 4> files = filesOfSession(path);
  std::error_code ignored;
  if (std::filesystem::exists(std::filesystem::symlink_status(path, ignored)))
    failOnFile(path, "create the session", EEXIST);
  SessionLock lock(path);
  makeSession(path, info, options.max_pages);
  try {
    return SessionWriter(std::make_unique<Impl>(std::move(lock), path, options));
  } catch (...) {
    for (const std::string& file : files) ::unlink(file.c_str());
    throw;
  }
}

SessionWriter SessionWriter::resume(const std::string& path, const SessionOptions& options) {
  infoOfUnfinished(path);
  SessionLock lock(path);
  const SessionInfo earlier = infoOfUnfinished(path);  // once more: another program may have finished it in between
  removeLeftParts(path);                               // a second name, where the file system can't rename in one step
  return SessionWriter(std::make_unique<Impl>(std::move(lock), path, options, earlier));
}

SessionWriter::SessionWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SessionWriter::SessionWriter(SessionWriter&&) noexcept = default;
SessionWriter::~SessionWriter() = default;

bool SessionWriter::pushSample(const SampleRecord& sample) noexcept { return impl_->push(sample); }
std::uint64_t SessionWriter::droppedSamples() const noexcept { return impl_->dropped(); }
void SessionWriter::addEvent(const EventRecord& event) { impl_->addEvent(event); }
bool SessionWriter::pushInput(const InputRecord& input) noexcept { return impl_->push(input); }
void SessionWriter::addHands(const HandsRecord& hands) { impl_->addHands(hands); }
void SessionWriter::addReading(const ReadingRecord& reading) { impl_->addReading(reading); }
void SessionWriter::finishTrial(const TrialRecord& trial) { impl_->finish(trial); }
void SessionWriter::addSurvey(const SurveyRecord& answer) { impl_->finish(answer); }
void SessionWriter::finishResponse(const ResponseRecord& response) { impl_->finish(response); }
void SessionWriter::close() { impl_->close(); }
void SessionWriter::abort(std::string_view why) noexcept { impl_->abort(why); }
std::optional<std::uint64_t> SessionWriter::samplesHash() const { return impl_->samplesHash(); }

}  // namespace pincer::tasks
