#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pincer/tasks/lab/report/device_errors.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

constexpr double kPeriod = 5e-3, kLag = 40e-3, kAmplitude = 4e-3, kRate = 6;  // [s], [s], [m], [rad/s]

// A tactor that follows a sine along the finger `kLag` late; in the second half the finger
// touches nothing and the tactor is far away.
SampleRecord lateSample(int k) {
  SampleRecord sample;
  sample.tick = 5 * k;
  sample.time = kPeriod * k;
  const bool touching = k < 1000;
  for (FingerRecord& finger : sample.fingers) {
    finger.flags = touching ? 1 : 0;
    finger.place_wanted_L = {kAmplitude * std::sin(kRate * sample.time), 0};
    finger.place_shown_L = {touching ? kAmplitude * std::sin(kRate * (sample.time - kLag)) : 1.0, 0};
  }
  return sample;
}

TEST(DeviceErrors, FindTheLagAndNothingElse) {
  const tests::TemporaryDirectory dir;
  auto writer = SessionWriter::create(dir / "a.db", {}, {.block_when_full = true});
  for (int k = 0; k < 2000; ++k) writer.pushSample(lateSample(k));
  writer.finishTrial({});
  writer.close();
  const DeviceErrors errors = deviceErrors(SessionReader(dir / "a.db"));
  EXPECT_EQ(errors.samples, 2000);  // of two fingers
  EXPECT_NEAR(errors.lag, kLag, 1e-9);
  EXPECT_NEAR(errors.step, kPeriod, 1e-9);
  EXPECT_LT(errors.remains, 1e-12);
  // The difference is 2 A sin(w lag/2) cos(w (t - lag/2)): its median is 1/sqrt(2) of its
  // amplitude, to the 5 s that are no whole periods.
  EXPECT_NEAR(errors.median, 2 * kAmplitude * std::sin(0.5 * kRate * kLag) * std::sqrt(0.5), 0.02e-3);
  EXPECT_EQ(errors.noticed, 0);
  EXPECT_NE(deviceErrorsHtml(errors).find("40 ± 2.5"), std::string::npos) << deviceErrorsHtml(errors);
}

TEST(DeviceErrors, SayNothingWhereTactorsWereParkedOrUnmeasured) {
  const tests::TemporaryDirectory dir;
  auto writer = SessionWriter::create(dir / "a.db", {}, {.block_when_full = true});
  SampleRecord parked = lateSample(1), unmeasured = lateSample(2);
  for (FingerRecord& finger : parked.fingers) finger.flags = 1 | 8;
  for (FingerRecord& finger : unmeasured.fingers) finger.place_shown_L[0] = std::numeric_limits<double>::quiet_NaN();
  writer.pushSample(parked);
  writer.pushSample(unmeasured);
  writer.close();
  EXPECT_EQ(deviceErrors(SessionReader(dir / "a.db")).samples, 0);
  EXPECT_TRUE(deviceErrorsHtml(deviceErrors(SessionReader(dir / "a.db"))).empty());
}

}  // namespace
}  // namespace pincer::tasks
