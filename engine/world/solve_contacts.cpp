#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/cone.h"
#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/far_contacts.h"
#include "pincer/engine/world/link_contacts.h"
#include "pincer/engine/world/stages.h"

namespace pincer::engine {
namespace {

// slower than this is rest: well above the solver's residual, far below anything felt [m/s]
constexpr double kSlidingSpeed = 1e-9;

double inverseMassOf(const WorldModel& model, const WorldScratch& scratch, const Side& side) {
  if (side.kind == SideKind::kJoint) return scratch.joint_rows[side.index].mobility;
  return side.kind == SideKind::kBody ? model.bodies[side.index].inverse_mass
                                      : scratch.points[side.index].inverse_mass.sum() * (1.0 / 3);
}

double bothInverseMasses(const WorldModel& model, const WorldScratch& scratch, const Contact& c) {
  return inverseMassOf(model, scratch, c.a) + inverseMassOf(model, scratch, c.b);
}

// True if a contact that opens still has an impulse, below the solver's tolerance: what is in the air would stick with
// it, and remember how far it flies as slip that is to be undone.
bool isResidue(const WorldModel& model, const WorldScratch& scratch, const Contact& c) {
  if (c.r[kNormalRow] >= 0 && !(c.u_C[kNormalRow] > 0)) return false;  // it doesn't open
  return bothInverseMasses(model, scratch, c) * c.r[kNormalRow] < kResidue * c.u_C[kNormalRow];
}

// True if friction is used up. Impulses that are off by `error` [m/s] may lie a little inside of their cone, however
// fast the contact slips: what slips faster than that slides, if more friction would slow it down.
bool slides(const double* r, const double* u, int rows, double mu, double w, double error) {
  const double slip2 = tangentNorm2(u, rows), on_cone = (1 - kResidue) * mu * r[kNormalRow];
  if (!(r[kNormalRow] > 0) || !(slip2 > kSlidingSpeed * kSlidingSpeed)) return false;
  if (tangentNorm2(r, rows) >= on_cone * on_cone) return true;
  double y[kMaxContactRows];
  for (int k = 0; k < rows; ++k) y[k] = w * r[k] - (k == kNormalRow ? 0 : u[k]);
  return slip2 > error * error && contactMode(y, rows, mu) == ContactMode::kSlide;
}

// A contact that is left out has no impulse; haveFarClosed finds its u_C.
void readNoSolution(Contact& c) {
  c.r.setZero();
  c.impulse_W.setZero();
  c.sliding = false;
}

}  // namespace

void readSolution(const WorldModel& model, const WorldScratch& scratch, int i, double error, Contact& c) {
  const int first = scratch.first_row[i], count = scratch.first_row[i + 1] - first;
  const double *const r = scratch.r.data() + first, *const u = scratch.u.data() + first;
  PINCER_ASSERT(!scratch.solve.converged || r[kNormalRow] >= 0);
  PINCER_ASSERT(!scratch.solve.converged || isInCone(r, count, c.mu, 1e-6) || scratch.h == 0);
  c.r.setZero();
  withRows(count, [&](auto rows) {
    for (int k = 0; k < rows; ++k) c.r[k] = r[k];
  });
  c.u_C = Eigen::Map<const Vec3>(u);
  if (isResidue(model, scratch, c)) c.r.setZero();
  c.impulse_W = c.R_WC * c.r.head<3>();
  c.sliding = slides(c.r.data(), u, count, c.mu, bothInverseMasses(model, scratch, c), error);
}

void prepareContacts(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  if (!model.trees.empty()) leaveOutGrazingLinks(model, scratch);
  if (scratch.contacts.empty()) return;
  sortContacts(scratch);
  fillContacts(model, state, scratch);
  if (!model.trees.empty() && scratch.h > 0) adjustLinkContacts(model, scratch);
  markFarContacts(model, scratch);
}

void solveContacts(const WorldModel& model, WorldScratch& scratch) {
  scratch.solve = {};
  if (scratch.contacts.empty()) return;
  ++scratch.solves;
  solveIslands(model, scratch);
  if (scratch.far_contacts == 0) return;
  for (Contact& c : scratch.contacts) {
    if (c.far) readNoSolution(c);
  }
}

}  // namespace pincer::engine
