// finger_query: where a fingertip touches a shape; spheres first, other fingers from them.
//
//   p_BS  the surface point, n_B the outward normal of the body there, both in the body's frame B
//   phi   signed gap between fingertip and surface [m]: phi = (p_BC - p_BS) . n_B - r, negative when they overlap
//
// The finger's centre lies on the normal over the surface point: p_BC = p_BS + (phi + r) n_B, for every shape but
// meshes with force shading, whose n_B is that of the force, not of the facet touched (flat_contact.h).
#pragma once
#include <array>

#include "pincer/contact/finger_shape.h"
#include "pincer/contact/math.h"
#include "pincer/contact/shape.h"
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

// Contacts of a sphere of radius `r` > 0 [m] centred at `p_BC` with `shape`: the main one, whatever its gap, then up to
// two further ones nearer than `margin` >= 0 [m]. Total: for a centre on the medial axis of a primitive one of the
// nearest points is chosen, always the same one. Allocates nothing; `cache` is memory only.
SurfaceContacts querySphere(const Shape& shape, const Vec3& p_BC, double r, double margin, SurfaceTracker& tracker,
                            PatchCache& cache);

// A place of a finger's core that is followed, and the ball there.
struct CoreTracker {
  SurfaceTracker ball;
  Vec3 c_F = Vec3::Zero();
  bool warm = false;  // there was a query
};

// Memory of a finger that isn't a sphere from query to query; a plain value, like SurfaceTracker.
struct FingerTracker {
  static constexpr int kFeet = 4;  // chosen: a capsule has two ends, of a pad up to four corners are led downhill
  // numbers of its balls' memories (SurfaceTracker::memory): from the main one's on, the feet's, one for what is tried
  static constexpr std::uint32_t kMemories = kFeet + 2;
  CoreTracker main;                     // the deepest place of the core
  std::array<CoreTracker, kFeet> feet;  // of a capsule its two ends, of a pad see shape/pad_query.h
};

// A ball's and one per foot; of a pad's points with a solid the deepest are kept.
constexpr int kMaxFingerContacts = kMaxSurfaceContacts + FingerTracker::kFeet;
struct FingerContacts {
  std::array<SurfaceContact, kMaxFingerContacts> points;
  std::array<Vec3, kMaxFingerContacts> p_BT;  // the finger's own point there: p_BT = p_BS + phi n_B [m]
  int count = 0;
  int queries = 0;               // of balls that it took
  Mat3 wander_B = Mat3::Zero();  // W of the main contact's place (shape/wander.h) [m]; zero where nobody asks
  const SurfaceContact& main() const { return points[0]; }
};

// Contacts of any finger (finger_shape.h) at pose `X_BF` with `shape`. The
// core's point c nearest to the surface is where
//
//   c = P_K(c - tau N(c)) for every tau > 0,   N(c) the normal over which c lies:  c - S = h N,  phi = h - rho
//
// that is, the finger's support point s(-N) lies on the shading normal over S: the tangent plane is all that the finger
// meets. P_K nearest point of the core. Found by projected gradient steps with Barzilai and Borwein's step lengths tau,
// from where the last query ended; each takes one query of a ball; one that doesn't come deeper is taken back and
// shortened. Where a capsule's ends come near too (it lies flat) they are further contacts, and so are the corners of
// what a pad shares with the shape (shape/pad_query.h). Source: J. Barzilai, J. Borwein, IMA J. Numer. Anal. 8 (1988)
// 141-148; E. Birgin, J. Martinez, M. Raydan, SIAM J. Optim. 10 (2000) 1196-1211.
FingerContacts queryFinger(const Shape& shape, const FingerShape& finger, const Pose& X_BF, double margin,
                           FingerTracker& tracker, PatchCache& cache);

// A lower bound of phi that costs next to nothing (bounding sphere), for skipping fingers that are far away. [m]
double lowerBoundOfGap(const Shape& shape, const Vec3& p_BC, double r);

}  // namespace pincer::contact
