#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "pincer/devices/cld/sim_cld.h"
#include "pincer/devices/cld/sim_one_dof_cld.h"
#include "pincer/devices/cld/tactor_error.h"
#include "pincer/tasks/judge/bench/devices/devices_bench.h"

namespace pincer::tasks {
namespace {

using devices::SimCld;
using devices::SimOneDofCld;

// A display as it is seen from outside: a place asked for, a millisecond, where the tactor then is.
using DisplayProbe = std::function<double(double place)>;

// A fresh 2-DOF display, watched along one axis on the cylindrical half of the
// finger, where the axes are the actuators'.
DisplayProbe twoDofProbe(int axis) {
  return [cld = SimCld(), axis](double place) mutable {
    Vec2 place_L(-0.004, 0);
    place_L[axis] += place;
    cld.command({false, place_L});
    cld.advance(1e-3);
    return cld.trueTactor_L()[axis];
  };
}

DisplayProbe oneDofProbe() {
  return [cld = SimOneDofCld()](double place) mutable {
    cld.command({false, Vec2(place, 0)});
    cld.advance(1e-3);
    return cld.trueRoller();
  };
}

// Half the travel while it follows a sine, once it is steady.
double displayAmplitude(DisplayProbe probe, double amplitude, double frequency) {
  const int period = static_cast<int>(std::lround(1000 / frequency));
  double low = 1, high = -1;
  for (int i = 0; i < 5 * period; ++i) {
    const double y = probe(amplitude * math::sin(2 * std::numbers::pi * i / period));
    if (i >= 3 * period) low = std::min(low, y), high = std::max(high, y);
  }
  return (high - low) / 2;
}

// The dissertation's way: the smallest slow sine that still moves the output.
double backlashOf(const std::function<DisplayProbe()>& make) {
  double still = 0, moves = 2e-3;
  while (moves - still > 1e-6) {
    const double middle = (still + moves) / 2;
    (displayAmplitude(make(), middle, 0.2) > 2e-6 ? moves : still) = middle;
  }
  return 2 * moves;
}

double bandwidthOf(const std::function<DisplayProbe()>& make) {
  const double slow = displayAmplitude(make(), 2e-3, 0.2);
  double frequency = 1;
  while (frequency < 40 && displayAmplitude(make(), 2e-3, frequency) > slow * std::numbers::sqrt2 / 2) frequency += 0.1;
  return frequency;
}

std::vector<Record> displayBacklash(MeasureContext&) {
  const double pd = 1e3 * backlashOf([] { return twoDofProbe(0); }),
               ru = 1e3 * backlashOf([] { return twoDofProbe(1); });
  return {atMost("proximal-distal, off the published 1.13 mm by", std::abs(pd - 1.13), "mm", 0.02),
          atMost("radial-ulnar, off the published 0.42 mm by", std::abs(ru - 0.42), "mm", 0.02)};
}

std::vector<Record> displayBandwidth(MeasureContext&) {
  return {atLeast("proximal-distal, -3 dB", bandwidthOf([] { return twoDofProbe(0); }), "Hz", 5),
          atLeast("radial-ulnar, -3 dB", bandwidthOf([] { return twoDofProbe(1); }), "Hz", 5)};
}

std::vector<Record> displayResolution(MeasureContext&) {
  SimCld cld;
  double step = 0, last = 0;
  for (int i = 0; i < 4000; ++i) {
    cld.command({false, Vec2(-1e-6 * i, 0)});
    cld.advance(1e-3);
    const double place = cld.sample().place_L->x();
    step = std::max(step, std::abs(place - last));
    last = place;
  }
  return {atMost("largest step of the measured place", 1e6 * step, "um", 53.001)};
}

// From a command in step with the frames to the first motion.
std::vector<Record> displayDelay(MeasureContext&) {
  double worst = 0;
  for (int phase = 0; phase < 4; ++phase) {
    SimCld cld;
    cld.advance(2e-3 * phase);
    cld.command({false, Vec2(-0.005, 0)});
    double waited = 0;
    for (; cld.trueActuator_L().x() == 0 && waited < 0.01; waited += 0.5e-3) cld.advance(0.5e-3);
    worst = std::max(worst, waited - 0.5e-3);  // the motion shows at the end of the half millisecond in which it begins
  }
  SimCld cld;
  return {atMost("from a command at its frame to the first motion", 1e3 * worst, "ms", 2),
          exactly("frames of commands", cld.capabilities().rate, "Hz", 500)};
}

std::vector<Record> rollerFigures(MeasureContext&) {
  SimOneDofCld cld;
  return {atMost("backlash, off the published 0.23 mm by", std::abs(1e3 * backlashOf(oneDofProbe) - 0.23), "mm", 0.01),
          atLeast("bandwidth, -3 dB", bandwidthOf(oneDofProbe), "Hz", 5),
          atMost("resolution", 1e6 * cld.capabilities().resolution, "um", 0.801)};
}

// A contact that glides over the pad at a hand's speed: how far the tactor is off, and why.
std::vector<Record> policyErrors(double speed) {
  SimCld cld;
  devices::TactorErrorMeter meter({});
  const double amplitude = 4e-3, w = speed / amplitude;
  for (int i = 0; i < 60000; ++i) {
    const Vec2 wanted(-0.004 + amplitude * math::sin(w * 1e-3 * i), 0.5 * amplitude * math::sin(0.7 * w * 1e-3 * i));
    cld.command({false, wanted});
    cld.advance(1e-3);
    if (i > 5000) meter.add(wanted, cld.trueTactor_L(), 1e-3);
  }
  const devices::TactorErrors e = meter.result();
  return {atMost("rms error (people localise to 1.3 mm)", 1e3 * e.total, "mm", speed < 0.03 ? 1.3 : 4),
          unbounded("its share from bandwidth", 1e3 * e.bandwidth, "mm"),
          unbounded(fmt::format("its share from backlash (noticed from {:.2f} / {:.2f} mm of play)",
                                1e3 * devices::kPlayLimitLowCurvature, 1e3 * devices::kPlayLimitEdge),
                    1e3 * e.play, "mm"),
          unbounded("its share from delay", 1e3 * e.delay, "mm"),
          unbounded("quantisation of what the host is told", 1e3 * e.quantisation, "mm"),
          unbounded("time with more than 1.3 mm", 100 * e.beyond_limit, "%")};
}

std::vector<Record> displayLag(MeasureContext&) {
  return {atMost("behind a slow ramp (people notice 61 ms)", 1e3 * devices::DisplayFigures{}.lag(), "ms",
                 1e3 * devices::kDelayLimit)};
}

}  // namespace

std::vector<Measurement> displayMeasurements() {
  return {{"cld/resolution", displayResolution},
          {"cld/bandwidth", displayBandwidth},
          {"cld/backlash", displayBacklash},
          {"cld/delay", displayDelay},
          {"cld/error-20mm_s", [](MeasureContext&) { return policyErrors(0.020); }},
          {"cld/error-74mm_s", [](MeasureContext&) { return policyErrors(0.074); }},
          {"cld/lag", displayLag},
          {"roller/figures", rollerFigures}};
}

}  // namespace pincer::tasks
