// synthetic_session: a sphere-pickup session that no physics made, for tests of the store and the report. Made
// to look like the real thing: reaches, squeezes that slip out, a lift to 50 mm, tactors that follow with
// delay. The same seed gives the same session.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "pincer/tasks/run/session_store.h"

namespace pincer::tests {

struct SyntheticPlan {
  std::uint64_t seed = 1;
  int participants = 1;
  int repetitions = 5;
  std::vector<std::string> conditions{"force", "cld+force"};
  std::vector<double> frictions{0.30, 0.45, 0.60, 0.90};
  double rate = 1000;  // samples per second
};

class SyntheticSession {
 public:
  explicit SyntheticSession(SyntheticPlan plan) : plan_(std::move(plan)), random_(plan_.seed) {}

  static tasks::SessionInfo info(std::uint64_t seed = 1) {
    return {"sphere-pickup",
            seed,
            "0.1.0",
            "g++ 12.2.0 -O2 & <tests>",
            R"({"bodies": [{"shape": "sphere", "radius": 0.02}]})",
            R"({"repetitions": 5})",
            R"({"arms": "simulated"})",
            R"({"strategy": "none"})",
            "0"};
  }

  // All trials of the plan, in order. Returns how many.
  std::int64_t writeTo(tasks::SessionWriter& out) {
    for (int participant = 0; participant < plan_.participants; ++participant) {
      std::int64_t index = 0;
      for (const std::string& condition : plan_.conditions) {
        for (const double mu : plan_.frictions) {
          for (int k = 0; k < plan_.repetitions; ++k) writeTrial(out, participant, condition, mu, index++);
        }
      }
    }
    return next_trial_;
  }

  void writeTrial(tasks::SessionWriter& out, std::int64_t participant, const std::string& condition, double mu,
                  std::int64_t index) {
    tasks::TrialRecord t;
    t.trial = next_trial_++;
    t.participant = participant;
    t.condition = condition;
    t.index = index;
    t.mu_s = mu;
    t.mu_d = 0.85 * mu;
    cld_ = condition.find("cld") != std::string::npos;
    failures_ = std::min(11, std::poisson_distribution<int>((cld_ ? 0.5 : 1.2) * 0.6 / mu)(random_));
    const bool timeout = failures_ == 11;
    start_ = time_;
    event(out, t.trial, "phase", "reach");
    seek(uniform(1.2, 2.2));
    for (int k = 0; k < failures_; ++k) failedTry(out, t);
    if (!timeout) finalLift(out, t);
    t.outcome = timeout ? "timeout" : "success";
    t.duration = time_ - start_;
    event(out, t.trial, t.outcome, "");
    flush(out, t);
    t.offset_at_squeeze = uniform(0.5e-3, 6e-3);
    t.tick_us_median = 14;
    t.tick_us_p999 = 41;
    out.finishTrial(t);
    time_ += 1;
  }

 private:
  static constexpr double kMass = 0.075, kGravity = 9.81, kRadius = 0.02;

  // The state of the little puppet show: a target for grip and height that the samples approach.
  struct Key {
    double until, grip, height, slide;
  };

  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  double normal(double sd) { return std::normal_distribution<double>(0, sd)(random_); }
  void event(tasks::SessionWriter& out, std::int64_t trial, const char* kind, const std::string& detail) {
    event(out, trial, std::string(kind), detail);
  }
  void event(tasks::SessionWriter& out, std::int64_t trial, const std::string& kind, const std::string& detail) {
    out.addEvent({trial, time_, kind, detail});
  }
  void key(double seconds, double grip, double height, double slide) {
    time_ += seconds;
    keys_.push_back({time_, grip, height, slide});
  }
  void seek(double seconds) { key(seconds, 0, 0, 0); }

  void failedTry(tasks::SessionWriter& out, tasks::TrialRecord& t) {
    const double grip = uniform(0.5, 0.9) * kMass * kGravity / (2 * t.mu_s) + 0.3;
    const double height = uniform(0, 1) < 0.3 ? uniform(6e-3, 12e-3) : uniform(0, 2e-3);
    ++t.squeezes;
    event(out, t.trial, "squeeze", "");
    key(uniform(0.3, 0.6), grip, 0, 0);
    key(uniform(0.3, 0.6), grip, height, 0);
    ++t.slips;
    event(out, t.trial, "slip", "thumb");
    key(uniform(0.08, 0.2), 0.8 * grip, 0.5 * height, 1);
    if (height > 1e-3) ++t.lifts;
    if (height > 5e-3) {
      ++t.tries_5mm;
      ++t.drops;
      event(out, t.trial, "drop", "");
    }
    key(0.05, 0, 0, 1);
    seek(uniform(0.8, 1.8));
  }

  void finalLift(tasks::SessionWriter& out, tasks::TrialRecord& t) {
    const double grip = uniform(1.3, 1.9) * kMass * kGravity / (2 * t.mu_s);
    ++t.squeezes;
    event(out, t.trial, "squeeze", "");
    key(0.5, grip, 0, 0);
    event(out, t.trial, "lift", "");
    key(1.2, grip, 0.055, 0);
    key(1.1, grip, 0.055, 0);
    ++t.lifts;
    ++t.tries_5mm;
    t.peak_grip = grip;
    t.grip_ratio = grip / (kMass * kGravity / (2 * t.mu_s));
  }

  void flush(tasks::SessionWriter& out, const tasks::TrialRecord& t) {
    tasks::SampleRecord s;
    double from_grip = 0, from_height = 0, from_time = start_;
    std::array<double, 2> shown{};
    const double phase = uniform(0, 6);
    for (const Key& k : keys_) {
      for (double now = from_time; now < k.until; now += 1 / plan_.rate) {
        const double u = (now - from_time) / (k.until - from_time), blend = u * u * u * (10 - 15 * u + 6 * u * u);
        fill(s, t, now, from_grip + blend * (k.grip - from_grip), from_height + blend * (k.height - from_height),
             k.slide, phase, shown);
        out.pushSample(s);
      }
      from_time = k.until;
      from_grip = k.grip;
      from_height = k.height;
    }
    keys_.clear();
  }

  void fill(tasks::SampleRecord& s, const tasks::TrialRecord& t, double now, double grip, double height, double slide,
            double phase, std::array<double, 2>& shown) {
    s.trial = t.trial;
    s.tick = tick_++;
    s.time = now;
    s.p_WB = {0, 0, kRadius + height};
    s.q_WB = {1, 0, 0, 0};
    s.tick_us = 13 + std::exp(normal(0.45)) + (uniform(0, 1) < 2e-3 ? uniform(10, 30) : 0);
    for (int f = 0; f < tasks::kRecordedFingers; ++f) {
      tasks::FingerRecord& r = s.fingers[static_cast<std::size_t>(f)];
      const double side = f == 0 ? -1 : 1;
      const bool touching = grip > 0.02;
      r.normal_force = touching ? std::max(0.0, grip + normal(0.01) + 0.03 * side) : 0;
      r.tangential_force = touching ? (slide > 0 ? t.mu_d * r.normal_force
                                                 : std::min(0.5 * kMass * kGravity, 0.95 * t.mu_s * r.normal_force))
                                    : 0;
      r.gap = touching ? 0 : 5e-3;
      r.flags = (touching ? 1 : 0) | (touching && slide > 0 ? 2 : 0) | (cld_ ? 0 : 8);
      r.p_WF = {side * (kRadius + 8e-3 - 2e-3 * grip), 0, kRadius + height};
      r.p_WP = {side * (kRadius + 8e-3), 0, kRadius + height};
      r.f_contact_W = {side * r.normal_force, 0, -r.tangential_force};
      r.f_arm_D = r.f_contact_W;
      for (std::size_t a = 0; a < 2; ++a) {
        r.place_wanted_L[a] =
            cld_ ? 3.5e-3 * std::sin(1.3 * (now - start_) + phase + 1.2 * f + 0.9 * static_cast<double>(a)) : 0;
        if (f == 0) shown[a] += (r.place_wanted_L[a] - shown[a]) * std::min(1.0, 18 / plan_.rate);
        r.place_shown_L[a] = f == 0 ? shown[a] : (cld_ ? 0.92 * r.place_wanted_L[a] : 0);
      }
    }
  }

  SyntheticPlan plan_;
  std::mt19937_64 random_;
  std::vector<Key> keys_;
  double time_ = 0, start_ = 0;
  std::int64_t next_trial_ = 0, tick_ = 0;
  int failures_ = 0;
  bool cld_ = false;
};

}  // namespace pincer::tests
