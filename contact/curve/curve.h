// curve: a round fingertip in the plane against a polyline that stands for a smooth curve (the 2D algorithm), and
// against its segments as they are, for comparison.
//
// smooth: around each vertex P a quadratic Bezier arc runs from the middle M0 of the segment before it to
// the middle M1 of the one after. The finger, centre C, meets the arc's tangent line at the radial
// parameter of its own contact with that line:
//
//   F = C - h N(t),   t = alpha(F) / beta
//
//   t        Bezier parameter, 0 at M0, 1 at M1 [-]
//            tangent line through (1-t) M0 + t P and (1-t) P + t M1, unit normal N (outward)
//   F, h     contact point on that line [m] and height of C over it [m]
//   alpha    angle of F about the local centre O, from M0 on [rad];  beta  that of M1: the turn of the path at P
//   O        where the perpendicular bisectors of the two segments meet [m]; at infinity
//            where the path is straight, then t is linear
//
// A vertex that is named twice is a sharp corner: straight on both sides up to P, between them contact is with P
// itself. Neighbouring arcs share the tangent line at M, so contact point and normal are continuous. On an arc of
// radius R with `beta` between segments, contact runs at the radius R cos(beta/2) (-0.405 % at 0.18 rad), and the
// normal turns per arc length by tan(b)/b * {cos^2(b) .. 1} / cos(b) times 1/R, b = beta/2: -0.14 to +0.68 % at 0.18
// rad. Source: A. J. Doxon, D. E. Johnson, H. Z. Tan, W. R. Provancher, Presence 20(6), 2011, 2D algorithm.
// Departures: each step of t is divided by 1 - dt(F)/dt, that is 1 + h/R; the plain iteration has the error factor
// -h/R and diverges once the finger is larger than the local radius. And contact is found between gates, the lines
// across the segments' middles: the foot of C on a segment before or behind its middle tells on which side contact
// is, so that every start converges, and none goes in circles (on a closed path C can't be ahead of all gates: sum
// over segments of (C - M) . (P1 - P0) = 0).
//
// facet: the finger's centre over the segments, whose offset lines meet in mitres (god-object; C. Zilles, K. Salisbury,
// IROS 1995). The gates are the bisecting lines at the vertices: there both neighbours are equally near, depth is
// continuous, and the normal jumps by beta. force: contact point as in facet, normal interpolated between the vertices'
// (H.-B. Morgenbesser, M. A. Srinivasan, ASME DSC-58, 1996).
//
// Everything in the polyline's frame B.
#pragma once
#include <cstdint>
#include <vector>

#include "pincer/contact/curve/polyline.h"
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

// Where the last query ended; a plain value. A default one means "search the whole polyline".
struct CurveTracker {
  std::int32_t cell = -1;  // smooth: vertex; facet and force: segment
  double t = 0.5;          // smooth: Bezier parameter within it
};

struct CurveContact {
  Vec2 p_BS = Vec2::Zero();  // contact point [m]
  Vec2 n_B = Vec2::UnitY();  // unit, outward: direction of the force on the finger
  double phi = 0;            // gap between finger and line [m], negative when they overlap
  // of the contact on the fingertip, counter-clockwise from -y [rad], in (-pi, pi]; with `force` the segment's
  double finger_angle = 0;
};

class Curve {
 public:
  // Throws InputError for a polyline that requireSound() refuses: turns of 90 degrees and more for `smooth` but at
  // sharp corners (vertices named twice in a row), spikes (179 degrees) at those and for the others; and for
  // `smooth_published`, which exists for meshes only.
  Curve(const Polyline& polyline, SurfaceVariant variant);

  // Contact of a circle of radius `r` > 0 [m] about the finite `p_BC`. While it touches (phi <= 0), contact is
  // followed from `tracker` on; in free space a nearer part of the path takes over. Beyond the ends of an open path
  // contact is with its end point. Allocates nothing.
  CurveContact queryCircle(const Vec2& p_BC, double r, CurveTracker& tracker) const;

 private:
  struct Segment {
    Vec2 start, e, n;     // first vertex [m], unit direction, outward normal
    Vec2 n_start, n_end;  // of the vertices (unit), for `force`
    double length;        // [m]
  };
  struct Bend {
    Vec2 M0, P, M1;  // [m]
    Vec2 e, n;       // of the segment before P
    double beta;     // [rad]
    double kappa;    // of the circle about O through M0 [1/m], 0 where straight
    double reach;    // from M0 to M1 along e [m]
    bool is_corner;  // sharp: no arc round P
    Vec2 e_after, n_after;
  };
  struct Gate {
    Vec2 p, d;  // contact is ahead where (C - p) . d > 0
  };
  struct Tangent;  // the line that the finger meets

  void addSegments(const CorneredPath& path);
  void addBends(const CorneredPath& path);
  void addGates();
  bool isEnd(std::int32_t cell) const;
  std::int32_t nearestCell(const Vec2& C) const;
  std::int32_t walk(const Vec2& C, std::int32_t cell) const;
  Tangent onSegment(const Segment& segment, const Vec2& C) const;
  Tangent onBend(const Bend& bend, const Vec2& C, double& t) const;
  static Tangent onCorner(const Bend& bend, const Vec2& C);
  Tangent beyondEnd(const Tangent& line, const Vec2& C, std::int32_t cell) const;
  CurveContact follow(const Vec2& C, double r, CurveTracker& tracker) const;

  SurfaceVariant variant_;
  bool is_closed_;
  std::vector<Segment> segments_;
  std::vector<Bend> bends_;  // smooth only: per vertex of a closed path, per inner vertex of an open one
  std::vector<Gate> gates_;  // gate k: from cell k to the next
};

}  // namespace pincer::contact
