// place_judge: are all places of a mesh that face a finger told of, each where it is? By brute force (shell_oracle.h).
//
// A place counts that is stable, not hidden by the surface, faces the finger and is nearer than r + margin. As the
// product promises, normals that differ by less than 3.6 degrees belong to one contact, and of more than three places
// any three may be told.
#pragma once
#include <memory>
#include <span>
#include <string>

#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/shell_oracle.h"

namespace pincer::tests {

struct PlaceVerdicts {
  int judged = 0;                     // queries
  int several = 0;                    // of those with more than one contact
  int places = 0;                     // that should have been told
  int missed = 0, felt = 0;           // that weren't; of those with phi < 0
  double deepest = 0;                 // of those [m]
  int extra = 0;                      // contacts where no place is, but for those that are eased
  double off_place = 0, off_gap = 0;  // of the others, at most [m]
  std::string first;                  // complaint

  void complain(const char* what, const Vec3& C, const Vec3& S, double phi);
};

// A finger that is led around a place of a mesh and judged meanwhile.
struct LedFinger {
  double r, margin;  // [m]
  double step;       // per query [m]
  double depth = 0;  // by which it is pressed into what it touches first; 0: pushed out of all that it overlaps [m]
  int each = 15;     // query is judged
  int counted = contact::kMaxSurfaceContacts;  // contacts of each answer: fewer to see that the judge sees it
};

class PlaceJudge {
 public:
  explicit PlaceJudge(const contact::TriangleMesh& mesh);

  // Wanders about `home`, where the finger begins, for so many queries.
  void wander(const LedFinger& finger, const Vec3& home, int queries, RandomNumbers& random, PlaceVerdicts& verdicts);
  // A centre over a random place of the mesh that is no nearer to any other than `height` [m], less a hundredth.
  Vec3 homeOver(double height, RandomNumbers& random) const;

  const ShellOracle& oracle() const { return oracle_; }
  const contact::SmoothMesh& object() const { return *object_; }

 private:
  void judge(const LedFinger& finger, const Vec3& C, const Vec3& outside, const contact::SurfaceContacts& found,
             PlaceVerdicts& verdicts) const;
  void judgeContact(const LedFinger& finger, const Vec3& C, const contact::SurfaceContact& c,
                    std::span<const ShellPlace> places, PlaceVerdicts& verdicts) const;
  bool mayBeTold(const LedFinger& finger, const Vec3& C, const Vec3& outside, const ShellPlace& place) const;
  void judgePlace(const LedFinger& finger, const Vec3& C, const ShellPlace& place,
                  std::span<const contact::SurfaceContact> told, PlaceVerdicts& verdicts) const;

  const contact::TriangleMesh mesh_;
  const ShellOracle oracle_;
  const std::shared_ptr<const contact::SmoothMesh> object_;
  contact::PatchCache cache_;
  contact::SurfaceTracker tracker_;
};

}  // namespace pincer::tests
