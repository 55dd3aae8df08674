#include "pincer/tasks/judge/bench/sweep.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/judge/bench/path_figures.h"

namespace pincer::tasks {
namespace {

constexpr double kSpeed = 0.1;                      // [m/s]
constexpr double kSweepStep = kSpeed * kBenchTick;  // way of a tick [m]

}  // namespace

FingerPath sweepAround(const contact::SmoothMesh& mesh, const SweepPlane& plane, const Vec3& start, double length,
                       double depth) {
  BenchFinger finger;
  const auto inPlane = [&](const Vec3& p) -> Vec3 { return p + (plane.offset - p.dot(plane.axis)) * plane.axis; };
  contact::SurfaceContact touch = finger.on(mesh, inPlane(2 * mesh.boundingRadius() * start)).main();
  Vec3 C = inPlane(touch.p_BS + (kBenchFinger - depth) * touch.n_B);
  FingerPath path{{}, static_cast<int>(length / kSweepStep)};
  for (int i = 0; i < path.restart_every; ++i) {
    touch = finger.on(mesh, C).main();
    path.centres.push_back(C);
    const Vec3 up = (touch.n_B - touch.n_B.dot(plane.axis) * plane.axis).normalized();
    C += kSweepStep * plane.axis.cross(up) + std::clamp(-depth - touch.phi, -kSweepStep, kSweepStep) * up;
    C = inPlane(C);
  }
  return path;
}

FingerPath circleAround(const SweepPlane& plane, double R) {
  PINCER_ASSERT(isUnit(plane.axis) && R > 0);
  const Mat3 frame = frameFromNormal(plane.axis);
  FingerPath path{{}, static_cast<int>(2 * M_PI * R / kSweepStep)};
  for (int i = 0; i < path.restart_every; ++i) {
    const double a = i * kSweepStep / R;
    path.centres.push_back(plane.offset * plane.axis + R * (math::cos(a) * frame.col(0) + math::sin(a) * frame.col(1)));
  }
  return path;
}

SweepTrace traceAlong(const contact::SmoothMesh& mesh, const FingerPath& path, const SweepPlane& plane) {
  const Mat3 frame = frameFromNormal(plane.axis);
  SweepTrace trace;
  BenchFinger finger;
  double turned = 0, last = 0;
  for (std::size_t i = 0; i < path.centres.size(); ++i) {
    const contact::SurfaceContacts contacts = finger.on(mesh, path.centres[i]);
    const Vec3 n = feltDirection(contacts);
    const double angle = math::atan2(n.dot(frame.col(1)), n.dot(frame.col(0)));
    if (i > 0) turned += std::remainder(angle - last, 2 * M_PI);
    last = angle;
    trace.n.push_back(n);
    trace.place.push_back(kBenchFinger * turned);
    trace.phi.push_back(contacts.main().phi);
    trace.held += (finger.tracker.status & contact::kQueryHeldDirection) != 0;
  }
  return trace;
}

double largestStep(const std::vector<double>& values) {
  double largest = 0;
  for (std::size_t i = 1; i < values.size(); ++i) largest = std::max(largest, std::abs(values[i] - values[i - 1]));
  return largest;
}

double rippleAboutLine(const std::vector<double>& values) {
  double low = 0, high = 0;
  const double slope = (values.back() - values.front()) / static_cast<double>(values.size() - 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double off = values[i] - values.front() - slope * static_cast<double>(i);
    low = std::min(low, off);
    high = std::max(high, off);
  }
  return high - low;
}

}  // namespace pincer::tasks
