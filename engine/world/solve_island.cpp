#include "pincer/engine/world/solve_island.h"

#include <algorithm>
#include <cmath>

#include "pincer/engine/solve/contact_solver.h"
#include "pincer/engine/solve/few_contacts.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/round_contact.h"
#include "pincer/engine/solve/search.h"
#include "pincer/engine/solve/sweeps.h"
#include "pincer/engine/world/budget.h"
#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/grip.h"
#include "pincer/engine/world/island_bias.h"
#include "pincer/engine/world/island_sides.h"
#include "pincer/engine/world/push_out.h"
#include "pincer/engine/world/rest.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/engine/world/tree_sides.h"
#include "pincer/engine/world/wedge.h"

namespace pincer::engine {
namespace {

constexpr double kLost = 1e-2;  // residual that is no answer
// of more than kFewContacts, whose impulses may have been scaled down to add no energy
constexpr double kHeapLost = 0.3;
constexpr int kStoppingSweeps = 30;                      // instead
constexpr double kTakenOver = 0.9;                       // of the last tick's impulses: from below, or columns hop
constexpr std::int64_t kPushOperations = 50'000;         // multiplications per contact, twice what was needed
constexpr double kMostPushed = 10 * kLargestCorrection;  // of what is pushed out, chosen [m/s]
constexpr double kStirring = 100;      // times the tolerance, chosen: residuals that are less come and go by themselves
constexpr double kLargestGive = 1e-4;  // by which contacts around loops of bodies may contradict each other [m/s]

class IslandSolve {
 public:
  IslandSolve(const WorldModel& model, int k, int thread, WorldScratch& scratch)
      : model_(model),
        options_(model.options.solver),
        scratch_(scratch),
        island_(scratch.islands.islands[k]),
        memory_(*scratch.islands.solvers[thread]),
        problem_(problemOf(model.options.h, island_, scratch.islands)),
        order_(scratch.islands.order.data() + island_.place, static_cast<std::size_t>(island_.contacts)),
        is_loop_(mayContradict(problem_)),
        tick_(model.options.h) {}

  void run() {
    const bool is_limited = scratch_.operations_left < kNoLimit;
    const std::int64_t share =
        is_limited ? std::max<std::int64_t>(scratch_.operations_left, 0) * island_.rows / scratch_.islands.rows
                   : kNoLimit;
    const std::int64_t reserve = is_limited ? reserveForStops() : 0;
    memory_.operations_left = share - reserve;
    memory_.haste = hasteAfter(scratch_.solves);
    memory_.hit_operations = mostHitOperations(island_.contacts);
    island_.hit_operations = 0;
    if (!island_.has_sides && !(is_grip_ = readGrip(model_, scratch_, order_, grip_))) fillSides();
    if (problem_.calm) projectOntoCones(problem_, island_.r);
    if (problem_.calm && restsAsItIs(problem_, options_, memory_, island_.r, island_.u, island_.result)) {
      island_.operations = 0;
      return;
    }
    if (island_.contacts > kFewContacts) findRoundContacts(memory_.round, problem_);
    is_loop_&& scratch_.h > 0 ? solveLoop() : solveOne();
    if (isInexact()) polish();
    if (stirs()) settle();
    if (scratch_.h > 0 && memory_.operations_left >= 0 && isWedged(problem_, island_.r, island_.result)) {
      fit(PushingBy::kWedged);
      std::fill(island_.r, island_.r + island_.rows, 0.0);  // or the squeeze would stay
      solveAgain(options_);
    }
    island_.hit_operations = mostHitOperations(island_.contacts) - memory_.hit_operations;
    if (island_.result.give > 0) {
      island_.as_asked = false;
      giveWay(scratch_.h, offsetRate(), problem_, memory_.give.data(), island_.q, order_, scratch_.contacts);
    }
    std::int64_t spent = share - reserve - memory_.operations_left;
    if (isLost()) spent += stopOnly(reserve + std::max<std::int64_t>(memory_.operations_left, 0));
    if (is_limited && scratch_.h > 0 && !isAnswered()) doNoWork();
    island_.operations = is_limited ? spent : 0;
  }

 private:
  // Heaps that are hit are solved hit by hit: the first few times as exactly as any.
  static int hasteAfter(int solves) {
    constexpr int kUnhurried = 3, kMostHaste = 4;  // solves; doublings, to a sixteenth of the work
    return 1 << std::clamp(solves - kUnhurried, 0, kMostHaste);
  }
  static ContactProblem problemOf(double h, Island& island, IslandScratch& s) {
    const auto n = static_cast<std::size_t>(island.contacts);
    const std::span<const ContactSide> sides(s.sides[static_cast<std::size_t>(island.work)].data(), 2 * n);
    ContactProblem problem{
        {island.first_row, n + 1}, {island.mu, n}, sides, VectorMap(island.q, island.rows), island.movers,
        island.settling > 0,       island.calm};
    problem.weight = {s.weight.data() + island.work, n};
    if (island.holds_trees) problem.noise = linkNoise(h);
    if (island.has_many_sides) takeManySides(island, s, problem);
    return problem;
  }

  // The gaps of a loop of bodies are fitted to the contacts that pushed in the last tick, once more to the impulses
  // found if that fails; then contacts give way.
  void solveLoop() {
    fit(PushingBy::kLastTick);
    if (island_.holds_trees) fitToTurnOfTrees();
    if (island_.contacts > kFewContacts) return solve(giving(kLargestGive));
    solve(trying(SolverEffort::kInside));
    if (island_.result.converged) return;
    fit(PushingBy::kImpulses);
    solveAgain(giving(kLargestGive));
    if (pushesInVain()) solveWithoutPushes();
  }

  // A body that friction jams between supports may have no answer that pushes it out of them: then the pushes are left
  // out. If that fails, what contacts ask for is fitted to the impulses found, and they give way.
  void solveOne() {
    const bool may_jam = island_.contacts <= kFewContacts && scratch_.h > 0;
    solve(may_jam ? trying(SolverEffort::kShort) : options_);
    if (pushesInVain()) solveWithoutPushes();
    if (may_jam && !isAnswered()) solveAgain(options_);
    if (isAnswered() || !(scratch_.h > 0) || memory_.operations_left < 0) return;
    fit(PushingBy::kImpulses);
    solveAgain(giving(kLargestGive));
  }

  SolverOptions trying(SolverEffort effort) const {
    SolverOptions options = options_;
    options.effort = effort;
    return options;
  }
  SolverOptions giving(double largest) const {
    SolverOptions options = options_;
    options.largest_give = largest;
    return options;
  }
  bool isAnswered() const { return island_.result.converged || island_.result.yields; }
  bool pushesInVain() const {
    return island_.contacts <= kFewContacts && scratch_.h > 0 && !island_.result.converged &&
           island_.result.give == 0 && memory_.operations_left >= 0;
  }

  // Contacts with what doesn't move that only stop what closes have an answer always: no motion at all obeys them (V.
  // Acary, F. Cadoux, C. Lemarechal, J. Malick, Z. Angew. Math. Mech. 91 (2011) 155). So overlaps of a body that
  // friction jams, or holds where it grazes an edge, stay for as long as it sticks, but for what push_out.h undoes.
  // Walls that close on what is between them keep it in the middle by their pushes.
  void solveWithoutPushes() {
    const SolveResult pushed = island_.result;
    keepAnswer();
    if (hasOnlyJoined() && findsPushes()) return;
    dropPushes();
    std::fill(island_.r, island_.r + island_.rows, 0.0);
    solveAgain(options_);
    if (!island_.result.converged) searchOn();
    const bool is_better = island_.result.converged || island_.result.error < pushed.error;
    if (is_better && (!pushed.yields || holdsWithoutPushes())) return keepOverlaps();
    pushAgain();
    takeKeptAnswer();
    const int iterations = island_.result.iterations;
    island_.result = pushed;
    island_.result.iterations = iterations;
  }
  // True if nothing moves but what joints hold: what is led might close on it.
  bool hasOnlyJoined() const {
    const auto moves_freely = [&](const Side& side) {
      if (side.kind != SideKind::kBody) return side.kind == SideKind::kPoint;
      const BodyModel& body = model_.bodies[side.index];
      return body.driven || (body.dynamic && !isJoined(body));
    };
    return std::none_of(order_.begin(), order_.end(), [&](int n) {
      const Contact& c = scratch_.contacts[static_cast<std::size_t>(n)];
      return moves_freely(c.a) || moves_freely(c.b);
    });
  }
  // Newton's method may fail on bodies of few freedoms, whose W has a low rank, though joints let them be pushed out.
  // Then the search finds impulses. Bounded, as jams have none; what is nearly jammed would be flung.
  bool findsPushes() {
    const std::int64_t before = memory_.operations_left, most = kPushOperations * island_.contacts;
    memory_.operations_left = std::min(before, most);
    std::fill(island_.r, island_.r + island_.rows, 0.0);
    const SolveResult first = island_.result;
    searchOn();
    memory_.operations_left += before - std::min(before, most);
    if (island_.result.converged && !flings()) return true;
    island_.result = first;
    return false;
  }
  bool flings() const {
    double fastest = 0;
    for (int row = 0; row < island_.rows; ++row) fastest = std::max(fastest, std::abs(island_.u[row]));
    return !(fastest <= kMostPushed);
  }
  void keepAnswer() {
    std::copy(island_.r, island_.r + island_.rows, memory_.kept_r.begin());
    std::copy(island_.u, island_.u + island_.rows, memory_.kept_u.begin());
  }
  void takeKeptAnswer() {
    std::copy(memory_.kept_r.begin(), memory_.kept_r.begin() + island_.rows, island_.r);
    std::copy(memory_.kept_u.begin(), memory_.kept_u.begin() + island_.rows, island_.u);
  }
  // All that overlaps does so by little, and presses.
  bool holdsWithoutPushes() const {
    for (int n = 0; n < island_.contacts; ++n) {
      const auto normal = static_cast<std::size_t>(problem_.firstRow(n) + kNormalRow);
      const double phi = scratch_.contacts[static_cast<std::size_t>(order_[static_cast<std::size_t>(n)])].phi;
      if (!(phi >= -kDeepSpeed / kNormalCorrection * tick_)) return false;
      if (memory_.pushes[normal] < 0 && !(island_.r[normal] > 0)) return false;
    }
    return true;
  }

  // Strictness asks for more than was found: where friction is used up at no slip, Newton's method for few contacts
  // gets no nearer.
  bool isInexact() const {
    const SolveResult& found = island_.result;
    return problem_.strict && island_.contacts <= kFewContacts && found.converged && found.give == 0 &&
           scratch_.h > 0 && island_.holds_trees &&
           found.residual > exactResidual(options_.tolerance, problem_.noise, referenceSpeed(problem_));
  }
  // The search may end as if contacts were soft (squeeze.h), far from the law: then the first answer stays.
  void polish() {
    const SolveResult first = island_.result;
    keepAnswer();
    searchOn();
    const SolveResult searched = island_.result;
    const bool is_better = searched.residual < first.residual;
    if (!is_better) takeKeptAnswer();
    island_.result = is_better ? searched : first;
    island_.result.iterations = searched.iterations;
    island_.result.converged = true;
    island_.result.method = first.method;
  }

  // True if contacts that contradict each other, by less than their solver minds, keep from rest what hardly moves.
  bool stirs() const {
    const SolveResult& found = island_.result;
    return scratch_.h > 0 && island_.contacts <= kFewContacts && found.converged && found.give == 0 &&
           found.residual > kStirring * options_.tolerance && memory_.operations_left >= 0 && hardlyMoves();
  }
  bool hardlyMoves() const {
    const auto is_slow = [](const MoverScratch& mover) {
      return mover.start.v_W.squaredNorm() < kClosingSpeed * kClosingSpeed;
    };
    return std::all_of(order_.begin(), order_.end(), [&](int n) {
      const Contact& c = scratch_.contacts[static_cast<std::size_t>(n)];
      return is_slow(*c.mover_a) && is_slow(*c.mover_b);
    });
  }
  // Asks for a motion that exists instead.
  void settle() {
    const SolveResult first = island_.result;
    keepAnswer();
    fit(PushingBy::kImpulses);
    solveAgain(options_);
    if (island_.result.converged) return;
    takeKeptAnswer();
    island_.result = first;
  }
  void searchOn() {
    const SolveResult first = island_.result;
    island_.result = searchImpulses(problem_, options_, memory_, island_.r, island_.u);
    island_.result.iterations += first.iterations;
    island_.result.start = first.start;
  }

  void fit(PushingBy pushing) {
    if (!island_.has_sides && askForNothing(problem_, island_.r, order_, scratch_.contacts)) return;
    fillSides();
    if (fitIslandBiases(pushing, scratch_.h, offsetRate(), problem_, island_.r, island_.q, order_, scratch_.contacts,
                        memory_))
      island_.as_asked = false;
  }

  void fitToTurnOfTrees() {
    island_.as_asked = false;
    fillSides();
    projectOntoCones(problem_, island_.r);
    weighContacts(problem_, memory_);
    errorOf(problem_, island_.r, memory_, island_.u);
    fitToTurn(scratch_.h, offsetRate(), problem_, island_.r, island_.u, island_.q, order_, scratch_.contacts, memory_);
  }

  void fillSides() {
    if (!island_.has_sides) engine::fillSides(model_, scratch_, island_, scratch_.islands);
    island_.has_sides = true;
  }

  void solve(const SolverOptions& options) {
    if (is_grip_ && solveAsGrip(options)) return;
    fillSides();
    solveContacts(problem_, options, memory_, island_.r, island_.u, island_.result);
  }

  bool solveAsGrip(const SolverOptions& options) {
    projectOntoCones(problem_, island_.r);
    return solveGripProblem(grip_, problem_, options, memory_, island_.r, island_.u, island_.result);
  }

  void solveAgain(const SolverOptions& options) {
    const SolveResult first = island_.result;
    solve(options);
    island_.result.iterations += first.iterations;
    island_.result.start = first.start;
  }

  // Contacts that contradict each other have no answer: what overlaps in all directions can't be pushed apart. Then
  // they only stop what closes: biases that push are left out, and sweeps begin with no impulse at all. Support is
  // better than falling through the floor. Where a budget cut the solve they take the last tick's impulses further, or
  // a column of fourteen bricks would sink by 6 mm. Returns what it took of the operations.
  std::int64_t stopOnly(std::int64_t operations) {
    memory_.operations_left = operations;
    dropPushes();
    const bool goes_on = isLimited(scratch_) && scratch_.h > 0;
    forEachRow([&](Contact& c, int k, int row) { island_.r[row] = goes_on ? kTakenOver * c.r[k] : 0; });
    projectOntoCones(problem_, island_.r);
    stopBySweeps(problem_, kStoppingSweeps, memory_, VectorMap(island_.r, island_.rows),
                 VectorMap(island_.u, island_.rows));
    return operations - memory_.operations_left;
  }

  // Scales the impulses of a solve that was cut until they do no work, by the mean of the velocities at both ends of
  // the tick: they would lift bricks that stand, by round a micrometre a tick.
  //   r . (v_start + v_free + W r) / 2 <= 0
  void doNoWork() {
    double free_work = 0, response = 0;  // twice each
    forEachRow([&](const Contact& c, int k, int row) {
      const double unit = k >= kTorsionRow ? radiusOf(c, k) : 1, r = island_.r[row];
      free_work += r * (island_.q[row] + unit * (c.v_start_C[k] - c.bias_C[k]));
      response += r * (island_.u[row] - island_.q[row]);
    });
    if (free_work + response <= 0) return;
    const double share = free_work < 0 ? -free_work / response : 0;
    for (int row = 0; row < island_.rows; ++row) island_.r[row] *= share;
    const ContactError error = errorOf(problem_, island_.r, memory_, island_.u);
    island_.result.residual = error.residual;
    island_.result.error = error.speed;
  }

  // Gaps and offsets are put right in the ticks to come.
  void dropPushes() {
    island_.as_asked = false;
    forEachRow([&](Contact& c, int k, int row) {
      const bool is_push = k != kNormalRow || c.bias_C[k] < 0;
      memory_.pushes[static_cast<std::size_t>(row)] = is_push ? c.bias_C[k] : 0;
      addBias(is_push ? -c.bias_C[k] : 0, k, row, c);
    });
  }
  void pushAgain() {
    forEachRow([&](Contact& c, int k, int row) { addBias(memory_.pushes[static_cast<std::size_t>(row)], k, row, c); });
  }
  void keepOverlaps() {
    forEachRow([&](Contact& c, int k, int row) {
      if (k != kNormalRow && c.stuck)
        c.offset_C[k] = -0.5 * scratch_.h * c.v_start_C[k];
      else if (k == kNormalRow && memory_.pushes[static_cast<std::size_t>(row)] < 0)
        c.offset_C[k] = std::min(c.phi, 0.0);
    });
  }
  template <class Act>
  void forEachRow(const Act& act) {
    for (int n = 0; n < island_.contacts; ++n) {
      for (int k = 0; k < problem_.rows(n); ++k) act(scratch_.contacts[order_[n]], k, problem_.firstRow(n) + k);
    }
  }
  void addBias(double change, int k, int row, Contact& c) {
    island_.q[row] += (k >= kTorsionRow ? radiusOf(c, k) : 1) * change;
    c.bias_C[k] += change;
  }

  // Share of the budget kept for stopOnly: support doesn't depend on it.
  std::int64_t reserveForStops() const { return kStoppingSweeps * kPerContactSwept * island_.contacts; }
  double offsetRate() const { return scratch_.h > 0 ? kTangentCorrection / tick_ : 0; }
  // Or nothing was done for it: a residual is one of the fastest gap that closes, and may hide what sinks.
  bool isLost() const {
    const double most = island_.contacts > kFewContacts ? kHeapLost : kLost;
    return !isAnswered() && (island_.result.residual > most || island_.result.iterations == 0);
  }

  const WorldModel& model_;
  const SolverOptions& options_;
  WorldScratch& scratch_;
  Island& island_;
  SolverScratch& memory_;
  ContactProblem problem_;
  GripProblem grip_;
  bool is_grip_ = false;
  const std::span<const int> order_;
  const bool is_loop_;
  const double tick_;  // [s]
};

}  // namespace

void solveIsland(const WorldModel& model, int k, int thread, WorldScratch& scratch) {
  IslandSolve(model, k, thread, scratch).run();
}

}  // namespace pincer::engine
