#include "pincer/contact/surface/shell_solver.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/surface/shell_edge.h"
#include "pincer/contact/surface/shell_face.h"

namespace pincer::contact {

namespace {

constexpr double kDone = 1e-8;  // of the surface's length: a residual that needs no further step
// of it: a residual from which Newton's next step, squaring it, need not be looked at again
constexpr double kNear = 4e-5;
constexpr double kAlong = 1e-9;     // of a step: what leads so little across an edge leads along it
constexpr int kMaxSteps = 20;       // within faces, and visits of edges and vertices
constexpr int kMaxCrossings = 200;  // of edges, at most one per step of a walk over fine triangles

double longest(const std::array<double, 3>& db) {
  return std::max({std::abs(db[0]), std::abs(db[1]), std::abs(db[2])});
}

// The last step, if it stays within the face: its end is so near that the patch is as good as linear.
[[gnu::flatten]] bool finish(const PatchPoint& x, double u, double v, const Vec3& C, ShellContact& contact) {
  const std::array<double, 3> b{contact.foot.b[0] - u - v, contact.foot.b[1] + u, contact.foot.b[2] + v};
  if (b[0] < 0 || b[1] < 0 || b[2] < 0) return false;
  contact.foot.b = b;
  contact.n = (x.N + u * x.Nu + v * x.Nv).normalized();
  PINCER_ASSERT(isUnitIfFinite(contact.n));
  contact.h = (C - x.S - u * x.Su - v * x.Sv).dot(contact.n);
  contact.converged = true;
  return true;
}

// Coordinates of the triangle's point nearest to `p` in its plane.
std::array<double, 3> coordinatesOf(const SurfaceNet& net, std::int32_t triangle, const Vec3& p) {
  const Vec3& from = net.vertex(triangle, 0);
  const Vec3 e = net.vertex(triangle, 1) - from, f = net.vertex(triangle, 2) - from, w = p - from;
  const double ee = e.squaredNorm(), ef = e.dot(f), ff = f.squaredNorm(), we = w.dot(e), wf = w.dot(f);
  const double inverse = 1 / (ee * ff - ef * ef), u = (ff * we - ef * wf) * inverse, v = (ee * wf - ef * we) * inverse;
  return {1 - u - v, u, v};
}

// The edge beyond which a foot is furthest outside.
int edgeLeft(const std::array<double, 3>& b) {
  const bool second = b[1] < b[0], third = b[2] < (second ? b[1] : b[0]);
  // across from the corner whose coordinate is least; no branch, for nothing foretells it
  return (1 + second) * !third;
}

// Carries a foot that is outside of its triangle over smooth edges into the one that
// it is in, as far as the flat mesh tells.
bool carryInside(const SurfaceNet& net, Foot& foot, int& crossings) {
  constexpr int kMostCrossings = 4;  // of edges in one step
  for (; std::min({foot.b[0], foot.b[1], foot.b[2]}) < 0; ++crossings) {
    const int edge = edgeLeft(foot.b);
    if (!(crossings < kMostCrossings) || net.isSharp(foot.triangle, edge)) return false;
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < 3; ++i) p += foot.b[static_cast<std::size_t>(i)] * net.vertex(foot.triangle, i);
    const std::int32_t other = net.neighbour(foot.triangle, edge).triangle;
    foot = {other, coordinatesOf(net, other, p)};
  }
  return true;
}

class ShellWalk {
 public:
  ShellWalk(const SurfaceNet& net, PatchCache& cache, const Vec3& C, const Foot& start)
      : net_(net), cache_(cache), C_(C), done_(kDone * net.length()), nearly_(kNear * net.length()), foot_(start) {
    PINCER_ASSERT(isIndex(start.triangle, static_cast<std::size_t>(net.size())));
    result_.foot = start;
  }

  ShellContact run() {
    while (state_ == State::onFace) stepOnFace();
    result_.cost = {steps_, crossings_};
    return result_;
  }

 private:
  enum class State { onFace, ended };
  struct Side {
    std::int32_t triangle = -1;
    int edge = -1;
  };

  const SurfaceCell& cell() const { return net_.cell(foot_.triangle, cache_); }
  void stepOnFace();
  bool polish(const PatchPoint& x, const FaceStep& step);
  bool halveLastMove(double residual);
  void move(const std::array<double, 3>& db);
  void meetEdge(int edge, double s);
  void cross(int edge, double s);
  void settleOnEdge(int edge, double s);
  bool leadsInside(int edge) const;
  void settleOnVertex(const CellCorner& at);
  bool leaveVertexIntoFace(const CellCorner& at);
  bool leaveVertexAlongEdge(const CellCorner& at);
  void putOnEdge(int edge, double s);
  void enterFace();
  void accept(const Vec3& n, double h);
  void giveUp() { state_ = State::ended; }

  const SurfaceNet& net_;
  PatchCache& cache_;
  const Vec3 C_;
  const double done_, nearly_;  // [m]
  Foot foot_;
  State state_ = State::onFace;
  ShellContact result_;

  StepKind next_kind_ = StepKind::newton;
  bool near_ = false;  // the last residual was below nearly_
  Side entered_by_;    // the edge through which the walk came into this face, until a step stays inside
  int steps_ = 0, crossings_ = 0;

  Foot last_;  // where the last step within this face began
  std::array<double, 3> last_db_{};
  double last_residual_ = 0, last_scale_ = 0;  // scale 0: no step to halve
};

void ShellWalk::stepOnFace() {
  const PatchPoint x = evaluate(cell().patch, foot_.b[1], foot_.b[2]);
  const FaceStep step = faceStep(x, C_, next_kind_);
  if (step.residual < done_ || (near_ && step.residual < nearly_)) {
    accept(step.n, step.h);
    if (step.is_newton) result_.motion = {step.du, step.dv};
    return;
  }
  if (step.residual < nearly_ && step.is_newton && polish(x, step)) return;
  if (steps_ >= kMaxSteps || crossings_ >= kMaxCrossings) return giveUp();
  near_ = step.residual < nearly_;
  if (!near_ && halveLastMove(step.residual)) return;
  last_ = foot_;
  last_db_ = step.db;
  last_residual_ = step.residual;
  last_scale_ = step.is_newton ? 1 : 0;
  next_kind_ = StepKind::newton;
  move(step.db);
}

bool ShellWalk::polish(const PatchPoint& x, const FaceStep& step) {
  ShellContact contact;
  contact.foot = foot_;
  if (!finish(x, step.db[1], step.db[2], C_, contact)) return false;
  contact.motion = {step.du, step.dv};
  result_ = contact;
  state_ = State::ended;
  return true;
}

bool ShellWalk::halveLastMove(double residual) {
  constexpr double kLeastScale = 0.05;  // of a step that is halved
  if (last_scale_ < kLeastScale || residual <= last_residual_) return false;
  ++steps_;
  last_scale_ *= 0.5;
  for (std::size_t i = 0; i < 3; ++i) foot_.b[i] = last_.b[i] + last_scale_ * last_db_[i];
  return true;
}

void ShellWalk::move(const std::array<double, 3>& db) {
  double part = 1;
  int leaving = -1;  // the coordinate that reaches 0 first
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (foot_.b[k] + db[k] >= 0 || db[k] >= -kAlong * longest(db)) continue;
    const double until = foot_.b[k] / -db[k];
    if (until >= part) continue;
    part = until;
    leaving = i;
  }
  for (std::size_t i = 0; i < 3; ++i) foot_.b[i] = std::max(0.0, foot_.b[i] + part * db[i]);
  if (leaving < 0) {
    ++steps_;
    entered_by_ = {};
    return;
  }
  const int edge = (leaving + 1) % 3;
  const double to = foot_.b[static_cast<std::size_t>((edge + 1) % 3)], from = foot_.b[static_cast<std::size_t>(edge)];
  meetEdge(edge, to / (from + to));
}

void ShellWalk::meetEdge(int edge, double s) {
  last_scale_ = 0;
  near_ = false;
  const bool turned_back = entered_by_.triangle == foot_.triangle && entered_by_.edge == edge;
  if (turned_back || cell().neighbours[static_cast<std::size_t>(edge)].triangle < 0) return settleOnEdge(edge, s);
  // through a vertex, around which steps may lead forever
  const bool circling = (s == 0 || s == 1) && entered_by_.triangle == foot_.triangle;
  if (circling) return settleOnVertex({foot_.triangle, s == 0 ? edge : (edge + 1) % 3});
  cross(edge, s);
}

void ShellWalk::putOnEdge(int edge, double s) {
  foot_.b[static_cast<std::size_t>(edge)] = 1 - s;
  foot_.b[static_cast<std::size_t>((edge + 1) % 3)] = s;
  foot_.b[static_cast<std::size_t>((edge + 2) % 3)] = 0;
}

void ShellWalk::cross(int edge, double s) {
  ++crossings_;
  const Neighbour other = cell().neighbours[static_cast<std::size_t>(edge)];
  foot_.triangle = other.triangle;
  putOnEdge(other.edge, 1 - s);
  entered_by_ = {other.triangle, other.edge};
}

// The next step goes along the residual, which leads inside by the test that sent us
// here; Newton's need not on a kinked patch.
void ShellWalk::enterFace() {
  next_kind_ = StepKind::alongResidual;
  entered_by_ = {};
  last_scale_ = 0;
  near_ = false;
}

void ShellWalk::settleOnEdge(int edge, double s) {
  if (steps_ >= kMaxSteps) return giveUp();
  ++steps_;
  const SharpEdge curve = sharpEdge(net_, cache_, foot_.triangle, edge);
  const EdgeFoot foot = footOnEdge(curve, C_, s);
  putOnEdge(edge, foot.s);
  if (foot.s == 0 || foot.s == 1) return settleOnVertex({foot_.triangle, foot.s == 0 ? edge : (edge + 1) % 3});
  if (foot.leads_left && leadsInside(edge)) return enterFace();
  if (foot.leads_right) {
    cross(edge, foot.s);
    if (leadsInside(entered_by_.edge)) return enterFace();
  }
  const FeatureContact contact =
      contactWithPoint(C_, foot.x.E, foot.x.left.normalized() + foot.x.right.normalized(), curve.is_border, done_);
  accept(contact.n, contact.h);
}

// True if the residual leads from the edge that the foot is on into its face. By the edge's normals
// it may seem so where the patch is kinked.
bool ShellWalk::leadsInside(int edge) const {
  const FaceStep step = faceStep(evaluate(cell().patch, foot_.b[1], foot_.b[2]), C_, StepKind::alongResidual);
  return step.db[static_cast<std::size_t>((edge + 2) % 3)] > 0;
}

void ShellWalk::settleOnVertex(const CellCorner& at) {
  if (steps_ >= kMaxSteps) return giveUp();
  ++steps_;
  if (leaveVertexIntoFace(at)) return;
  if (leaveVertexAlongEdge(at)) return;
  Vec3 outward = Vec3::Zero();
  const bool has_border =
      net_.visitCorners(at, [&](const CellCorner& c) { outward += net_.normal(c.triangle, c.corner); });
  const Vec3& p = net_.vertex(at.triangle, at.corner);
  const FeatureContact contact = contactWithPoint(C_, p, outward, has_border, done_);
  accept(contact.n, contact.h);
}

// Into the face whose residual leads inside, the largest if there are several.
bool ShellWalk::leaveVertexIntoFace(const CellCorner& at) {
  double largest = done_;
  Foot best;
  net_.visitCorners(at, [&](const CellCorner& face) {
    Foot foot{face.triangle, {0, 0, 0}};
    const auto c = static_cast<std::size_t>(face.corner);
    foot.b[c] = 1;
    const FaceStep step =
        faceStep(evaluate(net_.cell(face.triangle, cache_).patch, foot.b[1], foot.b[2]), C_, StepKind::alongResidual);
    const double least = -kAlong * longest(step.db);
    if (step.db[(c + 1) % 3] < least || step.db[(c + 2) % 3] < least || step.residual <= largest) return;
    largest = step.residual;
    best = foot;
  });
  if (largest == done_) return false;
  foot_ = best;
  enterFace();
  return true;
}

// Along the sharp edge that leads away from the vertex most directly.
bool ShellWalk::leaveVertexAlongEdge(const CellCorner& at) {
  double largest = done_;
  Side best;
  double best_end = 0;
  net_.visitCorners(at, [&](const CellCorner& face) {
    for (const int edge : {face.corner, (face.corner + 2) % 3}) {
      if (!net_.isSharp(face.triangle, edge)) continue;
      const double end = edge == face.corner ? 0 : 1;
      const SharpEdgePoint x = evaluate(sharpEdge(net_, cache_, face.triangle, edge), end);
      const double away = (end == 0 ? 1 : -1) * (C_ - x.E).dot(x.D.normalized());
      if (away <= largest) continue;
      largest = away;
      best = {face.triangle, edge};
      best_end = end;
    }
  });
  if (best.triangle < 0) return false;
  foot_.triangle = best.triangle;
  settleOnEdge(best.edge, best_end);
  return true;
}

void ShellWalk::accept(const Vec3& n, double h) {
  PINCER_ASSERT(isUnitIfFinite(n));
  PINCER_ASSERT(!(std::abs(foot_.b[0] + foot_.b[1] + foot_.b[2] - 1) > 1e-6));  // steps may lead kAlong across an edge
  result_ = {foot_, n, h, true, {}};
  state_ = State::ended;
}

}  // namespace

ShellContact solveShell(const SurfaceNet& net, PatchCache& cache, const Vec3& C, const Foot& start) {
  return ShellWalk(net, cache, C, start).run();
}

[[gnu::flatten]] ShellContact solveShellBeside(const SurfaceNet& net, PatchCache& cache, const Vec3& C,
                                               const Foot& start, const FootMotion& motion, const Vec3& dC) {
  ShellContact contact;
  const double du = motion.du.dot(dC), dv = motion.dv.dot(dC);
  contact.foot = {start.triangle, {start.b[0] - du - dv, start.b[1] + du, start.b[2] + dv}};
  if (!carryInside(net, contact.foot, contact.cost.crossings)) return contact;
  const PatchPoint x = evaluate(net.cell(contact.foot.triangle, cache).patch, contact.foot.b[1], contact.foot.b[2]);
  const NewtonStep step = newtonStep(x, C);
  const double nearly = kNear * net.length();
  if (!step.is_usable || !(step.residual2 < nearly * nearly)) return contact;
  contact.cost.steps = 1;
  contact.motion = {step.du, step.dv};
  finish(x, step.u, step.v, C, contact);
  return contact;
}

ShellContact tangentContact(const SurfaceNet& net, PatchCache& cache, const Vec3& C, const Foot& foot) {
  const FaceStep step =
      faceStep(evaluate(net.cell(foot.triangle, cache).patch, foot.b[1], foot.b[2]), C, StepKind::alongResidual);
  return {foot, step.n, step.h, false, {}};
}

}  // namespace pincer::contact
