// Senses of a tactor's play and delay, and of a tactor that freezes before its end.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/tasks/lab/experiments/arc_study.h"
#include "pincer/tasks/lab/participants/stroke_senses.h"

namespace pincer::tasks {
namespace {

LagLimits exactStrokeSenses() {
  LagLimits limits;
  limits.way_sd = limits.place_sd = limits.time_sd = limits.difference = 0;
  return limits;
}

// The finger goes back 8 mm, the tactor by 0.5 of it less 1 mm of play, or less nothing.
TEST(PlaySense, FeelsWhatTheTactorLost) {
  PlaySense sense(exactStrokeSenses());
  Random random(1);
  for (const std::size_t interval : {0u, 1u}) {
    sense.clear();
    sense.stop(0, 0);
    sense.back(-8e-3, interval == 0 ? 3e-3 : 4e-3, 0.5, random);
    sense.read(interval);
  }
  EXPECT_EQ(sense.larger(), 1);
}

// P(right) = Phi(play / (sqrt(2) sigma)), sigma^2 = (g sigma_w)^2 + sigma_d^2 of one stop: the faster
// the tactor per finger, the less is noticed.
TEST(PlaySense, IsAsSureAsItsLimitsSay) {
  LagLimits limits;
  limits.difference = 0;
  const int trials = 4000;
  const auto shareRight = [&](double gain, double play) {
    Random random(7);
    int right = 0;
    for (int k = 0; k < trials; ++k) {
      PlaySense sense(limits);
      for (const std::size_t interval : {0u, 1u}) {
        sense.clear();
        sense.stop(0, 0);
        sense.back(-8e-3, gain * 8e-3 - (interval == 1 ? play : 0), gain, random);
        sense.read(interval);
      }
      right += sense.larger() == 2;
    }
    return static_cast<double>(right) / trials;
  };
  for (const double gain : {0.12, 1.0}) {
    const double sigma = std::hypot(gain * limits.way_sd, limits.place_sd);
    // 4 SD of 4000 answers
    EXPECT_NEAR(shareRight(gain, 0.5e-3), 0.5 * std::erfc(-0.5e-3 / (2 * sigma)), 0.03) << gain;
  }
}

// A tactor that moves at 10 mm/s until 30 ms after the hand's stop, felt every 0.2 mm, that is every 20 ms.
TEST(DelaySense, FeelsMotionAfterTheStopAndTheOnset) {
  const auto lag = [&](int late, bool onset) {
    DelaySense sense(exactStrokeSenses());
    Random random(1);
    for (const std::size_t interval : {0u, 1u}) {
      const int own = interval == 0 ? 30 : late;
      sense.clear();
      sense.handStarts(0, 0);
      for (int k = 0; k < 1500; ++k) {
        if (k == 1000) sense.handStops(1);
        sense.feel(1e-3 * k, 1e-5 * std::clamp(k - own, 0, 1000));
      }
      onset ? sense.takeOnset(1.5) : sense.takeStop();
      sense.read(interval, onset, random);
    }
    return sense.larger();
  };
  for (const bool onset : {false, true}) {
    EXPECT_EQ(lag(60, onset), 2) << onset;
    EXPECT_EQ(lag(1, onset), 1) << onset;
  }
}

// Of the front end the tactor freezes two thirds across its travel from where a sweep began, either way, and only a
// raised finger frees it; without it the whole travel is shown.
TEST(FrontEnd, TheTactorFreezesAtTwoThirdsOfASweepUntilTheFingerIsRaised) {
  struct Places final : StudySink {
    void sample(const SampleRecord& s) override {
      if (!(s.fingers[0].flags & 1)) return;
      low = std::min(low, s.fingers[0].place_wanted_L[0]);
      high = std::max(high, s.fingers[0].place_wanted_L[0]);
      held += std::abs(std::abs(s.fingers[0].place_wanted_L[0]) - 8e-3 / 3) < 1e-12;
      ++touching;
    }
    void event(const EventRecord&) override {}
    void response(const ResponseRecord&) override {}
    double low = 1, high = -1;
    int held = 0, touching = 0;
  };
  for (const std::size_t condition : {0u, 1u}) {
    ArcStudy study = delayStudy();
    study.participants = 1;
    study.conditions = {study.conditions[condition]};
    study.conditions[0].staircase.most_trials = 1;
    ArcExperiment experiment(study, {}, 10);
    Places places;
    const std::atomic<bool> no{false};
    runStudy(experiment, 1, {}, places, no);
    EXPECT_LT(places.low, -7e-3);
    EXPECT_GT(places.high, 7e-3);
    const double share = static_cast<double>(places.held) / places.touching;
    if (condition == 0) {
      EXPECT_EQ(places.held, 0);
    } else {
      EXPECT_GT(share, 0.15);  // a third of a sweep, less its share of rests
    }
  }
}

// On the cylinder the finger rolls, so that it goes less far for the same travel of the tactor; on the edge it doesn't.
TEST(StrokeObserver, RollsTheFingerWhereTheArmLetsIt) {
  StrokeObserver observer(3);
  StrokeCues cues;
  observer.begin(cues);
  EXPECT_EQ(observer.roll(), 0);
  cues.rolls = true;
  observer.begin(cues);
  EXPECT_GT(observer.roll(), 0);
  EXPECT_LT(observer.roll(), 1);
}

}  // namespace
}  // namespace pincer::tasks
