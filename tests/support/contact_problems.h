// contact_problems: frictional contact problems for tests of the solver, from bodies and
// contact points: W = J M^-1 J^T, q = J v + b.
#pragma once
#include <Eigen/Dense>
#include <random>
#include <vector>

#include "pincer/engine/solve/contact_solver.h"

namespace pincer::tests {

// A contact problem that owns its memory.
struct OwnedContactProblem {
  std::vector<int> first_row{0};
  std::vector<double> mu;
  std::vector<engine::ContactSides> sides;
  int movers = 0;
  Eigen::MatrixXd W;  // what `sides` stand for, for the tests to judge by
  Eigen::VectorXd q;

  engine::ContactProblem view() {
    const std::span<const engine::ContactSide> all(sides.empty() ? nullptr : sides.front().data(), 2 * sides.size());
    return {first_row, mu, all, {q.data(), q.size()}, movers};
  }
  // Makes a contact with the world softer by `compliance` [1/kg] along the normal.
  void soften(int contact, double compliance);
};

// Bodies (a point mass at `p` with an isotropic inertia) and contacts between them or with the world (body -1).
class ContactScene {
 public:
  int addBody(const Vec3& p, double mass, double inertia, const Vec3& v, const Vec3& w);
  // Contact at `p`, normal `n` from body `b` into body `a`; `b` may be -1. `torsion_radius` > 0 adds a torsional row.
  void addContact(int a, int b, const Vec3& p, const Vec3& n, double mu, double torsion_radius = 0,
                  double normal_bias = 0);
  OwnedContactProblem build() const;

 private:
  struct Body {
    Vec3 p;
    double mass, inertia;
    Eigen::Matrix<double, 6, 1> velocity;
  };
  struct Contact {
    int a, b;
    Vec3 p;
    Mat3 R_WC;
    double mu, torsion_radius, normal_bias;
  };
  Eigen::Matrix<double, Eigen::Dynamic, 6> jacobian(const Contact& contact, int body) const;

  std::vector<Body> bodies_;
  std::vector<Contact> contacts_;
};

// Random scenes; every draw depends on the seed only.
class RandomScenes {
 public:
  explicit RandomScenes(unsigned seed) : generator_(seed) {}

  OwnedContactProblem grasp(int fingers, double mass_ratio, bool torsion);
  OwnedContactProblem stack(int boxes, double mass_ratio, double disturbance);
  OwnedContactProblem cluster(int bodies, int contacts, double mass_ratio, double mu_max, bool torsion);
  OwnedContactProblem ring(int contacts, double disturbance);  // one body on a plane, held by redundant contacts

  double uniform(double low, double high);
  int integer(int low, int high);
  Vec3 vector(double sigma);
  Vec3 direction() { return vector(1).normalized(); }

 private:
  std::mt19937_64 generator_;
};

// The result of one solve, from a warm start of zeros unless given.
struct Solved {
  Eigen::VectorXd r, u;
  engine::SolveResult result;
};
Solved solve(OwnedContactProblem& problem, const engine::SolverOptions& options = {},
             const Eigen::VectorXd* warm_start = nullptr);

}  // namespace pincer::tests
