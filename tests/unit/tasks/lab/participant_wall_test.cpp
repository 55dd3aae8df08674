// A participant's answers come from the samples that it is given. That its files include nothing but devices/
// is the house's test (tests/house): here the participants are fed by hand, with no world at all.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pincer/tasks/lab/experiments/solids.h"
#include "pincer/tasks/lab/participants/known_solids.h"
#include "pincer/tasks/lab/participants/place_observer.h"
#include "pincer/tasks/lab/participants/shape_explorer.h"
#include "pincer/tasks/lab/participants/stroke_observer.h"

namespace pincer::tasks {
namespace {

// A tactor that follows the finger's pull `lag` milliseconds late, on a fingertip of 20 mm,
// and the push that the participant wants.
class LateTactor {
 public:
  explicit LateTactor(int lag) : past_(static_cast<std::size_t>(lag) + 1, 0.0) {}
  FingerPercept percept(const Vec3& p_D) {
    past_.push_back(-0.02 * p_D.y() / 0.12);
    FingerPercept percept;
    percept.arm.valid = percept.tactile.valid = true;
    percept.arm.p_DF = p_D;
    percept.f_D = Vec3(0, 0, StrokeLimits{}.press);
    percept.tactile.place_L = Vec2(past_[past_.size() - past_lag_], 0);
    return percept;
  }
  void setLag(int lag) { past_lag_ = static_cast<std::size_t>(lag) + 1; }

 private:
  std::vector<double> past_;
  std::size_t past_lag_ = 1;
};

// The answer when the tactor is `first` ms late in the first interval and `second` in the other.
int laterOf(StrokeObserver& observer, std::uint64_t seed, int first, int second) {
  StrokeCues cues;
  cues.seed = seed;
  cues.strokes = 2;
  cues.question = StrokeQuestion::kLater;
  observer.begin(cues);
  LateTactor tactor(200);
  Vec3 p_D = Vec3::Zero();
  int intervals = 0;
  Cue cue = Cue::kStart;
  for (int tick = 0; tick < 60'000; ++tick) {
    tactor.setLag(intervals == 0 ? first : second);
    const OneFingerAction action = observer.act(tactor.percept(p_D), 1e-3 * tick, cue);
    p_D = action.pull.p_D;
    cue = Cue::kNone;
    if (action.interval_over && ++intervals == 1) cue = Cue::kStart;
    if (action.answered) return observer.answer();
  }
  return 0;
}

double shareRight(const StrokeLimits& limits, int added, int trials) {
  int right = 0;
  for (int k = 0; k < trials; ++k) {
    StrokeObserver observer(7, limits);
    const bool second = k % 2;
    right +=
        laterOf(observer, static_cast<std::uint64_t>(k), second ? 0 : added, second ? added : 0) == (second ? 2 : 1);
  }
  return static_cast<double>(right) / trials;
}

StrokeLimits withoutSpread() {
  StrokeLimits limits;
  limits.sensitivity_spread = 0;
  return limits;
}

// d' follows from the limits alone: a pure delay D shifts the mean lag by D, so P(right) = Phi(D / (sqrt(2) sigma)).
TEST(ParticipantWall, DelayIsFeltAsWellAsTheLimitsSay) {
  StrokeLimits limits = withoutSpread();
  limits.lag.difference = 0;
  const int trials = 200, delay = 80;
  const double expected = 0.5 * std::erfc(-0.080 / (2 * limits.lag.time_sd));
  // 3 SD of a binomial
  EXPECT_NEAR(shareRight(limits, delay, trials), expected, 3 * std::sqrt(expected * (1 - expected) / trials));
}

TEST(ParticipantWall, NothingIsLeftWhenTheNoiseDrownsIt) {
  StrokeLimits limits = withoutSpread();
  limits.lag.time_sd = 1e9;
  EXPECT_NEAR(shareRight(limits, 200, 100), 0.5, 0.15);  // 3 SD of a fair coin thrown 100 times
}

// A finger on two circles, one 20 mm aside and smaller, whose tactor is where the finger touches: with exact
// readings the match is the reference to within the hold's tolerance (0.1 mm), and that lies within 0.25 mm of
// the target, though the hand is elsewhere.
TEST(ParticipantWall, FindsThePlaceOfTheTactorAgainAndNotOfTheHand) {
  PlaceLimits limits;
  limits.reading_sd = limits.memory_draw = 0;
  PlaceObserver observer(1, limits);
  PlaceCues cues;
  cues.target = 2.8e-3;
  cues.paths[0].from = 0.3;
  cues.paths[1] = {{0, 0.02, 0}, 0.08, -0.3};
  observer.begin(cues);
  std::vector<double> entered, hand;
  FingerPercept percept;
  percept.tactile.valid = true;
  percept.tactile.place_L = Vec2::Zero();
  Cue cue = Cue::kStart;
  for (int tick = 0; tick < 60'000; ++tick) {
    const OneFingerAction action = observer.act(percept, 1e-3 * tick, cue);
    cue = action.interval_over ? Cue::kStart : Cue::kNone;
    const PlacePath& path = cues.paths[entered.size() < 1 ? 0 : 1];
    const Vec3 from_centre = action.pull.p_D - path.centre_W;
    percept.tactile.place_L = Vec2(-0.013 * std::atan2(from_centre.y(), from_centre.z()), 0);
    if (action.enters) entered.push_back(percept.tactile.place_L->x()), hand.push_back(action.pull.p_D.y());
    if (action.answered) break;
  }
  ASSERT_EQ(entered.size(), 2u);
  EXPECT_NEAR(entered[0], cues.target, cues.tolerance);
  EXPECT_NEAR(entered[1], entered[0], limits.match_tolerance);
  EXPECT_GT(std::abs(hand[1] - hand[0]), 0.01);
}

// A sine of amplitude 1 in the middle of the band passes with the filters' own gain, and one far outside hardly at all.
TEST(ParticipantSkin, BandsLetTheirOwnFrequenciesThrough) {
  const auto rms = [](double frequency, double low, double high) {
    BandPower band(low, high);
    for (int k = 0; k < 4000; ++k) band.add(std::sin(2 * std::numbers::pi * frequency * 1e-3 * k), k > 2000);
    return band.rms();
  };
  // Skirts of third order below and second above: (1 + (5/16)^2)^(-3/2) / (1 + (16/50)^2) = 0.79
  // in the middle; 10 % for the step of 1 ms.
  EXPECT_NEAR(rms(16, 5, 50), 0.79 / std::numbers::sqrt2, 0.08);
  EXPECT_LT(rms(0.5, 5, 50), 0.001 / std::numbers::sqrt2 * 1.1);  // (f / f1)^3
  EXPECT_LT(rms(400, 5, 50), 0.05);
}

// A push that stays bends the skin by f / k, whatever the mass.
TEST(ParticipantSkin, SettlesAtForceOverStiffness) {
  PushedSkin skin(SkinLimits{});
  Vec2 u = Vec2::Zero();
  for (int k = 0; k < 3000; ++k) u = skin.pushed({0.2, -1});
  EXPECT_NEAR(u.x(), 0.2e-3, 1e-9);
  EXPECT_NEAR(u.y(), -1e-3, 1e-9);
}

// Place of the roller for a contact in this direction of the finger, as far as it goes.
Vec2 placeShown(const Vec3& to_contact_F, const ShapeCues& cues) {
  const double place = cues.tip_radius * std::atan2(to_contact_F.x(), -to_contact_F.z());
  return {std::clamp(place, -cues.tactor_reach, cues.tactor_reach), 0};
}

// A finger that keeps to a solid, pushed off along its normal, as long as the
// explorer wants; the name that it then gives.
int answerAbout(const KnownSolid& solid, std::uint64_t seed, bool display) {
  ShapeExplorer explorer(1);
  ShapeCues cues;
  cues.seed = seed;
  explorer.begin(cues);
  FingerPercept percept;
  percept.arm.valid = true;
  percept.arm.p_DF = Vec3(0, 0, 0.09);
  constexpr double kTick = 0.01;
  for (int tick = 0; tick < 20'000; ++tick) {
    const OneFingerAction action = explorer.act(percept, kTick * tick, tick == 0 ? Cue::kStart : Cue::kNone);
    if (action.answered) break;
    const Vec3 aim = action.pull.p_D, away = aim - solid.nearest(aim);
    const double depth = cues.tip_radius - away.norm();
    percept.arm.p_DF = depth > 0 ? Vec3(aim + depth * solid.outward(aim)) : aim;
    percept.f_D = depth > 0 ? Vec3(400 * depth * solid.outward(aim)) : Vec3::Zero();
    if (!display) continue;
    percept.tactile.valid = true;
    percept.tactile.place_L = placeShown(action.q_WF->conjugate() * -solid.outward(aim), cues);
  }
  return explorer.answer();
}

int rightAnswers(bool display) {
  int right = 0;
  for (const LyingSolid& lying : lyingSolids()) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) right += answerAbout(lying.solid, seed, display) == lying.name;
  }
  return right;
}

// The hand's misplacement of 7 mm per axis is the same for all readings of a trial; taken for
// noise of each, it made the solids look alike.
TEST(ShapeExplorer, IsNotMisledByAMisplacementThatStays) { EXPECT_GE(rightAnswers(false), 190); }

// Who feels more can't know less: places of a roller at its stop, taken for directions, once made answers worse.
TEST(ShapeExplorer, IsNotMisledByTheDisplay) {
  constexpr int kByChance = 20;  // of 280: two standard deviations of the difference of two such counts
  EXPECT_GE(rightAnswers(true), rightAnswers(false) - kByChance);
}

const KnownSolid& firstOf(const std::vector<LyingSolid>& all, const std::string& name) {
  return std::find_if(all.begin(), all.end(),
                      [&](const LyingSolid& s) { return kSolidNames[static_cast<std::size_t>(s.name)] == name; })
      ->solid;
}

TEST(KnownSolids, DistancesAreThoseOfTheClosedForms) {
  const auto all = lyingSolids();
  const auto off = [&](const char* name, const Vec3& p) { return (p - firstOf(all, name).nearest(p)).norm(); };
  EXPECT_NEAR(off("sphere", {0.05, 0, 0}), 0.01, 1e-12);
  EXPECT_NEAR(off("cylinder", {0.01, 0.03, 0.04}), 0.01, 1e-12);                         // 0.05 from the axis
  EXPECT_NEAR(off("cylinder", {0.043, 0.033, 0.044}), std::hypot(0.003, 0.015), 1e-12);  // beyond the rim
  EXPECT_NEAR(off("cone", {0.07, 0, 0}), 0.03, 1e-12);                                   // beyond the tip, on the right
  // beside: 20 mm of radius there, steepness 1 : 2
  EXPECT_NEAR(off("cone", {0, 0, 0.05}), 0.03 * 2 / std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(off("tetrahedron", {0.06, 0, 0}), 0.02, 1e-3);  // projections to a fraction of a millimetre
  EXPECT_NEAR(off("octagon", {0, 0, 0.05}), 0.05 - 0.04 * std::cos(std::numbers::pi / 8), 1e-12);  // over a face
  EXPECT_LT((firstOf(all, "cube").outward({0.028, 0, 0}) - Vec3::UnitX()).norm(), 1e-9);
}

// Every solid lies as it is rendered in one of its ways: the nearest points of both agree on the vertices of its mesh.
TEST(KnownSolids, AreTheSolidsThatAreShown) {
  int shown = 0;
  for (const LyingSolid& lying : lyingSolids()) {
    if (lying.way != 0) continue;
    ++shown;
    const auto mesh = makeSolid(kSolidNames[static_cast<std::size_t>(lying.name)], false, {});
    double worst = 0;
    for (const Vec3& vertex : mesh->triangles().vertices)
      worst = std::max(worst, (vertex - lying.solid.nearest(vertex)).norm());
    EXPECT_LT(worst, 1e-4) << kSolidNames[static_cast<std::size_t>(lying.name)];
  }
  EXPECT_EQ(shown, 7);
}

}  // namespace
}  // namespace pincer::tasks
