#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/schema_reference.h"
#include "pincer/tasks/lab/experiments/study_schema.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/session/column_meanings.h"

namespace pincer::tasks {
namespace {

struct FileKind {
  std::string_view name;
  std::string (*schema)();
};

template <class Study>
std::string studySchema(std::string_view task, const Study& published) {
  return SchemaWriter().schemaOf(fmt::format("pincer study, {}, version 1", task), published);
}

// Of every experiment, in one file: what an editor can be given once for all.
std::string anyStudySchema() {
  return SchemaWriter().schemaOfAny("pincer study that names its experiment, version 1", smoothnessStudy(),
                                    backlashStudy(), delayStudy(), LocalisationStudy{}, ShapeStudy{},
                                    ManipulationStudy{});
}

// Kinds of file, and how the schema of each is written.
constexpr FileKind kFileKinds[] = {
    {"scene", [] { return std::string(sceneSchema()); }},
    {"study", anyStudySchema},
    {"manipulation", [] { return studySchema("manipulation", ManipulationStudy{}); }},
    {"smoothness-discrimination", [] { return studySchema("smoothness-discrimination", smoothnessStudy()); }},
    {"backlash-discrimination", [] { return studySchema("backlash-discrimination", backlashStudy()); }},
    {"delay-discrimination", [] { return studySchema("delay-discrimination", delayStudy()); }},
    {"repeated-localisation", [] { return studySchema("repeated-localisation", LocalisationStudy{}); }},
    {"shape-identification", [] { return studySchema("shape-identification", ShapeStudy{}); }},
};

constexpr std::string_view kSessionTables = "session";  // no file that anybody writes, but one that many read

std::vector<std::string> kindNames() {
  std::vector<std::string> names;
  for (const FileKind& kind : kFileKinds) names.emplace_back(kind.name);
  names.emplace_back(kSessionTables);
  return names;
}

void printSchema(const std::string& name, bool markdown) {
  if (name == kSessionTables)
    return markdown ? print("{}\nMade by `pincer schema {} --markdown`.\n", columnsMarkdown(), name)
                    : print("{}", columnsCsv());
  for (const FileKind& kind : kFileKinds) {
    if (kind.name != name) continue;
    const std::string schema = kind.schema();
    if (!markdown) return print("{}", schema);
    print("{}Made by `pincer schema {} --markdown`.\n", schemaMarkdown(parseJson(schema, name + ".schema.json")), name);
  }
}

}  // namespace

void addSchemaCommand(CLI::App& app, int& exit_code) {
  struct Arguments {
    std::string name;
    bool markdown = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "schema",
      "Every key of a scene or study file: a JSON Schema for editors, or tables to read; every column of a session");
  command
      ->add_option("file", arguments->name,
                   "scene; study: of any experiment; one experiment's: manipulation, delay-discrimination, ...; "
                   "session: its tables and their columns")
      ->required()
      ->check(CLI::IsMember(kindNames()));
  command->add_flag("--markdown", arguments->markdown, "Tables, as in docs/reference");
  command->footer("\nExample:\n  pincer schema delay-discrimination > delay.schema.json");
  command->callback([arguments, &exit_code] {
    printSchema(arguments->name, arguments->markdown);
    exit_code = kExitOk;
  });
}

}  // namespace pincer::tasks
