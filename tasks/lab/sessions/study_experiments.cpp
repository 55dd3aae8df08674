#include "pincer/tasks/lab/sessions/study_experiments.h"

#include <fmt/format.h>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {
namespace {

template <class Kind, class Study>
std::unique_ptr<Experiment> experimentIn(const SessionInfo& info, const std::string& name, Study study,
                                         const ServoOptions& servo, int stride) {
  parseStudy(info.protocol_json, name + ": protocol", study);
  study.seed = info.seed;
  return std::make_unique<Kind>(study, servo, stride);
}

}  // namespace

bool isOneFingerTask(const std::string& task) {
  return task == "shape-identification" || task == "repeated-localisation" || task == "smoothness-discrimination" ||
         task == "backlash-discrimination" || task == "delay-discrimination";
}

std::unique_ptr<Experiment> experimentOf(const SessionInfo& info, const std::string& name, const ServoOptions& servo,
                                         int stride) {
  if (info.task == "shape-identification")
    return experimentIn<ShapeExperiment>(info, name, ShapeStudy{}, servo, stride);
  if (info.task == "repeated-localisation")
    return experimentIn<LocalisationExperiment>(info, name, LocalisationStudy{}, servo, stride);
  for (const ArcStudy& study : {smoothnessStudy(), backlashStudy(), delayStudy()})
    if (info.task == study.task) return experimentIn<ArcExperiment>(info, name, study, servo, stride);
  throw InputError(
      fmt::format("{}: its task, {}, is none of this program's experiments with one finger.", name, info.task));
}

std::string personJson(std::int64_t person) {
  return JsonWriter().beginObject().key("person").value(person + 1).endObject().text();
}

std::optional<std::int64_t> personOf(const SessionInfo& info) {
  if (info.participants_json.empty()) return {};
  const auto json = parseJson(info.participants_json, "participants");
  const JsonValue* person = json.find("person");
  return person ? std::optional(static_cast<std::int64_t>(person->number({1, 1e6})) - 1) : std::nullopt;
}

}  // namespace pincer::tasks
