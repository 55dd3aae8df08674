// arc_segments: how many segments a polygon of the smoothness study has, and how far it turns from one to the next.
//
//   n = 1 + 0.9 rad / turn
//
//   n  segments on the published arc, needn't be whole [-];  turn  between neighbouring segments [rad]
// Source: A. J. Doxon, doctoral dissertation, University of Utah (2014), ch. 2: about 90 mm of travel on a radius of
// 100 mm; this reading gives the printed angles of the mean thresholds (257.3 segments: 0.20 degrees; 16.3: 3.37).
#pragma once

namespace pincer::tasks {

inline constexpr double kPublishedArc = 0.9;  // [rad]

// turn > 0 [rad].
inline double segmentsOf(double turn) { return 1 + kPublishedArc / turn; }
// segments > 1; the turn [rad].
inline double turnOf(double segments) { return kPublishedArc / (segments - 1); }

}  // namespace pincer::tasks
