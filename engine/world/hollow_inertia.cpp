#include "pincer/engine/world/hollow_inertia.h"

#include <algorithm>

namespace pincer::engine {
namespace {

constexpr double kLeastWay = 1e-6;  // over less than this a normal's turn is noise [m]

bool mayBeHollow(const WorldModel& model, const Side& side) {
  return side.kind == SideKind::kBody && model.bodies[side.index].may_be_hollow;
}

// f kappa of one contact [N/m].
double turningStiffness(const WorldModel& model, const WorldState& state, double h, const Contact& c) {
  if (!mayBeHollow(model, c.a) && !mayBeHollow(model, c.b)) return 0;
  if (!c.memory || !c.memory->active || !(state.h_last > 0)) return 0;
  const double time = 0.5 * (h + state.h_last);  // between the middles
  const Vec3 way_W = time * (c.R_WC.leftCols<2>() * c.v_start_C.head<2>());
  const double way2 = way_W.squaredNorm();
  if (way2 < kLeastWay * kLeastWay) return 0;
  const Vec3 turn_W = c.n_W() - c.memory->n_W - time * c.mover_b->start.w_W.cross(c.n_W());
  return c.memory->r[kNormalRow] / state.h_last * std::max(0.0, -turn_W.dot(way_W) / way2);
}

double inertiaOf(const DrivenPointModel& point, AxisForm form, int axis, double h, double stiffness) {
  if (form != AxisForm::kImplicit) return 0;
  return std::max(0.0, 0.75 * h * h * stiffness - 0.5 * (point.mass + h * point.damping[axis]));
}

void addInertia(const DrivenPointModel& point, const std::array<AxisForm, 3>& forms, double h, double stiffness,
                PointScratch& out) {
  Vec3 share;  // of the start's velocity in the free one
  for (int i = 0; i < 3; ++i) {
    const double ratio = inertiaOf(point, forms[static_cast<std::size_t>(i)], i, h, stiffness) * out.inverse_mass[i];
    share[i] = ratio / (1 + ratio);
    out.inverse_mass[i] /= 1 + ratio;
  }
  if (share.isZero(0)) return;
  out.root_inverse_mass = out.inverse_mass.cwiseSqrt();
  out.mobility_h = 0;  // of this tick alone
  const Vec3 change_W = out.start.v_W - out.free.v_W;
  out.free.v_W += out.turned ? Vec3(out.R_WA * share.cwiseProduct(out.R_WA.transpose() * change_W))
                             : Vec3(share.cwiseProduct(change_W));
}

}  // namespace

void steadyInHollows(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  if (!(scratch.h > 0)) return;
  for (PointScratch& point : scratch.points) point.turning_stiffness = 0;
  for (const Contact& c : scratch.contacts) {
    for (const Side& side : {c.a, c.b}) {
      if (side.kind == SideKind::kPoint)
        scratch.points[side.index].turning_stiffness += turningStiffness(model, state, scratch.h, c);
    }
  }
  for (std::size_t i = 0; i < scratch.points.size(); ++i) {
    PointScratch& point = scratch.points[i];
    if (point.turning_stiffness > 0)
      addInertia(model.points[i], model.point_forms[i], scratch.h, point.turning_stiffness, point);
  }
}

}  // namespace pincer::engine
