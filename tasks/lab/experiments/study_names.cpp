#include "pincer/tasks/lab/experiments/study_names.h"

#include <fmt/format.h>

#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {

void requireExperiment(const JsonValue& file, std::string_view runs) {
  const JsonValue* named = file.find(kExperimentKey);
  if (!named) return;
  const std::string_view name = kExperimentNames[named->oneOf(kExperimentNames)];
  const bool holds_both = name == "manipulation" && (runs == "sphere-pickup" || runs == "cylinder-alignment");
  if (name == runs || holds_both) return;
  named->reject(fmt::format(
      "is another experiment than the one that runs here, {}. Give the file to `pincer run {}`, or correct the key.",
      runs, name));
}

}  // namespace pincer::tasks
