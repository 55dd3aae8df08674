#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>

#include "pincer/tasks/lab/experiments/sphere_pickup.h"

namespace pincer::tasks {
namespace {

TEST(SpherePickupTrials, HoldEveryFrictionEquallyOftenInEachCondition) {
  SpherePickupOptions options;
  options.participants = 3;
  std::map<std::tuple<std::int64_t, std::string, double>, int> counts;
  for (const auto& trial : pickupTrials(options)) {
    ++counts[{trial.participant, trial.condition.name, trial.mu_s}];
    EXPECT_EQ(trial.mu_d, 0.85 * trial.mu_s);
  }
  EXPECT_EQ(counts.size(), 3u * 2 * 4);
  for (const auto& [key, count] : counts) EXPECT_EQ(count, 5);
}

TEST(SpherePickupTrials, AreNumberedAndSeededEachForItself) {
  SpherePickupOptions options;
  options.participants = 2;
  const auto trials = pickupTrials(options);
  std::set<std::uint64_t> seeds;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    EXPECT_EQ(trials[i].trial, static_cast<std::int64_t>(i));
    EXPECT_EQ(trials[i].index, static_cast<std::int64_t>(i % 40));
    seeds.insert(trials[i].seed);
  }
  EXPECT_EQ(seeds.size(), trials.size());
}

TEST(SpherePickupTrials, DoOneConditionThenTheOtherAndBalanceWhichIsFirst) {
  SpherePickupOptions options;
  options.participants = 4;
  const auto trials = pickupTrials(options);
  for (const auto& trial : trials) {
    const bool first_half = trial.index < 20, even = trial.participant % 2 == 0;
    EXPECT_EQ(trial.condition.name == "force", first_half == even);
  }
}

std::vector<double> orderOf(const SpherePickupOptions& options) {
  std::vector<double> order;
  for (const auto& trial : pickupTrials(options)) order.push_back(trial.mu_s);
  return order;
}

TEST(SpherePickupTrials, AreShuffledByTheSeed) {
  SpherePickupOptions options, other;
  other.seed = 2;
  EXPECT_EQ(orderOf(options), orderOf(options));
  EXPECT_NE(orderOf(options), orderOf(other));
  const auto order = orderOf(options);
  EXPECT_NE(std::vector<double>(order.begin(), order.begin() + 20),
            std::vector<double>(order.begin() + 20, order.end()));
  EXPECT_FALSE(std::is_sorted(order.begin(), order.begin() + 20));
}

// Over many seeds each friction comes first equally often: 400 draws of 1/4 have SD 8.7; five of them.
TEST(SpherePickupTrials, FavourNoFriction) {
  std::map<double, int> first;
  SpherePickupOptions options;
  for (options.seed = 0; options.seed < 400; ++options.seed) ++first[pickupTrials(options).front().mu_s];
  for (const auto& [mu, count] : first) EXPECT_NEAR(count, 100, 44) << mu;
}

struct BadOption {
  const char* named;
  std::function<void(SpherePickupOptions&)> set;
};

TEST(SpherePickupOptions, OutOfRangeAreRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<BadOption> bad = {
      {"radius = -0.02", [](auto& o) { o.radius = -0.02; }},
      {"radius = 20", [](auto& o) { o.radius = 20; }},
      {"mass = nan", [&](auto& o) { o.mass = nan; }},
      {"frictions = -1",
       [](auto& o) {
         o.frictions = {0.5, -1};
       }},
      {"frictions is empty", [](auto& o) { o.frictions.clear(); }},
      {"dynamic_ratio = 1.5", [](auto& o) { o.dynamic_ratio = 1.5; }},
      {"torsion_radius", [](auto& o) { o.torsion_radius = 3.3; }},
      {"dish_radius", [](auto& o) { o.dish_radius = 0.01; }},
      {"dish_friction", [](auto& o) { o.dish_friction = -0.1; }},
      {"finger_radius", [](auto& o) { o.hand.finger_radius = 0; }},
      {"coupling_stiffness", [](auto& o) { o.hand.coupling_stiffness = 1e6; }},
      {"coupling_damping", [](auto& o) { o.hand.coupling_damping = -1; }},
      {"success_height", [](auto& o) { o.success_height = 50; }},
      {"hold_time", [](auto& o) { o.hold_time = -1; }},
      {"timeout = 0", [](auto& o) { o.timeout = 0; }},
      {"repetitions = 0", [](auto& o) { o.repetitions = 0; }},
      {"participants = -3", [](auto& o) { o.participants = -3; }},
      {"conditions is empty", [](auto& o) { o.conditions.clear(); }},
      {"given twice",
       [](auto& o) {
         o.conditions = {HandCondition{}, HandCondition{}};
       }},
  };
  for (const auto& [named, set] : bad) {
    SpherePickupOptions options;
    set(options);
    try {
      pickupTrials(options);
      ADD_FAILURE() << named << " was accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    }
  }
}

// Whoever adds a condition to a study, or leaves one out, finds the same trials in the others.
TEST(SpherePickupTrials, AreSeededByTheNameOfTheirCondition) {
  SpherePickupOptions two, three;
  three.conditions.push_back({"heavy", "heavy", true, HandShading::kTask, 2});
  std::map<std::string, std::vector<double>> orders_of_two, orders_of_three;
  for (const auto& trial : pickupTrials(two)) orders_of_two[trial.condition.name].push_back(trial.mu_s);
  for (const auto& trial : pickupTrials(three)) orders_of_three[trial.condition.name].push_back(trial.mu_s);
  EXPECT_EQ(orders_of_three.size(), 3u);
  for (const auto& [name, order] : orders_of_two) EXPECT_EQ(orders_of_three[name], order) << name;
  EXPECT_NE(orders_of_three["heavy"], orders_of_three["cld+force"]);
}

TEST(SpherePickupOptions, AreThoseOfTheConditionWhileItLasts) {
  const SpherePickupOptions heavy = inCondition(SpherePickupOptions{}, {"a", "", true, HandShading::kFacet, 2});
  EXPECT_DOUBLE_EQ(heavy.mass, 0.150);
  EXPECT_EQ(heavy.shading, contact::SurfaceVariant::facet);
  EXPECT_FALSE(inCondition(SpherePickupOptions{}, {"a", "", true, HandShading::kExactly, 1}).shading);
  SpherePickupOptions mesh;
  mesh.object = ObjectFile{"mug.obj"};
  EXPECT_EQ(inCondition(mesh, {"a", "", true, HandShading::kForce, 1}).object->shading, contact::SurfaceVariant::force);
  EXPECT_THROW(inCondition(mesh, {"a", "", true, HandShading::kExactly, 1}), InputError);
}

}  // namespace
}  // namespace pincer::tasks
