// columns: the one list of what a stored record's columns are called and which number stands in each. The schema, the
// writer, the reader and the CSV export all follow it.
//
//   forEachColumn(record, visit)   calls visit(ColumnName, field) for each column in order
//
// A name is [finger_]quantity[_axis][_unit]: `f0_normal_N`, `f1_place_shown_L_x_m`, `duration_s`. Units are
// SI, as in records.h; frames and symbols too. Fields are std::int64_t, std::int32_t, std::uint32_t,
// std::uint64_t, double, std::string or Bytes.
//
// A column has a range, and a reader refuses what lies outside (table.h): integers count something, so that they begin
// at 0; times, frictions and levels are sorted, compared and divided by. A measured number may be anything, NaN and
// infinity too: a session keeps what happened.
#pragma once
#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "pincer/tasks/run/records.h"

namespace pincer::tasks {

// Which values a column may hold, both ends included.
struct ColumnRange {
  double min, max;
  bool may_be_none = false;  // NaN, for what wasn't measured
  constexpr bool holds(double value) const { return value != value ? may_be_none : value >= min && value <= max; }
};

namespace columns {
constexpr double kInfinity = std::numeric_limits<double>::infinity();  // no end
constexpr double kLargestCount = 9007199254740992;  // 2^53, up to which doubles count exactly; 285,000 years of ticks
constexpr ColumnRange kAny{-kInfinity, kInfinity, true};  // a measured number: a session keeps what happened
constexpr ColumnRange kCount{0, kLargestCount};           // of what is counted
constexpr ColumnRange kYesNo{0, 1};                       // 0: no, 1: yes
constexpr ColumnRange kTime{0, 1e9};                      // [s]; 30 years
constexpr ColumnRange kMeasuredTime{0, 1e12, true};       // [s] or [us], where it was measured
constexpr ColumnRange kClock{-1e12, 1e12};  // [s]; a session's clock begins at 0, a device's where it likes
constexpr ColumnRange kFriction{0, 1e6};    // [-]; chosen: far above any material's
constexpr ColumnRange kLevel{-1e12, 1e12,
                             true};  // in the study's unit; no infinities: levels are sorted and divided by
constexpr ColumnRange kLength{1, kLargestCount};        // of a sequence: at least one
constexpr ColumnRange kPlace{-1e6, 1e6};                // [m]
constexpr ColumnRange kCapability{0, 1e6};              // of an arm
constexpr ColumnRange kCapabilityOrNone{0, 1e6, true};  // likewise; NaN: it doesn't tell
// of HandPhase and devices::Trip (experiments/hand_records.cpp compares them)
constexpr double kLastPhase = 9, kLastTrip = 8;
}  // namespace columns

struct ColumnName {
  std::string_view finger, quantity, axis, unit;  // empty parts are left out
  std::optional<ColumnRange> range{};             // nothing: that of the field's type
  std::int64_t since = 2;                         // the session format that added it

  template <class Field>
  constexpr ColumnRange rangeOf() const {
    if (range) return *range;
    if constexpr (std::is_integral_v<Field>) {
      return sizeof(Field) < 8 ? ColumnRange{0, static_cast<double>(std::numeric_limits<Field>::max())}
                               : columns::kCount;
    } else {
      return columns::kAny;
    }
  }
  // True of how long ticks took, which no two runs share.
  constexpr bool isMeasuredTime() const { return unit == "us"; }
  std::string text() const {
    std::string name;
    for (const std::string_view part : {finger, quantity, axis, unit}) {
      if (part.empty()) continue;
      if (!name.empty()) name += '_';
      name += part;
    }
    return name;
  }
};

template <class R, class Record>
concept RecordOf = std::same_as<std::remove_const_t<R>, Record>;

namespace columns {
// Endings of columns: by axis of a vector (a fourth number has none), and by part of a quaternion.
constexpr std::array<std::string_view, 4> kAxes{"x", "y", "z", ""};
constexpr std::array<std::string_view, 4> kQuaternion{"w", "x", "y", "z"};

template <class Visit, class Array>
constexpr void axes(Visit& visit, std::string_view finger, std::string_view quantity, std::string_view unit,
                    Array& values, const ColumnRange& range = kAny) {
  for (std::size_t i = 0; i < values.size(); ++i) visit(ColumnName{finger, quantity, kAxes[i], unit, range}, values[i]);
}

template <RecordOf<FingerRecord> R, class Visit>
void finger(std::string_view f, R& r, Visit& visit) {
  axes(visit, f, "p_WF", "m", r.p_WF);
  axes(visit, f, "p_WP", "m", r.p_WP);
  axes(visit, f, "f_contact_W", "N", r.f_contact_W);
  axes(visit, f, "f_arm_D", "N", r.f_arm_D);
  visit(ColumnName{f, "normal", "", "N"}, r.normal_force);
  visit(ColumnName{f, "tangential", "", "N"}, r.tangential_force);
  visit(ColumnName{f, "gap", "", "m"}, r.gap);
  axes(visit, f, "place_wanted_L", "m", r.place_wanted_L);
  axes(visit, f, "place_shown_L", "m", r.place_shown_L);
  visit(ColumnName{f, "flags", "", ""}, r.flags);
}
}  // namespace columns

template <RecordOf<SampleRecord> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  constexpr std::array<std::string_view, kRecordedFingers> kFingers{"f0", "f1"};  // index finger, thumb
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  visit(ColumnName{"", "tick", "", ""}, r.tick);
  visit(ColumnName{"", "time", "", "s", columns::kClock}, r.time);
  columns::axes(visit, "", "p_WB", "m", r.p_WB);
  for (std::size_t i = 0; i < r.q_WB.size(); ++i) visit(ColumnName{"", "q_WB", columns::kQuaternion[i], ""}, r.q_WB[i]);
  columns::axes(visit, "", "v_WB", "m_per_s", r.v_WB);
  for (std::size_t i = 0; i < r.fingers.size(); ++i) columns::finger(kFingers[i], r.fingers[i], visit);
  visit(ColumnName{"", "tick", "", "us", columns::kMeasuredTime}, r.tick_us);
  visit(ColumnName{"", "status", "", ""}, r.status);
}

template <RecordOf<HandsRecord> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  constexpr std::array<std::string_view, kRecordedFingers> kFingers{"f0", "f1"};  // index finger, thumb
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  for (std::size_t i = 0; i < r.fingers.size(); ++i) {
    auto& finger = r.fingers[i];
    columns::axes(visit, kFingers[i], "base_offset_W", "m", finger.base_offset_W, columns::kPlace);
    visit(ColumnName{kFingers[i], "base_turn", "", "rad", columns::kLevel}, finger.base_turn);
    visit(ColumnName{kFingers[i], "peak_force", "", "N", columns::kCapability}, finger.peak_force);
    visit(ColumnName{kFingers[i], "continuous_force", "", "N", columns::kCapability}, finger.continuous_force);
    columns::axes(visit, kFingers[i], "peak_torque", "Nm", finger.peak_torque, columns::kCapabilityOrNone);
    visit(ColumnName{kFingers[i], "tip_mass", "", "kg", columns::kCapabilityOrNone, 4}, finger.tip_mass);
    visit(ColumnName{kFingers[i], "tip_damping", "", "Ns_per_m", columns::kCapabilityOrNone, 4}, finger.tip_damping);
  }
  visit(ColumnName{"", "oldest_sample", "", "s", columns::kCapabilityOrNone}, r.oldest_sample);
  visit(ColumnName{"", "passive", "", "", columns::kYesNo}, r.passive);
}

namespace columns {
template <RecordOf<FingerInputRecord> R, class Visit>
constexpr void fingerInput(std::string_view f, R& r, Visit& visit) {
  // Row and column of J, column by column, as Eigen stores it.
  constexpr std::array<std::string_view, 9> kEntries{"11", "21", "31", "12", "22", "32", "13", "23", "33"};
  visit(ColumnName{f, "input_flags", "", ""}, r.flags);
  visit(ColumnName{f, "switches", "", ""}, r.switches);
  visit(ColumnName{f, "arm_time", "", "s"}, r.arm_time);
  axes(visit, f, "p_DF", "m", r.p_DF);
  axes(visit, f, "v_DF", "m_per_s", r.v_DF);
  for (std::size_t i = 0; i < r.q_DF.size(); ++i) visit(ColumnName{f, "q_DF", kQuaternion[i], ""}, r.q_DF[i]);
  for (std::size_t i = 0; i < r.J.size(); ++i) visit(ColumnName{f, "J", kEntries[i], "m_per_rad"}, r.J[i]);
  visit(ColumnName{f, "tactile_time", "", "s"}, r.tactile_time);
  axes(visit, f, "place_shown_L", "m", r.place_shown_L);
  axes(visit, f, "f_arm_D", "N", r.f_arm_D);
  axes(visit, f, "place_wanted_L", "m", r.place_wanted_L);
}
}  // namespace columns

template <RecordOf<InputRecord> R, class Visit>
constexpr void forEachColumn(R& r, Visit&& visit) {
  constexpr std::array<std::string_view, kRecordedFingers> kFingers{"f0", "f1"};  // index finger, thumb
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  visit(ColumnName{"", "tick", "", ""}, r.tick);
  visit(ColumnName{"", "time", "", "s", columns::kClock}, r.time);
  visit(ColumnName{"", "cut", "", "", ColumnRange{0, columns::kLastTrip}}, r.cut);
  visit(ColumnName{"", "phase", "", "", ColumnRange{0, columns::kLastPhase}}, r.phase);
  visit(ColumnName{"", "flags", "", ""}, r.flags);
  for (std::size_t i = 0; i < r.fingers.size(); ++i) columns::fingerInput(kFingers[i], r.fingers[i], visit);
  columns::axes(visit, "", "p_WB", "m", r.p_WB);
  for (std::size_t i = 0; i < r.q_WB.size(); ++i) visit(ColumnName{"", "q_WB", columns::kQuaternion[i], ""}, r.q_WB[i]);
  columns::axes(visit, "", "v_WB", "m_per_s", r.v_WB);
  visit(ColumnName{"", "status", "", ""}, r.status);
}

template <RecordOf<InputChunk> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  visit(ColumnName{"", "first_tick", "", ""}, r.first_tick);
  visit(ColumnName{"", "ticks", "", "", columns::kLength}, r.ticks);
  visit(ColumnName{"", "check", "", "", columns::kAny}, r.check);
  visit(ColumnName{"", "data", "", ""}, r.data);
}

template <RecordOf<EventRecord> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  visit(ColumnName{"", "time", "", "s", columns::kClock}, r.time);
  visit(ColumnName{"", "kind", "", ""}, r.kind);
  visit(ColumnName{"", "detail", "", ""}, r.detail);
}

template <RecordOf<ReadingRecord> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  visit(ColumnName{"", "time", "", "s", columns::kClock}, r.time);
  visit(ColumnName{"", "kind", "", ""}, r.kind);
  columns::axes(visit, "", "truth", "", r.truth);
  columns::axes(visit, "", "percept", "", r.percept);
  columns::axes(visit, "", "estimate", "", r.estimate);
  visit(ColumnName{"", "decision", "", ""}, r.decision);
}

template <RecordOf<TrialRecord> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  visit(ColumnName{"", "task", "", ""}, r.task);
  visit(ColumnName{"", "participant", "", ""}, r.participant);
  visit(ColumnName{"", "condition", "", ""}, r.condition);
  visit(ColumnName{"", "training", "", "", columns::kYesNo}, r.training);
  visit(ColumnName{"", "place_in_order", "", ""}, r.index);
  visit(ColumnName{"", "mu_s", "", "", columns::kFriction}, r.mu_s);
  visit(ColumnName{"", "mu_d", "", "", columns::kFriction}, r.mu_d);
  visit(ColumnName{"", "outcome", "", ""}, r.outcome);
  visit(ColumnName{"", "duration", "", "s", columns::kTime}, r.duration);
  visit(ColumnName{"", "squeezes", "", ""}, r.squeezes);
  visit(ColumnName{"", "lifts", "", ""}, r.lifts);
  visit(ColumnName{"", "tries_5mm", "", ""}, r.tries_5mm);
  visit(ColumnName{"", "slips", "", ""}, r.slips);
  visit(ColumnName{"", "drops", "", ""}, r.drops);
  visit(ColumnName{"", "cause", "", ""}, r.cause);
  visit(ColumnName{"", "peak_grip", "", "N"}, r.peak_grip);
  visit(ColumnName{"", "grip_ratio", "", ""}, r.grip_ratio);
  visit(ColumnName{"", "offset_at_squeeze", "", "m"}, r.offset_at_squeeze);
  visit(ColumnName{"", "felt_grip", "", "N"}, r.felt_grip);
  visit(ColumnName{"", "true_grip", "", "N"}, r.true_grip);
  visit(ColumnName{"", "start_angle", "", "rad"}, r.start_angle);
  visit(ColumnName{"", "error", "", "rad"}, r.error);
  visit(ColumnName{"", "regrasps", "", ""}, r.regrasps);
  visit(ColumnName{"", "flat_time", "", "s"}, r.flat_time);
  visit(ColumnName{"", "phase_times", "", "json"}, r.phase_times);
  visit(ColumnName{"", "tick_median", "", "us"}, r.tick_us_median);
  visit(ColumnName{"", "tick_p999", "", "us"}, r.tick_us_p999);
}

template <RecordOf<ResponseRecord> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  visit(ColumnName{"", "participant", "", ""}, r.participant);
  visit(ColumnName{"", "condition", "", ""}, r.condition);
  visit(ColumnName{"", "run", "", ""}, r.run);
  visit(ColumnName{"", "place_in_run", "", ""}, r.index);
  visit(ColumnName{"", "stimulus", "", ""}, r.stimulus);
  visit(ColumnName{"", "level", "", "si", columns::kLevel}, r.level);
  visit(ColumnName{"", "interval", "", "", ColumnRange{0, 2}}, r.interval);
  visit(ColumnName{"", "answer", "", ""}, r.answer);
  visit(ColumnName{"", "answer_value", "", "si", columns::kLevel}, r.answer_value);
  visit(ColumnName{"", "correct", "", "", columns::kYesNo}, r.correct);
  visit(ColumnName{"", "reversal", "", "", columns::kYesNo}, r.reversal);
  visit(ColumnName{"", "outcome", "", ""}, r.outcome);
  visit(ColumnName{"", "duration", "", "s", columns::kTime}, r.duration);
  visit(ColumnName{"", "response_time", "", "s"}, r.response_time);
  visit(ColumnName{"", "contact_share", "", ""}, r.contact_share);
  visit(ColumnName{"", "finger_speed", "", "m_per_s"}, r.finger_speed);
  visit(ColumnName{"", "tactor_speed", "", "m_per_s"}, r.tactor_speed);
}

template <RecordOf<SurveyRecord> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  visit(ColumnName{"", "participant", "", ""}, r.participant);
  visit(ColumnName{"", "moment", "", ""}, r.moment);
  visit(ColumnName{"", "item", "", ""}, r.item);
  visit(ColumnName{"", "task", "", ""}, r.task);
  visit(ColumnName{"", "condition", "", ""}, r.condition);
  visit(ColumnName{"", "question", "", ""}, r.question);
  visit(ColumnName{"", "answer", "", ""}, r.answer);
  visit(ColumnName{"", "answer_value", "", "", columns::kLevel}, r.answer_value);
}

template <RecordOf<SessionInfo> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  visit(ColumnName{"", "task", "", ""}, r.task);
  visit(ColumnName{"", "seed", "", ""}, r.seed);
  visit(ColumnName{"", "version", "", ""}, r.version);
  visit(ColumnName{"", "build", "", ""}, r.build);
  visit(ColumnName{"", "scene_json", "", ""}, r.scene_json);
  visit(ColumnName{"", "protocol_json", "", ""}, r.protocol_json);
  visit(ColumnName{"", "devices_json", "", ""}, r.devices_json);
  visit(ColumnName{"", "participants_json", "", ""}, r.participants_json);
  visit(ColumnName{"", "participants_hash", "", ""}, r.participants_hash);
  visit(ColumnName{"", "commit_id", "", "", {}, 5}, r.commit);
  visit(ColumnName{"", "sources", "", "", {}, 5}, r.sources);
  visit(ColumnName{"", "flags", "", "", {}, 5}, r.flags);
  visit(ColumnName{"", "c_library", "", "", {}, 5}, r.c_library);
  visit(ColumnName{"", "processor", "", "", {}, 5}, r.processor);
}

template <RecordOf<SessionProgress> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  visit(ColumnName{"", "started_utc", "", ""}, r.started_utc);
  visit(ColumnName{"", "state", "", ""}, r.state);
  visit(ColumnName{"", "samples_dropped", "", ""}, r.samples_dropped);
}

}  // namespace pincer::tasks
