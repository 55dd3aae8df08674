#include "pincer/tasks/lab/sessions/study_file.h"

#include <fmt/format.h>

#include "pincer/tasks/lab/experiments/study_reader.h"
#include "pincer/tasks/lab/experiments/study_writer.h"
#include "pincer/tasks/lab/sessions/observer_fields.h"
#include "pincer/tasks/run/files/file_limits.h"

namespace pincer::tasks {
namespace {

class LimitsWriter {
 public:
  explicit LimitsWriter(JsonWriter& json) : json_(json) {}
  template <class Field>
  void operator()(std::string_view key, const Field& field) {
    json_.key(key);
    if constexpr (std::is_class_v<Field>) {
      writeObject(field);
    } else {
      json_.value(field);
    }
  }
  template <class Object>
  void writeObject(const Object& object) {
    json_.beginObject();
    visitFields(object, *this);
    json_.endObject();
  }

 private:
  JsonWriter& json_;
};

template <class Limits>
std::string peopleJson(const Limits& limits) {
  JsonWriter json;
  LimitsWriter writer(json);
  json.beginObject().key("limits");
  writer.writeObject(limits);
  json.key("hands");
  writer.writeObject(HandRanges{});
  return json.endObject().text();
}

}  // namespace

void readStudy(const std::string& path, ArcStudy& study) { readStudyText(readJson(path, kStudyFile), study); }
void readStudy(const std::string& path, LocalisationStudy& study) { readStudyText(readJson(path, kStudyFile), study); }
void readStudy(const std::string& path, ShapeStudy& study) { readStudyText(readJson(path, kStudyFile), study); }
void parseStudy(const std::string& text, const std::string& name, ShapeStudy& study) {
  readStudyText(parseJson(text, name), study);
}
void parseStudy(const std::string& text, const std::string& name, LocalisationStudy& study) {
  readStudyText(parseJson(text, name), study);
}
void parseStudy(const std::string& text, const std::string& name, ArcStudy& study) {
  readStudyText(parseJson(text, name), study);
}
std::string studyJson(const ArcStudy& study) { return studyText(study); }
std::string studyJson(const LocalisationStudy& study) { return studyText(study); }
std::string studyJson(const ShapeStudy& study) { return studyText(study); }
std::string participantsJson(const ArcStudy&) { return peopleJson(StrokeLimits{}); }
std::string participantsJson(const LocalisationStudy&) { return peopleJson(PlaceLimits{}); }
std::string participantsJson(const ShapeStudy&) { return peopleJson(ShapeLimits{}); }

std::string fingerprint(const std::string& text) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return fmt::format("{:016x}", hash);
}

}  // namespace pincer::tasks
