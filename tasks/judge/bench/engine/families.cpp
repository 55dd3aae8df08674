// Families of scenes: what they cost tick by tick, how far they are off, whether they come to rest; what Bullet costs
// in the same run. (Errors of other engines: walls/3x8 of scenes_resting.cpp.)
#include <fmt/format.h>

#include <algorithm>

#include "pincer/tasks/judge/bench/engine/engine_bench.h"
#include "pincer/tasks/judge/bench/engine/family_worlds.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

// Times of ticks, of this thread [us].
struct Costs {
  std::vector<double> all, late;  // late: of the second half of each run

  void add(const Costs& run) {
    all.insert(all.end(), run.all.begin(), run.all.end());
    late.insert(late.end(), run.all.begin() + static_cast<std::ptrdiff_t>(run.all.size() / 2), run.all.end());
  }
};

// Results of a run, or of several.
struct FamilyRun {
  Costs us;
  int flagged = 0;
  double error = 0, overlap = 0;      // of contact velocities [m/s]; [m]; the largest of all ticks
  double end_overlap = 0;             // in the last tick [m]
  double moved = 0, moved_after = 0;  // of the last body: altogether, and after half of the time [m]
  bool rests = true;                  // the last ten ticks changed nothing, to the bit

  void add(const FamilyRun& run) {
    us.add(run.us);
    flagged += run.flagged;
    error = std::max(error, run.error);
    overlap = std::max(overlap, run.overlap);
    end_overlap = std::max(end_overlap, run.end_overlap);
    moved = std::max(moved, run.moved);
    moved_after = std::max(moved_after, run.moved_after);
    rests = rests && run.rests;
  }
};

class FamilyRunner {
 public:
  explicit FamilyRunner(FamilyWorld world) : world_(std::move(world)), scratch_(engine::makeScratch(world_.model)) {}

  // Its progress goes on from `done`, by `part`, of all that is measured.
  FamilyRun run(double seconds, MeasureContext& context, double done = 0, double part = 1) {
    const int ticks = static_cast<int>(std::lround(seconds / world_.model.options.h));
    const Vec3 start = place();
    Vec3 half = start;
    std::uint64_t hash = 0;
    for (int n = 0; n < ticks && !context.interrupted(); ++n) {
      tick();
      if (n == ticks / 2) half = place();
      if (n == ticks - 11) hash = bodiesHash();
      if (n % 64 == 0) context.progress(done + part * n / ticks);
    }
    run_.end_overlap = overlap();
    run_.moved = (place() - start).norm();
    run_.moved_after = (place() - half).norm();
    run_.rests = hash == bodiesHash();
    return std::move(run_);
  }

 private:
  void tick() {
    const double before = threadCpuSeconds();
    const engine::StepReport report = engine::step(world_.model, world_.state, *scratch_);
    run_.us.all.push_back(1e6 * (threadCpuSeconds() - before));
    run_.flagged += report.status != engine::kStepOk;
    run_.error = std::max(run_.error, report.solve.error);
    run_.overlap = std::max(run_.overlap, overlap());
  }
  double overlap() const {
    double deepest = 0;
    for (int k = 0; k < engine::contactCount(*scratch_); ++k)
      deepest = std::max(deepest, -engine::contactAt(*scratch_, k).gap);
    return deepest;
  }
  // Error of all that can be seen: places and velocities.
  std::uint64_t bodiesHash() const {
    engine::WorldState seen = world_.state;
    seen.tick = 0;
    seen.time = 0;
    return engine::hashOf(seen);
  }
  const Vec3& place() const { return world_.state.bodies.back().X_WI.p; }

  FamilyWorld world_;
  engine::ScratchHandle scratch_;
  FamilyRun run_;
};

double shareOf(std::vector<double> us, double share) {
  std::sort(us.begin(), us.end());
  return us.empty() ? 0 : us[std::min(us.size() - 1, static_cast<std::size_t>(share * static_cast<double>(us.size())))];
}

double meanOf(const std::vector<double>& us) {
  double sum = 0;
  for (const double x : us) sum += x;
  return us.empty() ? 0 : sum / static_cast<double>(us.size());
}

void addCosts(const FamilyRun& run, std::vector<Record>& records) {
  const double median = shareOf(run.us.all, 0.5);
  records.push_back(unbounded("tick, mean", meanOf(run.us.all), "us"));
  records.push_back(unbounded("tick, median", median, "us"));
  records.push_back(unbounded("tick, p99 over the median", shareOf(run.us.all, 0.99) / median, "-"));
  records.push_back(unbounded("tick, longest", shareOf(run.us.all, 1), "us"));
  records.push_back(unbounded("contact velocities off by, largest", run.error, "m/s"));
}

// Another engine in the same world, tick by tick.
struct PeerRun {
  Costs us;
  double moved = 0, moved_after = 0;  // as FamilyRun's [m]
};

PeerRun runPeer(const Contestant& peer, const FamilyWorld& world, double seconds, MeasureContext& context) {
  PeerRun run;
  const double h = world.model.options.h;
  const int ticks = static_cast<int>(std::lround(seconds / h)), last = static_cast<int>(world.bench.bodies.size()) - 1;
  const auto engine = peer.make(world.bench, {.h = h});
  Vec3 start = engine->motion(last).X_WB.p, half = start;
  for (int n = 0; n < ticks && !context.interrupted(); ++n) {
    const double before = threadCpuSeconds();
    engine->step();
    run.us.all.push_back(1e6 * (threadCpuSeconds() - before));
    if (n == ticks / 2) half = engine->motion(last).X_WB.p;
  }
  run.moved = (engine->motion(last).X_WB.p - start).norm();
  run.moved_after = (engine->motion(last).X_WB.p - half).norm();
  return run;
}

// pincer's own runs, then, if `peers`, the others' beside them: what they cost, and how far their last body went. Heaps
// are chaotic: of one seed a roller may stop or go on by chance, so the mean is that of several.
class Family {
 public:
  using Make = std::function<FamilyWorld(std::uint64_t seed)>;
  Family(Make make, int seeds, double seconds, bool peers)
      : make_(std::move(make)),
        seeds_(seeds),
        seconds_(seconds),
        peers_(peers ? familyPeers() : std::vector<Contestant>()) {}

  FamilyRun run(MeasureContext& context) const {
    FamilyRun all;
    forEachWorld(context, [&](FamilyWorld world, double done) {
      all.add(FamilyRunner(std::move(world)).run(seconds_, context, done, 1.0 / seeds_));
    });
    return all;
  }

  void addPeers(const FamilyRun& own, std::vector<Record>& records, MeasureContext& context) const {
    for (const Contestant& peer : peers_) {
      PeerRun all;
      forEachWorld(context, [&](const FamilyWorld& world, double) {
        const PeerRun run = runPeer(peer, world, seconds_, context);
        all.us.add(run.us);
        all.moved = std::max(all.moved, run.moved);
        all.moved_after = std::max(all.moved_after, run.moved_after);
      });
      const std::string name = peer.name();
      records.push_back(unbounded(name + ": tick, mean", meanOf(all.us.all), "us"));
      records.push_back(unbounded(name + ": tick, longest", shareOf(all.us.all, 1), "us"));
      records.push_back(unbounded(name + ": the last body moves", 1e6 * all.moved, "um"));
      records.push_back(unbounded(name + ": of that in the second half", 1e6 * all.moved_after, "um"));
      records.push_back(unbounded("mean over that of " + name, meanOf(own.us.all) / meanOf(all.us.all), "-"));
      records.push_back(unbounded("the same in the second half", meanOf(own.us.late) / meanOf(all.us.late), "-"));
    }
  }

 private:
  template <class Act>
  void forEachWorld(MeasureContext& context, const Act& act) const {
    for (int n = 0; n < seeds_ && !context.interrupted(); ++n)
      act(make_(static_cast<std::uint64_t>(n + 1)), static_cast<double>(n) / seeds_);
  }

  Make make_;
  int seeds_;
  double seconds_;
  std::vector<Contestant> peers_;
};

// A wall that stands must come to rest to the bit; unflagged, unless it is laid with gaps and overlaps.
Measurement wallMeasurement(const std::string& name, const Family& family, bool is_exact) {
  return {"walls/" + name, [=](MeasureContext& context) {
            const FamilyRun run = family.run(context);
            std::vector<Record> records = {
                is_exact ? atMost("ticks flagged", run.flagged, "-", 0) : unbounded("ticks flagged", run.flagged, "-"),
                atMost("top moves in the second half", 1e6 * run.moved_after, "um", 1e-3),
                exactly("changes in the last ten ticks", !run.rests, "-", 0)};
            addCosts(run, records);
            family.addPeers(run, records, context);
            return records;
          }};
}

Measurement hitMeasurement(const std::string& name, const Family& family) {
  return {"walls/" + name, [=](MeasureContext& context) {
            const FamilyRun run = family.run(context);
            std::vector<Record> records = {
                unbounded("ticks flagged", run.flagged, "-"),
                unbounded("tick, longest over the mean", shareOf(run.us.all, 1) / meanOf(run.us.all), "-")};
            addCosts(run, records);
            family.addPeers(run, records, context);
            return records;
          }};
}

Measurement heapMeasurement(const std::string& name, const Family& family) {
  return {name, [=](MeasureContext& context) {
            const FamilyRun run = family.run(context);
            std::vector<Record> records = {
                atMost("overlap at the end", 1e6 * run.end_overlap, "um", 20),
                unbounded("overlap, deepest", 1e6 * run.overlap, "um"),
                unbounded("ticks flagged", 100.0 * run.flagged / static_cast<double>(run.us.all.size()), "%")};
            addCosts(run, records);
            family.addPeers(run, records, context);
            return records;
          }};
}

// Pegs that fall onto their holes, tip and jam there.
Measurement randomPegsMeasurement(int pegs) {
  return {"pegs/random", [=](MeasureContext& context) {
            FamilyRun all;
            for (int n = 1; n <= pegs && !context.interrupted(); ++n) {
              FamilyRunner runner(randomPegWorld(static_cast<std::uint64_t>(n)));
              all.add(runner.run(0.7, context, (n - 1.0) / pegs, 1.0 / pegs));
            }
            const double flagged =
                100.0 * all.flagged / static_cast<double>(std::max<std::size_t>(1, all.us.all.size()));
            // 2e-3 are those of 400; two of 40's 28,000 ticks
            std::vector<Record> records = {atMost(fmt::format("ticks flagged of {} pegs", pegs), flagged, "%", 8e-3)};
            addCosts(all, records);
            return records;
          }};
}

}  // namespace

std::vector<Measurement> familyMeasurements(bool whole, bool peers) {
  const double stands = whole ? 60 : 2;
  std::vector<Measurement> all;
  const auto wall = [&](const std::string& name, const WallSpec& spec, double seconds) {
    const Family family([=](std::uint64_t) { return wallWorld(spec); }, 1, seconds, peers);
    // laid with gaps and overlaps its bricks hit each other first
    all.push_back(spec.hit_speed > 0 ? hitMeasurement(name, family) : wallMeasurement(name, family, spec.jitter == 0));
  };
  const auto heap = [&](const std::string& name, Family::Make make, double seconds, int seeds = 1) {
    all.push_back(heapMeasurement(name, Family(std::move(make), seeds, seconds, peers)));
  };
  const int seeds = whole ? 20 : 1;
  for (const auto& [columns, rows] : {std::pair(1, 1), {1, 5}, {2, 4}, {2, 9}, {3, 8}, {3, 10}, {10, 10}})
    wall(fmt::format("{}x{}", columns, rows), {.columns = columns, .rows = rows}, stands);
  for (const double mu : {0.3, 0.9}) wall(fmt::format("5x8-mu-{}", mu), {.columns = 5, .rows = 8, .mu = mu}, stands);
  wall("5x8-heading-30", {.columns = 5, .rows = 8, .heading = 0.52}, stands);
  wall("3x10-jitter-10um", {.columns = 3, .rows = 10, .jitter = 1e-5}, stands);
  wall("3x10-jitter-100um", {.columns = 3, .rows = 10, .jitter = 1e-4}, stands);
  wall("6x6-hit", {.columns = 6, .rows = 6, .hit_speed = 10}, 1);
  heap(
      "heaps/balls-100", [](std::uint64_t seed) { return ballWorld(100, 5, seed); }, 2);
  heap(
      "heaps/discs-12", [](std::uint64_t seed) { return heapWorld(Falling::kDiscs, 12, seed); }, whole ? 3 : 2, seeds);
  heap(
      "hulls/50", [](std::uint64_t seed) { return hullWorld(50, seed); }, whole ? 3 : 1.5, seeds);
  const auto dial = [&](const std::string& name, double accuracy, double h) {
    heap(
        "hulls/50-" + name,
        [=](std::uint64_t seed) {
          FamilyWorld world = hullWorld(50, seed);
          world.model.options.solver.accuracy = accuracy;
          world.model.options.h = h;
          return world;
        },
        whole ? 3 : 1.5, seeds);
  };
  for (const double accuracy : {1e-4, 1e-3, 1e-2}) dial(fmt::format("accuracy-{}", accuracy), accuracy, 1e-3);
  for (const double h : {2e-3, 4e-3}) dial(fmt::format("accuracy-0.01-tick-{}ms", 1e3 * h), 1e-2, h);
  for (const double play : {5e-5, 1e-4, 2e-4})
    heap(
        fmt::format("pegs/play-{}um", 1e6 * play), [=](std::uint64_t) { return pegWorld(play, 8e-3); }, 0.5);
  all.push_back(randomPegsMeasurement(whole ? 400 : 40));
  if (!whole) return all;
  for (const auto& [columns, rows] : {std::pair(20, 6), {20, 10}, {40, 20}})
    wall(fmt::format("{}x{}", columns, rows), {.columns = columns, .rows = rows}, columns * rows > 400 ? 10 : stands);
  wall("20x10-jitter-10um", {.columns = 20, .rows = 10, .jitter = 1e-5}, 10);
  wall("20x10-hit", {.columns = 20, .rows = 10, .hit_speed = 10}, 1);
  wall("3x8-masses-1e3", {.columns = 3, .rows = 8, .mass_ratio = 1e3}, 10);
  heap(
      "heaps/balls-400", [](std::uint64_t seed) { return ballWorld(400, 8, seed); }, 3);
  for (const auto& [name, what] : {std::pair("discs", Falling::kDiscs),
                                   {"capsules", Falling::kCapsules},
                                   {"cans", Falling::kCans},
                                   {"cubes", Falling::kCubes},
                                   {"mixed", Falling::kMixed}})
    heap(
        fmt::format("heaps/{}-50", name), [what = what](std::uint64_t seed) { return heapWorld(what, 50, seed); }, 3,
        seeds);
  heap(
      "hulls/100", [](std::uint64_t seed) { return hullWorld(100, seed); }, 3);
  return all;
}

}  // namespace pincer::tasks
