// sweep_machines: ready files for those who have several machines: a list of commands
// for GNU parallel, a job array for Slurm.
//
// Both run one shard per job, into DIR/shard-I, with --resume, so that a job which
// was killed or requeued goes on; then merge.
#pragma once
#include <string>
#include <vector>

namespace pincer::tasks {

struct MachinePlan {
  std::vector<std::string> command;  // the sweep: program, `sweep` and all arguments but those that this adds
  std::string out;                   // DIR
  int shards = 2;
  int threads = 1;                     // per job
  std::string time_limit = "1:00:00";  // per job, as Slurm has it
};

// For `parallel < FILE`.
std::string parallelFile(const MachinePlan& plan);
// For `sbatch FILE`.
std::string slurmFile(const MachinePlan& plan);

// The arguments as a shell takes them.
std::string shellText(const std::vector<std::string>& arguments);

}  // namespace pincer::tasks
