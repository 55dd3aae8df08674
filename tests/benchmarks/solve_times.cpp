// solve_times: what the contact solver, heaps and pushed meshes cost, as tables.
//
//   build/solve_times solver   warm-started solves: times, iterations, share of each method
//   build/solve_times heap [TICKS [BALLS]]  1, 10, 100, 1000 spheres, or only so many, in a walled box for 2 s
//                                           (scene S8 of the work-precision benchmark)
//   build/solve_times pushed   meshes pushed about in a dish and on a plane: how often
//                              each method is needed, how many solves fail
// Times are medians and quantiles on this machine, now; what else runs on it shows in the tail.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/engine/state.h"
#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/tests/support/contact_problems.h"

namespace {

using namespace pincer;
using namespace pincer::engine;

class Times {
 public:
  template <class Work>
  void time(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    us_.push_back(1e6 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  double quantile(double q) {
    std::sort(us_.begin(), us_.end());
    return us_[static_cast<std::size_t>(q * static_cast<double>(us_.size() - 1))];
  }

 private:
  std::vector<double> us_;
};

// Which methods solves needed.
struct Methods {
  int counts[7] = {}, solves = 0, failed = 0;
  long iterations = 0;

  void add(const SolveResult& result) {
    ++counts[static_cast<int>(result.method)];
    ++solves;
    failed += !result.converged;
    iterations += result.iterations;
  }
  std::string row() const {
    const auto share = [&](SolveMethod m) { return 100.0 * counts[static_cast<int>(m)] / solves; };
    return fmt::format("{:6.2f}  {:6.1f} {:6.1f} {:6.1f} {:6.1f} {:6.1f}   {:6.3f}",
                       static_cast<double>(iterations) / solves, share(SolveMethod::kWarmStart),
                       share(SolveMethod::kNewton), share(SolveMethod::kProximalNewton),
                       share(SolveMethod::kInteriorPoint), share(SolveMethod::kGaussSeidel), 100.0 * failed / solves);
  }
};

constexpr const char* kMethodsHead = "iter/solve  warm% newton%  prox%  int.p% sweep%  failed%";

struct Family {
  const char* name;
  std::function<tests::OwnedContactProblem(tests::RandomScenes&)> draw;
};

// Bodies' velocities change a little from solve to solve, as from tick to tick.
void disturb(tests::OwnedContactProblem& p, const Eigen::VectorXd& q0, double size, int tick) {
  double largest = 0;
  for (int part = 0; part < 2; ++part) {
    p.q = q0;
    for (std::size_t c = 0; c < p.sides.size(); ++c) {
      for (const ContactSide& side : p.sides[c]) {
        if (side.mover < 0) continue;
        for (int k = 0; k < p.first_row[c + 1] - p.first_row[c]; ++k) {
          double u = 0;
          for (int j = 0; j < kMoverFreedoms; ++j) u += side.A[k][j] * std::sin(1.7 * j + 3 * side.mover + 0.3 * tick);
          if (part == 1)
            p.q[p.first_row[c] + k] += size / largest * u;
          else
            largest = std::max(largest, std::abs(u));
        }
      }
    }
  }
}

void measureFamily(const Family& family) {
  tests::RandomScenes random(3);
  Times times;
  Methods methods;
  for (int scene = 0; scene < 40; ++scene) {
    tests::OwnedContactProblem p = family.draw(random);
    const Eigen::VectorXd q0 = p.q;
    SolverScratch scratch(static_cast<int>(p.mu.size()), p.movers);
    Eigen::VectorXd r = Eigen::VectorXd::Zero(p.q.size()), u = r;
    for (int tick = 0; tick < 100; ++tick) {
      disturb(p, q0, 1e-3 * q0.cwiseAbs().maxCoeff(), tick);
      SolveResult result;
      const auto solve = [&] {
        result = solveContacts(p.view(), {}, scratch, {r.data(), r.size()}, {u.data(), u.size()});
      };
      if (tick == 0) {
        solve();
        continue;
      }
      times.time(solve);
      methods.add(result);
    }
  }
  fmt::print("{:<24} {:8.2f} {:8.2f} {:8.2f}   {}\n", family.name, times.quantile(0.5), times.quantile(0.99),
             times.quantile(0.999), methods.row());
}

void measureSolver() {
  fmt::print("{:<24} {:>8} {:>8} {:>8}   {}\n", "warm, [us]", "median", "p99", "p99.9", kMethodsHead);
  using S = tests::RandomScenes;
  for (const Family& family :
       std::vector<Family>{{"grasp, 2 contacts", [](S& s) { return s.grasp(2, 1, false); }},
                           {"grasp, 5 contacts", [](S& s) { return s.grasp(5, 1, false); }},
                           {"grasp, 10 contacts", [](S& s) { return s.grasp(10, 1, false); }},
                           {"one body, 5 contacts", [](S& s) { return s.ring(5, 1e-3); }},
                           {"one body, 10 contacts", [](S& s) { return s.ring(10, 1e-3); }},
                           {"one body, 30 contacts", [](S& s) { return s.ring(30, 1e-3); }},
                           {"stack, 12 contacts", [](S& s) { return s.stack(3, 1, 1e-3); }},
                           {"stack 1:1e4, 20 contacts", [](S& s) { return s.stack(5, 1e4, 1e-4); }},
                           {"stack, 32 contacts", [](S& s) { return s.stack(8, 1, 1e-3); }},
                           {"stack, 80 contacts", [](S& s) { return s.stack(20, 1, 1e-3); }}})
    measureFamily(family);
}

void measureHeap(int balls, int ticks) {
  const int side = balls == 1 ? 1 : balls == 10 ? 2 : balls == 100 ? 5 : 10;
  const double spacing = 0.0215, half_width = 0.5 * (side * spacing + 0.002);
  const Material glass{0.5, 0.5, 0, 0};
  WorldOptions options;
  options.max_contacts = std::max(64, 6 * balls);
  WorldBuilder builder{options};
  std::vector<BodyStart> starts;
  for (const Vec3& n : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)}) {
    builder.addBody({"wall", contact::HalfSpace{}, false, 0, glass});
    starts.push_back({{Quat::FromTwoVectors(Vec3::UnitZ(), n), n.z() > 0 ? Vec3(0, 0, 0) : Vec3(-half_width * n)},
                      Vec3::Zero(),
                      Vec3::Zero()});
  }
  std::mt19937 generator(7);
  const auto jitter = [&] { return 1e-3 * (static_cast<double>(generator()) / 4294967296.0 - 0.5); };
  for (int i = 0; i < balls; ++i) {
    builder.addBody({"ball", contact::Sphere{0.01}, true, 0.05, glass});
    const double x = spacing * (i % side + 0.5) - half_width + 0.001 + jitter(),
                 y = spacing * (i / side % side + 0.5) - half_width + 0.001 + jitter();
    starts.push_back(
        {{Quat::Identity(), Vec3(x, y, 0.0112 + spacing * (i / side / side) + jitter())}, Vec3::Zero(), Vec3::Zero()});
  }
  const WorldModel model = builder.build();
  WorldState state = makeState(model, starts, {});
  WorldScratch scratch(model);
  Times settled;
  Methods methods;
  double deepest = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    StepReport report;
    const auto tickOnce = [&] { report = step(model, state, scratch); };
    tick < ticks / 2 ? tickOnce() : settled.time(tickOnce);
    methods.add(report.solve);
    // at the start of the tick: phi is that of its middle, as if nothing stopped what lands
    for (const Contact& c : scratch.contacts)
      deepest = std::min(deepest, c.phi - 0.5 * model.options.h * c.v_start_C[kNormalRow]);
  }
  fmt::print("{:6} {:9.1f} {:9.1f} {:8.2f} {:9.2e} {:6}   {}\n", balls, settled.quantile(0.5), settled.quantile(0.99),
             -1e6 * deepest, kineticEnergy(model, state), scratch.contacts.size(), methods.row());
}

void measurePushed(const char* name, const contact::TriangleMesh& mesh, bool dish) {
  WorldBuilder builder{WorldOptions{}};
  builder.addBody({"support",
                   dish ? contact::Shape(contact::Dish{0.15}) : contact::Shape(contact::HalfSpace{}),
                   false,
                   0,
                   {0.5, 0.5, 0, 0}});
  builder.addBody({"object", contact::Mesh{contact::SmoothMesh::build(mesh)}, true, 0.075, {0.6, 0.51, 0, 0}});
  WorldModel model = builder.build();
  WorldState state = makeState(model, {{}, {{Quat::Identity(), Vec3(0, 0, 0.05)}, Vec3::Zero(), Vec3::Zero()}}, {});
  WorldScratch scratch(model);
  std::mt19937 generator(5);
  const auto kick = [&](double size) {
    return Vec3(size * (generator() / 2147483648.0 - 1), size * (generator() / 2147483648.0 - 1), 0);
  };
  Methods methods;
  for (int tick = 0; tick < 20000; ++tick) {
    if (tick % 200 == 0 && tick > 1000) state.bodies[1].v_W += kick(0.25);
    // a push of 4 m/s^2 that turns slowly
    model.options.gravity_W = Vec3(4 * std::sin(2e-3 * tick), 4 * std::cos(3.1e-3 * tick), -9.81);
    methods.add(step(model, state, scratch).solve);
  }
  fmt::print("{:<28} {}\n", fmt::format("{} {}", name, dish ? "in a dish" : "on a plane"), methods.row());
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "solver") measureSolver();
  if (what == "heap") {
    const int ticks = argc > 2 ? std::stoi(argv[2]) : 2000;
    fmt::print("{:>6} {:>9} {:>9} {:>8} {:>9} {:>6}   {}\n", "balls", "median us", "p99 us", "pen. um", "E end J",
               "cont.", kMethodsHead);
    for (const int balls : argc > 3 ? std::vector<int>{std::stoi(argv[3])} : std::vector<int>{1, 10, 100, 1000})
      measureHeap(balls, ticks);
  }
  if (what == "pushed") {
    fmt::print("{:<28} {}\n", "20 s of pushing", kMethodsHead);
    for (const bool dish : {true, false}) {
      measurePushed("rounded cube", contact::roundedCube(0.025, 0.004, 3), dish);
      measurePushed("torus", contact::torus(0.025, 0.01, 24, 12), dish);
      measurePushed("cylinder with flat", contact::cylinderWithFlat(0.02, 0.02, 0.012, 24, 3), dish);
    }
  }
  if (what == "solver" || what == "heap" || what == "pushed") return 0;
  fmt::print("usage: solve_times solver|heap|pushed\n");
  return 2;
}
