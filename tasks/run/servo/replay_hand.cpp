#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "pincer/contact/error.h"
#include "pincer/contact/io/printable.h"
#include "pincer/devices/arm/replay_arm.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/scene/scene_ranges.h"
#include "pincer/tasks/run/servo/hand_devices_parts.h"
#include "pincer/tasks/run/session_store.h"
#include "pincer/tasks/run/trajectory.h"

namespace pincer::tasks {
namespace {

using devices::ReplayArm;
using devices::ReplayPoint;

std::vector<std::string> csvCells(std::string_view line) {
  std::vector<std::string> cells;
  std::stringstream stream{std::string(line)};
  stream.exceptions(std::ios::badbit);  // else it takes a lack of memory for the end
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

// Where a finger's place stands in a row, and in which frame.
struct FingerColumns {
  std::array<std::size_t, 3> at{};
  bool in_world = false;
};

std::optional<std::size_t> columnOf(const std::vector<std::string>& header, const std::string& name) {
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (header[i] == name) return i;
  }
  return std::nullopt;
}

FingerColumns columnsOf(const std::string& path, const std::vector<std::string>& header, int finger) {
  for (const char* frame : {"DF", "WF"}) {
    FingerColumns columns;
    columns.in_world = frame[0] == 'W';
    bool all = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = columnOf(header, fmt::format("f{}_p_{}_{}_m", finger, frame, "xyz"[k]));
      all = all && at;
      columns.at[k] = at.value_or(0);
    }
    if (all) return columns;
  }
  throw InputError(fmt::format(
      "{}:1: columns f{}_p_WF_x_m, _y_m, _z_m (or p_DF, in the arm's frame) are missing. `pincer export` writes them.",
      path, finger));
}

double numberIn(const std::string& path, int line, const std::vector<std::string>& row, std::size_t column) {
  char* end = nullptr;
  const std::string text = column < row.size() ? row[column] : "";
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || end != text.c_str() + text.size() || !std::isfinite(value)) {
    throw InputError(
        fmt::format("{}:{}: \"{}\" in column {} isn't a number.", path, line, printable(text), column + 1));
  }
  return value;
}

bool isStore(const std::string& path) {
  requireRegularFile(path, kRecordingFile.name);
  std::ifstream file(path, std::ios::binary);
  std::array<char, 15> head{};
  return file.read(head.data(), head.size()) && std::string_view(head.data(), head.size()) == "SQLite format 3";
}

// The first trial of a session's store, or of a table of samples.
class ReplayRecording {
 public:
  ReplayRecording(const std::string& path, int fingers) : places_(static_cast<std::size_t>(fingers)) {
    isStore(path) ? readStore(path) : readTable(path, fingers);
  }
  const std::vector<ReplayPoint>& places(int finger) const { return places_[static_cast<std::size_t>(finger)]; }
  bool inWorld(int finger) const { return columns_[static_cast<std::size_t>(finger)].in_world; }

 private:
  void readStore(const std::string& path) {
    const SessionReader session(path);
    columns_.assign(places_.size(), FingerColumns{.at = {}, .in_world = true});
    std::optional<std::int64_t> first;
    session.forEachSample({}, [&](const SampleRecord& sample) {
      if (!first) first = sample.trial;
      if (sample.trial != *first) return;
      for (std::size_t i = 0; i < places_.size(); ++i) {
        const auto& p = sample.fingers.at(i).p_WF;
        add(i, {sample.time, Vec3(p[0], p[1], p[2])}, path);
      }
    });
    if (!first) throw InputError(path + ": the session holds no samples. Record one with `pincer run` first.");
  }
  // `place`: in the file, for messages.
  void add(std::size_t finger, const ReplayPoint& point, const std::string& place) {
    std::vector<ReplayPoint>& points = places_[finger];
    for (int k = 0; k < 3; ++k) {
      if (!isWithin(point.p_DF[k], ranges::kCoordinate))
        throw InputError(fmt::format("{}: finger {} is at {:g} m, which {}", place, finger, point.p_DF[k],
                                     outOfRange(ranges::kCoordinate)));
    }
    if (!points.empty()) {
      const ReplayPoint& last = points.back();
      const std::string problem = problemBetween({last.time, last.p_DF, Vec3::Zero()},
                                                 {point.time, point.p_DF, Vec3::Zero()}, ranges::kFastest);
      if (!problem.empty()) throw InputError(fmt::format("{}: finger {}: {}", place, finger, problem));
    }
    points.push_back(point);
  }
  void readTable(const std::string& path, int fingers) {
    // The size of a recording's file bounds this table too [bytes].
    constexpr InputKind kTable = {"a CSV file of samples", kRecordingFile.most_bytes, true, kRecordingFile.remedy};
    InputFile file(path, kTable);
    std::string_view line;
    if (!file.nextLine(line)) throw InputError(path + ": the file is empty. Give a CSV file of samples.");
    const auto header = csvCells(line);
    const auto time = columnOf(header, "time_s"), trial = columnOf(header, "trial");
    if (!time) throw InputError(path + ":1: column time_s is missing. `pincer export` writes it.");
    for (int i = 0; i < fingers; ++i) columns_.push_back(columnsOf(path, header, i));
    const auto trialOf = [&](const std::vector<std::string>& row) {
      return trial && *trial < row.size() ? row[*trial] : "";
    };
    std::optional<std::string> first_trial;
    for (int number = 2; file.nextLine(line); ++number) {
      const auto row = csvCells(line);
      if (!first_trial) first_trial = trialOf(row);
      if (trialOf(row) != *first_trial) break;
      for (std::size_t i = 0; i < places_.size(); ++i) {
        const auto at = [&](std::size_t k) { return numberIn(path, number, row, columns_[i].at[k]); };
        add(i, {numberIn(path, number, row, *time), Vec3(at(0), at(1), at(2))}, fmt::format("{}:{}", path, number));
      }
    }
  }

  std::vector<FingerColumns> columns_;
  std::vector<std::vector<ReplayPoint>> places_;
};

class ReplayHand final : public HandDevices {
 public:
  explicit ReplayHand(const DeviceOptions& options)
      : path_(options.recording), recording_(options.recording, options.fingers) {
    for (int i = 0; i < options.fingers; ++i) place(i, recording_.places(i));
  }
  devices::Arm& arm(int finger) override { return *arms_[static_cast<std::size_t>(finger)]; }
  devices::TactileDisplay* display(int) override { return nullptr; }
  void setEpoch(std::int64_t) override {}
  void setBase(int finger, const Vec3& p_WD, const Quat& q_WD) override {
    if (!recording_.inWorld(finger)) return;
    std::vector<ReplayPoint> points = recording_.places(finger);
    for (ReplayPoint& point : points) point.p_DF = q_WD.conjugate() * (point.p_DF - p_WD);
    place(finger, points);
  }
  void advanceTo(double now) override {
    for (const auto& arm : arms_) arm->moveTo(now);
  }
  std::vector<std::string> describe() override {
    return {fmt::format("recording {}: {:.1f} s; forces reach nobody", path_, arms_[0]->duration())};
  }

 private:
  void place(int finger, const std::vector<ReplayPoint>& points) {
    arms_.resize(std::max(arms_.size(), static_cast<std::size_t>(finger) + 1));
    try {
      arms_[static_cast<std::size_t>(finger)] =
          std::make_unique<ReplayArm>(fmt::format("{} f{}", path_, finger), points);
    } catch (const std::invalid_argument& error) {
      throw InputError(error.what());
    }
  }

  std::string path_;
  ReplayRecording recording_;
  std::vector<std::unique_ptr<ReplayArm>> arms_;
};

}  // namespace

std::unique_ptr<HandDevices> openReplayHand(const DeviceOptions& options) {
  if (options.recording.empty())
    throw DeviceError(
        "--devices replay needs the recording: --recording FILE, a session.db, or a CSV of samples (pincer export).");
  return std::make_unique<ReplayHand>(options);
}

}  // namespace pincer::tasks
