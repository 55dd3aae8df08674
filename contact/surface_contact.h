// surface_contact: what a query of a fingertip on a surface answers, and what it remembers for the next one.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "pincer/contact/math.h"

namespace pincer::contact {

// How a mesh is felt; the variants that the literature compares.
enum class SurfaceVariant : std::uint8_t {
  smooth,            // place and normal of the smooth surface
  facet,             // the flat triangles
  force,             // the flat triangles' place, an interpolated normal (Morganbesser & Srinivasan 1996)
  smooth_published,  // as `smooth`, with the iteration and the edges as they were printed; for comparison only
};

// As scenes and the command line name them, in the order of the enumeration.
inline constexpr std::array<std::string_view, 4> kSurfaceVariantNames = {"smooth", "facet", "force",
                                                                         "smooth_published"};

// Working memory of queries, for one thread at a time: patches that they touched. No answer depends on what it holds.
class PatchCache;
struct DeletePatchCache {
  void operator()(PatchCache* cache) const;
};
using PatchCacheHandle = std::unique_ptr<PatchCache, DeletePatchCache>;

// Room for `cells` > 0 patches, rounded up to a power of two, about half a kilobyte each. A finger needs some dozens.
PatchCacheHandle makePatchCache(int cells = 1024);

constexpr int kMaxSurfaceContacts = 3;  // the main one and two: three planes hold a ball in a corner

struct SurfaceContact {
  Vec3 p_BS, n_B;
  double phi = 0;             // [m]; eased where the contact came or goes while it overlaps (surface/ease.h)
  std::uint32_t feature = 0;  // the tracker's slot: the same for as long as this contact is followed
};

// Work that the answer took; the same input takes the same.
struct QueryCost {
  int iterations = 0;    // Newton steps of the followed contacts
  int longest_walk = 0;  // the most that one of them took
  int crossings = 0;     // of triangle edges
  int reseeds = 0;       // contacts that the search had to find again
  int held = 0;          // contacts without a solution
  int looks = 0;         // around for what is near
};

struct SurfaceContacts {
  std::array<SurfaceContact, kMaxSurfaceContacts> points;
  int count = 0;  // >= 1; points[0] is the main one: the deepest, or in free space the nearest
  QueryCost cost;

  const SurfaceContact& main() const { return points[0]; }
};

// One followed contact: its foot, and what the last query answered.
struct SurfaceSlot {
  std::int32_t triangle = -1;  // -1: nothing is followed here
  bool fades = false;          // lost while it overlapped: stands for its tangent plane until it has been eased away
  double u = 0, v = 0;         // barycentric coordinates of corners 1 and 2 of the triangle [-]
  double ease = 0;             // by which the gap is answered larger than it is [m], >= 0
  Vec3 p_BS = Vec3::Zero(), n_B = Vec3::UnitZ();
  Vec3 du = Vec3::Zero(), dv = Vec3::Zero();  // how u and v move with the centre [1/m]; zero where it isn't known
};

// The last look around for further places, from which the next queries live (near_parts.h).
struct SurfaceLook {
  Vec3 p_BC = Vec3::Zero();  // where the centre was
  double reach = 0;          // further contacts were wanted no further than this from it [m]
  double horizon = 0;        // the centre's way for which what it found is all that may be met [m]; 0: look again
  bool is_alone = false;     // nothing may be met but the one contact that was followed (lone_contact.h)
  // The normals of the contacts that were followed, by slot, zero without one: while they have hardly
  // turned, what faces along them is theirs.
  std::array<Vec3, kMaxSurfaceContacts> n = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

// Where the last query of one finger on one mesh ended; the next begins there. Closed forms don't use it. A plain
// value: part of the world's state, copied with snapshots. A default one means "search the whole mesh".
struct SurfaceTracker {
  std::array<SurfaceSlot, kMaxSurfaceContacts> slots;
  // where the fingertip's centre was, or would have been had it not been pressed under the surface [m]
  Vec3 p_BC = Vec3::Zero();
  Vec3 p_BC_last = Vec3::Zero();  // where it was
  bool has_centre = false;        // it has been outside
  SurfaceLook look;
  double reach = 0;             // how far from it contacts were followed [m]
  std::uint32_t turn = 0;       // how far around the circle of places' turns it has gone (surface/lookout.h)
  double left_out = kInfinity;  // the way since a place that was touched found no slot [m]
  std::uint32_t status = 0;     // bits of QueryStatus of the last query
  // Which of the cache's memories of what is near is this tracker's. No answer depends on it; trackers that share a
  // cache and a number cost a look around at every query.
  std::uint32_t memory = 0;
};

enum QueryStatus : std::uint32_t {
  kQueryOk = 0,
  kQueryReseeded = 1u << 0,  // the warm start failed; the answer came from the tree (nothing was lost)
  // no solution found: the last contact was kept. Remedy: refine or smooth the mesh there
  kQueryHeldDirection = 1u << 1,
  // more than three places are touched: the shallowest of the new ones were dropped. Fill such hollows
  kQueryContactsDropped = 1u << 2,
  // a contact came or went while it overlapped: eased in or out. Widen hollows tighter than the finger
  kQueryEased = 1u << 3,
};

}  // namespace pincer::contact
