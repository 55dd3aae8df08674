#include "pincer/engine/world/part_inputs.h"

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/motion/driven_motion.h"
#include "pincer/engine/world/drive_rows.h"
#include "pincer/engine/world/state_checks.h"

namespace pincer::engine {
namespace {

class PartInputs {
 public:
  PartInputs(const WorldModel& model, const StepInputs& inputs, double h, double left, WorldState& state,
             WorldScratch& scratch)
      : model_(model),
        inputs_(inputs),
        left_(left),
        share_(h < left ? h / left : 1),
        state_(state),
        scratch_(scratch) {}

  std::uint32_t set() {
    for (std::size_t i = 0; i < scratch_.point_inputs.size(); ++i) setPoint(i);
    for (std::size_t d = 0; d < scratch_.drives.size(); ++d) setControl(d);
    for (std::size_t i = 0; i < model_.bodies.size() && model_.driven_count > 0; ++i) {
      if (model_.bodies[i].driven) setMotion(static_cast<std::size_t>(model_.bodies[i].motion), state_.bodies[i]);
    }
    return status_;
  }

 private:
  void setPoint(std::size_t i) {
    const PointInput& end = inputs_.points[i];
    const PointState& now = state_.points[i];
    PointInput& out = scratch_.point_inputs[i];
    out = end;
    scratch_.points[i].input_ok = isFinite(end);
    if (!scratch_.points[i].input_ok) status_ |= kInputNotFinite;
    if (share_ < 1)
      out.p_target_W =
          cubicBetween(now.p_target_W, now.v_target_W, end.p_target_W, end.v_target_W, left_, share_, out.v_target_W);
  }

  void setControl(std::size_t d) {
    DriveInput end{state_.controls[d].value, state_.controls[d].rate, false};
    const bool is_given = d < inputs_.controls.size(), is_finite = is_given && isFinite(inputs_.controls[d]);
    if (is_finite) end = withinControls(model_.drives[d], inputs_.controls[d]);
    if (is_given && !is_finite) status_ |= kInputNotFinite;
    // it has come from somewhere
    if (state_.h_last == 0) state_.controls[d] = {end.value - left_ * end.rate, end.rate, end.moves};
    scratch_.drives[d].input = controlAt(state_.controls[d], end, left_, share_);
  }

  void setMotion(std::size_t i, const BodyState& now) {
    MotionInput& out = scratch_.motion_inputs[i];
    out = {now.X_WI, {}};
    if (i >= inputs_.motions.size()) return;
    if (!isFinite(inputs_.motions[i])) {
      status_ |= kInputNotFinite;
      return;
    }
    out = inputs_.motions[i];
    PINCER_ASSERT(isUnit(out.X_WB.q));
    if (share_ < 1) out = drivenPlace({now.X_WI, {now.v_W, state_.driven_w_W[i]}}, inputs_.motions[i], left_, share_);
  }

  const WorldModel& model_;
  const StepInputs& inputs_;
  const double left_, share_;  // of the tick [s]; of what is left, that this part takes
  WorldState& state_;
  WorldScratch& scratch_;
  std::uint32_t status_ = kStepOk;
};

}  // namespace

std::uint32_t setPartInputs(const WorldModel& model, const StepInputs& inputs, double h, double left, WorldState& state,
                            WorldScratch& scratch) {
  return PartInputs(model, inputs, h, left, state, scratch).set();
}

}  // namespace pincer::engine
