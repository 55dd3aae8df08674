#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>

#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

const QuantityKind* findKind(std::span<const QuantityKind> kinds, std::string_view name) {
  const auto it = std::find_if(kinds.begin(), kinds.end(), [&](const QuantityKind& kind) { return kind.name == name; });
  return it == kinds.end() ? nullptr : &*it;
}

std::vector<std::string_view> namesOf(std::span<const QuantityKind> kinds) {
  std::vector<std::string_view> names;
  for (const QuantityKind& kind : kinds) names.push_back(kind.name);
  return names;
}

// A family of things that quantities are of, in the order of their names.
struct Family {
  std::span<const QuantityKind> kinds;
  std::vector<std::string_view> names;
};
template <class List, class Name>
Family familyOf(std::span<const QuantityKind> kinds, const List& list, const Name& name) {
  Family family{kinds, {}};
  for (const auto& item : list) family.names.push_back(name(item));
  return family;
}

std::vector<Family> familiesOf(const Scene& scene) {
  const auto own = [](const auto& item) { return std::string_view(item.name); };
  const auto of_model = [](const auto& item) { return std::string_view(item.model.name); };
  return {familyOf(bodyQuantities(), scene.bodies, own), familyOf(jointQuantities(), scene.joints, own),
          familyOf(driveQuantities(), scene.drives, of_model), familyOf(frameQuantities(), scene.frames, own),
          familyOf(fingerQuantities(), scene.fingers, of_model)};
}

// `reject` throws, with where the text stands before what it is told.
using Reject = std::function<void(const std::string&)>;

Quantity find(const std::string& text, std::span<const QuantityKind> kinds, std::string_view word, std::size_t index,
              const Reject& reject) {
  const QuantityKind* kind = findKind(kinds, word);
  if (!kind) reject(fmt::format("isn't known.{}", suggestion(word, namesOf(kinds))));
  return {text, kind, index};
}

constexpr std::string_view kPressure = "pressure";  // of a taxel: begins "pressure_2_5"

// "pressure_2_5": the taxel in row 2, column 5, from 0.
Quantity findTaxel(const std::string& text, std::string_view word, const SceneFinger& finger, std::size_t index,
                   const Reject& reject) {
  const grasp::PressureGrid& grid = finger.model.taxels;
  int row = -1, column = -1;
  const std::string_view numbers = word.substr(kPressure.size() + 1);
  const char* const end = numbers.data() + numbers.size();
  const auto first = std::from_chars(numbers.data(), end, row);
  const bool has_two = first.ec == std::errc() && first.ptr != end && *first.ptr == '_';
  const auto second = has_two ? std::from_chars(first.ptr + 1, end, column) : first;
  if (!has_two || second.ec != std::errc() || second.ptr != end || row < 0 || row >= grid.rows || column < 0 ||
      column >= grid.columns) {
    reject(fmt::format(
        "is no taxel of the finger: it has {} rows and {} columns, numbered from 0 (\"pressure_0_0\"; key \"taxels\").",
        grid.rows, grid.columns));
  }
  return {text, findKind(fingerQuantities(), kPressure), index, row * grid.columns + column};
}

Quantity findOfFinger(const std::string& text, std::string_view word, const Scene& scene, std::size_t index,
                      const Reject& reject) {
  const SceneFinger& finger = scene.fingers[index];
  if (word == kPressure && !finger.model.taxels.isOn())
    reject("needs the finger's key \"taxels\": {\"rows\": 8, \"columns\": 6}.");
  if (word.starts_with(kPressure) && word.size() > kPressure.size())
    return findTaxel(text, word, finger, index, reject);
  return find(text, fingerQuantities(), word, index, reject);
}

bool slides(const Scene& scene, int joint) {
  return scene.joints[static_cast<std::size_t>(joint)].kind == engine::JointKind::kSlider;
}

// "rad or m" as the one that it is; a drive along joints of both kinds keeps both.
Quantity inItsUnit(Quantity quantity, std::span<const QuantityKind> kinds, const Scene& scene) {
  std::vector<int> joints;
  if (kinds.data() == jointQuantities().data()) joints.push_back(static_cast<int>(quantity.index));
  if (kinds.data() == driveQuantities().data())
    for (const engine::DriveTerm& term : scene.drives[quantity.index].model.terms) joints.push_back(term.joint);
  const auto slide = [&](int joint) { return slides(scene, joint); };
  const bool all = std::all_of(joints.begin(), joints.end(), slide);
  if (!joints.empty() && (all || std::none_of(joints.begin(), joints.end(), slide)))
    quantity.kind = &inUnitOf(all, *quantity.kind);
  return quantity;
}

constexpr char kTouching = '|';  // between the names of two bodies

// "cube|left.f_x": of what touches between two bodies, on the first.
Quantity findOfPair(const std::string& text, std::string_view owner, std::string_view word, const Scene& scene,
                    const Reject& reject) {
  const std::vector<std::string_view> bodies = familiesOf(scene).front().names;
  const std::size_t bar = owner.find(kTouching);
  std::array<std::size_t, 2> pair{};
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string_view name = k == 0 ? owner.substr(0, bar) : owner.substr(bar + 1);
    const auto it = std::find(bodies.begin(), bodies.end(), name);
    if (it == bodies.end())
      reject(fmt::format("names no body of this scene by \"{}\".{}", name, suggestion(name, bodies)));
    pair[k] = static_cast<std::size_t>(it - bodies.begin());
  }
  if (pair[0] == pair[1]) reject("names one body twice: it doesn't touch itself.");
  return find(text, pairQuantities(), word, pairIndex(pair[0], pair[1], bodies.size()), reject);
}

Quantity findQuantity(const std::string& text, const Scene& scene, const Reject& reject) {
  const std::size_t dot = text.find('.');
  if (dot == std::string::npos) return find(text, worldQuantities(), text, 0, reject);
  const std::string_view owner = std::string_view(text).substr(0, dot);
  const std::string_view word = std::string_view(text).substr(dot + 1);
  if (owner.find(kTouching) != std::string_view::npos) return findOfPair(text, owner, word, scene, reject);
  const std::vector<Family> families = familiesOf(scene);
  std::vector<std::string_view> owners;
  for (const Family& family : families) {
    const auto it = std::find(family.names.begin(), family.names.end(), owner);
    owners.insert(owners.end(), family.names.begin(), family.names.end());
    if (it == family.names.end()) continue;
    const auto index = static_cast<std::size_t>(it - family.names.begin());
    if (family.kinds.data() == fingerQuantities().data()) return findOfFinger(text, word, scene, index, reject);
    return inItsUnit(find(text, family.kinds, word, index, reject), family.kinds, scene);
  }
  reject(fmt::format("names no body, joint, drive, frame or finger of this scene.{}", suggestion(owner, owners)));
  return {};
}

Quantity readQuantity(const JsonValue& json, const Scene& scene) {
  return findQuantity(json.text(), scene, [&](const std::string& problem) { json.reject(problem); });
}

std::int64_t readTicks(const JsonValue& json, const Scene& scene, const NumberRule& rule) {
  const std::int64_t ticks = wholeTicks(json.number(rule), scene.options.h);
  if (ticks < 0) json.reject(fmt::format("isn't a whole number of ticks of {} s.", scene.options.h));
  return ticks;
}

void readWhen(const JsonValue& json, const Scene& scene, Expectation& expectation) {
  const JsonValue& time = json.at("time", "In seconds, or \"end\" or \"always\".");
  if (time.kind() == JsonValue::Kind::kString) {
    constexpr std::array<std::string_view, 2> words = {"always", "end"};
    expectation.tick = time.oneOf(words) == 0 ? Expectation::kAlways : scene.ticks();
  } else {
    expectation.tick =
        readTicks(time, scene, {.min = 0, .max = scene.duration, .remedy = "Within the scene's duration."});
  }
  expectation.time = static_cast<double>(std::max<std::int64_t>(expectation.tick, 0)) * scene.options.h;
}

void readTolerance(const JsonValue& json, Expectation& expectation) {
  const JsonValue* tolerance = json.find("tolerance");
  if (tolerance) {
    expectation.tolerance = tolerance->number(ranges::kExpectedTolerance);
  } else if (expectation.relation == Relation::kEqual) {
    json.reject("lacks the key \"tolerance\": how far the measured value may lie from \"value\", in its unit.");
  }
}

}  // namespace

Quantity quantityOf(const std::string& name, const Scene& scene) {
  return findQuantity(name, scene, [&](const std::string& problem) {
    throw InputError(fmt::format("quantity \"{}\" {}", name, problem));
  });
}

namespace {

// Of a recorded pressure every taxel is a column; any other quantity is one.
void addColumns(const Quantity& quantity, const Scene& scene, std::vector<Quantity>& columns) {
  if (!quantity.name.ends_with(std::string(".") + std::string(kPressure))) return columns.push_back(quantity);
  const grasp::PressureGrid& grid = scene.fingers[quantity.index].model.taxels;
  for (int taxel = 0; taxel < grid.rows * grid.columns; ++taxel) {
    const std::string name = fmt::format("{}_{}_{}", quantity.name, taxel / grid.columns, taxel % grid.columns);
    columns.push_back({name, quantity.kind, quantity.index, taxel});
  }
}

}  // namespace

Recording readRecording(const JsonValue& json, const Scene& scene) {
  json.allowOnly(keys::kRecord);
  Recording record;
  if (const JsonValue* interval = json.find("interval")) {
    record.every =
        readTicks(*interval, scene, {.min = scene.options.h, .max = scene.duration, .remedy = "At least one tick."});
  }
  const JsonValue& quantities = json.at("quantities", "What to record: [\"object.p_z\", \"energy\"].");
  if (quantities.array().size() > kMostQuantities)
    quantities.reject(fmt::format("has {} elements; a scene records at most {}. Leave some out.",
                                  quantities.array().size(), kMostQuantities));
  for (const JsonValue& quantity : quantities.array()) {
    addColumns(readQuantity(quantity, scene), scene, record.quantities);
  }
  return record;
}

namespace {

constexpr QuantityKind kHashKind{"hash", "", nullptr};  // of no unit and nothing measured: the whole state's

// "" stands for one that hasn't been taken yet.
void readHash(const JsonValue& json, Expectation& expectation) {
  const std::string& hash = json.text();
  const bool is_hash = hash.size() == 16 && hash.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (!hash.empty() && !is_hash) {
    json.reject(
        "is no hash: 16 of the digits 0-9 and a-f, as `pincer sim` prints it; or \"\", which `pincer test "
        "--update-hashes` fills in.");
  }
  expectation.hash = hash;
  expectation.hash_line = json.line();
  expectation.quantity = {"hash", &kHashKind, 0};
}

Expectation readHashExpectation(const JsonValue& json, const Scene& scene) {
  json.allowOnly(keys::kHashExpectation);
  Expectation expectation;
  readHash(json.at("hash"), expectation);
  readWhen(json, scene, expectation);
  if (expectation.tick == Expectation::kAlways)
    json.at("time").reject("isn't a moment: a hash is that of one. Write a time [s] or \"end\".");
  if (const JsonValue* because = json.find("because")) expectation.because = because->text();
  return expectation;
}

}  // namespace

Expectation readExpectation(const JsonValue& json, const Scene& scene) {
  if (json.kind() == JsonValue::Kind::kObject && json.find("hash")) return readHashExpectation(json, scene);
  json.allowOnly(keys::kExpectation);
  Expectation expectation;
  expectation.quantity = readQuantity(json.at("quantity", "What is measured: \"object.p_z\"."), scene);
  if (const JsonValue* relation = json.find("relation"))
    expectation.relation = static_cast<Relation>(relation->oneOf(kRelationNames));
  readWhen(json, scene, expectation);
  expectation.value = json.at("value", "What it is compared with, in the quantity's unit.").number(ranges::kExpected);
  readTolerance(json, expectation);
  if (const JsonValue* because = json.find("because")) expectation.because = because->text();
  return expectation;
}

}  // namespace pincer::tasks
