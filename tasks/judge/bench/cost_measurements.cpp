// Cost of a query: warm, with the global guard, over the number of triangles, and beside other engines.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh/mesh_writer.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/tasks/judge/bench/contact_bench.h"
#include "pincer/tasks/judge/bench/flat_distance.h"
#include "pincer/tasks/judge/bench/objects.h"
#include "pincer/tasks/judge/bench/path_figures.h"
#include "pincer/tasks/judge/bench/peers.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

using contact::SmoothMesh;
using contact::TriangleMesh;

constexpr double kPressed = 0.002;  // [m]

// One long stroke at 100 mm/s, pressed 2 mm, or at a constant gap where `depth` is negative.
FingerPath evenStroke(const SmoothMesh& mesh, double depth, MeasureContext& context) {
  Stroke stroke;
  stroke.ticks = 20000;
  stroke.restart_every = 20000;
  stroke.slowest = stroke.fastest = 0.1;
  stroke.depth = depth;
  return strokeOver(mesh, stroke, context);
}

// A finger that goes along a path over a mesh, again and again.
class Walk {
 public:
  Walk(const SmoothMesh& mesh, const FingerPath& path, double margin = kBenchMargin)
      : mesh_(mesh), path_(path), margin_(margin) {}

  void query() {
    if (next_ == path_.centres.size()) next_ = 0;
    if (next_ == 0) finger_.tracker = {};
    sum_ += finger_.on(mesh_, path_.centres[next_++], margin_).main().phi;
  }
  void query(int count) {
    for (int i = 0; i < count; ++i) query();
  }
  void restart() {
    finger_ = BenchFinger();
    next_ = 0;
  }
  double sum() const { return sum_; }  // of all gaps: so that no answer is optimised away

 private:
  const SmoothMesh& mesh_;
  const FingerPath& path_;
  const double margin_;
  BenchFinger finger_;
  std::size_t next_ = 0;
  double sum_ = 0;
};

CallCost costAlong(const SmoothMesh& mesh, const FingerPath& path, double margin = kBenchMargin) {
  Walk walk(mesh, path, margin);
  const auto query = [&](std::int64_t) { walk.query(); };
  CallCost cost = costOfCalls(query, {.single_calls = 0});
  cost.p999 = tailOfWalk([&] { walk.restart(); }, query, static_cast<std::int64_t>(path.centres.size()));
  if (std::isnan(walk.sum())) return {walk.sum(), walk.sum(), walk.sum()};
  return cost;
}

FingerPath liftedBy(const SmoothMesh& mesh, FingerPath path, double gap) {
  BenchFinger finger;
  for (Vec3& C : path.centres) {
    const contact::SurfaceContact c = finger.on(mesh, C).main();
    C += (gap - c.phi) * c.n_B;
  }
  return path;
}

std::vector<Record> warmCost(MeasureContext& context) {
  const auto mesh = SmoothMesh::build(contact::icosphere(0.02, 3));
  const FingerPath path = evenStroke(*mesh, kPressed, context);
  const CallCost cost = costAlong(*mesh, path, 0), wide = costAlong(*mesh, path);
  return {atMost("1280 triangles, median", cost.median, "ns", 200), unbounded("1280 triangles, p99.9", cost.p999, "ns"),
          unbounded("1280 triangles, all contacts nearer than 1 mm, median", wide.median, "ns")};
}

// In the air, where the nearest place is asked of the whole mesh each tick.
std::vector<Record> guardCost(MeasureContext& context) {
  const auto mesh = SmoothMesh::build(contact::icosphere(0.04, 6));
  const FingerPath path = liftedBy(*mesh, evenStroke(*mesh, kPressed, context), 0.0005);
  const CallCost cost = costAlong(*mesh, path);
  return {atMost("81,920 triangles, median", cost.median / 1000, "us", 3),
          atMost("81,920 triangles, p99.9", cost.p999 / 1000, "us", 10)};
}

// A name in the system's temporary directory, for as long as this lives.
class ScratchFile {
 public:
  explicit ScratchFile(const char* ending)
      : path_(std::filesystem::temp_directory_path() / fmt::format("pincer-bench-{}{}", ::getpid(), ending)) {}
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct GrowthStep {
  int n;         // 20 n^2 triangles
  double bound;  // [us]
};
// Each has ten times the triangles of the last, 980 to 1,003,520; of the largest nothing is promised.
constexpr GrowthStep kGrowth[] = {{7, 0.5}, {22, 1.2}, {71, 3}, {224, std::numeric_limits<double>::infinity()}};

// By turns: where the machine changes its speed meanwhile both change.
double costRatio(const SmoothMesh& large, const FingerPath& over_large, const SmoothMesh& small,
                 const FingerPath& over_small) {
  constexpr int kRounds = 401, kQueries = 1000;  // rounds, odd for their median; calls in one; chosen
  Walk a(large, over_large), b(small, over_small);
  return ratioOfCosts([&] { a.query(kQueries); }, [&] { b.query(kQueries); }, kRounds);
}

std::vector<Record> growth(MeasureContext& context) {
  std::vector<Record> records;
  std::shared_ptr<const SmoothMesh> first, mesh;
  FingerPath over_first, path;
  double triangles = 0;
  for (const auto& [n, bound] : kGrowth) {
    triangles = 20.0 * n * n;
    TriangleMesh sphere = contact::geodesicSphere(0.04, n);
    const double start = threadCpuSeconds();
    mesh = SmoothMesh::build(std::move(sphere));
    const double built = threadCpuSeconds() - start;
    path = evenStroke(*mesh, kPressed, context);
    if (!first) {
      first = mesh;
      over_first = path;
    }
    const double cost = costAlong(*mesh, path).median;
    records.push_back(atMost(fmt::format("{:.0f} triangles, warm, median", triangles), cost / 1000, "us", bound));
    records.push_back(atMost(fmt::format("{:.0f} triangles, processor time to build", triangles), built, "s", 10));
    const double bytes = static_cast<double>(mesh->memoryBytes()) / triangles;
    records.push_back(atMost(fmt::format("{:.0f} triangles, memory per untouched one", triangles), bytes, "B", 160));
    if (context.interrupted()) return records;
  }
  const double allowed = math::log(triangles) / math::log(20.0 * kGrowth[0].n * kGrowth[0].n);
  records.push_back(
      atMost("largest over smallest mesh, by turns", costRatio(*mesh, path, *first, over_first), "-", allowed));
  return records;
}

std::vector<Record> fileCost(const BenchObject& object, MeasureContext& context) {
  const auto mesh = SmoothMesh::build(object.mesh);
  const CallCost cost = costAlong(*mesh, evenStroke(*mesh, kPressed, context));
  return {atMost("warm query, median", cost.median / 1000, "us", 5),
          atMost("warm query, p99.9", cost.p999 / 1000, "us", 20)};
}

struct ReadKind {
  const char* name;
  const char* ending;
  bool ascii;
};
// Name, ending, and if it is written as text: the formats that are read.
constexpr ReadKind kReadKinds[] = {{"STL", ".stl", false},
                                   {"PLY", ".ply", false},
                                   {"PLY as text", ".ply", true},
                                   {"OBJ", ".obj", false},
                                   {"OFF", ".off", false}};

// A file of a million triangles, written before and removed after.
std::vector<Record> readCost(MeasureContext& context) {
  // Promises [s], [-]; chosen: a person waits no longer, and sees it go on.
  constexpr double kMostSeconds = 10, kFewestReports = 10;
  const TriangleMesh mesh = contact::geodesicSphere(0.04, 224);
  std::vector<Record> records;
  for (const auto& [name, ending, ascii] : kReadKinds) {
    const ScratchFile file(ending);
    contact::writeMesh(file.path(), mesh, {.ascii = ascii});
    int reports = 0;
    const double start = steadySeconds();
    const TriangleMesh read = contact::readMesh(file.path(), {.progress = [&](double) { ++reports; }});
    const double seconds = steadySeconds() - start;
    const double megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(file.path()));
    records.push_back(atMost(fmt::format("{}, {} triangles", name, read.triangles.size()), seconds, "s", kMostSeconds));
    records.push_back(unbounded(fmt::format("{}, {:.0f} MB", name, megabytes), megabytes / seconds, "MB/s"));
    records.push_back(atLeast(fmt::format("{}, reports of progress", name), reports, "-", kFewestReports));
    if (context.interrupted()) return records;
  }
  return records;
}

struct PeerFigures {
  double cost = 0;         // median [ns]
  double turn = 0;         // largest per tick [rad]
  double depth_error = 0;  // against all flat triangles [m]
  int missed = 0;          // of the checked places where triangles and finger overlap: without an answer
};

double turnBetween(const Vec3& a, const Vec3& b) { return math::atan2(a.cross(b).norm(), a.dot(b)); }

PeerFigures figuresOf(MeshPeer& peer, const TriangleMesh& mesh, const FingerPath& path) {
  constexpr std::size_t kChecked = 100;  // every so many ticks, for trying all triangles takes long
  PeerFigures f;
  Vec3 last = Vec3::Zero();
  for (std::size_t i = 0; i < path.centres.size() / 10; ++i) {
    const PeerContact c = peer.query(path.centres[i]);
    if (i % kChecked == 0) {
      const double phi = distanceToTriangles(mesh, path.centres[i]) - kBenchFinger;
      f.missed += !c.touches && phi < -1e-6;
      if (c.touches) f.depth_error = std::max(f.depth_error, std::abs(c.phi - phi));
    }
    if (c.touches && last != Vec3::Zero()) f.turn = std::max(f.turn, turnBetween(last, c.n_B));
    last = c.touches ? c.n_B : Vec3(Vec3::Zero());
  }
  const auto n = static_cast<std::int64_t>(path.centres.size());
  double sum = 0;
  const auto query = [&](std::int64_t i) { sum += peer.query(path.centres[static_cast<std::size_t>(i % n)]).phi; };
  f.cost = costOfCalls(query, {.warm_up = 50, .batches = 11, .calls_per_batch = 50, .single_calls = 0}).median;
  return f;
}

double pincersLargestTurn(const SmoothMesh& mesh, const FingerPath& path) {
  BenchFinger finger;
  Vec3 last = Vec3::Zero();
  double turn = 0;
  for (std::size_t i = 0; i < path.centres.size(); ++i) {
    const Vec3 n = feltDirection(finger.on(mesh, path.centres[i]));
    if (i > 0) turn = std::max(turn, turnBetween(last, n));
    last = n;
  }
  return turn;
}

std::vector<Record> besidePeers(int n, MeasureContext& context) {
  const TriangleMesh triangles = contact::geodesicSphere(0.04, n);
  const auto mesh = SmoothMesh::build(triangles);
  const FingerPath path = evenStroke(*mesh, kPressed, context);
  const double mine = costAlong(*mesh, path).median;
  std::vector<Record> records = {
      unbounded("pincer, smooth, median", mine / 1000, "us"),
      unbounded("pincer, smooth, largest turn per tick", pincersLargestTurn(*mesh, path) * 180 / M_PI, "deg")};
  for (const auto& peer : meshPeers(triangles, kBenchFinger)) {
    const PeerFigures f = figuresOf(*peer, triangles, path);
    records.push_back(unbounded(peer->name() + ", median", f.cost / 1000, "us"));
    records.push_back(unbounded(peer->name() + ", largest turn per tick", f.turn * 180 / M_PI, "deg"));
    records.push_back(unbounded(peer->name() + ", depth error against the flat triangles", 1e6 * f.depth_error, "um"));
    records.push_back(unbounded(peer->name() + ", overlaps missed, of 20 checked", f.missed, "-"));
    records.push_back(atMost("pincer's cost over " + peer->name() + "'s", mine / f.cost, "-", 1));
  }
  return records;
}

}  // namespace

std::vector<Measurement> costMeasurements(const ContactBenchOptions& options) {
  std::vector<Measurement> measurements = {
      {"cost/warm", warmCost}, {"cost/global-guard", guardCost}, {"cost/growth", growth}, {"cost/read", readCost}};
  if (!options.meshes.empty()) {
    for (const MeshFile& file : meshFilesIn(options.meshes)) {
      const auto run = [file](MeasureContext& context) {
        return measureFile(file, [&](const BenchObject& object) { return fileCost(object, context); });
      };
      measurements.push_back({"cost/file/" + file.name, run});
    }
  }
  if (options.peers) {
    for (const int n : {7, 22, 71}) {
      measurements.push_back({fmt::format("peers/sphere-{}", 20 * n * n),
                              [n](MeasureContext& context) { return besidePeers(n, context); }});
    }
  }
  return measurements;
}

}  // namespace pincer::tasks
