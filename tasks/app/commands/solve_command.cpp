#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/judge/solve/problem_file.h"
#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {
namespace {

constexpr const char* kSolveExample = R"(
Contact problems u = W r + q with Coulomb's law, exact cones, as text (docs/engine.md, "A problem of one's
own"), solved by the engine's method. The error is |r - P_K(r - (u + mu |u_T| n))| / |q|, computed from W as
the file has it. Exit code 1: one is above --enough.

Example:
  pincer solve problem.txt --enough 1e-8)";

constexpr NumberRule kEnough = {.min = 0, .max = 1};  // of the error, over the problem's q [-]: dense_problem.h

struct SolveArguments {
  std::vector<std::string> files;
  double enough = 1e-8;
};

int runSolve(const SolveArguments& arguments) {
  std::size_t width = 4;
  for (const std::string& file : arguments.files)
    width = std::max(width, std::filesystem::path(file).filename().string().size());
  print("{:<{}} {:>8} {:>6} {:>11} {:>11} {:>9}\n", "file", width, "contacts", "steps", "error", "of speed", "ms");
  bool is_enough = true;
  for (const std::string& file : arguments.files) {
    if (interruptFlag().load(std::memory_order_relaxed)) return kExitInterrupted;
    const engine::DenseProblem problem = readContactProblem(file);
    const auto begin = std::chrono::steady_clock::now();
    const engine::DenseAnswer answer = engine::solveDense(problem, {.tolerance = 1e-13, .accuracy = 0});
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    const bool is_good = answer.natural_map <= arguments.enough;
    print("{:<{}} {:>8} {:>6} {:>11.2e} {:>11.2e} {:>9.1f}{}\n",
          printable(std::filesystem::path(file).filename().string()), width, problem.mu.size(),
          answer.result.iterations, answer.natural_map, answer.result.residual, took.count(),
          is_good ? "" : "  above --enough");
    is_enough = is_enough && is_good;
  }
  return is_enough ? kExitOk : kExitCheckFailed;
}

}  // namespace

void addSolveCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<SolveArguments>();
  CLI::App* command = app.add_subcommand("solve", "Contact problems from files");
  command->add_option("files", arguments->files, "Text files, a problem each")->required();
  command->add_option("--enough", arguments->enough, "What the error may be [-]")
      ->check(within(kEnough))
      ->capture_default_str();
  command->footer(kSolveExample);
  command->callback([arguments, &exit_code] { exit_code = runSolve(*arguments); });
}

}  // namespace pincer::tasks
