// findings: do the published findings of the two manipulation tasks follow from what people can feel, without tuning?
//
// A simulated experiment is the published design: 12 participants, two conditions, half of them in either order; each
// finding is judged on it as on the original, by a paired t-test and Wilcoxon's signed ranks over the participants
// (paired_test.h). Many experiments, each with other participants, tell how often it would come out significant.
// Controls repeat them with one thing changed; the same seeds give the same people.
//
// Published: A. J. Doxon, dissertation, University of Utah, 2014: fewer tries with the contact location display, pickup
// time unchanged, alignment error unchanged, alignment 7 s slower.
// Time-outs: person_means.h. Training is left out: these participants don't learn.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "pincer/tasks/lab/experiments/manipulation_study.h"
#include "pincer/tasks/lab/report/person_means.h"

namespace pincer::tasks {

struct FindingsVariant {
  const char *name, *what;
  std::function<void(ManipulationStudy&)> change;
};
const std::vector<FindingsVariant>& findingsVariants();  // the first is the primary analysis

struct FindingsOptions {
  int experiments = 20;
  int control_experiments = 10;
  int participants = 12;
  std::uint64_t seed = 1;
  int pickups = 1;     // repetitions of every friction per condition
  int alignments = 3;  // per condition
  int threads = 2;
  std::string only;  // variants whose name holds one of these, separated by commas; empty: all
};

// Throws InputError naming the first value out of range.
void validate(const FindingsOptions& options);

// The design of one experiment, counted from 0: its own people, each variant's the same.
ManipulationStudy experimentOf(const FindingsOptions& options, const FindingsVariant& variant, int experiment);

// `only`: parts of names, separated by commas; empty: all.
bool isWanted(const std::string& name, const std::string& only);

struct FindingResult {
  Estimate force, cld;                                        // over the experiments' means
  Estimate difference;                                        // cld - force, likewise
  Estimate effect;                                            // d_z
  int experiments = 0, significant_t = 0, significant_w = 0;  // at 0.05, two-sided, in either direction
  int less = 0, more = 0;                                     // experiments whose difference is negative, positive
  int significant_less = 0, significant_more = 0;             // of the t-test
};

struct VariantResult {
  std::string name, what, hash;            // of the participants' parameters
  std::vector<FindingResult> findings;     // one per measure
  std::vector<std::string> sessions = {};  // that it was judged by
};

// Results of the sessions of a variant's experiments; those that aren't whole are left out. No findings where none is.
// Throws InputError for one that can't be read.
VariantResult judgeVariant(const FindingsVariant& variant, const std::vector<std::string>& sessions);

struct FindingsResult {
  FindingsOptions options;
  ManipulationStudy study;              // of the primary analysis
  std::vector<VariantResult> variants;  // of which at least one experiment is whole
  double simulated = 0, wall = 0;       // of what ran now [s]
  double processor = 0;                 // time of all threads [s]
  bool interrupted = false;
};

// "follows", "does not follow", "in the same direction only", "too few
// experiments", or "-" where nothing was published.
std::string verdictOn(const FindingMeasure& measure, const FindingResult& result);

}  // namespace pincer::tasks
