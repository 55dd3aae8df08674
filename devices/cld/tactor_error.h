// tactor_error: how far the tactor is from where it should be, and which part of the display is to blame.
//
//   w --delay--> d --second order, speed limit--> a --play--> y --potentiometer--> m
//   error = w - y = (w - d) + (d - a) + (a - y);    quantisation = m - a rounded, on top of what the host believes
//
// All of it root mean square over the time watched [m], on the place (both axes together). The chain is that of
// the simulated display (sim_cld.h) with the device's figures; the total is taken from the tactor itself where
// its place is known (`shown`), else from the chain. Measured against people, who localise a contact to 1.3 mm
// (mean absolute), notice a delay of 61 ms, and play of 0.69 mm (low curvature) or 1.16 mm (an edge): 0.46 and
// 0.93 mm were added to their display's own 0.23 mm, which is taken for unfelt (A. J. Doxon, doctoral
// dissertation, University of Utah, 2014, ch. 2 to 4).
#pragma once
#include <array>
#include <optional>

#include "pincer/devices/math.h"

namespace pincer::devices {

inline constexpr double kLocalisationLimit = 1.3e-3;                                 // [m]
inline constexpr double kPlayLimitLowCurvature = 0.69e-3, kPlayLimitEdge = 1.16e-3;  // of all play together [m]
inline constexpr double kDelayLimit = 61e-3;                                         // [s]

struct DisplayFigures {
  double delay = 1.5e-3;         // [s], 0 .. 0.05, in milliseconds' steps as the meter is fed
  double natural_frequency = 8;  // [Hz]
  double damping_ratio = 0.8;    // (0, 1)
  double speed = 0.1;            // [m/s]
  Vec2 play{1.13e-3, 0.42e-3};   // [m]
  double resolution = 53e-6;     // [m]

  // Of a slow ramp: the time by which the tactor trails behind [s].
  double lag() const;
};

struct TactorErrors {
  double total = 0, delay = 0, bandwidth = 0, play = 0, quantisation = 0;  // rms [m]
  double worst = 0;                                                        // of the total [m]
  double beyond_limit = 0;  // share of the time with more than kLocalisationLimit
};

class TactorErrorMeter {
 public:
  explicit TactorErrorMeter(const DisplayFigures& figures) : figures_(figures) {}

  // A tick of `dt` [s], 0 < dt <= 4 ms: where the tactor should be, and where
  // it is if that is known. Allocates nothing.
  void add(const Vec2& wanted_L, const std::optional<Vec2>& shown_L, double dt);
  TactorErrors result() const;

 private:
  void follow(const Vec2& delayed, double dt);

  DisplayFigures figures_;
  std::array<Vec2, 64> history_{};
  std::size_t newest_ = 0;
  bool begun_ = false;
  Vec2 a_ = Vec2::Zero(), v_ = Vec2::Zero(), y_ = Vec2::Zero();
  double time_ = 0, total_ = 0, delay_ = 0, bandwidth_ = 0, play_ = 0, quantisation_ = 0, worst_ = 0, beyond_ = 0;
};

}  // namespace pincer::devices
