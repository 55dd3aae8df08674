#include "pincer/tasks/view/joint_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pincer::tasks {
namespace {

// Colours: red, green, blue, 0 to 1; chosen by eye.
const Vec3f kAxis(0.95f, 0.65f, 0.05f), kStop(0.75f, 0.05f, 0.20f), kDrive(0.35f, 0.10f, 0.75f);
constexpr double kLeastDrive = 1e-3;  // smaller ones get no arrow [N, N m over the size of marks]

void addRod(const MarkMeshes& marks, const Vec3& from_W, const Vec3& along_W, double thickness, const Vec3f& colour,
            DrawList& list) {
  list.push_back({marks.rod,
                  placed(pointing(from_W, along_W), Vec3(thickness, thickness, along_W.norm())),
                  {.colour = colour, .glow = 0.6f},
                  Layer::kMark});
}

void addBall(const MarkMeshes& marks, const Vec3& p_W, double radius, const Vec3f& colour, DrawList& list) {
  list.push_back({marks.ball,
                  placed({Quat::Identity(), p_W}, Vec3::Constant(radius)),
                  {.colour = colour, .glow = 0.6f},
                  Layer::kMark});
}

Pose frameOn(const engine::WorldModel& model, int body, const Pose& X_IJ) {
  return body < 0 ? X_IJ : model.bodies[static_cast<std::size_t>(body)].X_BI * X_IJ;
}

}  // namespace

void addMarkArrow(const MarkMeshes& marks, const Vec3& from_W, const Vec3& along_W, double thickness,
                  const Paint& paint, DrawList& list) {
  const double length = along_W.norm(), head = std::min(5.5 * thickness, 0.6 * length);
  const Pose X_WM = pointing(from_W, along_W);
  list.push_back({marks.rod, placed(X_WM, Vec3(thickness, thickness, length - head)), paint, Layer::kMark});
  const double wide = std::min(2.4 * thickness, 0.6 * length);
  list.push_back(
      {marks.head, placed({X_WM.q, X_WM * Vec3(0, 0, length - head)}, Vec3(wide, wide, head)), paint, Layer::kMark});
}

JointDrawing::JointDrawing(const engine::WorldModel& model) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const engine::JointModel& joint = model.joints[j];
    Look look{joint.kind,
              joint.a,
              joint.b,
              frameOn(model, joint.a, joint.X_AJ),
              frameOn(model, joint.b, joint.X_BJ),
              joint.traits.lower,
              joint.traits.upper,
              {}};
    for (std::size_t d = 0; d < model.drives.size(); ++d) {
      for (const engine::DriveTerm& term : model.drives[d].terms) {
        if (term.joint == static_cast<int>(j)) look.drives.emplace_back(static_cast<int>(d), term.factor);
      }
    }
    joints_.push_back(std::move(look));
  }
}

void JointDrawing::add(const Snapshot& snapshot, const MarkMeshes& marks, double metres_per_newton,
                       DrawList& list) const {
  for (const Look& look : joints_) {
    const Pose X_WK = snapshot.X_WB[static_cast<std::size_t>(look.a)] * look.X_AJ;
    const Pose X_WJ = look.b < 0 ? look.X_BJ : snapshot.X_WB[static_cast<std::size_t>(look.b)] * look.X_BJ;
    if (look.kind == engine::JointKind::kWeld) continue;
    addBall(marks, X_WK.p, 0.06 * marks.size, kAxis, list);
    if (look.kind == engine::JointKind::kBall) continue;
    const Vec3 axis_W = X_WJ.q * Vec3::UnitZ();
    addRod(marks, X_WK.p - 0.4 * marks.size * axis_W, 0.8 * marks.size * axis_W, 0.02 * marks.size, kAxis, list);
    addStops(look, X_WJ, X_WK, marks, list);
    const double scale = metres_per_newton / (look.kind == engine::JointKind::kPivot ? marks.size : 1);
    for (const auto& [drive, factor] : look.drives) {
      const Vec3 along_W = scale * factor * snapshot.drive_forces[static_cast<std::size_t>(drive)] * axis_W;
      if (along_W.norm() > kLeastDrive * metres_per_newton)
        addMarkArrow(marks, X_WK.p, along_W, 0.03 * marks.size, {.colour = kDrive, .glow = 0.5f}, list);
    }
  }
}

void JointDrawing::addStops(const Look& look, const Pose& X_WJ, const Pose& X_WK, const MarkMeshes& marks,
                            DrawList& list) const {
  const bool turns = look.kind == engine::JointKind::kPivot;
  const double reach = 0.5 * marks.size;
  bool has_stops = false;
  for (const double limit : {look.lower, look.upper}) {
    if (!std::isfinite(limit)) continue;
    has_stops = true;
    if (turns) {
      addRod(marks, X_WJ.p, reach * (X_WJ.q * quatFromRotationVector({0, 0, limit}) * Vec3::UnitX()), 0.02 * marks.size,
             kStop, list);
    } else {
      addBall(marks, X_WJ * Vec3(0, 0, limit), 0.05 * marks.size, kStop, list);
    }
  }
  if (has_stops && turns) addRod(marks, X_WJ.p, reach * (X_WK.q * Vec3::UnitX()), 0.01 * marks.size, kAxis, list);
}

}  // namespace pincer::tasks
