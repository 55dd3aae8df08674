// columns: the one list of what a stored record's columns are called and which number stands in each. The schema, the writer, the reader
// and the CSV export all follow it.
//
//   forEachColumn(record, visit)   calls visit(ColumnName, field) for each column in order
//
// A name is [finger_]quantity[_axis][_unit]: `f0_normal_N`, `f1_place_shown_L_x_m`, `duration_s`. Units are SI, as in records.h; frames and
// symbols too. Fields are std::int64_t, std::int32_t, std::uint32_t, std::uint64_t, double, std::string or Bytes.
#pragma once
#include <array>
#include <concepts>
#include <string>
#include <string_view>

#include "tasks/session/records.h"

namespace pincer::tasks {

struct ColumnName {
  std::string_view finger, quantity, axis, unit;  // empty parts are left out
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
constexpr std::array<std::string_view, 4> kAxes{"x", "y", "z", ""};
constexpr std::array<std::string_view, 4> kQuaternion{"w", "x", "y", "z"};

template <class Visit, class Array>
constexpr void axes(Visit& visit, std::string_view finger, std::string_view quantity, std::string_view unit, Array& values) {
  for (std::size_t i = 0; i < values.size(); ++i) visit(ColumnName{finger, quantity, kAxes[i], unit}, values[i]);
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
  constexpr std::array<std::string_view, kRecordedFingers> kFingers{"f0", "f1"};
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  visit(ColumnName{"", "tick", "", ""}, r.tick);
  visit(ColumnName{"", "time", "", "s"}, r.time);
  columns::axes(visit, "", "p_WB", "m", r.p_WB);
  for (std::size_t i = 0; i < r.q_WB.size(); ++i) visit(ColumnName{"", "q_WB", columns::kQuaternion[i], ""}, r.q_WB[i]);
  columns::axes(visit, "", "v_WB", "m_per_s", r.v_WB);
  for (std::size_t i = 0; i < r.fingers.size(); ++i) columns::finger(kFingers[i], r.fingers[i], visit);
  visit(ColumnName{"", "tick", "", "us"}, r.tick_us);
  visit(ColumnName{"", "status", "", ""}, r.status);
}

template <RecordOf<HandsRecord> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  constexpr std::array<std::string_view, kRecordedFingers> kFingers{"f0", "f1"};
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  for (std::size_t i = 0; i < r.fingers.size(); ++i) {
    auto& finger = r.fingers[i];
    columns::axes(visit, kFingers[i], "base_offset_W", "m", finger.base_offset_W);
    visit(ColumnName{kFingers[i], "base_turn", "", "rad"}, finger.base_turn);
    visit(ColumnName{kFingers[i], "peak_force", "", "N"}, finger.peak_force);
    visit(ColumnName{kFingers[i], "continuous_force", "", "N"}, finger.continuous_force);
    columns::axes(visit, kFingers[i], "peak_torque", "Nm", finger.peak_torque);
    visit(ColumnName{kFingers[i], "tip_mass", "", "kg"}, finger.tip_mass);
    visit(ColumnName{kFingers[i], "tip_damping", "", "Ns_per_m"}, finger.tip_damping);
  }
  visit(ColumnName{"", "oldest_sample", "", "s"}, r.oldest_sample);
  visit(ColumnName{"", "passive", "", ""}, r.passive);
}

namespace columns {
template <RecordOf<FingerInputRecord> R, class Visit>
constexpr void fingerInput(std::string_view f, R& r, Visit& visit) {
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
  constexpr std::array<std::string_view, kRecordedFingers> kFingers{"f0", "f1"};
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  visit(ColumnName{"", "tick", "", ""}, r.tick);
  visit(ColumnName{"", "time", "", "s"}, r.time);
  visit(ColumnName{"", "cut", "", ""}, r.cut);
  visit(ColumnName{"", "phase", "", ""}, r.phase);
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
  visit(ColumnName{"", "ticks", "", ""}, r.ticks);
  visit(ColumnName{"", "check", "", ""}, r.check);
  visit(ColumnName{"", "data", "", ""}, r.data);
}

template <RecordOf<EventRecord> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  visit(ColumnName{"", "time", "", "s"}, r.time);
  visit(ColumnName{"", "kind", "", ""}, r.kind);
  visit(ColumnName{"", "detail", "", ""}, r.detail);
}

template <RecordOf<ReadingRecord> R, class Visit>
void forEachColumn(R& r, Visit&& visit) {
  visit(ColumnName{"", "trial", "", ""}, r.trial);
  visit(ColumnName{"", "time", "", "s"}, r.time);
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
  visit(ColumnName{"", "training", "", ""}, r.training);
  visit(ColumnName{"", "place_in_order", "", ""}, r.index);
  visit(ColumnName{"", "mu_s", "", ""}, r.mu_s);
  visit(ColumnName{"", "mu_d", "", ""}, r.mu_d);
  visit(ColumnName{"", "outcome", "", ""}, r.outcome);
  visit(ColumnName{"", "duration", "", "s"}, r.duration);
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
  visit(ColumnName{"", "level", "", "si"}, r.level);
  visit(ColumnName{"", "interval", "", ""}, r.interval);
  visit(ColumnName{"", "answer", "", ""}, r.answer);
  visit(ColumnName{"", "answer_value", "", "si"}, r.answer_value);
  visit(ColumnName{"", "correct", "", ""}, r.correct);
  visit(ColumnName{"", "reversal", "", ""}, r.reversal);
  visit(ColumnName{"", "outcome", "", ""}, r.outcome);
  visit(ColumnName{"", "duration", "", "s"}, r.duration);
  visit(ColumnName{"", "response_time", "", "s"}, r.response_time);
  visit(ColumnName{"", "contact_share", "", ""}, r.contact_share);
  visit(ColumnName{"", "finger_speed", "", "m_per_s"}, r.finger_speed);
  visit(ColumnName{"", "tactor_speed", "", "m_per_s"}, r.tactor_speed);
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
}

}  // namespace pincer::tasks
