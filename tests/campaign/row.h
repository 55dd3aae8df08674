// row: one kind of harm that the campaign does, over and over. Each case draws what it does from (seed, row, number)
// and nothing else, so that a case can be repeated alone.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "pincer/tests/campaign/program_run.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::campaign {

namespace fs = std::filesystem;
using tests::RandomNumbers;

// How a run ended, or what was wrong with it.
enum class Verdict { kFine, kRefused, kStopped, kCrashed, kHung, kLost, kWrong };
inline constexpr std::array<const char*, 7> kVerdictNames = {"fine", "refused", "stopped", "crashed",
                                                             "hung", "lost",    "wrong"};
inline bool isFault(Verdict v) { return v >= Verdict::kCrashed; }

struct Fault {
  std::string row;
  int number = 0;  // of the case
  Verdict verdict = Verdict::kWrong;
  std::string why, command;
};

struct Tally {
  std::array<std::int64_t, 7> counts{};
  std::int64_t cases = 0, runs = 0;  // runs of programs, or executions of a parser
  double seconds = 0;
  std::vector<Fault> faults;
  std::string skipped;    // why the row, or a part of it, wasn't done
  std::int64_t hits = 0;  // of the cases whose harm may come too late: in so many it came
};

// Programs and files that all cases share.
struct Ground {
  fs::path pincer, build, source, out;
  std::uint64_t seed = 1;
  double times = 1;
  double session_time = 1;                            // of a processor, that the session of inputs.h takes [s]
  bool has_devices = false;                           // real ones are attached: nothing may move them
  fs::path inputs() const { return out / "inputs"; }  // made once, never changed by a case
};

struct Expect {
  std::string name = {};  // that a refusal must mention, for example the file's
  std::set<int> codes = {0, 1, 2, 3, 4, 5};
  std::vector<int> signals = {};  // that may end it besides the one that asked it to stop
  bool may_be_silent = false;     // standard error couldn't be written
  bool may_leave_parts = false;   // nothing can be removed
  bool may_keep_journal = false;  // nothing can be written: half a change is undone by whoever opens the database next
  long most_memory = 1'500;       // resident [MB]
};

class Case {
 public:
  Case(const Ground& ground, std::string row, int number, Tally& tally);
  Case(Case&&) = delete;
  ~Case();  // removes its folder unless something was wrong

  const Ground& ground;
  const int number;
  RandomNumbers random;
  const fs::path folder;  // its own, empty at first; programs run in it

  // The program in the folder with these arguments.
  Launch pincer(std::vector<std::string> arguments) const;
  // Runs, judges and counts it.
  Ended run(const Launch& launch, const Expect& expect = {});
  // Runs and counts it; judges only that it ended by itself or by `expect.signals`.
  Ended runUnjudged(const Launch& launch);
  void judge(const Launch& launch, const Ended& ended, const Expect& expect);

  void fault(Verdict verdict, const std::string& why, const std::string& command);
  void fault(Verdict verdict, const std::string& why) { fault(verdict, why, last_command_); }
  void count(Verdict verdict, std::int64_t runs = 1);
  void spend(double seconds) { tally_.seconds += seconds; }
  void skip(const std::string& why) { tally_.skipped = why; }
  void hit() { ++tally_.hits; }
  bool faulty() const { return faulty_; }

  fs::path write(const std::string& name, const std::string& bytes) const;  // into the folder; the path
  int below(std::size_t n) { return random.below(static_cast<int>(n)); }
  template <class T>
  const T& anyOf(const std::vector<T>& choices) {
    return choices.at(static_cast<std::size_t>(below(choices.size())));
  }
  bool chance(double p) { return random.uniform(0, 1) < p; }

 private:
  fs::path log_;
  std::string row_, last_command_;
  Tally& tally_;
  int launches_ = 0;
  bool faulty_ = false;
};

struct Row {
  std::string name, what;
  int usual;  // cases at --times 1
  void (*act)(Case&);
  int (*all)(const Ground&) =
      nullptr;  // how many there are, if they can be listed: then at most these at --times 1, drawn without repetition
};

// In the order in which they run.
const std::vector<Row>& rows();

// Place `k` of a list of `size` in an order that the seed scatters: the first `size` places are all different.
std::size_t scattered(const Ground& ground, int k, std::size_t size);

std::string readFile(const fs::path& file);

}  // namespace pincer::campaign
