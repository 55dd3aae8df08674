#include "pincer/tasks/app/sim_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/app/grasp_text.h"
#include "pincer/tasks/app/terminal.h"
#include "pincer/tasks/run/scene/expectation_text.h"
#include "pincer/tasks/run/scene/sim_run.h"

namespace pincer::tasks {
namespace {

std::string millimetres(const Vec3& p) {
  return fmt::format("{:11.6f} {:11.6f} {:11.6f}", 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
}

std::string expectationLine(const Expectation& expected, const Outcome& outcome) {
  const std::string verdict = !outcome.reached ? "  -  " : outcome.holds() ? good(" ok  ") : bad("FAILS");
  std::string line = fmt::format("  {} {}\n", verdict, outcomeText(expected, outcome));
  if (outcome.reached && !outcome.holds() && !expected.because.empty())
    line += fmt::format("        because {}\n", printable(expected.because, kLongestMessage));
  return line;
}

void appendStates(const Simulation& simulation, std::string& out) {
  const Moment moment = simulation.moment();
  out += fmt::format("\nAt {:g} s              x [mm]      y [mm]      z [mm]\n", simulation.time());
  for (std::size_t i = 0; i < simulation.scene().bodies.size(); ++i) {
    const engine::BodySpec& body = simulation.scene().bodies[i];
    if (!body.dynamic) continue;
    const Pose X_WB = simulation.bodyPose(static_cast<int>(i));
    out += fmt::format("  {:<14} {}   turned {:.3g} rad, {:.3g} mm/s\n", body.name, millimetres(X_WB.p),
                       angleBetween(simulation.scene().starts[i].X_WB.q, X_WB.q),
                       1e3 * moment.state.world.bodies[i].v_W.norm());
  }
  for (std::size_t i = 0; i < simulation.scene().fingers.size(); ++i) {
    const grasp::FingerReport& felt = moment.fingers[i];
    const std::string contact = felt.touching ? fmt::format("presses {:.4g} N, friction {:.4g} N{}", felt.normal_force,
                                                            felt.tangential_force, felt.sliding ? ", slides" : "")
                                              : "touches nothing";
    out += fmt::format("  {:<14} {}   {}\n", simulation.scene().fingers[i].model.name,
                       millimetres(moment.state.world.points[i].p_W), contact);
  }
}

void appendRecorded(const Simulation& simulation, std::string& out) {
  const std::vector<Quantity>& quantities = simulation.scene().record.quantities;
  if (quantities.empty()) return;
  out += "\nRecorded, last values (all of them: --out FILE.csv)\n";
  for (const Quantity& q : quantities)
    out += fmt::format("  {:<24} {:.10g} {}\n", q.name, q.measure(simulation.moment()), q.kind->unit);
}

constexpr std::size_t kMostOverlaps = 5;  // that are told one by one

void appendOverlaps(const Scene& scene, const std::vector<StartOverlap>& overlaps, std::string& out) {
  const auto nameOf = [&](int body) { return printable(scene.bodies[static_cast<std::size_t>(body)].name); };
  for (std::size_t i = 0; i < std::min(overlaps.size(), kMostOverlaps); ++i)
    out += fmt::format("\n{} {} and {} overlap by {:.3g} mm at the start. Draw them apart.\n", bad("Note:"),
                       nameOf(overlaps[i].a), nameOf(overlaps[i].b), 1e3 * overlaps[i].depth);
  if (overlaps.size() > kMostOverlaps)
    out += fmt::format("      And {} (all of them: --json).\n",
                       counted(static_cast<std::int64_t>(overlaps.size() - kMostOverlaps), "more pair"));
}

void appendStatuses(const SimResult& result, std::string& out) {
  for (std::size_t i = 0; i < kStatusKinds.size(); ++i) {
    if (result.statuses.of(i) > 0)
      out += fmt::format("\n{} in {} {}\n", bad("Note:"), counted(result.statuses.of(i), "tick"),
                         kStatusKinds[i].sentence);
  }
}

}  // namespace

std::string expectationsText(const ExpectationLog& log) {
  if (log.expectations().empty()) return "";
  std::string out = "\nExpected\n";
  for (std::size_t i = 0; i < log.expectations().size(); ++i)
    out += expectationLine(log.expectations()[i], log.outcomes()[i]);
  return out;
}

std::string simText(const Simulation& simulation, const SimOptions& options, const SimResult& result) {
  const Scene& scene = simulation.scene();
  std::string out = scene.description.empty()
                        ? printable(scene.file) + "\n"
                        : fmt::format("{}\n{}\n", printable(scene.file), printable(scene.description, kLongestMessage));
  appendStates(simulation, out);
  if (options.grasp) out += graspText(simulation);
  appendRecorded(simulation, out);
  out += expectationsText(result.log);
  appendOverlaps(scene, result.overlaps, out);
  appendStatuses(result, out);
  out += fmt::format("\n{} of {:g} ms, each: median {:.2f} us, p99.9 {:.2f} us, longest {:.1f} us\n",
                     counted(simulation.ticks(), "tick"), 1e3 * scene.options.h, 1e6 * result.times.quantile(0.5),
                     1e6 * result.times.quantile(0.999), 1e6 * result.times.quantile(1));
  out += fmt::format("State {} at {:g} s\n", hashText(simulation.state().world), simulation.time());
  if (result.interrupted) out += fmt::format("Interrupted at {:g} s of {:g} s.\n", simulation.time(), scene.duration);
  return out;
}

}  // namespace pincer::tasks
