// Faults as programmers make them, each put into the real functions: the promise that it
// breaks ends the program and names itself.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/contact/mesh/half_edges.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/shape/convex_features.h"
#include "pincer/contact/surface/aabb_tree.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/engine/motion/free_motion.h"
#include "pincer/engine/motion/mass.h"
#include "pincer/engine/motion/one_freedom.h"
#include "pincer/engine/world/stages.h"
#include "pincer/grasp/energy_ledger.h"
#include "pincer/grasp/finger_distance.h"
#include "pincer/grasp/grasp_quality.h"
#include "pincer/grasp/passivity.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

using tests::startAt;

// Two fingers that hold a ball, ready to be stepped.
struct Pinch {
  tests::GraspWorld world = tests::pinchedBall(0.05, 0.5);
  GraspScratch scratch{world.model};
  std::vector<FingerInput> inputs{at(-0.0275), at(0.0275)};

  static FingerInput at(double x) { return {Vec3(x, 0, 0.1), Vec3::Zero(), Quat::Identity(), Vec3::Zero()}; }
  void step() { grasp::step(world.model, world.state, scratch, inputs); }
};

// A ball that a driven table carries.
struct Table {
  engine::WorldModel model = [] {
    engine::WorldBuilder builder{engine::WorldOptions{}};
    builder.addBody({"table", contact::Box{Vec3(0.1, 0.1, 0.01)}, false, 0, {}, true});
    builder.addBody({"ball", contact::Sphere{0.02}, true, 0.1, {}});
    return builder.build();
  }();
  engine::WorldState state = engine::makeState(model, {startAt(Vec3::Zero()), startAt(Vec3(0, 0, 0.03))}, {});
  engine::WorldScratch scratch{model};
  std::vector<engine::MotionInput> motions = std::vector<engine::MotionInput>(1);

  void step(engine::ContactSource* source = nullptr) { engine::step(model, state, scratch, {{}, motions}, source); }
};

struct SeededFault {
  const char* name;
  const char* caught_by;  // as the sentence has it
  void (*seed)();
};

std::string nameOf(const testing::TestParamInfo<SeededFault>& info) { return info.param.name; }

// Text as a regular expression that matches it, and nothing else.
std::string literally(const std::string& text) {
  std::string pattern;
  for (const char c : text) {
    if (std::string_view("\\^$.|?*+()[]{}").find(c) != std::string_view::npos) pattern += '\\';
    pattern += c;
  }
  return pattern;
}

// Preconditions are demanded of the caller in every build.
class FaultOfTheCaller : public testing::TestWithParam<SeededFault> {};
TEST_P(FaultOfTheCaller, IsCaughtInEveryBuild) { EXPECT_DEATH(GetParam().seed(), literally(GetParam().caught_by)); }

const SeededFault kOfTheCaller[] = {
    {"AModelWhoseTickIsChanged", "options.h isn't the tick that the model was built for",
     [] {  // its coupling is stable for another: what it pushed gained speed without end
       engine::WorldBuilder builder{engine::WorldOptions{}};
       engine::DrivenPointModel point;
       point.mass = 0.01;  // behind 1000 N/m: soft at 1 ms, not at 8
       point.damping.setConstant(1);
       builder.addPoint(point);
       engine::WorldModel model = builder.build();
       model.options.h = 8e-3;
       const engine::WorldScratch scratch(model);
     }},
    {"FewerInputsThanFingers", "step: one input per finger",
     [] {
       Pinch p;
       p.inputs.pop_back();
       p.step();
     }},
    {"FewerInputsThanDrivenPoints", "step: one input per driven point",
     [] {
       Pinch p;
       const std::vector<engine::PointInput> one(1);
       engine::step(p.world.model.world, p.world.state.world, p.scratch.world, one);
     }},
    {"MoreMotionsThanDrivenBodies", "step: no more motions than driven bodies",
     [] {
       Table t;
       t.motions.resize(2);
       t.step();
     }},
    {"StateOfAnotherModel", "step: the state is one of this model",
     [] {
       Table t;
       t.state = tests::pinchedBall(0.05, 0.5).state.world;
       t.step();
     }},
    {"ScratchOfAnotherModel", "step: the scratch is one of this model",
     [] {
       Table t;
       Pinch p;
       engine::step(t.model, t.state, p.scratch.world, {{}, t.motions});
     }},
    {"PairOfABodyThatIsYetToCome", "excludePair: add both bodies first",
     [] {
       engine::WorldBuilder builder{engine::WorldOptions{}};
       builder.excludePair(0, 1);
     }},
    {"MaterialOfNoPair", "setPairMaterial: add both bodies first",
     [] {
       engine::WorldBuilder builder{engine::WorldOptions{}};
       builder.setPairMaterial(0, -1, {});
     }},
    {"QuaternionOfZeros", "makeState: the starts' quaternions have length 1",
     [] {
       Table t;
       engine::makeState(t.model,
                         {{{Quat(0, 0, 0, 0), Vec3::Zero()}, Vec3::Zero(), Vec3::Zero()}, startAt(Vec3::Zero())}, {});
     }},
    {"JointFrameOfLength1_1", "addJoint: the frames' quaternions have length 1",
     [] {
       engine::WorldBuilder builder{engine::WorldOptions{}};
       builder.addBody({"ball", contact::Sphere{0.02}, true, 0.1, {}});
       builder.addJoint({engine::JointKind::kWeld, 0, -1, {}, {Quat(1.1, 0, 0, 0), Vec3::Zero()}, 0});
     }},
    {"QualityOfABodyThatIsNotThere", "graspQuality: there is no such body",
     [] {
       Pinch p;
       graspQuality(p.world.model, p.world.state, p.scratch, 1);
     }},
    {"FewerPlacesThanPorts", "observePorts: one place per finger",
     [] {
       PassivityState state(2);
       observePorts({}, std::vector<Vec3>(1, Vec3::Zero()), 0, 1e-3, state);
     }},
    {"FewerForcesThanFingersInALedger", "EnergyLedger: one force per finger, or none at all",
     [] {
       Pinch p;
       EnergyLedger ledger(p.world.model, p.world.state);
       ledger.add(p.world.model, p.world.state, p.scratch, std::vector<Vec3>(1, Vec3::Zero()));
     }},
};
INSTANTIATE_TEST_SUITE_P(Seeded, FaultOfTheCaller, testing::ValuesIn(kOfTheCaller), nameOf);

#ifdef PINCER_ASSERTS
// Adds contacts of the ball with the table as `change` leaves them.
class FaultyContacts final : public engine::ContactSource {
 public:
  explicit FaultyContacts(void (*change)(engine::Contact& first, engine::Contact& second)) : change_(change) {}
  void addContacts(engine::WorldScratch& scratch) override {
    engine::Contact* all[2] = {engine::addContact(scratch, 0), engine::addContact(scratch, 0)};
    for (int i = 0; i < 2; ++i) {
      engine::Contact& c = *all[i];
      c.a = {engine::SideKind::kBody, 0, 0};
      c.b = {engine::SideKind::kBody, 0, 1};
      c.id = engine::contactId(0, c.a, c.b, 100 + static_cast<std::uint32_t>(i));
      c.p_W = Vec3(0.001 * i, 0, 0.01);
      c.R_WC.col(2) = -Vec3::UnitZ();
    }
    change_(*all[0], *all[1]);
  }

 private:
  void (*change_)(engine::Contact&, engine::Contact&);
};

void stepWith(void (*change)(engine::Contact& first, engine::Contact& second)) {
  Table table;
  FaultyContacts source(change);
  table.step(&source);
}

class FaultOfOurs : public testing::TestWithParam<SeededFault> {};
TEST_P(FaultOfOurs, IsCaughtInAssertingBuilds) { EXPECT_DEATH(GetParam().seed(), literally(GetParam().caught_by)); }

const SeededFault kOfOurs[] = {
    // contact
    {"SphereOfNegativeRadius", "sphere.radius > 0",
     [] { contact::nearestPoint(contact::Sphere{-0.02}, Vec3(0, 0, 0.1)); }},
    {"FlatOutsideOfItsCylinder", "0 < flat_distance && flat_distance < radius",
     [] {
       contact::nearestPoint(contact::CylinderWithFlat{0.02, 0.02, 0.03}, Vec3(0.1, 0, 0));
     }},
    {"DirectionOfLength1_1", "isUnitIfFinite(d)",
     [] {
       contact::reachOf(contact::Cylinder{0.02, 0.02}, Vec3::Zero(), Vec3(0, 0, 1.1));
     }},
    {"FeaturesOfAHalfSpace", "isConvex(shape)", [] { contact::supportOf(contact::HalfSpace{}, Vec3::UnitZ()); }},
    {"BodyWithAQuaternionOfZeros", "isUnitIfFinite(X_WA.q) && isUnitIfFinite(X_WB.q)",
     [] {
       contact::PatchCache cache(1);
       contact::PairPoints found;
       const contact::Box box{Vec3::Constant(0.01)};
       contact::collideShapes(box, {Quat(0, 0, 0, 0), Vec3::Zero()}, box, {}, 1e-3, cache, found);
     }},
    {"TreeOfNothing", "!boxes.empty()", [] { contact::AabbTree tree(std::vector<contact::Aabb>{}); }},
    {"BoxInsideOut", "(box(item).low.array() <= box(item).high.array()).all()",
     [] {
       contact::AabbTree tree({{Vec3::UnitX(), Vec3::Zero()}});
     }},
    {"TriangleWithANegativeIndex", "std::min({triangles[t][0], triangles[t][1], triangles[t][2]}) >= 0",
     [] {
       const std::array<std::int32_t, 3> triangle = {0, 1, -1};
       contact::sortedHalfEdges({&triangle, 1});
     }},
    // engine
    {"NormalOfLength1_1", "isUnitIfFinite(c.n_W())",
     [] { stepWith([](engine::Contact& first, engine::Contact&) { first.R_WC.col(2) *= 1.1; }); }},
    {"TwoContactsWithOneId", "isAscending(scratch.contacts, &Contact::id)",
     [] { stepWith([](engine::Contact& first, engine::Contact& second) { second.id = first.id; }); }},
    {"MemoriesOutOfOrder", "isAscending(memories, &ContactMemory::id)",
     [] {
       Pinch p;
       p.step();
       std::swap(p.world.state.world.contacts[0], p.world.state.world.contacts[1]);
       p.step();
     }},
    {"OrientationOfLength1_1", "isUnitIfFinite(s.X_WI.q)",
     [] {
       Table t;
       t.state.bodies[1].X_WI.q.coeffs() *= 1.1;
       t.step();
     }},
    {"MotionWithAQuaternionOfZeros", "isUnit(out.X_WB.q)",
     [] {
       Table t;
       t.motions[0].X_WB.q = Quat(0, 0, 0, 0);
       t.step();
     }},
    {"NegativeMass", "out.inverse_mass.allFinite() && out.inverse_mass.minCoeff() >= 0",
     [] {
       Pinch p;
       p.world.model.world.points[0].mass = -1;
       p.step();
     }},
    {"NegativeMoment", "(moments.array() > 0).all()", [] { engine::FreeRotation rotation(Vec3(1e-5, -1e-5, 1e-5)); }},
    {"InertiaThatIsNotSymmetric", "isSymmetric(properties.I_BBcm)",
     [] {
       Mat3 I = 1e-5 * Mat3::Identity();
       I(1, 0) = 1e-6;
       engine::principalInertia({0.1, Vec3::Zero(), I});
     }},
    {"BodyOutOfRange", "isIndex(body, state.bodies.size())",
     [] {
       Table t;
       engine::bodyPose(t.model, t.state, 2);
     }},
    {"PairTheWrongWayRound", "a < b",
     [] {
       Table t;
       engine::materialOf(t.model, 1, 0);
     }},
    {"DamperThatDrives", "law.c >= 0",
     [] {
       engine::followFreedom({0, 0, -1, false}, 0, 1e-3);
     }},
    {"MoreMemoriesThanThereIsRoomFor", "static_cast<std::size_t>(state.contact_count) <= state.contacts.size()",
     [] {
       Table t;
       t.state.contact_count = t.model.options.max_contacts + 1;
       engine::hashOf(t.state);
     }},
    // grasp
    {"PoseThatIsNoNumber", "X_WF.p.allFinite() && isUnit(X_WF.q)",
     [] {
       Pinch p;
       p.world.state.world.points[1].p_W.x() = std::numeric_limits<double>::quiet_NaN();
       fingerDistances(p.world.model, p.world.state);
     }},
    {"LeftHandedFrame", "isRotation(contact.R_WC)",
     [] {
       GraspContact contact;
       contact.R_WC.col(0) *= -1;
       graspColumns(contact, Vec3::UnitX(), 0.02);
     }},
    {"ArmWithoutMass", "armOf(options, i).mass > 0",
     [] {
       PassivityOptions options;
       options.on = true;
       options.arms = {{0, 0, 0}};
       PassivityState state(1);
       std::vector<Vec3> f(1, Vec3::UnitX());
       controlPorts(options, 1e-3, state, f);
     }},
};
INSTANTIATE_TEST_SUITE_P(Seeded, FaultOfOurs, testing::ValuesIn(kOfOurs), nameOf);
#endif

}  // namespace
}  // namespace pincer::grasp
