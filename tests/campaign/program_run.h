// program_run: one run of a program as a black box: its arguments, surroundings and limits go
// in; how it ended and what it said come out.
//
// The program leads a process group of its own, so that what it started ends with it. Over its time limit it is asked
// to stop by a signal; if it hasn't ended `grace` seconds later, it is killed and counts as hung. Time in which it
// stood ready and others had the processors doesn't count: a busy machine is no fault of the program.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pincer::campaign {

enum class Stream { kNothing, kKept, kClosed, kFull, kBrokenPipe };  // kNothing: /dev/null; kFull: /dev/full

struct Blow {
  int signal = 9;
  double after = 0;  // [s] since the start, as the time limit is counted
};

struct Launch {
  std::string program;
  std::vector<std::string> arguments;  // without the program's name
  std::filesystem::path folder;        // where it runs
  std::filesystem::path log;           // folder for what it says: files stdout, stderr
  std::vector<std::pair<std::string, std::optional<std::string>>> environment;  // set, or unset where there is no value
  Stream in = Stream::kNothing, out = Stream::kKept, error = Stream::kKept;
  double limit = 10;              // [s]
  double grace = 15;              // [s]; a busy machine answers late
  int stop_signal = 15;           // SIGTERM
  std::optional<Blow> blow = {};  // what hits it while it runs
  long most_memory = 4'000;       // address space [MB]; 0: no limit
  long largest_file = 0;          // [bytes]; 0: no limit
  bool owner_rights = false;      // without root's right to read and write everything
};

double now();  // of the steady clock [s]

struct Ended {
  int exit_code = 0;     // if it ended by itself
  int signal = 0;        // that ended it; 0: none
  bool stopped = false;  // was asked to stop, over its time limit
  bool struck = false;   // was still there for the blow
  bool hung = false;
  double seconds = 0;
  long peak_memory = 0;    // resident [kB]
  std::string out, error;  // at most the first kMostText bytes
};
inline constexpr std::size_t kMostText = 1 << 20;

Ended run(const Launch& launch);

// As a shell would take it.
std::string shellText(const Launch& launch);

// In the background, for two programs at once.
class RunningProgram {
 public:
  explicit RunningProgram(const Launch& launch);
  RunningProgram(RunningProgram&& other) noexcept;
  RunningProgram& operator=(RunningProgram&&) = delete;
  ~RunningProgram();  // killed if nobody waited for it
  Ended wait();

 private:
  // True once it has ended, false `time` [s] after its start, not counting what it waited for a processor.
  bool endsWithin(double time) const;

  Launch launch_;
  int process_ = -1, handle_ = -1;
  double began_ = 0;
};

}  // namespace pincer::campaign
