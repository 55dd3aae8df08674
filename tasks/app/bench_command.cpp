#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "tasks/app/app.h"
#include "tasks/app/commands.h"
#include "tasks/app/measure_command.h"
#include "tasks/bench/contact_bench.h"

namespace pincer::tasks {
namespace {

constexpr const char* kBenchExample = R"(
What touching a mesh costs and how well it is felt, each figure beside what pincer promises (docs/benchmarks.md). Exit code 1 if a promise isn't
kept. Times are this machine's, while it does whatever else it does.

Examples:
  pincer bench contact
  pincer bench contact --list
  pincer bench contact --only stroke/creased --queries 1000000
  pincer bench contact --only shading --out out/bench)";

struct BenchArguments {
  MeasureOptions measure;
  ContactBenchOptions contact;
};

}  // namespace

void addBenchCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<BenchArguments>();
  CLI::App* bench = app.add_subcommand("bench", "Measure costs and quality against what pincer promises");
  bench->require_subcommand(1);
  bench->footer("\nExample:\n  pincer bench contact --only cost");
  CLI::App* contact = bench->add_subcommand("contact", "A finger on meshes: iterations, failures, continuity, errors, nanoseconds");
  addMeasureOptions(*contact, arguments->measure);
  contact->add_option("--queries", arguments->contact.queries, "Queries per object")
      ->check(CLI::Range(1000, 100'000'000))
      ->capture_default_str();
  contact->add_option("--meshes", arguments->contact.meshes, "Directory of mesh files to touch too, each scaled to 80 mm");
  contact->add_option("--out", arguments->contact.out, "Directory for tables (CSV) and plots of the contact's place on the finger");
  contact->add_flag("--peers", arguments->contact.peers, "Measure Bullet and ODE on the same paths (built with -DPINCER_PEERS=ON)");
  contact->footer(kBenchExample);
  contact->callback([arguments, &exit_code] {
    exit_code = runMeasurements(contactMeasurements(arguments->contact), arguments->measure, "bench contact");
  });
}

}  // namespace pincer::tasks
