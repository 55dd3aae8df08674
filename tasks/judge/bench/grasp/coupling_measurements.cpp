// Coupling: which stiffness with which body at which rate; energy that sampling
// makes, and passivity that takes it back.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/grasp/energy_ledger.h"
#include "pincer/grasp/hold_bounds.h"
#include "pincer/grasp/passivity.h"
#include "pincer/tasks/judge/bench/finger_path.h"
#include "pincer/tasks/judge/bench/grasp/bench_grasp.h"
#include "pincer/tasks/judge/bench/grasp/grasp_bench.h"
#include "pincer/tasks/judge/bench/grasp/hand_on_arm.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/lab/report/gnuplot.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {
namespace {

constexpr double kHalfCube = 0.02;                                                             // [m]
constexpr std::array<double, 9> kStiffnesses = {10, 30, 100, 300, 1000, 3000, 1e4, 3e4, 1e5};  // [N/m]
constexpr std::array<double, 4> kMasses = {1e-3, 1e-2, 0.1, 1};                                // [kg]
constexpr std::array<double, 3> kRates = {500, 1000, 2000};                                    // [Hz]

grasp::GraspModel heldCube(double stiffness, double damping, double mass, double rate) {
  engine::WorldOptions options = benchWorld(false);
  options.h = 1 / rate;
  engine::WorldBuilder builder(options);
  builder.addBody({"cube", contact::Box{Vec3::Constant(kHalfCube)}, true, mass, {0.8, 0.8, 0, 3e-3}});
  return grasp::buildGrasp(std::move(builder),
                           {benchFinger("left", stiffness, damping), benchFinger("right", stiffness, damping)});
}

Vec3 besideCube(int finger, double squeeze) {
  return {(finger == 0 ? -1 : 1) * (kHalfCube + kBenchTip - squeeze), 0, 0};
}

// Devices that don't give way: the coupling alone, squeezed in one tick.
std::vector<Record> stableCouplings(MeasureContext&) {
  double speed = 0, place = 0;
  for (const double k : kStiffnesses) {
    for (const double m : kMasses) {
      const grasp::GraspModel model = heldCube(k, 2 * 0.1 * std::sqrt(k * m), m, 1000);
      grasp::GraspState state = grasp::makeState(model, {engine::BodyStart{}}, {besideCube(0, 0), besideCube(1, 0)});
      const grasp::ScratchHandle scratch = grasp::makeScratch(model);
      std::vector<grasp::FingerInput> inputs(2);
      const double squeeze = std::min(1e-3, 10 / k);
      // One side alone at first, so that the cube is pushed off its middle and rings.
      const int ticks = static_cast<int>(1000 * std::clamp(40 * std::sqrt(m / k), 1.0, 20.0));
      for (int i = 0; i < ticks; ++i) {
        for (int f = 0; f < 2; ++f)
          inputs[static_cast<std::size_t>(f)].p_WF = besideCube(f, f == 0 && i < 20 ? 1.2 * squeeze : squeeze);
        grasp::step(model, state, *scratch, inputs);
      }
      speed = std::max(speed, state.world.bodies[0].v_W.norm());
      place = std::max(place, state.world.bodies[0].X_WI.p.norm() / squeeze);
    }
  }
  return {atMost("10 .. 1e5 N/m, 1 g .. 1 kg, 1 ms: speed once it has rung out", 1e6 * speed, "um/s", 1),
          atMost("likewise, how far from its middle, over the squeeze", place, "-", 1e-3)};
}

// Energy that came in through the fingers, the arms' friction counted with it:
// passive is what never lets it become negative.
struct Cell {
  double least = 0;       // [J]
  double least_of_1 = 0;  // within the first second [J]
  double unforeseen = 0;  // what the hands could do in one tick, largest, see unforeseenBy [J]
  // Without passivity: what buzzes has thrown the object away before the first second is over.
  // With it: debts of the start are made once.
  double wholePerMinute() const { return -least * 60 / 3; }  // [J/min]
  // in the last two of the three seconds [J/min]
  double laterPerMinute() const { return (least_of_1 - least) * 60 / 2; }
};

// The energy that a hand can take out within one tick beyond what its last velocity foretells: a held force f
// while the hand accelerates by a adds at most
// |f| |a| h^2: the velocity is that of the middle of the last tick, h before that of the coming one.
double unforeseenBy(const HandOnArm& hand, const Vec3& f_held_W, double h) {
  const Vec3 f_hand_W = hand.hand_stiffness * (hand.wish_W - hand.p_W) - (hand.friction + hand.hand_damping) * hand.v_W;
  return f_held_W.norm() * f_hand_W.norm() / hand.mass * h * h;
}

// Two hands hold the cube and wish at random, for 3 s.
Cell handsOn(double stiffness, double mass, double rate, bool passive) {
  const grasp::GraspModel model = heldCube(stiffness, 0, mass, rate);
  const double h = model.world.options.h;
  grasp::GraspState state = grasp::makeState(model, {engine::BodyStart{}}, {besideCube(0, 0), besideCube(1, 0)});
  const grasp::ScratchHandle scratch = grasp::makeScratch(model);
  grasp::PassivityState ports(2);
  grasp::PassivityOptions options;
  std::array<HandOnArm, 2> hands;
  options.on = passive;
  for (const HandOnArm& hand : hands) options.arms.push_back({hand.mass, hand.friction});
  std::vector<grasp::FingerInput> inputs(2);
  std::vector<Vec3> p(2), f(2, Vec3::Zero());
  for (int i = 0; i < 2; ++i)
    hands[static_cast<std::size_t>(i)].p_W = p[static_cast<std::size_t>(i)] = besideCube(i, 0);
  Random random(5);
  Cell cell;
  double friction = 0;
  const int ticks = static_cast<int>(3 * rate), wish_every = static_cast<int>(0.05 * rate);
  for (int k = 0; k < ticks; ++k) {
    double unforeseen = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      HandOnArm& hand = hands[i];
      if (k % wish_every == 0) hand.wish_W = besideCube(static_cast<int>(i), 6e-3) + 3e-3 * randomDirection(random);
      unforeseen += unforeseenBy(hand, f[i], h);
      hand.advance(f[i], h);
      friction += hand.friction * (hand.p_W - p[i]).squaredNorm() / h;
      inputs[i].v_WF = (hand.p_W - p[i]) / h;
      inputs[i].p_WF = p[i] = hand.p_W;
    }
    cell.unforeseen = std::max(cell.unforeseen, unforeseen);
    grasp::step(model, state, *scratch, inputs);
    for (std::size_t i = 0; i < 2; ++i) f[i] = grasp::fingersOf(*scratch)[i].f_user_W;
    grasp::observePorts(options, p, grasp::storedEnergy(model, state), h, ports);
    grasp::controlPorts(options, h, ports, f);
    grasp::holdPorts(f, ports);
    cell.least = std::min(cell.least, ports.energy() + friction);
    if (k < rate) cell.least_of_1 = cell.least;
  }
  return cell;
}

struct MapRow {
  double rate, stiffness, mass, bound;
  Cell free, held;
};

std::vector<MapRow> stabilityMap(MeasureContext& context) {
  std::vector<MapRow> rows;
  for (const double rate : kRates) {
    const double bound = grasp::passiveStiffness({HandOnArm{}.mass, HandOnArm{}.friction, 0}, 0, 1 / rate);
    for (const double k : kStiffnesses) {
      for (const double m : kMasses) {
        if (context.interrupted()) return rows;
        rows.push_back({rate, k, m, bound, handsOn(k, m, rate, false), handsOn(k, m, rate, true)});
        context.progress(static_cast<double>(rows.size()) / (kRates.size() * kStiffnesses.size() * kMasses.size()));
      }
    }
  }
  return rows;
}

std::string mapTable(const std::vector<MapRow>& rows) {
  CsvTable table;
  for (const char* column : {"rate_Hz", "stiffness_N_per_m", "mass_kg", "bound_N_per_m", "made_J_per_min",
                             "made_with_passivity_J_per_min", "least_J", "least_with_passivity_J"})
    table.add(column);
  table.endRow();
  for (const MapRow& row : rows) {
    for (const double x : {row.rate, row.stiffness, row.mass, row.bound, row.free.wholePerMinute(),
                           row.held.laterPerMinute(), row.free.least, row.held.least})
      table.add(x);
    table.endRow();
  }
  return table.take();
}

// Energy over stiffness, a curve per mass, without and with passivity, at 1 kHz; where theory draws the line.
void plotMap(const std::string& directory, const std::vector<MapRow>& rows) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw InputError(fmt::format("--out {}: can't make this directory: {}.", directory, error.message()));
  // Colours of the lines, by mass.
  constexpr std::array<const char*, 4> kColours = {palette::kBlue, palette::kGreen, palette::kOrange,
                                                   palette::kVermillion};
  Figure figure;
  figure.name = "stability-map";
  figure.data = {{figure.name + ".csv", mapTable(rows)}};
  std::string script = figurePrelude(figure.name) +
                       "set multiplot layout 1,3\nset logscale xy\nset format xy '1e%T'\nset datafile missing NaN\nset "
                       "yrange [1e-6:1e6]\n";
  script += "set xlabel 'stiffness [N/m]'\nset ylabel 'energy made [J/min]; 1e-6: none'\n";
  for (const double rate : kRates) {
    const double bound = grasp::passiveStiffness({HandOnArm{}.mass, HandOnArm{}.friction, 0}, 0, 1 / rate);
    script += fmt::format(
        "set title '{:g} Hz' textcolor rgb '{}'\nset arrow 1 from {},graph 0 to {},graph 1 nohead dt 2 lc rgb "
        "'{}'\nplot ",
        rate, palette::kInk, bound, bound, palette::kGrey);
    for (std::size_t i = 0; i < kMasses.size(); ++i) {
      for (const bool passive : {false, true}) {
        script += fmt::format(
            "data skip 1 using ($1=={}&&$3=={}?$2:NaN):(${}>1e-6?${}:1e-6) with linespoints lw {} dt {} pt {} lc rgb "
            "'{}' title '{:g} "
            "g{}'{}",
            rate, kMasses[i], passive ? 6 : 5, passive ? 6 : 5, passive ? 1 : 2, passive ? 3 : 1, passive ? 6 : 7,
            kColours[i], 1e3 * kMasses[i], passive ? ", passivity" : "",
            i + 1 == kMasses.size() && passive ? "\n" : ", ");
      }
    }
  }
  figure.script = script + "unset multiplot\n";
  figure.width = 2400;
  writeAtomically(directory + "/" + figure.name + ".csv", figure.data.front().second);
  writeAtomically(directory + "/" + figure.name + ".png", Gnuplot().plot(figure));
}

std::vector<Record> energyMap(const GraspBenchOptions& options, MeasureContext& context) {
  const std::vector<MapRow> rows = stabilityMap(context);
  double within = 0, beyond = 0, held = 0, beyond_minute = 0, held_minute = 0, of_unforeseen = 0;
  for (const MapRow& row : rows) {
    double& free = row.stiffness <= row.bound ? within : beyond;
    free = std::min(free, row.free.least);
    held = std::min(held, row.held.least);
    of_unforeseen = std::min(of_unforeseen, row.held.least / row.held.unforeseen);
    beyond_minute = std::max(beyond_minute, row.free.wholePerMinute());
    held_minute = std::max(held_minute, row.held.laterPerMinute());
  }
  if (!options.out.empty() && !context.interrupted()) plotMap(options.out, rows);
  return {atLeast("within theory's bound, passivity off: least energy that came in", 1e3 * within, "mJ", -1e-6),
          unbounded("beyond it, passivity off: least energy that came in", 1e3 * beyond, "mJ"),
          unbounded("beyond it, passivity off: made, largest", beyond_minute, "J/min"),
          atLeast("everywhere, passivity on: least energy that came in", 1e3 * held, "mJ", -1),
          atLeast("everywhere, passivity on: likewise, over what the hands can do unforeseen within a tick",
                  of_unforeseen, "-", -1),
          atMost("everywhere, passivity on: made, largest", held_minute, "J/min", 0.01)};
}

}  // namespace

std::vector<Measurement> couplingMeasurements(const GraspBenchOptions& options) {
  return {{"coupling/stable", stableCouplings},
          {"coupling/energy-map", [options](MeasureContext& c) { return energyMap(options, c); }}};
}

}  // namespace pincer::tasks
