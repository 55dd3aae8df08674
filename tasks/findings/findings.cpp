#include "tasks/findings/findings.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <exception>
#include <map>
#include <mutex>
#include <sstream>
#include <thread>

#include "tasks/experiments/row_sink.h"
#include "tasks/experiments/simulated_trial.h"
#include "tasks/measure/timing.h"

namespace pincer::tasks {
namespace {

constexpr double kSignificant = 0.05;
constexpr int kFewest = 4;      // with fewer not even all of them are certainly more than half (Wilson)
constexpr double kRate = 1000;  // [Hz]

ManipulationStudy studyOf(const FindingsOptions& options, const FindingsVariant& variant, int experiment) {
  ManipulationStudy study;
  study.participants = options.participants;
  study.seed = seedFor(options.seed, static_cast<std::uint64_t>(experiment));
  study.training = {0, 0};
  study.pickup.repetitions = options.pickups;
  study.alignment.repetitions = options.alignments;
  variant.change(study);
  return study;
}

// One participant of one experiment of one variant.
struct Job {
  std::size_t variant = 0;
  int experiment = 0;
  std::int64_t person = 0;
};

class Workshop {
 public:
  Workshop(const FindingsOptions& options, std::vector<const FindingsVariant*> variants, const std::atomic<bool>& interrupted,
           const std::function<void(std::int64_t, std::int64_t)>& progress)
      : options_(options), variants_(std::move(variants)), interrupted_(interrupted), progress_(progress), object_(makePickupObject({})) {
    for (std::size_t v = 0; v < variants_.size(); ++v) {
      means_.emplace_back(static_cast<std::size_t>(experimentsOf(v)), People());
      if (isPrimary(v)) addExperiments(v, 0, options.experiments);
    }
    for (int e = 0; e < options.control_experiments; ++e) {
      for (std::size_t v = 0; v < variants_.size(); ++v) {
        if (!isPrimary(v)) addExperiments(v, e, e + 1);
      }
    }
  }

  void run() {
    std::vector<std::thread> threads;
    for (int t = 0; t < options_.threads; ++t) threads.emplace_back([this] { work(); });
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
  }

  // The experiments whose participants have all been simulated: all of them, unless the work was interrupted.
  std::vector<std::vector<PersonMeans>> whole(std::size_t variant) const {
    std::vector<std::vector<PersonMeans>> experiments;
    for (const People& people : means_[variant]) {
      if (people.size() < static_cast<std::size_t>(options_.participants)) continue;
      experiments.emplace_back();
      for (const auto& [person, means] : people) experiments.back().push_back(means);
    }
    return experiments;
  }
  double simulated() const { return simulated_; }

 private:
  using People = std::map<std::int64_t, PersonMeans>;

  bool isPrimary(std::size_t v) const { return variants_[v] == &findingsVariants().front(); }
  int experimentsOf(std::size_t v) const { return isPrimary(v) ? options_.experiments : options_.control_experiments; }
  void addExperiments(std::size_t v, int first, int end) {
    for (int e = first; e < end; ++e) {
      for (int p = 0; p < options_.participants; ++p) jobs_.push_back({v, e, p});
    }
  }

  void work() {
    try {
      for (std::size_t k = next_++; k < jobs_.size(); k = next_++) {
        PersonMeans means = meansOf(jobs_[k]);
        if (interrupted_) return;  // half a person
        finish(jobs_[k], std::move(means));
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      next_ = jobs_.size();
    }
  }

  PersonMeans meansOf(const Job& job) {
    const ManipulationStudy study = studyOf(options_, *variants_[job.variant], job.experiment);
    RowSink sink;
    double simulated = 0;
    for (const ManipulationTrial& trial : manipulationTrials(study)) {
      if (trial.participant() != job.person) continue;
      const std::unique_ptr<Participant> participant = makeParticipant(study, trial);
      SimulatedTrial cycle(makeTrial(study, object_, trial, sink), *participant);
      for (std::int64_t tick = 0; cycle.tick(static_cast<double>(tick) / kRate) && !interrupted_;) ++tick;
      cycle.finish();
      simulated += cycle.trial().simulatedTime();
    }
    const std::lock_guard lock(mutex_);
    simulated_ += simulated;
    return personMeans(sink.rows);
  }

  void finish(const Job& job, PersonMeans means) {
    const std::lock_guard lock(mutex_);
    means_[job.variant][static_cast<std::size_t>(job.experiment)].emplace(job.person, std::move(means));
    ++done_;
    if (progress_) progress_(done_, static_cast<std::int64_t>(jobs_.size()));
  }

  const FindingsOptions& options_;
  std::vector<const FindingsVariant*> variants_;
  const std::atomic<bool>& interrupted_;
  const std::function<void(std::int64_t, std::int64_t)>& progress_;
  const PickupObject object_;
  std::vector<Job> jobs_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;  // guards the rest
  std::vector<std::vector<People>> means_;
  double simulated_ = 0;
  std::int64_t done_ = 0;
  std::exception_ptr failure_;
};

FindingResult summarise(const std::vector<std::vector<PersonMeans>>& experiments, std::size_t measure) {
  FindingResult result;
  std::vector<double> force, cld, difference, effect;
  for (const auto& people : experiments) {
    std::vector<double> a, b;
    for (const PersonMeans& person : people) {
      a.push_back(person.force[measure]);
      b.push_back(person.cld[measure]);
    }
    const PairedTest test = comparePairs(a, b);
    if (test.n == 0) continue;
    ++result.experiments;
    force.push_back(estimateMean(a).mean);
    cld.push_back(estimateMean(b).mean);
    difference.push_back(test.difference.mean);
    if (std::isfinite(test.effect)) effect.push_back(test.effect);
    const bool significant = test.p_t < kSignificant, less = test.difference.mean<0, more = test.difference.mean> 0;
    result.significant_t += significant;
    result.significant_w += test.p_wilcoxon < kSignificant;
    result.less += less;
    result.more += more;
    result.significant_less += significant && less;
    result.significant_more += significant && more;
  }
  result.force = estimateMean(force);
  result.cld = estimateMean(cld);
  result.difference = estimateMean(difference);
  result.effect = estimateMean(effect);
  return result;
}

void requireSizes(const FindingsOptions& o) {
  const auto require = [](const char* name, int value, int low, int high) {
    if (value >= low && value <= high) return;
    throw InputError(fmt::format("findings: {} = {} is out of range [{}, {}].", name, value, low, high));
  };
  require("experiments", o.experiments, 2, 1000);
  require("control_experiments", o.control_experiments, 2, 1000);
  require("participants", o.participants, 2, 60);
  require("pickups", o.pickups, 1, 100);
  require("alignments", o.alignments, 1, 100);
  require("threads", o.threads, 1, 256);
}

}  // namespace

bool isWanted(const std::string& name, const std::string& only) {
  std::istringstream parts(only);
  bool wanted = only.empty();
  for (std::string part; std::getline(parts, part, ',');) wanted = wanted || name.find(part) != std::string::npos;
  return wanted;
}

FindingsResult runFindings(const FindingsOptions& options, const std::atomic<bool>& interrupted,
                           const std::function<void(std::int64_t, std::int64_t)>& progress) {
  requireSizes(options);
  std::vector<const FindingsVariant*> chosen;
  for (const FindingsVariant& variant : findingsVariants()) {
    if (isWanted(variant.name, options.only)) chosen.push_back(&variant);
  }
  FindingsResult result{options, studyOf(options, findingsVariants().front(), 0), {}, 0, 0, 0, false};
  if (chosen.empty()) return result;
  const auto start = std::chrono::steady_clock::now();
  Workshop workshop(options, chosen, interrupted, progress);
  workshop.run();
  result.processor = processCpuSeconds();
  result.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.simulated = workshop.simulated();
  result.interrupted = interrupted;
  for (std::size_t v = 0; v < chosen.size(); ++v) {
    const auto experiments = workshop.whole(v);
    if (experiments.empty()) continue;
    VariantResult variant{chosen[v]->name, chosen[v]->what, hashOf(studyOf(options, *chosen[v], 0).people), {}};
    for (std::size_t m = 0; m < findingMeasures().size(); ++m) variant.findings.push_back(summarise(experiments, m));
    result.variants.push_back(std::move(variant));
  }
  return result;
}

std::string verdictOn(const FindingMeasure& measure, const FindingResult& r) {
  if (measure.expected == PublishedEffect::kNone) return "-";
  if (r.experiments < kFewest) return "too few experiments";
  if (measure.expected == PublishedEffect::kSame) {
    return wilsonInterval(r.significant_t, r.experiments).first <= kSignificant ? "follows" : "does not follow";
  }
  const bool less = measure.expected == PublishedEffect::kLess;
  if (wilsonInterval(less ? r.significant_less : r.significant_more, r.experiments).first > 0.5) return "follows";
  const double sign = less ? -1 : 1;
  return sign * r.difference.mean - r.difference.half_width > 0 ? "in the same direction only" : "does not follow";
}

}  // namespace pincer::tasks
