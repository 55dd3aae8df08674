#include "pincer/tasks/run/session/column_meanings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "pincer/tasks/run/csv.h"
#include "pincer/tasks/run/session/table.h"

namespace pincer::tasks {
namespace {

// Levels that several columns share.
constexpr std::string_view kNoYes = "0=no;1=yes";

// One quantity of a table; of any table, where `table` is empty. Levels: value=meaning, separated by semicolons.
struct DescribedQuantity {
  std::string_view table, name, description, levels = {};
};

// By table and name; a quantity that its table doesn't describe has the row of any table.
constexpr std::array kQuantities = {
    DescribedQuantity{"", "trial", "trial of the session, from 1"},
    DescribedQuantity{"", "participant", "participant, from 1; sub-NN in BIDS"},
    DescribedQuantity{"", "time", "time since the trial began"},
    DescribedQuantity{
        "event", "kind", "what happened",
        "tone=a tone sounded, detail says which;phase=the participant began another phase;key=a person pressed a "
        "key;squeeze=both fingers "
        "pressed the object to lift it;lift=the object left the dish;try_5mm=it rose over 5 mm;slip=a finger slid on "
        "it;drop=it fell back;"
        "failure=a squeeze failed, detail says how;turn=a grip turned the cylinder;answer=the participant "
        "answered;success=the trial "
        "succeeded;timeout=its time was over;fault=a safety limit ended it;gate_trip=forces were cut, detail says why"},
    DescribedQuantity{"event", "detail", "more of it, a line; may be empty"},
    DescribedQuantity{"reading", "kind", "which sense was read",
                      "place=offset of the object's centre from the middle of the fingertips, m;flat=direction of the "
                      "flat: angle, spread, 0, "
                      "rad;grip=mean of the two pushes, 0, 0, N"},
    DescribedQuantity{"reading", "truth", "what there was to read"},
    DescribedQuantity{"reading", "percept", "what the senses said; nan where they said nothing"},
    DescribedQuantity{"reading", "estimate", "what the participant believed after it"},
    DescribedQuantity{"reading", "decision", "what it decided"},
    DescribedQuantity{"trial", "task", "experiment",
                      "sphere-pickup=pick up a sphere;cylinder-alignment=turn a cylinder's flat to the monitor"},
    DescribedQuantity{"", "condition", "condition of the study, as its file names it"},
    DescribedQuantity{"trial", "training", "before the counted trials, left out of all results", kNoYes},
    DescribedQuantity{"trial", "place_in_order", "place in the participant's order of trials, from 1"},
    DescribedQuantity{"trial", "mu_s", "static friction coefficient of the object; 0 where the task has none"},
    DescribedQuantity{"trial", "mu_d", "dynamic friction coefficient of the object; 0 where the task has none"},
    DescribedQuantity{"trial", "outcome", "how the trial ended",
                      "success=as asked;timeout=its time was over: counts and times are lower bounds;fault=a safety "
                      "limit cut the forces"},
    DescribedQuantity{"trial", "duration", "from the start tone to the end"},
    DescribedQuantity{"trial", "squeezes", "squeezes with the intent to lift: both normal forces over 0.2 N"},
    DescribedQuantity{"trial", "lifts", "times that the object's bottom left the dish"},
    DescribedQuantity{"trial", "tries_5mm", "times that it cleared 5 mm"},
    DescribedQuantity{"trial", "slips", "times that a loaded finger slid on the object"},
    DescribedQuantity{"trial", "drops", "times that it fell back after it had been held"},
    DescribedQuantity{"trial", "cause", "why the last failed squeeze failed; empty: none did",
                      "not lifted=it stayed on the dish;slipped=it never cleared 5 mm;squeezed out=it went "
                      "aside;dropped=it fell from more than 5 mm"},
    DescribedQuantity{"trial", "peak_grip", "largest mean of the two normal forces"},
    DescribedQuantity{"trial", "grip_ratio",
                      "grip while held over the smallest that holds, m g / (2 mu_s); nan if never held"},
    DescribedQuantity{"trial", "offset_at_squeeze",
                      "distance of the contacts from the line through opposite points, at the last squeeze"},
    DescribedQuantity{"trial", "felt_grip",
                      "grip that a simulated participant felt when the last squeeze seemed firm enough"},
    DescribedQuantity{"trial", "true_grip", "grip that it was then"},
    DescribedQuantity{"trial", "start_angle", "direction of the flat from its target at the start"},
    DescribedQuantity{"trial", "error", "direction of the flat from its target at the end, from -pi to pi"},
    DescribedQuantity{"trial", "regrasps", "grips that turned the cylinder by more than 3 degrees, after the first"},
    DescribedQuantity{"trial", "flat_time", "time in which a finger touched the flat"},
    DescribedQuantity{"trial", "phase_times", "seconds in each phase of the participant, as JSON"},
    DescribedQuantity{"trial", "tick_median", "median computing time of a tick"},
    DescribedQuantity{"trial", "tick_p999", "computing time that 99.9 % of the ticks kept"},
    DescribedQuantity{"response", "run", "staircase or list of trials of the participant, from 1"},
    DescribedQuantity{"response", "place_in_run", "place of the trial in its run, from 1"},
    DescribedQuantity{"response", "stimulus", "what was shown, where it has a name"},
    DescribedQuantity{
        "response", "level",
        "what was shown, as a number: turn between segments in rad, backlash in m, delay in s, place in m"},
    DescribedQuantity{"response", "interval", "interval that would have been right, of two; 0: there was one only",
                      "0=one only;1=the first;2=the second"},
    DescribedQuantity{"response", "answer", "answer in words"},
    DescribedQuantity{"response", "answer_value",
                      "answer as a number; of solids, how sure a simulated participant was, from 0 to 1"},
    DescribedQuantity{"response", "correct", "the answer was right", kNoYes},
    DescribedQuantity{"response", "reversal", "the staircase turned here", kNoYes},
    DescribedQuantity{"response", "outcome", "how the trial ended",
                      "answered=with an answer;timeout=its time was over;fault=a safety limit cut the forces"},
    DescribedQuantity{"response", "duration", "time in which something was felt or could be"},
    DescribedQuantity{"response", "response_time", "from the end of the last stimulus to the answer"},
    DescribedQuantity{"response", "contact_share", "share of the duration in which the finger touched"},
    DescribedQuantity{"response", "finger_speed",
                      "mean speed of the finger while it touched and moved; nan if it didn't"},
    DescribedQuantity{"response", "tactor_speed",
                      "mean speed of the tactor on the pad while it moved; nan if it didn't"},
    DescribedQuantity{"", "tick", "tick of the trial, from 0"},
    DescribedQuantity{"", "p_WB", "place of the object in the world"},
    DescribedQuantity{"", "q_WB", "orientation of the object in the world, a unit quaternion"},
    DescribedQuantity{"", "v_WB", "velocity of the object's centre of mass in the world"},
    DescribedQuantity{"", "status", "bits of the physics step: 0 is well (engine/step.h)"},
    DescribedQuantity{"sample", "p_WF", "place of the fingertip on its arm, in the world"},
    DescribedQuantity{"sample", "p_WP", "place of its proxy, which doesn't sink into surfaces, in the world"},
    DescribedQuantity{"sample", "f_contact_W", "sum of the contact forces on it, in the world"},
    DescribedQuantity{"", "f_arm_D", "force let through to its arm, in the arm's frame"},
    DescribedQuantity{"sample", "normal", "force between it and what it touches, along the normal"},
    DescribedQuantity{"sample", "tangential", "force between it and what it touches, across the normal"},
    DescribedQuantity{"sample", "gap", "distance to the nearest surface; negative: pressed in"},
    DescribedQuantity{"", "place_wanted_L", "place that its tactor was told, on the pad: x towards the tip, y across"},
    DescribedQuantity{"", "place_shown_L", "place that its tactor measured, likewise; nan where it doesn't measure"},
    DescribedQuantity{"sample", "flags",
                      "sum of 1 touching, 2 sliding, 4 forces cut by a safety limit, 8 tactor parked"},
    DescribedQuantity{"hands", "base_offset_W", "offset of its arm's base from its place in the scene"},
    DescribedQuantity{"hands", "base_turn", "turn of its arm's base about the vertical; nan: nobody measured it"},
    DescribedQuantity{"hands", "peak_force", "largest force of its arm; 0: it doesn't tell"},
    DescribedQuantity{"hands", "continuous_force", "force that its arm bears for ever; 0: it doesn't tell"},
    DescribedQuantity{"hands", "peak_torque", "largest torques of its arm's joints; nan: it doesn't tell"},
    DescribedQuantity{"hands", "tip_mass", "least mass of its arm at the tip; nan: it doesn't tell"},
    DescribedQuantity{"hands", "tip_damping", "least viscous friction of its arm at the tip"},
    DescribedQuantity{"hands", "oldest_sample", "age up to which a sample was trusted; nan: as in the protocol"},
    DescribedQuantity{"hands", "passive", "the fingers were kept passive", kNoYes},
    DescribedQuantity{"input", "cut",
                      "why forces were cut from outside before the tick; 0: they weren't (devices/gate/force_gate.h)"},
    DescribedQuantity{"input", "phase", "phase of the hand's intent (tasks/lab/participants/participant.h)"},
    DescribedQuantity{"input", "flags", "sum of 1 wants to lift, 2 answers, and 256 times the key that was pressed"},
    DescribedQuantity{"input", "input_flags", "which of its quantities its devices measured (tasks/run/records.h)"},
    DescribedQuantity{"input", "switches", "bits of its arm's buttons"},
    DescribedQuantity{"input", "arm_time", "time of its arm's sample, on the arm's clock"},
    DescribedQuantity{"input", "p_DF", "place of the fingertip in the arm's frame"},
    DescribedQuantity{"input", "v_DF", "velocity of the fingertip in the arm's frame"},
    DescribedQuantity{"input", "q_DF", "orientation of the finger on its arm, a unit quaternion"},
    DescribedQuantity{"input", "J", "entry of the arm's Jacobian, row and column"},
    DescribedQuantity{"input", "tactile_time", "time of its display's sample, on the display's clock"},
    DescribedQuantity{"survey", "moment", "when it was asked", "before=before the first trial;after=after the last"},
    DescribedQuantity{"survey", "item", "name of the question in the study's file"},
    DescribedQuantity{"survey", "task", "task that it was asked of; empty: the whole session"},
    DescribedQuantity{"survey", "condition", "condition that it was asked of; empty: the whole session"},
    DescribedQuantity{"survey", "question", "question as the person read it"},
    DescribedQuantity{"survey", "answer", "answer in words; empty: none was given"},
    DescribedQuantity{"survey", "answer_value",
                      "answer as a number: a scale's, or the place of a choice; nan if it has none"},
    DescribedQuantity{"session", "task", "experiment that it is of"},
    DescribedQuantity{"session", "seed", "seed of all that varies"},
    DescribedQuantity{"session", "version", "version of pincer that made it"},
    DescribedQuantity{"session", "build", "compiler that built it"},
    DescribedQuantity{"session", "scene_json", "scene, as JSON"},
    DescribedQuantity{"session", "protocol_json", "study, as JSON: every parameter"},
    DescribedQuantity{"session", "devices_json", "devices, as JSON"},
    DescribedQuantity{"session", "participants_json",
                      "parameters of simulated participants, or the number of the person, as JSON"},
    DescribedQuantity{"session", "participants_hash", "fingerprint of that"},
    DescribedQuantity{"session", "commit_id", "commit of the sources"},
    DescribedQuantity{"session", "sources", "fingerprint of the sources that decide a trial's bits"},
    DescribedQuantity{"session", "flags", "flags of the compiler"},
    DescribedQuantity{"session", "c_library", "C library that it ran with"},
    DescribedQuantity{"session", "processor", "processor that it ran on"},
    DescribedQuantity{"session", "started_utc", "when it began, UTC, ISO 8601"},
    DescribedQuantity{"session", "state", "how far it came", "running=it goes on, or was killed;complete=to its end"},
    DescribedQuantity{"session", "samples_dropped", "samples that were lost because the disk was too slow"},
};

// Which finger, which axis, beside the quantity's own words.
std::string describedWith(const ColumnName& column, std::string_view description) {
  std::string text;
  if (!column.finger.empty()) text = column.finger == "f0" ? "of the index finger: " : "of the thumb: ";
  text += description;
  if (!column.axis.empty()) text += fmt::format("; {}", column.axis);
  return text;
}

std::vector<std::pair<std::string, std::string>> levelsOf(std::string_view text) {
  std::vector<std::pair<std::string, std::string>> levels;
  while (!text.empty()) {
    const std::string_view one = text.substr(0, text.find(';'));
    const auto equals = one.find('=');
    levels.emplace_back(one.substr(0, equals), one.substr(equals + 1));
    text.remove_prefix(std::min(text.size(), one.size() + 1));
  }
  return levels;
}

std::string unitFor(std::string_view unit) {
  // The ending of a column's name, and the unit as it is shown; "": none.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kUnits = {{{"m_per_s", "m/s"},
                                                                                    {"m_per_rad", "m/rad"},
                                                                                    {"Ns_per_m", "N s/m"},
                                                                                    {"Nm", "N m"},
                                                                                    {"us", "us"},
                                                                                    {"si", ""},
                                                                                    {"json", ""}}};
  for (const auto& [name, shown] : kUnits)
    if (name == unit) return std::string(shown);
  return std::string(unit);
}

template <class Record>
void describeTable(std::string_view table, const ConditionLabels& conditions, std::vector<DescribedColumn>& all) {
  const Record record{};
  forEachColumn(record, [&](const ColumnName& name, const auto&) {
    all.push_back({std::string(table), name.text(), meaningOf(table, name, conditions)});
  });
}

}  // namespace

ColumnMeaning meaningOf(std::string_view table, const ColumnName& column, const ConditionLabels& conditions) {
  const auto found = [&](std::string_view of) {
    return std::find_if(kQuantities.begin(), kQuantities.end(),
                        [&](const DescribedQuantity& q) { return q.table == of && q.name == column.quantity; });
  };
  auto quantity = found(table);
  if (quantity == kQuantities.end()) quantity = found("");
  if (quantity == kQuantities.end())
    throw std::logic_error(fmt::format("column {} of table {} isn't described", column.text(), table));
  return {describedWith(column, quantity->description), unitFor(column.unit),
          column.quantity == "condition" ? conditions : levelsOf(quantity->levels)};
}

std::string levelText(const ColumnMeaning& meaning) {
  std::string text;
  for (const auto& [value, means] : meaning.levels)
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", value, means);
  return text;
}

int countsFrom(const ColumnName& column) {
  // Quantities that count from 1; all others begin at 0.
  constexpr std::array<std::string_view, 5> kCounted = {"trial", "participant", "run", "place_in_order",
                                                        "place_in_run"};
  return std::find(kCounted.begin(), kCounted.end(), column.quantity) != kCounted.end() ? 1 : 0;
}

std::vector<DescribedColumn> allColumns(const ConditionLabels& conditions) {
  std::vector<DescribedColumn> all;
  describeTable<SessionInfo>(tableName<SessionInfo>(), conditions, all);
  describeTable<SessionProgress>(tableName<SessionProgress>(), conditions, all);
  describeTable<TrialRecord>(tableName<TrialRecord>(), conditions, all);
  describeTable<ResponseRecord>(tableName<ResponseRecord>(), conditions, all);
  describeTable<SurveyRecord>(tableName<SurveyRecord>(), conditions, all);
  describeTable<EventRecord>(tableName<EventRecord>(), conditions, all);
  describeTable<ReadingRecord>(tableName<ReadingRecord>(), conditions, all);
  describeTable<SampleRecord>(tableName<SampleRecord>(), conditions, all);
  describeTable<HandsRecord>(tableName<HandsRecord>(), conditions, all);
  describeTable<InputRecord>("input", conditions, all);
  return all;
}

std::string columnsCsv(const ConditionLabels& conditions) {
  CsvTable table;
  for (const char* head : {"table", "column", "unit", "description", "levels"}) table.add(std::string(head));
  table.endRow();
  for (const DescribedColumn& c : allColumns(conditions)) {
    for (const std::string& text : {c.table, c.column, c.meaning.unit, c.meaning.description, levelText(c.meaning)})
      table.add(text);
    table.endRow();
  }
  return table.take();
}

std::string columnsMarkdown() {
  std::string text =
      "# Tables of a session\n\nAs `pincer export` writes them; `columns.csv` beside them says the same.\n`nan` (in "
      "BIDS `n/a`): nothing "
      "was measured.\n"
      "Trials, participants, runs and places in an order count from 1 in all exports; in `session.db` itself "
      "they\nbegin at 0.\nExports list the conditions of their session's study as levels of `condition`, with their "
      "labels.\n";
  std::string table;
  for (const DescribedColumn& c : allColumns()) {
    if (c.table != table) text += fmt::format("\n## {}\n| column | unit | meaning |\n|---|---|---|\n", table = c.table);
    const std::string levels = levelText(c.meaning);
    text += fmt::format("| `{}` | {} | {}{}{} |\n", c.column, c.meaning.unit, c.meaning.description,
                        levels.empty() ? "" : ". ", levels);
  }
  return text;
}

}  // namespace pincer::tasks
