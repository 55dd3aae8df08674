// How far a lone contact stays alone, against all minima of the flat mesh around.
#include <gtest/gtest.h>

#include <algorithm>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/surface/flat_minimum.h"
#include "pincer/contact/surface/near_parts.h"
#include "pincer/contact/surface/shell_face.h"
#include "pincer/contact/surface/surface_search.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/notched_blocks.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::contact {
namespace {

using tests::kCreaseAngle;
using tests::RandomNumbers;

constexpr double kReach = 0.009, kLeast = kReach / 16, kMost = kReach / 4;

struct Surface {
  explicit Surface(const TriangleMesh& mesh) : net(mesh, kCreaseAngle, true), search(net, inspector, nullptr) {}
  SurfaceNet net;
  NetInspector inspector;
  SurfaceSearch search;
  PatchCache cache;

  ShellContact nearest(const Vec3& p) {
    const SurfaceSeed seed = search.nearest(net, cache, p, 1, Facing::front);
    return seed.found ? solveShell(net, cache, p, seed.foot) : ShellContact{};
  }
};

Vec3 randomVector(RandomNumbers& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size), z = random.uniform(-size, size);
  return {x, y, z};
}

// Contacts within reach of `p` that aren't `main`, that p faces and that nothing hides: from all minima of the flat
// mesh, whatever bounds the search has.
int othersThan(const ShellContact& main, Surface& s, const Vec3& p) {
  constexpr double kShort = 0.95;
  const double reach = kReach + s.search.bulge();
  int others = 0;
  for (std::int32_t t = 0; t < s.net.size(); ++t) {
    const FlatPoint flat = closestOnFacet(s.net, t, p);
    if (!(flat.distance2 < reach * reach) || !isFlatMinimum(s.net, t, flat, p)) continue;
    const ShellContact found = solveShell(s.net, s.cache, p, {t, flat.b});
    if (!found.converged || !(found.h > 0 && found.h < kReach) || found.n.dot(main.n) > kApart) continue;
    const PatchPoint x = evaluate(s.net.cell(found.foot.triangle, s.cache).patch, found.foot.b[1], found.foot.b[2]);
    const bool is_on_face = *std::min_element(found.foot.b.begin(), found.foot.b.end()) > 0;
    if (is_on_face && !isStable(x, p)) continue;
    others += !s.search.isHidden(s.net, p, p - kShort * found.h * found.n);
  }
  return others;
}

TEST(SurfaceAlone, NothingElseIsMetOnTheWay) {
  const TriangleMesh plate = gridBox({0.03, 0.02, 0.0005}, 12);
  const TriangleMesh slot = tests::mapped(tests::pitBlock(0.02), Vec3(0.1, 1, 1).asDiagonal());
  for (const TriangleMesh& mesh :
       {geodesicSphere(0.02, 8), torus(0.03, 0.015, 96, 64), bumpySphere(0.03, 0.02, 4, 20),
        ellipsoid({0.03, 0.02, 0.015}, 16), noisy(geodesicSphere(0.03, 12), 5e-5, 1), cylinder(0.025, 0.03, 50, 1),
        cylinderWithFlat(0.025, 0.03, 0.015, 48, 1), box(Vec3::Constant(0.03)), plate, slot}) {
    Surface s(mesh);
    RandomNumbers random(3);
    const int tried = tests::draws(500, 20000);
    int found = 0, alone = 0;
    for (int i = 0; i < tried; ++i) {
      const ShellContact near = s.nearest(randomVector(random, 0.04));
      if (!near.converged) continue;
      ++found;
      const double h = random.uniform(0.003, kReach);
      const Vec3 S = place(s.net.cell(near.foot.triangle, s.cache).patch, near.foot.b[1], near.foot.b[2]),
                 C = S + h * near.n;
      const double way = s.search.wayAlone(C, near.n, h, kReach, kLeast, kMost);
      if (!(way > 0)) continue;
      ++alone;
      ASSERT_LE(way, kMost);
      for (int k = 0; k < 3; ++k) {
        const Vec3 p = C + way * random.uniform(0, 1) * randomVector(random, 1).normalized();
        const ShellContact main = solveShell(s.net, s.cache, p, near.foot);
        ASSERT_TRUE(main.converged) << mesh.source << ' ' << i;
        ASSERT_EQ(othersThan(main, s, p), 0) << mesh.source << ' ' << i << " h " << h << " way " << way;
      }
    }
    const bool is_gentle = mesh.triangles.size() > 1000 && mesh.source != plate.source && mesh.source != slot.source;
    EXPECT_GE(found, 0.7 * tried) << mesh.source;  // 403 of 500 and more
    // 193 of 500 and more. Of the plate and the slot none is said today; what is said of them is judged all the same.
    if (is_gentle) {
      EXPECT_GE(alone, 0.25 * tried) << mesh.source;
    }
  }
}

// Over a slot of 2 mm whose rims are equally near, and beside the edge of a plate.
TEST(SurfaceAlone, IsNotSaidWhereOthersAreNear) {
  Surface slot(tests::mapped(tests::pitBlock(0.02), Vec3(0.1, 1, 1).asDiagonal()));
  const Vec3 C(0.0005, 0, 0.018);
  const ShellContact rim = slot.nearest(C);
  ASSERT_TRUE(rim.converged);
  EXPECT_EQ(slot.search.wayAlone(C, rim.n, rim.h, kReach, kLeast, kMost), 0);

  Surface plate(gridBox({0.03, 0.02, 0.0005}, 12));
  EXPECT_EQ(plate.search.wayAlone({0.0265, 0, 0.0075}, Vec3::UnitZ(), 0.007, kReach, kLeast, kMost), 0);

  Surface sphere(geodesicSphere(0.02, 8));
  EXPECT_GT(sphere.search.wayAlone({0, 0, 0.027}, Vec3::UnitZ(), 0.007, kReach, kLeast, kMost), kLeast);
}

}  // namespace
}  // namespace pincer::contact
