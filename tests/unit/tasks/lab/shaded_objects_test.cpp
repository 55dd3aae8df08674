#include "pincer/tasks/lab/experiments/shaded_objects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pincer/contact/finger_query.h"
#include "pincer/grasp/step.h"
#include "pincer/tasks/lab/experiments/cylinder_alignment.h"
#include "pincer/tasks/lab/experiments/pickup_scene.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {
namespace {

using contact::SurfaceVariant;

// so far may the shaded mesh's normal be off [rad]: the design's bound
constexpr double kNormal = 0.2 * std::numbers::pi / 180;
constexpr double kPlace = 0.05e-3;  // and the place on a pad of 8 mm [m], likewise
constexpr double kGap = 0.05e-3;    // nor the gap: as the place [m]
constexpr double kFinger = 8e-3;    // [m]

struct Found {
  Vec3 n = Vec3::Zero();
  double phi = 0;
};

Found touch(const contact::Shape& shape, const Vec3& p) {
  const contact::PatchCacheHandle cache = contact::makePatchCache(64);
  contact::SurfaceTracker tracker;
  const contact::SurfaceContacts found = contact::querySphere(shape, p, kFinger, 1e-3, tracker, *cache);
  return {found.main().n_B, found.main().phi};
}

// The largest angle between both normals, over fingers all round that press by half a
// millimetre at most or hover as far away.
double worstNormal(const contact::Shape& exact, const contact::Shape& shaded, double reach, double gap_tolerance) {
  Random random(7);
  double worst = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vec3 direction = random.normal3().normalized();
    const double out = random.uniform(-0.5e-3, 0.5e-3);
    Vec3 p = 2 * reach * direction;
    for (int i = 0; i < 40; ++i) {  // along the exact normal until the gap is the wanted one
      const Found at = touch(exact, p);
      if (std::abs(at.phi - out) < 1e-6) break;
      p -= (at.phi - out) * at.n;
    }
    const Found a = touch(exact, p), b = touch(shaded, p);
    worst = std::max(worst, std::atan2(a.n.cross(b.n).norm(), a.n.dot(b.n)));
    EXPECT_NEAR(a.phi, b.phi, gap_tolerance);
  }
  return worst;
}

TEST(ShadedObjects, TheSphereIsFeltAsItsClosedForm) {
  for (const double radius : {0.005, 0.02, 0.05}) {
    const double worst = worstNormal(
        contact::Sphere{radius}, contact::Mesh{shadedSphere(radius, SurfaceVariant::smooth)}, radius + kFinger, kGap);
    EXPECT_LT(worst, kNormal) << radius;
    EXPECT_LT(kFinger * worst, kPlace) << radius;
  }
}

// Rims and the flat's edges too, from a flat that takes next to nothing (0.2 rad) to one that takes most (1.2 rad).
TEST(ShadedObjects, TheCylinderIsFeltAsItsClosedForm) {
  for (const double half_angle : {0.2, 0.7854, 1.2}) {
    for (const double radius : {0.01, 0.02, 0.05}) {
      const double half = 0.04, flat = radius * std::cos(half_angle);
      const double worst = worstNormal(contact::CylinderWithFlat{radius, half, flat},
                                       contact::Mesh{shadedCylinder(radius, half, flat, SurfaceVariant::smooth)},
                                       half + radius + kFinger, kGap);
      EXPECT_LT(worst, kNormal) << radius << " " << half_angle;
      EXPECT_LT(kFinger * worst, kPlace) << radius << " " << half_angle;
    }
  }
}

// Unshaded facets are felt as such: 10 degrees from one to the next, their middles 0.13 mm below the sphere.
TEST(ShadedObjects, FacetsAreNotShaded) {
  const double worst = worstNormal(contact::Sphere{0.02}, contact::Mesh{shadedSphere(0.02, SurfaceVariant::facet)},
                                   0.02 + kFinger, 2e-4);
  EXPECT_GT(worst, 3 * std::numbers::pi / 180);
}

// By default both tasks' objects are meshes to fingers, and closed forms to dish, pivot and inertia; the
// option gives the closed form to fingers too.
TEST(ShadedObjects, BothTasksFeelThemByDefault) {
  const SpherePickupOptions pickup;
  const HandScene sphere = makePickupScene(pickup, makePickupObject(pickup), {});
  const CylinderAlignmentOptions alignment;
  const HandScene cylinder = makeCylinderScene(alignment, {});
  for (const HandScene* scene : {&sphere, &cylinder}) {
    const grasp::GraspModel& model = scene->model.grasp;
    const int collider = model.world.bodies[static_cast<std::size_t>(scene->object)].first_collider;
    EXPECT_TRUE(std::holds_alternative<contact::Mesh>(grasp::feltShape(model, collider)));
    EXPECT_FALSE(
        std::holds_alternative<contact::Mesh>(model.world.colliders[static_cast<std::size_t>(collider)].shape));
  }
  SpherePickupOptions exact;
  exact.shading.reset();
  EXPECT_TRUE(makePickupScene(exact, makePickupObject(exact), {}).model.grasp.felt.empty());
}

}  // namespace
}  // namespace pincer::tasks
