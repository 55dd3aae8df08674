#include "tasks/app/study_file.h"

#include <fmt/format.h>

#include <cmath>

#include "tasks/app/json_writer.h"
#include "tasks/app/study_fields.h"
#include "tasks/scene/strict_json.h"

namespace pincer::tasks {
namespace {

using contact::SurfaceVariant;

// Reads the members of one JSON object into fields; remembers the keys, to find those that don't exist.
class FieldReader {
 public:
  explicit FieldReader(const JsonValue& object) : object_(object) {}
  template <class Field>
  void operator()(std::string_view key, Field& field) {
    keys_.push_back(key);
    if (const JsonValue* value = object_.find(key)) read(*value, field);
  }
  void refuseOthers() const { object_.allowOnly(keys_); }

 private:
  static void read(const JsonValue& v, double& field) {
    field = v.kind() == JsonValue::Kind::kNull ? std::nan("") : v.number();  // null: there is no such figure
  }
  static void read(const JsonValue& v, bool& field) { field = v.boolean(); }
  static void read(const JsonValue& v, std::string& field) { field = v.text(); }
  static void read(const JsonValue& v, int& field) { field = v.integer(-1'000'000'000, 1'000'000'000, "Give a whole number."); }
  static void read(const JsonValue& v, std::uint64_t& field) {
    field = static_cast<std::uint64_t>(v.integer(0, 2'000'000'000, "Give a whole number, 0 or larger."));
  }
  static void read(const JsonValue& v, SurfaceVariant& field) {
    field = static_cast<SurfaceVariant>(v.oneOf(std::span(contact::kSurfaceVariantNames).first(3)));
  }
  static void read(const JsonValue& v, std::optional<SurfaceVariant>& field) {
    field.reset();
    if (v.kind() == JsonValue::Kind::kNull) return;  // the tactor is parked
    SurfaceVariant variant{};
    read(v, variant);
    field = variant;
  }
  static void read(const JsonValue& v, StaircaseRule& rule) { readObject(v, rule); }
  static void read(const JsonValue& v, SolidSizes& sizes) { readObject(v, sizes); }
  template <class Condition>
  static void read(const JsonValue& v, std::vector<Condition>& conditions) {
    std::vector<Condition> list;
    for (const JsonValue& item : v.array()) {
      const std::string& name = item.at("name", "Each condition has one.").text();
      Condition condition;
      for (const Condition& known : conditions)
        if (known.name == name) condition = known;
      readObject(item, condition);
      list.push_back(std::move(condition));
    }
    conditions = std::move(list);
  }
  template <class Object>
  static void readObject(const JsonValue& v, Object& object) {
    FieldReader reader(v);
    visitFields(object, reader);
    reader.refuseOthers();
  }

  const JsonValue& object_;
  std::vector<std::string_view> keys_;
};

class FieldWriter {
 public:
  explicit FieldWriter(JsonWriter& json) : json_(json) {}
  template <class Field>
  void operator()(std::string_view key, const Field& field) {
    json_.key(key);
    write(field);
  }
  template <class Object>
  void writeObject(const Object& object) {
    json_.beginObject();
    visitFields(object, *this);
    json_.endObject();
  }

 private:
  void write(double field) { json_.value(field); }
  void write(bool field) { json_.value(field); }
  void write(int field) { json_.value(field); }
  void write(std::uint64_t field) { json_.value(static_cast<std::int64_t>(field)); }
  void write(const std::string& field) { json_.value(field); }
  void write(SurfaceVariant field) { json_.value(contact::kSurfaceVariantNames[static_cast<std::size_t>(field)]); }
  void write(const std::optional<SurfaceVariant>& field) {
    field ? write(*field) : write(std::nan(""));  // null
  }
  template <class Condition>
  void write(const std::vector<Condition>& conditions) {
    json_.beginArray();
    for (const Condition& c : conditions) writeObject(c);
    json_.endArray();
  }
  template <class Object>
  requires std::is_class_v<Object>
  void write(const Object& object) { writeObject(object); }

  JsonWriter& json_;
};

template <class Study>
void takeStudy(const JsonValue& file, Study& study) {
  FieldReader reader(file);
  visitFields(study, reader);
  reader.refuseOthers();
}

template <class Object>
std::string objectJson(const Object& object) {
  JsonWriter json;
  FieldWriter(json).writeObject(object);
  return json.text();
}

template <class Limits>
std::string peopleJson(const Limits& limits) {
  JsonWriter json;
  FieldWriter writer(json);
  json.beginObject().key("limits");
  writer.writeObject(limits);
  json.key("hands");
  writer.writeObject(HandRanges{});
  return json.endObject().text();
}

}  // namespace

void readStudy(const std::string& path, ArcStudy& study) { takeStudy(readJson(path), study); }
void readStudy(const std::string& path, LocalisationStudy& study) { takeStudy(readJson(path), study); }
void readStudy(const std::string& path, ShapeStudy& study) { takeStudy(readJson(path), study); }
void parseStudy(const std::string& text, const std::string& name, ShapeStudy& study) { takeStudy(parseJson(text, name), study); }
void parseStudy(const std::string& text, const std::string& name, LocalisationStudy& study) { takeStudy(parseJson(text, name), study); }
void parseStudy(const std::string& text, const std::string& name, ArcStudy& study) { takeStudy(parseJson(text, name), study); }
std::string studyJson(const ArcStudy& study) { return objectJson(study); }
std::string studyJson(const LocalisationStudy& study) { return objectJson(study); }
std::string studyJson(const ShapeStudy& study) { return objectJson(study); }
std::string participantsJson(const ArcStudy&) { return peopleJson(StrokeLimits{}); }
std::string participantsJson(const LocalisationStudy&) { return peopleJson(PlaceLimits{}); }
std::string participantsJson(const ShapeStudy&) { return peopleJson(ShapeLimits{}); }

std::string fingerprint(const std::string& text) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return fmt::format("{:016x}", hash);
}

}  // namespace pincer::tasks
