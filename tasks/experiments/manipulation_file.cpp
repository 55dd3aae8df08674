#include "tasks/experiments/manipulation_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "tasks/scene/strict_json.h"

namespace pincer::tasks {
namespace {

constexpr double kLargestSeed = 9007199254740992;  // 2^53: larger ones are no exact numbers in JSON
constexpr std::array<std::string_view, 2> kConditionNames = {"force", "cld+force"};
constexpr std::array<std::string_view, 2> kTaskNames = {"sphere-pickup", "cylinder-alignment"};
constexpr std::array<std::string_view, 2> kStrategyNames = {"rational", "simple"};
constexpr std::array<std::string_view, 10> kManipulationKeys = {
    "version", "participants", "seed", "conditions", "tasks", "training", "sphere_pickup", "cylinder_alignment", "people", "frozen_tactor"};

// visit(key, value, what it means): numbers, whole numbers and truths. Ranges are checked by validate().
template <class Options, class Visit>
void forEachPickupKey(Options& o, Visit&& visit) {
  visit("radius", o.radius, "of the sphere [m]");
  visit("mass", o.mass, "of the object [kg]");
  visit("dynamic_ratio", o.dynamic_ratio, "mu_d / mu_s");
  visit("torsion_radius", o.torsion_radius, "of a soft fingertip's patch [m]");
  visit("dish_radius", o.dish_radius, "of curvature [m]");
  visit("dish_friction", o.dish_friction, "mu of the dish");
  visit("finger_radius", o.finger_radius, "[m]");
  visit("coupling_stiffness", o.coupling_stiffness, "of finger and proxy [N/m]");
  visit("coupling_damping", o.coupling_damping, "[N s/m]");
  visit("success_height", o.success_height, "[m]");
  visit("hold_time", o.hold_time, "at that height [s]");
  visit("timeout", o.timeout, "[s]; censored data");
  visit("repetitions", o.repetitions, "of every friction per condition");
}

template <class Options, class Visit>
void forEachAlignmentKey(Options& o, Visit&& visit) {
  visit("radius", o.radius, "of the cylinder [m]");
  visit("length", o.length, "[m]");
  visit("mass", o.mass, "[kg]");
  visit("flat_half_angle", o.flat_half_angle, "half of what the flat takes of the circle [rad]");
  visit("friction", o.friction, "mu_s of the cylinder");
  visit("dynamic_ratio", o.dynamic_ratio, "mu_d / mu_s");
  visit("torsion_radius", o.torsion_radius, "of a soft fingertip's patch [m]");
  visit("pivot", o.pivot, "false: free on a table");
  visit("pivot_damping", o.pivot_damping, "[N m s/rad]");
  visit("table_friction", o.table_friction, "mu of the table under a free cylinder");
  visit("finger_radius", o.hand.finger_radius, "[m]");
  visit("coupling_stiffness", o.hand.coupling_stiffness, "of finger and proxy [N/m]");
  visit("coupling_damping", o.hand.coupling_damping, "[N s/m]");
  visit("start_min", o.start_min, "of the flat's start from its target, either way [rad]");
  visit("start_max", o.start_max, "[rad]");
  visit("timeout", o.timeout, "[s]; censored data");
  visit("repetitions", o.repetitions, "per condition");
}

class ManipulationWriter {
 public:
  template <class Value>
  void operator()(std::string_view key, const Value& value, std::string_view meaning) {
    line(key, fmt::format("{}", value), meaning);
  }
  void line(std::string_view key, const std::string& value, std::string_view meaning) {
    end();
    text_ += fmt::format("{}\"{}\": {}", indent_, key, value);
    comment_ = std::string(meaning);
    pending_ = true;
  }
  void begin(std::string_view key) {
    end();
    text_ += fmt::format("{}\"{}\": {{\n", indent_, key);
    indent_ += "  ";
  }
  void close() {
    end(false);
    indent_.resize(indent_.size() - 2);
    text_ += indent_ + "}";
    pending_ = true;
  }
  std::string take() {
    end(false);
    return "{\n" + text_ + "}\n";
  }

 private:
  void end(bool comma = true) {
    if (!pending_) return;
    text_ += comma ? "," : "";
    if (!comment_.empty()) text_ += "  // " + comment_;
    text_ += "\n";
    comment_.clear();
    pending_ = false;
  }
  std::string text_, indent_ = "  ", comment_;
  bool pending_ = false;
};

std::string jsonText(std::string_view text) {
  std::string json = "\"";
  for (const char c : text) json += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return json + "\"";
}

void writeObjectFile(const ObjectFile& file, ManipulationWriter& out) {
  out.begin("object");
  out.line("path", jsonText(file.path), "a closed mesh in place of the sphere");
  file.size ? out("size", *file.size, "of its largest dimension [m]") : out.line("units", jsonText(file.units), "");
  out.line("shading", jsonText(contact::kSurfaceVariantNames[static_cast<std::size_t>(file.shading)]), "");
  out.close();
}

class ManipulationReader {
 public:
  explicit ManipulationReader(const JsonValue& object) : object_(object) {}
  void operator()(std::string_view key, double& value, std::string_view) {
    keys_.push_back(key);
    if (const JsonValue* found = object_.find(key)) value = found->number();
  }
  void operator()(std::string_view key, int& value, std::string_view) {
    keys_.push_back(key);
    if (const JsonValue* found = object_.find(key)) value = found->integer(0, 1000000, "A whole number.");
  }
  void operator()(std::string_view key, bool& value, std::string_view) {
    keys_.push_back(key);
    if (const JsonValue* found = object_.find(key)) value = found->boolean();
  }
  const JsonValue* find(std::string_view key) {
    keys_.push_back(key);
    return object_.find(key);
  }
  void finish() const { object_.allowOnly(keys_); }

 private:
  const JsonValue& object_;
  std::vector<std::string_view> keys_;
};

ObjectFile readObjectFile(const JsonValue& json) {
  ManipulationReader in(json);
  ObjectFile file;
  if (const JsonValue* path = in.find("path")) file.path = path->text();
  if (const JsonValue* units = in.find("units")) file.units = units->text();
  if (const JsonValue* size = in.find("size")) file.size = size->number();
  if (const JsonValue* shading = in.find("shading")) {
    file.shading = static_cast<contact::SurfaceVariant>(shading->oneOf(contact::kSurfaceVariantNames));
  }
  in.finish();
  return file;
}

void readPickup(const JsonValue& json, SpherePickupOptions& options) {
  ManipulationReader in(json);
  forEachPickupKey(options, in);
  if (const JsonValue* frictions = in.find("frictions")) {
    options.frictions.clear();
    for (const JsonValue& mu : frictions->array()) options.frictions.push_back(mu.number());
  }
  if (const JsonValue* object = in.find("object")) options.object = readObjectFile(*object);
  in.finish();
}

void readAlignment(const JsonValue& json, CylinderAlignmentOptions& options) {
  ManipulationReader in(json);
  forEachAlignmentKey(options, in);
  in.finish();
}

void readPeople(const JsonValue& json, ParticipantModel& people) {
  ManipulationReader in(json);
  if (const JsonValue* strategy = in.find("strategy")) people.strategy = static_cast<Strategy>(strategy->oneOf(kStrategyNames));
  in("feels_tactor", people.feels_tactor, "");
  forEachParameter(people, [&](const char* name, double& value, double, double, const char*) { in(name, value, ""); });
  in.finish();
}

void readTraining(const JsonValue& json, ManipulationStudy& study) {
  ManipulationReader in(json);
  in("pickups", study.training_pickups, "");
  in("alignments", study.training_alignments, "");
  in.finish();
}

void readTasks(const JsonValue& json, ManipulationStudy& study) {
  study.pickup_task = study.alignment_task = false;
  for (const JsonValue& task : json.array()) (task.oneOf(kTaskNames) == 0 ? study.pickup_task : study.alignment_task) = true;
}

std::string listOf(const std::vector<std::string>& words) { return fmt::format("[{}]", fmt::join(words, ", ")); }

void writePeople(const ParticipantModel& people, ManipulationWriter& out) {
  out.begin("people");
  out.line("strategy", jsonText(nameOf(people.strategy)), "of simulated participants: rational or simple");
  out("feels_tactor", people.feels_tactor, "false: what the tactors do says nothing");
  forEachParameter(people, [&](const char* name, double value, double, double, const char* unit) {
    out(name, value, *unit ? fmt::format("[{}]", unit) : "");
  });
  out.close();
}

}  // namespace

std::string studyFile(const ManipulationStudy& study) {
  ManipulationWriter out;
  out("version", 1, "");
  out("participants", study.participants, "the published study had 12");
  out("seed", study.seed, "of all that varies");
  std::vector<std::string> words;
  for (const PickupCondition condition : study.conditions) words.push_back(jsonText(nameOf(condition)));
  out.line("conditions", listOf(words), "every other participant begins with the last");
  words.clear();
  if (study.pickup_task) words.push_back(jsonText(kTaskNames[0]));
  if (study.alignment_task) words.push_back(jsonText(kTaskNames[1]));
  out.line("tasks", listOf(words), "in this order, in one condition, then in the other");
  out("frozen_tactor", study.frozen_tactor, "true: the tactors stay parked in every condition (a control)");
  out.begin("training");
  out("pickups", study.training_pickups, "per condition, before the counted ones");
  out("alignments", study.training_alignments, "likewise");
  out.close();
  out.begin("sphere_pickup");
  forEachPickupKey(study.pickup, out);
  out.line("frictions", fmt::format("[{}]", fmt::join(study.pickup.frictions, ", ")), "mu_s of the object");
  if (study.pickup.object) writeObjectFile(*study.pickup.object, out);
  out.close();
  out.begin("cylinder_alignment");
  forEachAlignmentKey(study.alignment, out);
  out.close();
  writePeople(study.people, out);
  return out.take();
}

ManipulationStudy parseStudyFile(std::string_view text, const std::string& name) {
  const JsonValue json = parseJson(text, name);
  json.allowOnly(kManipulationKeys);
  if (json.at("version", "Write \"version\": 1.").number() != 1) json.at("version").reject("is unknown. This pincer reads version 1.");
  ManipulationStudy study;
  if (const JsonValue* v = json.find("participants")) study.participants = v->integer(1, 1000, "The published study had 12.");
  if (const JsonValue* v = json.find("seed")) {
    const double seed = v->number({0, kLargestSeed, false, "A whole number up to 2^53."});
    if (seed != std::floor(seed)) v->reject("is no whole number.");
    study.seed = static_cast<std::uint64_t>(seed);
  }
  if (const JsonValue* v = json.find("conditions")) {
    study.conditions.clear();
    for (const JsonValue& c : v->array()) study.conditions.push_back(static_cast<PickupCondition>(c.oneOf(kConditionNames)));
  }
  if (const JsonValue* v = json.find("frozen_tactor")) study.frozen_tactor = v->boolean();
  if (const JsonValue* v = json.find("tasks")) readTasks(*v, study);
  if (const JsonValue* v = json.find("training")) readTraining(*v, study);
  if (const JsonValue* v = json.find("sphere_pickup")) readPickup(*v, study.pickup);
  if (const JsonValue* v = json.find("cylinder_alignment")) readAlignment(*v, study.alignment);
  if (const JsonValue* v = json.find("people")) readPeople(*v, study.people);
  validate(study);
  return study;
}

ManipulationStudy readStudyFile(const std::string& path) {
  const std::ifstream file(path);
  if (!file)
    throw InputError(path + ": can't be read. Give the path of a study file; `pincer run manipulation --write-study FILE` makes one.");
  std::ostringstream text;
  text << file.rdbuf();
  return parseStudyFile(text.str(), path);
}

}  // namespace pincer::tasks
