// The schemas of scene and study files say what the readers do: numbers just within their
// ranges are read, those just outside refused.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "pincer/contact/error.h"
#include "pincer/tasks/app/schema_reference.h"
#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/experiments/study_schema.h"
#include "pincer/tasks/lab/experiments/study_writer.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tests/support/run_app.h"

namespace pincer::tasks {
namespace {

using tests::contains;

// Other keys that an object of the schema needs, and where in a scene it stands; by the object's
// name, or for a single key by object.key.
struct Place {
  std::map<std::string, std::string> members;
  std::string before, after;
};

std::string bodyWith(const std::string& shape_open) {
  return R"({"version": 1, "duration": 1, "bodies": [{"mass": 0.1, "shape": )" + shape_open;
}
const std::string kBodyEnd = "}]}";
const std::string kFingerStart = R"({"version": 1, "duration": 1, "bodies": [], "fingers": [)";
const std::string kTipStart = kFingerStart + R"({"position": [0, 0, 1], "shape": )";
const std::string kSphere = R"({"type": "sphere", "radius": 0.02})";

const std::string kBodyFirst =
    R"({"version": 1, "tick": 1e-5, "duration": 1, "bodies": [{"mass": 1, "shape": )" + kSphere + "}], ";

const std::string kJointFirst = R"({"version": 1, "duration": 1, "bodies": [{"name": "b", "mass": 1, "shape": )" +
                                kSphere + R"(}], "joints": [{"name": "j", "type": "pivot", "body": "b"}], )";

const std::map<std::string, Place> kPlaces = {
    {"mesh.scale", {{{"type", "\"mesh\""}, {"file", "\"none.obj\""}, {"units", "\"mm\""}}, bodyWith(""), kBodyEnd}},
    {"pad_tip.scale", {{{"type", "\"pad\""}, {"file", "\"none.obj\""}, {"units", "\"mm\""}}, kTipStart, kBodyEnd}},
    {"scene", {{{"version", "1"}, {"duration", "1"}, {"bodies", "[]"}}, "", ""}},
    {"solver", {{}, R"({"version": 1, "duration": 1, "bodies": [], "solver": )", "}"}},
    {"part", {{{"shape", kSphere}}, R"({"version": 1, "duration": 1, "bodies": [{"mass": 1, "shapes": [)", "]}]}"}},
    {"pieces",
     {{{"file", "\"none.obj\""}, {"units", "\"mm\""}},
      R"({"version": 1, "duration": 1, "bodies": [{"mass": 1, "shapes": [{"pieces": )",
      "}]}]}"}},
    {"collides",
     {{},
      R"({"version": 1, "duration": 1, "bodies": [{"mass": 1, "shapes": [{"shape": )" + kSphere + R"(, "collides": )",
      "}]}]}"}},
    {"body", {{{"shape", kSphere}}, R"({"version": 1, "duration": 1, "bodies": [)", "]}"}},
    {"body_keyframe",
     {{{"time", "0"}},
      R"({"version": 1, "duration": 1, "bodies": [{"shape": )" + kSphere + R"(, "trajectory": {"keyframes": [)",
      "]}}]}"}},
    {"joint",
     {{{"type", "\"pivot\""}, {"body", "\"b\""}},
      R"({"version": 1, "duration": 1, "bodies": [{"name": "b", "mass": 1, "shape": )" + kSphere + R"(}], "joints": [)",
      "]}"}},
    {"drive", {{{"type", "\"affine\""}, {"joint", "\"j\""}}, kJointFirst + R"("drives": [)", "]}"}},
    {"drive_keyframe",
     {{{"time", "0"}, {"value", "0"}},
      kJointFirst + R"("drives": [{"joint": "j", "type": "motor", "trajectory": {"keyframes": [)",
      "]}}]}"}},
    {"material", {{}, bodyWith(kSphere + R"(, "material": )"), kBodyEnd}},
    {"sphere", {{{"type", "\"sphere\""}}, bodyWith(""), kBodyEnd}},
    {"capsule", {{{"type", "\"capsule\""}, {"radius", "0.01"}, {"length", "0.1"}}, bodyWith(""), kBodyEnd}},
    {"cylinder", {{{"type", "\"cylinder\""}, {"radius", "0.01"}, {"length", "0.1"}}, bodyWith(""), kBodyEnd}},
    {"cylinder_with_flat",
     {{{"type", "\"cylinder_with_flat\""}, {"radius", "0.01"}, {"length", "0.1"}, {"flat_distance", "0.005"}},
      bodyWith(""),
      kBodyEnd}},
    {"dish", {{{"type", "\"dish\""}}, R"({"version": 1, "duration": 1, "bodies": [{"shape": )", kBodyEnd}},
    {"mesh", {{{"type", "\"mesh\""}, {"lathe", "[[0, 0], [0.02, 0.01], [0, 0.03]]"}}, bodyWith(""), kBodyEnd}},
    {"convex", {{{"type", "\"convex\""}, {"file", "\"none.obj\""}, {"units", "\"mm\""}}, bodyWith(""), kBodyEnd}},
    {"finger", {{{"position", "[0, 0, 1]"}}, kFingerStart, "]}"}},
    {"sphere_tip", {{{"type", "\"sphere\""}}, kTipStart, kBodyEnd}},
    {"capsule_tip", {{{"type", "\"capsule\""}, {"radius", "0.01"}, {"half", "[0.01, 0, 0]"}}, kTipStart, kBodyEnd}},
    {"pad_tip",
     {{{"type", "\"pad\""}, {"points", "[[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]]"}}, kTipStart, kBodyEnd}},
    {"keyframe",
     {{{"time", "0"}, {"position", "[0, 0, 1]"}}, kFingerStart + R"({"trajectory": {"keyframes": [)", "]}}]}"}},
    {"record", {{{"quantities", "[\"energy\"]"}}, kBodyFirst + R"("record": )", "}"}},
    {"expectation", {{{"quantity", "\"energy\""}, {"time", "0"}, {"value", "0"}}, kBodyFirst + R"("expect": [)", "]}"}},
};

std::string sceneAt(const Place& place, const std::string& key, double value) {
  std::map<std::string, std::string> members = place.members;
  members[key] = fmt::format("{}", value);
  std::string object;
  for (const auto& [name, text] : members)
    object += fmt::format("{}\"{}\": {}", object.empty() ? "" : ", ", name, text);
  return place.before + "{" + object + "}" + place.after;
}

// The reader's objection to the number at `key` itself; empty where it takes it, whatever it says of the rest.
std::string complaint(const Place& place, const std::string& key, double value) {
  try {
    parseScene(sceneAt(place, key, value), "probe");
  } catch (const InputError& error) {
    const std::string said = error.what();
    if (contains(said, key + fmt::format(" = {} is out of range", value))) return said;
  }
  return "";
}

// Runs over the numbers with ranges of all objects of the scene's schema.
template <class Visit>
void forEachRange(const JsonValue& schema, Visit&& visit) {
  const JsonValue& defs = schema.at("$defs");
  for (const std::string& name : defs.keys()) {
    const JsonValue* properties = defs.at(name).find("properties");
    if (!properties) continue;
    for (const std::string& key : properties->keys()) {
      const JsonValue* number = &properties->at(key);
      const JsonValue* reference = number->find("$ref");
      if (reference) number = &defs.at(reference->text().substr(reference->text().rfind('/') + 1));
      const JsonValue* type = number->find("type");
      if (type && type->kind() == JsonValue::Kind::kString && (type->text() == "number" || type->text() == "integer"))
        visit(name, key, *number);
    }
  }
}

TEST(SceneSchema, HasTheRangesOfTheReader) {
  int probed = 0;
  forEachRange(readJson(PINCER_SOURCE_DIR "/docs/scene.schema.json", kSceneFile),
               [&](const std::string& def, const std::string& key, const JsonValue& number) {
                 const std::string place_name = kPlaces.contains(def + "." + key) ? def + "." + key : def;
                 ASSERT_TRUE(kPlaces.contains(place_name))
                     << def << " has a number, but no place in a scene is known for it";
                 const Place& place = kPlaces.at(place_name);
                 const bool whole = number.at("type").text() == "integer";
                 const auto below = [&](double v) { return whole ? v - 1 : v - std::max(1e-12, 1e-9 * std::abs(v)); };
                 const auto above = [&](double v) { return whole ? v + 1 : v + std::max(1e-12, 1e-9 * std::abs(v)); };
                 const auto expect = [&](double value, bool taken) {
                   ++probed;
                   const std::string said = complaint(place, key, value);
                   EXPECT_EQ(said.empty(), taken) << def << "." << key << " = " << value << ": " << said;
                 };
                 if (const JsonValue* low = number.find("minimum")) {
                   expect(low->number(), true);
                   expect(below(low->number()), false);
                 }
                 if (const JsonValue* low = number.find("exclusiveMinimum")) {
                   expect(low->number(), false);
                   expect(above(low->number()), true);
                 }
                 if (const JsonValue* high = number.find("maximum")) {
                   expect(high->number(), true);
                   expect(above(high->number()), false);
                 }
               });
  EXPECT_GT(probed, 100);
}

// Published studies' files are read as they are written, and their schemas know just the keys that the files have.
template <class Study>
void expectSchemaOf(const Study& study) {
  const JsonValue file = parseJson(studyText(study), "study.json");
  const JsonValue schema = parseJson(SchemaWriter().schemaOf("a study", study), "schema");
  std::vector<std::string> keys = file.keys();
  // written where it differs only, so that older protocols stay as they were
  if (!file.find("session")) keys.push_back("session");
  EXPECT_EQ(keys, schema.at("properties").keys());
  for (const std::string& key : file.keys()) {
    const JsonValue* standard = schema.at("properties").at(key).find("default");
    if (standard && standard->kind() == JsonValue::Kind::kNumber) {
      EXPECT_EQ(standard->number(), file.at(key).number()) << key;
    }
  }
}

TEST(StudySchema, KnowsTheKeysAndDefaultsOfTheFile) {
  expectSchemaOf(ManipulationStudy{});
  expectSchemaOf(smoothnessStudy());
  expectSchemaOf(LocalisationStudy{});
  expectSchemaOf(ShapeStudy{});
}

// One schema for whatever experiment a file names: under each name the one of that experiment.
TEST(StudySchema, OfAnyExperimentIsThatOfTheOneThatIsNamed) {
  const JsonValue any = parseJson(tests::runPincer({"schema", "study"}).out, "study");
  EXPECT_EQ(any.at("properties").at("experiment").at("enum").array().size(), kExperimentNames.size());
  std::size_t names = 0;
  for (const JsonValue& choice : any.at("allOf").array()) {
    const auto& named = choice.at("if").at("properties").at("experiment").at("enum").array();
    names += named.size();
    const JsonValue own = parseJson(tests::runPincer({"schema", named.back().text()}).out, named.back().text());
    EXPECT_EQ(choice.at("then").at("properties").keys(), own.at("properties").keys()) << named.back().text();
  }
  EXPECT_EQ(names, kExperimentNames.size());
}

TEST(StudySchema, RefusesWithTheLineWhatIsOutOfRange) {
  const auto said = [](const std::string& text) -> std::string {
    try {
      parseStudyFile(text, "study.json");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(said("{\"version\": 1,\n\"sphere_pickup\": {\n\"mass\": 75}}"),
            "study.json:3: sphere_pickup.mass = 75 is out of range [0.001, 1]. It is in kilograms; the usual sphere "
            "has 0.075.");
  EXPECT_TRUE(contains(said("{\"people\": {\n\"force_floor\": 7}}"),
                       "study.json:2: people.force_floor = 7 is out of range [0.01, 1]"));
  EXPECT_TRUE(contains(said("{\"tasks\": [\"sphere-pick\"]}"), "Did you mean \"sphere-pickup\"?"));
}

TEST(SchemaReference, HasARowPerKeyWithRangeDefaultAndMeaning) {
  const std::string page = tests::runPincer({"schema", "scene", "--markdown"}).out;
  EXPECT_TRUE(contains(page, "| `tick` | number in [1e-05, 0.01] | `0.001` |")) << page.substr(0, 2000);
  EXPECT_TRUE(contains(page, "| `shape` | [shape](#shape) |  | needed, unless there are shapes |"));
  EXPECT_TRUE(contains(page, "\n## finger.arm\n"));
  EXPECT_TRUE(contains(tests::runPincer({"schema", "delay-discrimination", "--markdown"}).out,
                       "| `strokes` | whole number in [2, 100] | `4` | per interval"));
  EXPECT_EQ(tests::runPincer({"schema", "scenes"}).exit_code, 2);
}

}  // namespace
}  // namespace pincer::tasks
