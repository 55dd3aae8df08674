// Equations of random trees against those of a textbook (textbook_tree.h).
//
//   equations   accelerations against Lagrange's equations
//   contacts    W = J M^-1 J^T: what impulses at contacts do to a tree's rates
#include <fmt/format.h>

#include <Eigen/Dense>

#include "pincer/tasks/judge/verify/linkage.h"
#include "pincer/tasks/judge/verify/textbook_tree.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

using engine::JointKind;

// The rates after one tick from there, under constant torques.
Eigen::VectorXd ratesAfter(const TextbookTree& tree, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                           const Eigen::VectorXd& tau, double h) {
  Linkage world(h);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(q.size());
  const int count = static_cast<int>(tree.links().size());
  for (int i = 0; i < count; ++i) {
    const TextbookLink& link = tree.links()[static_cast<std::size_t>(i)];
    engine::BodySpec spec{fmt::format("link{}", i), contact::Sphere{0.001}, true, link.mass, {}};
    spec.inertia = engine::GivenInertia{Vec3::Zero(), link.moments.asDiagonal()};
    world.body(spec, {tree.linkPose(zero, i)});
    for (int other = 0; other < i; ++other) world.exclude(other, i);
  }
  for (int i = 0; i < count; ++i) {
    const TextbookLink& link = tree.links()[static_cast<std::size_t>(i)];
    world.joint({link.slides ? JointKind::kSlider : JointKind::kPivot, i, link.parent, link.X_LJ, link.X_PJ});
    world.drive(motorOn(i));
  }
  world.build();
  for (int i = 0; i < count; ++i) {
    world.controls[static_cast<std::size_t>(i)].value = tau[i];
    world.set(i, q[i], v[i]);
  }
  world.tick();
  Eigen::VectorXd rates(count);
  for (int i = 0; i < count; ++i) rates[i] = world.flagged > 0 ? std::nan("") : world.velocity(i);
  return rates;
}

// Of q, v and -v: time runs backwards as it runs forwards, so the mean of both is off by h^2 v'''/6 only.
std::vector<Record> equations(MeasureContext& context) {
  constexpr double kTick = 1e-5;  // [s]
  constexpr int kTrees = 40;
  double worst = 0;
  for (int n = 0; n < kTrees; ++n) {
    Random random(static_cast<std::uint64_t>(n) + 1);
    const TextbookTree tree = randomTree(random, 1 + n % 10);
    const auto draw = [&](double most) {
      Eigen::VectorXd x(static_cast<Eigen::Index>(tree.links().size()));
      for (double& value : x) value = random.uniform(-most, most);
      return x;
    };
    const Eigen::VectorXd q = draw(0.5), v = draw(1), tau = draw(0.5);
    const Eigen::VectorXd a = (ratesAfter(tree, q, v, tau, kTick) + ratesAfter(tree, q, -v, tau, kTick)) / (2 * kTick);
    const Eigen::VectorXd exact = tree.accelerations(q, v, tau);
    worst = std::max(worst, (a - exact).norm() / exact.norm());
    context.progress((n + 1.0) / kTrees);
  }
  return {atMost(fmt::format("accelerations of {} trees of 1 to 10 joints, error", kTrees), worst, "-", 1e-8)};
}

// --- Contacts

// Links touch pegs and each other, and overlap a little. Nothing moves at first, so that contacts are found where the
// tick starts, and all rates after it are what their impulses give:
//   v = T (T^T M T)^-1 T^T sum of J_k^T r_k,   q = T z (joints that follow others),   W r = J v
// Each case is drawn with rates that part all contacts, more than friction needs: there is an answer, and a tick that
// finds none is a fault.
constexpr double kTouchRadius = 0.01, kOverlap = 1e-4;  // radius, by how much two overlap [m]

// Ratios of joints that follow others; q = T z.
struct Ties {
  std::vector<engine::CouplingModel> couplings;
  Eigen::MatrixXd T;
};
Ties randomTies(int count, Random& random) {
  Ties ties;
  std::vector<int> follows(static_cast<std::size_t>(count), -1);
  for (int i = 1; i < count; i += 3) {
    const double ratio = random.uniform(0.5, 2) * (random.below(2) == 0 ? -1 : 1);
    ties.couplings.push_back({i, i - 1, {0, ratio, 0, 0, 0}});
    follows[static_cast<std::size_t>(i)] = i - 1;
  }
  const auto tied = static_cast<int>(ties.couplings.size());
  ties.T = Eigen::MatrixXd::Zero(count, count - tied);
  std::vector<int> column(static_cast<std::size_t>(count), 0);
  for (int i = 0, next = 0; i < count; ++i) {
    const int leader = follows[static_cast<std::size_t>(i)];
    column[static_cast<std::size_t>(i)] = leader < 0 ? next++ : column[static_cast<std::size_t>(leader)];
    ties.T(i, column[static_cast<std::size_t>(i)]) = 1;
  }
  for (const engine::CouplingModel& c : ties.couplings)
    ties.T(c.joint, column[static_cast<std::size_t>(c.joint)]) = c.polynomial[1];
  return ties;
}

// Links with spheres, and pegs of a sphere each. Spheres touch in pairs: each pair has a bit of its own.
struct Touching {
  std::vector<engine::BodySpec> links, pegs;
  std::vector<Vec3> peg_places;
};

// A sphere at `p` in the body's frame.
void addSphere(engine::BodySpec& body, const Vec3& p, std::uint32_t bit) {
  body.shapes.push_back({.name = fmt::format("ball{}", body.shapes.size()),
                         .shape = contact::Sphere{kTouchRadius},
                         .X_BS = {Quat::Identity(), p},
                         .bits = {bit, bit}});
}

// A normal along which what parts by `d_W` parts, and slides by less than friction `mu` would hold.
Vec3 partingNormal(const Vec3& d_W, double mu, Random& random) {
  constexpr double kShare = 0.8;  // of the angle of friction
  const Vec3 along = d_W.normalized(), across = along.cross(random.normal3()).normalized();
  const double angle = random.uniform() * kShare * math::atan2(1, mu);
  return math::cos(angle) * along + math::sin(angle) * across;
}

Touching randomTouching(const TextbookTree& tree, const Eigen::MatrixXd& T, double mu, Random& random) {
  const auto count = static_cast<int>(tree.links().size());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(count);
  Eigen::VectorXd z(T.cols());
  for (double& rate : z) rate = random.normal();
  const Eigen::VectorXd parting = T * z;
  const engine::Material material{.mu_s = mu, .mu_d = mu};
  Touching made;
  for (const TextbookLink& link : tree.links()) {
    made.links.push_back({fmt::format("link{}", made.links.size()), {}, true, link.mass, material});
    made.links.back().inertia = engine::GivenInertia{Vec3::Zero(), link.moments.asDiagonal()};
    addSphere(made.links.back(), Vec3::Zero(), 0);
  }
  for (int touch = 0; touch < 2 + count / 2; ++touch) {
    const auto link = static_cast<int>(random.below(static_cast<std::uint64_t>(count)));
    const auto other = static_cast<int>(random.below(static_cast<std::uint64_t>(count) + 1));  // count: a peg
    const bool is_peg = other == count || other == link;
    const Vec3 p_W = tree.linkPose(zero, link) * Vec3(0.03 * random.normal3());
    Vec3 d_W = tree.jacobian(zero, link, p_W) * parting;
    if (!is_peg) d_W -= tree.jacobian(zero, other, p_W) * parting;
    constexpr double kParting = 0.01;  // [m/s], of rates of 1 rad/s
    if (d_W.norm() < kParting) continue;
    const Vec3 half_W = (kTouchRadius - kOverlap / 2) * partingNormal(d_W, mu, random);
    const std::uint32_t bit = 1u << touch;
    addSphere(made.links[static_cast<std::size_t>(link)], tree.linkPose(zero, link).inverse() * Vec3(p_W + half_W),
              bit);
    if (is_peg) {
      made.pegs.push_back({fmt::format("peg{}", touch), {}, false, 0, material});
      made.peg_places.push_back(p_W - half_W);
    }
    engine::BodySpec& touched = is_peg ? made.pegs.back() : made.links[static_cast<std::size_t>(other)];
    addSphere(touched, is_peg ? Vec3(Vec3::Zero()) : tree.linkPose(zero, other).inverse() * Vec3(p_W - half_W), bit);
  }
  return made;
}

void addJoints(const TextbookTree& tree, const Ties& ties, double armature, Linkage& world) {
  for (int i = 0; i < static_cast<int>(tree.links().size()); ++i) {
    const TextbookLink& link = tree.links()[static_cast<std::size_t>(i)];
    engine::JointModel joint{link.slides ? JointKind::kSlider : JointKind::kPivot, i, link.parent, link.X_LJ,
                             link.X_PJ};
    joint.traits.armature = armature;
    world.joint(joint);
  }
  for (const engine::CouplingModel& coupling : ties.couplings) world.couple(coupling);
}

struct Response {
  double error = 0, size = 0;  // of W r: J v of the engine less that of the dense matrices; of those [m/s]
  int contacts = 0;
  int flagged = 0;
};

Response responseOf(std::uint64_t seed, int count) {
  constexpr double kArmature = 1e-4;  // [kg m^2, kg]
  Random random(seed);
  const TextbookTree tree = randomTree(random, count);
  const Ties ties = randomTies(count, random);
  const Touching touching = randomTouching(tree, ties.T, random.uniform(), random);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(count);
  Linkage world(1e-3, Vec3::Zero());
  for (int i = 0; i < count; ++i) world.body(touching.links[static_cast<std::size_t>(i)], {tree.linkPose(zero, i)});
  for (std::size_t i = 0; i < touching.pegs.size(); ++i)
    world.body(touching.pegs[i], {Pose{Quat::Identity(), touching.peg_places[i]}});
  addJoints(tree, ties, kArmature, world);
  world.build();
  world.tick();
  Response response;
  response.flagged = world.flagged;
  response.contacts = world.contactCount();
  Eigen::VectorXd v(count), given = zero;
  for (int i = 0; i < count; ++i) v[i] = world.velocity(i);
  Eigen::MatrixXd J(3 * response.contacts, count);
  for (int k = 0; k < response.contacts; ++k) {
    const engine::ContactReport c = world.contact(k);
    Eigen::MatrixXd J_k = Eigen::MatrixXd::Zero(3, count);
    if (c.other_body < count) J_k += tree.jacobian(zero, c.other_body, c.p_W);
    if (c.body < count) J_k -= tree.jacobian(zero, c.body, c.p_W);
    J.middleRows<3>(3 * k) = J_k;
    given += J_k.transpose() * c.f_W * world.tickLength();
  }
  // In long double: what is left is the engine's own rounding.
  using Dense = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Dense T = ties.T.cast<long double>();
  const Dense M = (tree.massMatrix(zero) + kArmature * Eigen::MatrixXd::Identity(count, count)).cast<long double>();
  const Dense exact = T * (T.transpose() * M * T).ldlt().solve(T.transpose() * given.cast<long double>());
  const Eigen::VectorXd seen = J * exact.cast<double>();
  response.error = (J * v - seen).norm();
  response.size = seen.norm();
  return response;
}

std::vector<Record> contactResponses(MeasureContext& context) {
  constexpr int kTrees = 200;
  double worst = 0;
  int flagged = 0, touching = 0, unmoved = 0;
  for (int n = 0; n < kTrees; ++n) {
    const Response response = responseOf(static_cast<std::uint64_t>(n) + 1, 1 + n % 12);
    if (response.size > 0) worst = std::max(worst, response.error / response.size);
    touching += response.contacts;
    unmoved += response.contacts > 0 && !(response.size > 0);
    flagged += response.flagged;
    context.progress((n + 1.0) / kTrees);
  }
  return {atMost(fmt::format("W r of {} trees of 1 to 12 joints, a third of them geared, error", kTrees), worst, "-",
                 1e-12),
          atLeast("contacts, at links and between them", touching, "-", 2 * kTrees),
          exactly("trees that stay in what they overlap", unmoved, "-", 0), exactly("flagged ticks", flagged, "-", 0)};
}

}  // namespace

std::vector<Measurement> verifyTreeEquations() {
  return {{"tree/equations", equations}, {"tree/contacts", contactResponses}};
}

}  // namespace pincer::tasks
