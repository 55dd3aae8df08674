#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pincer/devices/arm/premium_dynamics.h"
#include "pincer/devices/arm/premium_kinematics.h"
#include "pincer/devices/arm/sim_arm.h"
#include "pincer/tasks/judge/bench/devices/devices_bench.h"

namespace pincer::tasks {
namespace {

namespace premium = devices::premium;

// `visit` at 9 x 9 x 9 places of the workspace.
template <typename Visit>
void overArmWorkspace(Visit visit) {
  constexpr int n = 9;
  for (int i = 0; i < n * n * n; ++i) {
    const Vec3 share(i % n, (i / n) % n, i / (n * n));
    visit(Vec3(premium::kWorkspaceMin_D +
               (premium::kWorkspaceMax_D - premium::kWorkspaceMin_D).cwiseProduct(share) / (n - 1)));
  }
}

// The motors' force on a tip that is held at `p_D`, after `f_D` was commanded for 20 ms.
Vec3 renderedArmForce(const Vec3& p_D, const Vec3& f_D) {
  devices::SimArmSettings settings;
  settings.start_D = p_D;
  devices::SimArm arm(settings);
  arm.setHand({.p_D = p_D, .stiffness = 1e5, .damping = 200, .mass = 1});  // a clamp
  for (int i = 0; i < 20; ++i) {
    arm.commandForce(f_D);
    arm.advance(1e-3);
  }
  return arm.motorForce_D();
}

// The largest force along `direction` that the arm may render at `p_D`: its peak, or what its joints bear but for 2 %,
// because the tip gives way a little, and its levers change with it.
double mostArmForce(const Vec3& p_D, const Vec3& direction) {
  const devices::SimArm arm;
  const auto q = premium::inverse(p_D);
  const double load =
      (premium::jacobian(*q).transpose() * direction).cwiseQuotient(arm.peakTorque()).cwiseAbs().maxCoeff();
  return std::min(arm.capabilities().peak_force, 0.98 / load);
}

double armForceError(const Vec3& p_D, const Vec3& wanted) {
  return 100 * (renderedArmForce(p_D, wanted) - wanted).norm() / wanted.norm();
}

std::vector<Record> armForceErrors(MeasureContext& context) {
  double continuous = 0, most = 0;
  int places = 0;
  overArmWorkspace([&](const Vec3& p_D) {
    if (context.interrupted()) return;
    for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(-1, 1, -1).normalized()}) {
      continuous = std::max(continuous, armForceError(p_D, 1.4 * direction));
      most = std::max(most, armForceError(p_D, mostArmForce(p_D, direction) * direction));
    }
    context.progress(++places / 729.0);
  });
  return {atMost("1.4 N at the tip, error over 729 places, worst", continuous, "%", 1),
          atMost("the most that peak and joints allow, likewise", most, "%", 1)};
}

// The eigenvalues of J^-T M J^-1.
std::vector<Record> armApparentMass(MeasureContext&) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  const premium::Inertia inertia = premium::inertia(0);
  overArmWorkspace([&](const Vec3& p_D) {
    const auto q = premium::inverse(p_D);
    if (!q) return;
    const premium::MassMatrix m = premium::massMatrix(inertia, *q);
    Mat3 M;
    M << m.m11, 0, 0, 0, m.m22, m.m23, 0, m.m23, m.m33;
    const Mat3 inverse = premium::jacobian(*q).inverse();
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(inverse.transpose() * M * inverse);
    least = std::min(least, solver.eigenvalues().minCoeff());
    most = std::max(most, solver.eigenvalues().maxCoeff());
  });
  return {atLeast("apparent mass, least over the workspace", 1e3 * least, "g", 25),
          atMost("apparent mass, most over the workspace", 1e3 * most, "g", 165)};
}

std::vector<Record> armResolution(MeasureContext&) {
  devices::SimArm arm;
  return {atMost("position resolution", 1e3 * arm.capabilities().resolution, "mm", 0.0301)};
}

}  // namespace

std::vector<Measurement> armMeasurements() {
  return {{"arm/force", armForceErrors}, {"arm/mass", armApparentMass}, {"arm/resolution", armResolution}};
}

}  // namespace pincer::tasks
