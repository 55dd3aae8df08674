#include "pincer/tasks/lab/sweep/sweep_machines.h"

#include <fmt/format.h>

namespace pincer::tasks {
namespace {

// Characters that a shell takes as they are.
constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";

std::string quotedWord(const std::string& word) {
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string shardCommand(const MachinePlan& plan, const std::string& index) {
  return fmt::format("{} --threads {} --shard {}/{} --out {}/shard-{} --resume", shellText(plan.command), plan.threads,
                     index, plan.shards, quotedWord(plan.out), index);
}

std::string mergeCommand(const MachinePlan& plan) {
  return fmt::format("{} sweep merge {}/shard-* --out {}", quotedWord(plan.command.at(0)), quotedWord(plan.out),
                     quotedWord(plan.out));
}

}  // namespace

std::string shellText(const std::vector<std::string>& arguments) {
  std::string text;
  for (const std::string& argument : arguments) text += (text.empty() ? "" : " ") + quotedWord(argument);
  return text;
}

std::string parallelFile(const MachinePlan& plan) {
  std::string text = fmt::format(
      "# A shard of the sweep per line. On this machine:   parallel --joblog {0}/joblog --retries 3 < FILE\n"
      "# On several, with pincer and {0} at the same paths: parallel --sshlogin HOST1,HOST2 --workdir $PWD --joblog "
      "{0}/joblog --retries 3 "
      "< FILE\n"
      "# What was killed goes on when the same is run again. When all are done:\n"
      "#   {1}\n",
      quotedWord(plan.out), mergeCommand(plan));
  for (int i = 1; i <= plan.shards; ++i) text += shardCommand(plan, std::to_string(i)) + "\n";
  return text;
}

std::string slurmFile(const MachinePlan& plan) {
  return fmt::format(
      "#!/bin/bash\n"
      "# A shard of the sweep per task of a job array:   sbatch FILE\n"
      "# A task that is killed is queued again and goes on. When all are done:\n"
      "#   {}\n"
      "#SBATCH --job-name=pincer-sweep\n"
      "#SBATCH --array=1-{}\n"
      "#SBATCH --ntasks=1\n"
      "#SBATCH --cpus-per-task={}\n"
      "#SBATCH --time={}\n"
      "#SBATCH --requeue\n"
      "#SBATCH --open-mode=append\n"
      "#SBATCH --output=pincer-sweep-%A_%a.log\n"
      "set -euo pipefail\n"
      "exec {}\n",
      mergeCommand(plan), plan.shards, plan.threads, plan.time_limit, shardCommand(plan, "\"$SLURM_ARRAY_TASK_ID\""));
}

}  // namespace pincer::tasks
