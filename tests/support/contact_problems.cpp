#include "pincer/tests/support/contact_problems.h"

#include <cmath>

namespace pincer::tests {
namespace {

Mat3 crossMatrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

Eigen::Matrix<double, 6, 1> stacked(const Vec3& v, const Vec3& w) {
  Eigen::Matrix<double, 6, 1> velocity;
  velocity << v, w;
  return velocity;
}

}  // namespace

int ContactScene::addBody(const Vec3& p, double mass, double inertia, const Vec3& v, const Vec3& w) {
  bodies_.push_back({p, mass, inertia, stacked(v, w)});
  return static_cast<int>(bodies_.size()) - 1;
}

void ContactScene::addContact(int a, int b, const Vec3& p, const Vec3& n, double mu, double torsion_radius,
                              double normal_bias) {
  contacts_.push_back({a, b, p, frameFromNormal(n), mu, torsion_radius, normal_bias});
}

Eigen::Matrix<double, Eigen::Dynamic, 6> ContactScene::jacobian(const Contact& contact, int body) const {
  const int rows = contact.torsion_radius > 0 ? 4 : 3;
  Eigen::Matrix<double, Eigen::Dynamic, 6> J = Eigen::Matrix<double, Eigen::Dynamic, 6>::Zero(rows, 6);
  if (body < 0 || (body != contact.a && body != contact.b)) return J;
  const double sign = body == contact.a ? 1 : -1;
  const Mat3 R = contact.R_WC.transpose() * sign;
  J.topLeftCorner<3, 3>() = R;
  J.topRightCorner<3, 3>() = -R * crossMatrix(contact.p - bodies_[static_cast<std::size_t>(body)].p);
  if (rows == 4) J.bottomRightCorner<1, 3>() = contact.torsion_radius * R.row(2);
  return J;
}

OwnedContactProblem ContactScene::build() const {
  OwnedContactProblem problem;
  for (const Contact& c : contacts_) {
    problem.first_row.push_back(problem.first_row.back() + (c.torsion_radius > 0 ? 4 : 3));
    problem.mu.push_back(c.mu);
  }
  const int m = problem.first_row.back();
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(m, 6 * static_cast<int>(bodies_.size()));
  Eigen::VectorXd inverse_mass(J.cols()), v(J.cols()), bias = Eigen::VectorXd::Zero(m);
  for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) {
    const Body& body = bodies_[static_cast<std::size_t>(b)];
    inverse_mass.segment<6>(6 * b) << Vec3::Constant(1 / body.mass), Vec3::Constant(1 / body.inertia);
    v.segment<6>(6 * b) = body.velocity;
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      const auto block = jacobian(contacts_[c], b);
      J.block(problem.first_row[c], 6 * b, block.rows(), 6) = block;
    }
  }
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    bias[problem.first_row[c] + engine::kNormalRow] = contacts_[c].normal_bias;
  const Eigen::MatrixXd scaled = J * inverse_mass.cwiseSqrt().asDiagonal();
  problem.movers = static_cast<int>(bodies_.size());
  problem.sides.resize(contacts_.size());
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const std::array<int, 2> ends = {contacts_[c].a, contacts_[c].b};
    for (std::size_t s = 0; s < 2; ++s) {
      problem.sides[c][s].mover = ends[s];
      for (int row = problem.first_row[c]; ends[s] >= 0 && row < problem.first_row[c + 1]; ++row) {
        for (int j = 0; j < 6; ++j) problem.sides[c][s].A[row - problem.first_row[c]][j] = scaled(row, 6 * ends[s] + j);
      }
    }
  }
  problem.W = Eigen::MatrixXd::Zero(m, m);
  problem.W.selfadjointView<Eigen::Lower>().rankUpdate(scaled);
  problem.W = problem.W.selfadjointView<Eigen::Lower>();
  problem.q = J * v + bias;
  return problem;
}

void OwnedContactProblem::soften(int contact, double compliance) {
  const auto c = static_cast<std::size_t>(contact);
  engine::ContactSide& spring = sides[c][1];
  spring = {};
  spring.mover = movers++;
  spring.A[engine::kNormalRow][0] = std::sqrt(compliance);
  const int row = first_row[c] + engine::kNormalRow;
  W(row, row) += compliance;
}

double RandomScenes::uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator_);
}
int RandomScenes::integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(generator_); }
Vec3 RandomScenes::vector(double sigma) {
  std::normal_distribution<double> normal(0, sigma);
  const double x = normal(generator_), y = normal(generator_), z = normal(generator_);
  return {x, y, z};
}

OwnedContactProblem RandomScenes::grasp(int fingers, double mass_ratio, bool torsion) {
  const double R = 0.02, r = 0.008, mass = 0.1;
  ContactScene scene;
  scene.addBody(Vec3::Zero(), mass, 0.4 * mass * R * R, Vec3(0, 0, -9.81e-3) + vector(0.02), vector(0.5));
  for (int f = 0; f < fingers; ++f) {
    const double m = mass * (f % 2 ? mass_ratio : 1) * uniform(0.5, 2);
    const Vec3 d = direction();
    const int finger =
        scene.addBody((R + r) * d, m, 0.4 * m * r * r, -d * uniform(0.005, 0.1) + vector(0.02), vector(0.3));
    scene.addContact(finger, 0, R * d, d, uniform(0.2, 1), torsion ? 0.003 : 0);
  }
  return scene.build();
}

OwnedContactProblem RandomScenes::stack(int boxes, double mass_ratio, double disturbance) {
  const double side = 0.04;
  ContactScene scene;
  for (int k = 0; k < boxes; ++k) {
    const double m = 0.05 * std::pow(mass_ratio, boxes > 1 ? double(k) / (boxes - 1) : 0) * uniform(0.8, 1.25);
    const Vec3 fall(0, 0, -9.81e-3);
    scene.addBody({0, 0, side * (k + 0.5)}, m, m * side * side / 6, fall + vector(disturbance),
                  vector(10 * disturbance));
    const double mu = uniform(0.2, 0.9);
    for (int i = 0; i < 4; ++i)
      scene.addContact(k, k - 1, {(i & 1 ? 0.5 : -0.5) * side, (i & 2 ? 0.5 : -0.5) * side, side * k}, Vec3::UnitZ(),
                       mu);
  }
  return scene.build();
}

OwnedContactProblem RandomScenes::cluster(int bodies, int contacts, double mass_ratio, double mu_max, bool torsion) {
  ContactScene scene;
  std::vector<Vec3> centres;
  for (int k = 0; k < bodies; ++k) {
    const double m = 0.02 * std::pow(mass_ratio, uniform(0, 1)), R = uniform(0.01, 0.03);
    centres.push_back({uniform(-0.05, 0.05), uniform(-0.05, 0.05), uniform(0, 0.1)});
    scene.addBody(centres.back(), m, 0.4 * m * R * R * uniform(0.5, 2), vector(0.1), vector(2));
  }
  for (int i = 0; i < contacts; ++i) {
    const int a = i % bodies;
    int b = integer(-1, bodies - 1);
    if (b == a) b = -1;
    const Vec3 p_a = centres[static_cast<std::size_t>(a)];
    const Vec3 p_b = b >= 0 ? centres[static_cast<std::size_t>(b)] : Vec3(p_a + 0.04 * direction());
    const Vec3 n = ((p_a - p_b).normalized() + vector(0.2)).normalized();
    const double bias = uniform(0, 1) < 0.2 ? uniform(0, 0.05) : 0;
    scene.addContact(a, b, 0.5 * (p_a + p_b) + vector(0.005), n, uniform(0, mu_max), torsion && i % 2 ? 0.003 : 0,
                     bias);
  }
  return scene.build();
}

OwnedContactProblem RandomScenes::ring(int contacts, double disturbance) {
  ContactScene scene;
  scene.addBody({0, 0, 0.02}, 0.2, 0.2 * 0.04 * 0.04 / 6, Vec3(0, 0, -9.81e-3) + vector(disturbance),
                vector(5 * disturbance));
  const double mu = uniform(0.2, 0.9);
  for (int i = 0; i < contacts; ++i) {
    const double angle = 2 * M_PI * i / contacts;
    scene.addContact(0, -1, {0.02 * std::cos(angle), 0.02 * std::sin(angle), 0}, Vec3::UnitZ(), mu);
  }
  return scene.build();
}

Solved solve(OwnedContactProblem& problem, const engine::SolverOptions& options, const Eigen::VectorXd* warm_start) {
  const engine::ContactProblem view = problem.view();
  Solved solved;
  solved.r = warm_start ? *warm_start : Eigen::VectorXd(Eigen::VectorXd::Zero(view.rowCount()));
  solved.u = Eigen::VectorXd::Zero(view.rowCount());
  engine::SolverScratch scratch(view.contactCount(), view.movers);
  solved.result = engine::solveContacts(view, options, scratch, {solved.r.data(), solved.r.size()},
                                        {solved.u.data(), solved.u.size()});
  return solved;
}

}  // namespace pincer::tests
