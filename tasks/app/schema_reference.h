// schema_reference: a JSON Schema as pages to read: a table per object, with each key's values, default and meaning. It
// knows the words that docs/scene.schema.json and study_schema.h use, and no others.
#pragma once
#include <string>

#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {

// Markdown, a whole page. Objects among the schema's $defs have a section each, as objects within objects do. Throws
// InputError where the schema says something that isn't known here.
std::string schemaMarkdown(const JsonValue& schema);

}  // namespace pincer::tasks
