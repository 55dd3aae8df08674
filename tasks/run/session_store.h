// session_store: one SQLite file per session, safe against a kill at any moment.
//
//   tick --pushSample, pushInput--> rings --> writer thread --a transaction at
//   least every 50 ms--> file (write-ahead log)
//
// A finished trial is committed and synchronised to the disk before finishTrial() returns; samples, inputs and events
// reach the file within 50 ms and so survive a kill of the process (after a power cut the last ones may be missing).
// The column `state` of table `session` reads "running" until close() writes "complete" or a failure "aborted: <why>";
// a killed session therefore stays "running", and a reader says so. A session appears whole, its tables made and its
// first row written; one program writes it at a time (session_lock.h), any number read.
//
// Errors: InputError with path, cause and remedy; std::bad_alloc. What fails in the writer thread
// is thrown by the next call and by close().
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/tasks/run/records.h"

namespace pincer::tasks {

class Database;

struct SessionOptions {
  bool block_when_full = false;      // virtual time: pushSample waits for space, so that no sample is lost
  std::size_t ring_capacity = 4096;  // [samples, inputs], a power of two; 4 s at 1 kHz
  std::int64_t max_pages = 0;        // for tests of a full disk: largest file [pages of 4096 bytes]; 0: no limit
};

class SessionWriter {
 public:
  // Makes a new file; refuses to overwrite one. Leaves nothing behind if it throws.
  static SessionWriter create(const std::string& path, const SessionInfo& info, const SessionOptions& options = {});
  // Goes on with a session that was killed or aborted: its finished trials stay, what it holds of an unfinished one
  // is removed. Refuses one that is complete, that another program writes, or that holds a trial twice. What is
  // finished must be read after this, not before.
  static SessionWriter resume(const std::string& path, const SessionOptions& options = {});
  SessionWriter(SessionWriter&&) noexcept;
  SessionWriter& operator=(SessionWriter&&) = delete;
  ~SessionWriter();  // without close(): state "aborted: ..."

  // From one thread, the tick's. Never throws; without block_when_full also never waits. False: the sample is lost,
  // because the ring is full (counted) or the store has failed or is closed.
  bool pushSample(const SampleRecord& sample) noexcept;
  bool pushInput(const InputRecord& input) noexcept;  // likewise; a lost one shows as a gap in the ticks
  std::uint64_t droppedSamples() const noexcept;

  // From one thread, outside of the real-time tick.
  void addEvent(const EventRecord& event);
  void addReading(const ReadingRecord& reading);
  void addHands(const HandsRecord& hands);     // before the first input of its trial
  void finishTrial(const TrialRecord& trial);  // returns once the trial and all that was pushed before are durable
  void finishResponse(const ResponseRecord& response);  // likewise
  void addSurvey(const SurveyRecord& answer);           // likewise
  void close();                               // final flush, state "complete", one plain file without a log beside it
  void abort(std::string_view why) noexcept;  // final flush, state "aborted: <why>"; needs no memory
  // After close(): over the values of all samples in their order (session/record_hash.h); nothing of a session that was
  // gone on with.
  std::optional<std::uint64_t> samplesHash() const;

 private:
  class Impl;
  explicit SessionWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

struct SampleFilter {
  std::optional<std::int64_t> trial{};  // only this trial's
  std::int64_t stride = 1;              // every stride-th of those, the first included; >= 1
};

// Reads a finished, a killed or even a still running session.
class SessionReader {
 public:
  explicit SessionReader(const std::string& path);
  SessionReader(SessionReader&&) noexcept;
  SessionReader& operator=(SessionReader&&) = delete;
  ~SessionReader();

  // From now on reading ends with Interrupted (tasks/run/process/interrupted.h) once
  // the flag is up, which must outlive this.
  void heed(const std::atomic<bool>& interrupted);

  const std::string& path() const;
  const SessionInfo& info() const { return info_; }
  const std::string& state() const { return progress_.state; }             // "running", "complete", "aborted: <why>"
  const std::string& startedUtc() const { return progress_.started_utc; }  // ISO 8601
  std::int64_t samplesDropped() const { return progress_.samples_dropped; }
  const SessionProgress& progress() const { return progress_; }
  bool complete() const;
  // sentences for a person if the session isn't complete, lost samples or holds trials twice; else empty
  std::string warning() const;
  std::string doubledTrials() const;  // the last of these; else empty

  // A value that a column can't hold is an InputError with its place (cells.h), wherever records are read.
  // Of trials that are there twice, the first.
  std::vector<TrialRecord> trials() const;        // in order of time
  std::vector<ResponseRecord> responses() const;  // in order of time
  std::vector<EventRecord> events(std::optional<std::int64_t> trial = {}) const;
  std::vector<ReadingRecord> readings(std::optional<std::int64_t> trial = {}) const;
  std::vector<SurveyRecord> survey() const;  // in order of time
  void forEachSample(const SampleFilter& filter, const std::function<void(const SampleRecord&)>& take) const;

  bool keepsInputs() const { return format_ >= 3; }  // of people; older sessions don't
  std::vector<HandsRecord> hands() const;            // of the trials with inputs, unfinished ones too; in order of time
  std::vector<InputRecord> inputs(std::int64_t trial) const;
  void forEachInput(std::int64_t trial, const std::function<void(const InputRecord&)>& take) const;

 private:
  std::unique_ptr<Database> database_;
  SessionInfo info_;
  SessionProgress progress_;
  std::int64_t format_ = 0;
};

}  // namespace pincer::tasks
