// expectation: what must be true of a scene, so that a scene is also a regression test.
//
//   ==  |measured - value| <= tolerance        <=  measured <= value + tolerance
//                                                  >=  measured >= value - tolerance
//   hash  every bit of the state is as it was when the hash was taken (engine::hashOf)
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pincer/tasks/run/quantity.h"

namespace pincer::tasks {

enum class Relation : std::uint8_t { kEqual, kAtMost, kAtLeast };
constexpr std::string_view kRelationNames[] = {"==", "<=", ">="};  // by Relation, as scenes write them

struct Expectation {
  Quantity quantity;
  Relation relation = Relation::kEqual;
  double value = 0;
  double tolerance = 0;         // >= 0, in the quantity's unit
  std::int64_t tick = kAlways;  // when it must hold
  double time = 0;              // the same as time [s]
  std::string because;          // why it must be so; may be empty
  // of the state, 16 hexadecimal digits, in place of the quantity; empty: not taken yet
  std::optional<std::string> hash;
  int hash_line = 0;  // in the file

  static constexpr std::int64_t kAlways = -1;  // at the start and after every tick

  // By how much `measured` misses [unit of the quantity]; not positive when it
  // holds, infinite when `measured` is no number.
  double excess(double measured) const;
};

// Outcome of one expectation.
struct Outcome {
  bool reached = false;  // the run came as far as its time
  double measured = 0;   // at its time; of "always", the worst one
  double worst_excess = 0;
  double worst_time = 0;  // [s]
  std::string hash;       // measured, where one is expected

  bool holds() const { return reached && worst_excess <= 0; }
};

// Follows a run and remembers what came of each expectation.
class ExpectationLog {
 public:
  explicit ExpectationLog(std::vector<Expectation> expectations);

  void observe(std::int64_t tick, double time, const Moment& moment);

  const std::vector<Expectation>& expectations() const { return expectations_; }
  const std::vector<Outcome>& outcomes() const { return outcomes_; }
  bool anyFailed() const;  // among those that were reached

 private:
  std::vector<Expectation> expectations_;
  std::vector<Outcome> outcomes_;
};

}  // namespace pincer::tasks
