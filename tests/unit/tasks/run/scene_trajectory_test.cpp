// Trajectories: the interpolations go where they should and their velocities are their positions' derivatives.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fstream>

#include "pincer/tasks/run/trajectory.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

TimedPoint at(double time, const Vec3& p_W) { return {time, p_W, Vec3::Zero()}; }

// Central difference; its error is d^3/6 p''' with p''' of the order 60 h/T^3 = 60 m/s^3
// here, so 1e-7, plus round-off of 1e-16/1e-4.
Vec3 slopeAt(const Trajectory& trajectory, double time) {
  constexpr double d = 1e-4;
  return (trajectory.at(time + d).p_W - trajectory.at(time - d).p_W) / (2 * d);
}

TEST(MinimumJerk, HasTheKnownValuesOfItsPolynomial) {
  const Trajectory reach = Trajectory::throughKeyframes({at(1, Vec3::Zero()), at(3, Vec3(0.4, 0, -0.2))});
  const TimedPoint middle = reach.at(2);
  EXPECT_NEAR((middle.p_W - Vec3(0.2, 0, -0.1)).norm(), 0, 1e-16);              // half way, by symmetry
  EXPECT_NEAR((middle.v_W - 1.875 / 2 * Vec3(0.4, 0, -0.2)).norm(), 0, 1e-15);  // peak speed 15/8 of the mean
  EXPECT_NEAR(reach.at(1.5).p_W.x(), 0.4 * (10.0 / 64 - 15.0 / 256 + 6.0 / 1024), 1e-16);
}

TEST(MinimumJerk, RestsBeforeBetweenAndAfter) {
  const Trajectory reach =
      Trajectory::throughKeyframes({at(0.5, Vec3::UnitX()), at(1, Vec3::UnitY()), at(2, Vec3::UnitZ())});
  EXPECT_EQ(reach.at(0).p_W, Vec3(Vec3::UnitX()));
  EXPECT_EQ(reach.at(-5).v_W, Vec3(Vec3::Zero()));
  EXPECT_EQ(reach.at(1).p_W, Vec3(Vec3::UnitY()));
  EXPECT_EQ(reach.at(1).v_W, Vec3(Vec3::Zero()));
  EXPECT_EQ(reach.at(2).p_W, Vec3(Vec3::UnitZ()));
  EXPECT_EQ(reach.at(99).p_W, Vec3(Vec3::UnitZ()));
  EXPECT_EQ(reach.at(99).v_W, Vec3(Vec3::Zero()));
  EXPECT_EQ(reach.start(), Vec3(Vec3::UnitX()));
}

RC_GTEST_PROP(MinimumJerk, VelocityIsTheDerivative, ()) {
  const Trajectory reach =
      Trajectory::throughKeyframes({at(0, Vec3::Zero()), at(1, Vec3(1, 2, 3)), at(2, Vec3(0, 1, -1))});
  const double t = *rc::gen::inRange(1, 2000) / 1000.0;
  RC_ASSERT((reach.at(t).v_W - slopeAt(reach, t)).norm() < 1e-5);
}

// A parabola sampled unevenly: slopes through three points are exact inside, so the cubic reproduces it there.
TEST(RecordedMotion, ReproducesAParabola) {
  const auto parabola = [](double t) { return at(t, Vec3(t * t, 1 - 2 * t, 3 * t - t * t)); };
  const Trajectory motion =
      Trajectory::throughSamples({parabola(0), parabola(0.3), parabola(0.5), parabola(1.1), parabola(1.2)});
  for (double t = 0.3; t <= 1.1; t += 0.01) EXPECT_NEAR((motion.at(t).p_W - parabola(t).p_W).norm(), 0, 1e-15) << t;
}

RC_GTEST_PROP(RecordedMotion, IsSmoothAndPassesThroughItsSamples, ()) {
  std::vector<TimedPoint> samples;
  for (int i = 0; i < 6; ++i)
    samples.push_back(at(0.1 * i, 1e-3 * Vec3(*rc::gen::inRange(-50, 50), *rc::gen::inRange(-50, 50), 0)));
  const Trajectory motion = Trajectory::throughSamples(samples);
  constexpr double d = 1e-9;
  for (int i = 1; i < 5; ++i) {
    RC_ASSERT((motion.at(0.1 * i).p_W - samples[static_cast<std::size_t>(i)].p_W).norm() < 1e-15);
    RC_ASSERT((motion.at(0.1 * i - d).v_W - motion.at(0.1 * i + d).v_W).norm() < 1e-5);  // curvature is below 1e3 m/s^2
  }
  const double t = *rc::gen::inRange(1, 499) / 1000.0;
  if (std::abs(t * 10 - std::round(t * 10)) > 0.01)
    RC_ASSERT((motion.at(t).v_W - slopeAt(motion, t)).norm() < 1e-2 * (1e-3 + motion.at(t).v_W.norm()) + 1e-3);
}

class TrajectoryCsv : public ::testing::Test {
 protected:
  std::string messageFor(const std::string& content) {
    std::ofstream(path_) << content;
    try {
      readTrajectoryCsv(path_);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(path_.size());
    }
    return "";
  }
  tests::TemporaryDirectory directory_;
  std::string path_ = directory_ / "motion.csv";
};

TEST_F(TrajectoryCsv, ReadsRows) {
  std::ofstream(path_) << "time,x,y,z\r\n0,0,0,0.1\r\n0.5,1e-2,-0.02,0.1\r\n";
  const Trajectory motion = readTrajectoryCsv(path_);
  EXPECT_EQ(motion.at(0.5).p_W, Vec3(0.01, -0.02, 0.1));
  EXPECT_EQ(motion.end(), 0.5);
}

TEST_F(TrajectoryCsv, NamesWhatIsWrong) {
  EXPECT_EQ(messageFor("t,x,y,z\n"), ":1: the header is \"t,x,y,z\", but must be \"time,x,y,z\".");
  EXPECT_EQ(messageFor("time,x,y,z\n"), ":1: there is no row below the header.");
  EXPECT_EQ(messageFor("time,x,y,z\n0,0,0\n"), ":2: has 3 columns, but four are needed: time,x,y,z.");
  EXPECT_EQ(messageFor("time,x,y,z\n0,0,0,0,0\n"), ":2: has 5 columns, but four are needed: time,x,y,z.");
  EXPECT_EQ(messageFor("time,x,y,z\n0,0,0,0\n1,a,0,0\n"),
            ":3: \"a\" isn't a finite number. Each row is time,x,y,z in seconds and metres.");
  EXPECT_EQ(messageFor("time,x,y,z\n0,nan,0,0\n"),
            ":2: \"nan\" isn't a finite number. Each row is time,x,y,z in seconds and metres.");
  EXPECT_EQ(messageFor("time,x,y,z\n1,0,0,0\n1,0,0,0\n"),
            ":3: time 1 doesn't follow 1. Times must increase from one point to the next.");
}

}  // namespace
}  // namespace pincer::tasks
