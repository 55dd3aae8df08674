#include "pincer/tasks/view/scene_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pincer/tasks/view/contact_drawing.h"
#include "pincer/tasks/view/shape_meshes.h"

namespace pincer::tasks {
namespace {

// Colours: red, green, blue, 0 to 1; chosen by eye.
const Vec3f kSkin(0.83f, 0.50f, 0.37f), kPad(0.88f, 0.40f, 0.34f), kNail(0.93f, 0.72f, 0.64f);
const Vec3f kTip(0.20f, 0.22f, 0.25f);
const Vec3f kPorcelain(0.50f, 0.52f, 0.54f);
const Vec3f kSelected(1.0f, 0.95f, 0.55f);
const Vec3f kGoal(0.05f, 0.45f, 0.85f);
const Vec3f kFloor(0.50f, 0.52f, 0.55f), kDevice(0.10f, 0.30f, 0.85f);
const std::array<Vec3f, 6> kBodyColours = {Vec3f(0.90f, 0.42f, 0.06f), Vec3f(0.06f, 0.36f, 0.62f),
                                           Vec3f(0.30f, 0.55f, 0.16f), Vec3f(0.55f, 0.16f, 0.42f),
                                           Vec3f(0.80f, 0.62f, 0.10f), Vec3f(0.10f, 0.50f, 0.52f)};
constexpr double kFingerBehind = 3.2;       // length of a finger behind its tip's centre, in radii
constexpr double kPadAngle = 55 * kDegree;  // of the pad about its normal, that the display's tactor reaches
constexpr double kGroundExtent = 12;        // radius of the drawn floor, in radii of what moves
// of the radius of what moves: the ground's lines are the next power of ten below as far apart
constexpr double kGridShare = 0.7;
constexpr double kLargestThing = 1;    // a larger body that doesn't move needn't be in the picture [m]
constexpr double kLongestArrow = 2.2;  // in sizes of what moves

bool isGround(const contact::Shape& shape) {
  return std::holds_alternative<contact::HalfSpace>(shape) || std::holds_alternative<contact::Dish>(shape);
}

Paint paintOf(const contact::Shape& shape, bool dynamic, const Vec3f& colour) {
  if (std::holds_alternative<contact::Dish>(shape)) return {.colour = kPorcelain, .gloss = 0.75f};
  if (std::holds_alternative<contact::HalfSpace>(shape)) return {.colour = kFloor, .gloss = 0.1f};
  if (!dynamic) return {.colour = Vec3f(0.55f, 0.55f, 0.57f), .gloss = 0.2f};
  Paint paint{.colour = colour, .gloss = 0.6f};
  if (std::holds_alternative<contact::Sphere>(shape)) paint.octants = 0.13f;
  return paint;
}

bool isHidden(const Snapshot& snapshot, std::size_t body) {
  return snapshot.hidden_body == Snapshot::kAllBodies || snapshot.hidden_body == static_cast<int>(body);
}

// Says what everything from the `first` item on stands for.
void markParts(DrawList& list, std::size_t first, Part part) {
  for (; first < list.size(); ++first) list[first].part = part;
}

// Where fingers whose devices give no orientation come from: from outside, and from above.
Quat plainOrientation(const Snapshot& start, std::size_t finger) {
  Vec3 others = Vec3::Zero();
  for (const FingerSnapshot& other : start.fingers) others += other.p_WP / static_cast<double>(start.fingers.size());
  Vec3 away = start.fingers[finger].p_WP - others;
  away = away.norm() > 1e-6 ? Vec3(away.normalized() + 0.55 * Vec3::UnitZ()).normalized() : Vec3::UnitZ();
  const Vec3 distal = -away;
  const Vec3 back = std::abs(away.z()) < 0.99 ? Vec3((Vec3::UnitZ() - away.z() * away).normalized()) : Vec3::UnitY();
  Mat3 R;
  R << distal, back.cross(distal), back;
  return Quat(R);
}

}  // namespace

SceneDrawing::SceneDrawing(const grasp::GraspModel& model, const Snapshot& start, MeshSink& meshes)
    : fingers_(model.fingers),
      joints_(model.world),
      ball_(meshes.add(ballMesh())),
      rod_(meshes.add(rodMesh())),
      cone_(meshes.add(openConeMesh())),
      head_(meshes.add(arrowHeadMesh())),
      finger_(meshes.add(fingerMesh(kFingerBehind))),
      pad_(meshes.add(padMesh(kPadAngle))),
      nail_(meshes.add(nailMesh())) {
  for (const grasp::FingerModel& finger : fingers_)
    tips_.push_back(finger.shape ? meshes.add(tipMesh(*finger.shape)) : -1);
  double smallest = kInfinity;
  for (const engine::BodyModel& body : model.world.bodies) {
    bodies_.push_back(bodyLook(model.world, body));
    if (body.dynamic) smallest = std::min(smallest, body.bounding_radius);
  }
  addShapes(model.world, start, radius(start), meshes);
  for (const grasp::FingerModel& finger : model.fingers) smallest = std::min(smallest, 3 * finger.radius);
  if (smallest < kInfinity) size_ = smallest;
  for (std::size_t i = 0; i < start.fingers.size(); ++i) plain_q_WF_.push_back(plainOrientation(start, i));
}

SceneDrawing::BodyLook SceneDrawing::bodyLook(const engine::WorldModel& model, const engine::BodyModel& body) {
  const auto shapes = engine::collidersOf(model, body);
  const bool is_ground =
      std::any_of(shapes.begin(), shapes.end(), [](const engine::ColliderModel& c) { return isGround(c.shape); });
  BodyLook look;
  look.dynamic = body.dynamic;
  look.moves = body.dynamic || body.driven;
  look.matters = look.moves || (!is_ground && body.bounding_radius < kLargestThing);
  look.p_BC = body.X_BI.p;
  look.radius = body.bounding_radius;
  return look;
}

SceneDrawing::ShapeLook SceneDrawing::shapeLook(const engine::ColliderModel& collider, double reach, MeshSink& meshes) {
  ShapeLook look;
  look.body = static_cast<std::size_t>(collider.body);
  look.X_BS = collider.X_BS;
  look.is_mesh = std::holds_alternative<contact::Mesh>(collider.shape);
  look.layer = std::holds_alternative<contact::HalfSpace>(collider.shape) ? Layer::kGround : Layer::kSolid;
  const auto* dish = std::get_if<contact::Dish>(&collider.shape);
  const double extent =
      dish ? std::min(0.55 * dish->radius, std::max(1.2 * reach, 0.3 * dish->radius)) : kGroundExtent * reach;
  const ViewMesh mesh = shapeMesh(collider.shape, MeshLook::kSmooth, extent);
  for (const ViewVertex& vertex : mesh.vertices) look.box_S.extend(vertex.p.cast<double>());
  look.smooth = look.facets = meshes.add(mesh);
  if (look.is_mesh) look.facets = meshes.add(shapeMesh(collider.shape, MeshLook::kFacets, extent));
  return look;
}

// Bodies that move differ in colour, a body's shapes don't.
void SceneDrawing::addShapes(const engine::WorldModel& model, const Snapshot& start, double reach, MeshSink& meshes) {
  grid_ = math::pow(10, std::floor(math::log10(kGridShare * reach)));
  const double extent = reach + centre_W(start).norm() / kGroundExtent;
  bool has_ground = false;
  double lowest = kInfinity;
  for (const FingerSnapshot& finger : start.fingers) lowest = std::min(lowest, finger.p_WP.z());
  std::size_t next_colour = 0;
  for (const engine::BodyModel& body : model.bodies) {
    const Vec3f& colour = kBodyColours[next_colour % kBodyColours.size()];
    if (body.dynamic) ++next_colour;
    for (const engine::ColliderModel& collider : engine::collidersOf(model, body)) {
      const bool is_ground = std::holds_alternative<contact::HalfSpace>(collider.shape);
      ShapeLook& look = shapes_.emplace_back(shapeLook(collider, is_ground ? extent : reach, meshes));
      look.paint = paintOf(collider.shape, body.dynamic, colour);
      has_ground = has_ground || is_ground;
      if (is_ground) look.paint.fade = static_cast<float>(kGroundExtent * reach);
      if (is_ground) look.paint.grid = static_cast<float>(grid_);
      const Pose X_WS = start.X_WB[look.body] * look.X_BS;
      for (int i = 0; i < 8 && !is_ground; ++i) {
        lowest = std::min(lowest, (X_WS * look.box_S.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i))).z());
      }
    }
  }
  if (!has_ground && lowest < kInfinity) addReferencePlane(start, lowest, reach, meshes);
}

// Things that float have lines and shadows below them that say how large they are, and how high.
void SceneDrawing::addReferencePlane(const Snapshot& start, double lowest, double reach, MeshSink& meshes) {
  const double extent = kGroundExtent * reach;
  Vec3 place_W = (centre_W(start) / (10 * grid_)).array().round() * 10 * grid_;
  place_W.z() = lowest - 0.1 * reach;
  reference_plane_ =
      DrawItem{meshes.add(shapeMesh(contact::HalfSpace{}, MeshLook::kSmooth, extent)),
               placed({Quat::Identity(), place_W}),
               {.fade = static_cast<float>(0.6 * extent), .grid = static_cast<float>(grid_), .sheer = true},
               Layer::kGround};
}

DrawList SceneDrawing::compose(const Snapshot& snapshot, const ViewChoice& choice) const {
  DrawList list;
  addBodies(snapshot, choice, list);
  if (snapshot.trial.blind) return list;
  if (reference_plane_) list.push_back(*reference_plane_);
  for (std::size_t i = 0; i < snapshot.fingers.size(); ++i) {
    addFinger(snapshot, i, list);
    const std::size_t first = list.size();
    if (choice.devices) addDevice(snapshot.fingers[i], i, list);
    if (*snapshot.trial.hint) addDropShadow(snapshot.fingers[i].p_WP, fingers_[i].radius, list);
    markParts(list, first, Part::kDevice);
  }
  const std::size_t goals = list.size();
  addGoal(snapshot, list);
  markParts(list, goals, Part::kGoal);
  const ContactLook look = contactLook(snapshot);
  const std::size_t joints = list.size();
  if (choice.joints) joints_.add(snapshot, marks(), look.metres_per_newton, list);
  markParts(list, joints, Part::kJoint);
  addContacts(snapshot, choice, look, list);
  return list;
}

void SceneDrawing::addBodies(const Snapshot& snapshot, const ViewChoice& choice, DrawList& list) const {
  for (const ShapeLook& look : shapes_) {
    const bool moves = bodies_[look.body].moves;
    if ((snapshot.trial.blind && moves) || isHidden(snapshot, look.body)) continue;
    DrawItem item{choice.facets ? look.facets : look.smooth, placed(snapshot.X_WB[look.body] * look.X_BS), look.paint,
                  look.layer};
    if (choice.selected == static_cast<int>(look.body))
      item.paint.colour = 0.55f * item.paint.colour + 0.45f * kSelected;
    if (bodies_[look.body].matters) item.thing = thingOfBody(look.body);
    if (look.is_mesh && choice.edges) item.paint.edges = choice.facets ? 0.7f : 0.3f;
    if (moves && choice.transparent) item.paint.alpha = 0.4f;
    list.push_back(item);
  }
}

void SceneDrawing::addFinger(const Snapshot& snapshot, std::size_t finger, DrawList& list) const {
  const FingerSnapshot& seen = snapshot.fingers[finger];
  const grasp::FingerModel& model = fingers_[finger];
  const int thing = thingOfBody(bodies_.size() + finger);
  if (tips_[finger] >= 0) {
    const Pose X_WF{seen.q_WF.value_or(Quat::Identity()), seen.p_WP};
    list.push_back({tips_[finger], placed(X_WF), {.colour = kTip, .gloss = 0.3f}, Layer::kSolid, Part::kThing, thing});
    return;
  }
  const Vec3 r = Vec3::Constant(model.radius);
  Pose X_WM{plain_q_WF_[finger], seen.p_WP};
  if (seen.q_WF) {
    Mat3 R_FM;  // the drawn finger's pad is -z, its tip +x
    R_FM << model.distal_F, model.distal_F.cross(model.pad_normal_F), -model.pad_normal_F;
    X_WM.q = *seen.q_WF * Quat(R_FM);
  }
  list.push_back({finger_, placed(X_WM, r), {.colour = kSkin, .gloss = 0.3f}, Layer::kSolid, Part::kThing, thing});
  list.push_back({nail_, placed(X_WM, r), {.colour = kNail, .gloss = 0.8f}});
  if (seen.q_WF) list.push_back({pad_, placed(X_WM, r), {.colour = kPad, .gloss = 0.25f}});
}

void SceneDrawing::addDevice(const FingerSnapshot& seen, std::size_t finger, DrawList& list) const {
  const bool is_tip = tips_[finger] >= 0;
  const Vec3 spring = seen.p_WF - seen.p_WP;
  if (spring.norm() < 1e-5) return;  // device and proxy are one
  list.push_back({is_tip ? tips_[finger] : ball_,
                  placed({is_tip ? seen.q_WF.value_or(Quat::Identity()) : Quat::Identity(), seen.p_WF},
                         Vec3::Constant(is_tip ? 1 : fingers_[finger].radius)),
                  {.colour = kDevice, .alpha = 0.16f, .gloss = 0.5f},
                  Layer::kMark});
  const double thin = 0.02 * size_;
  const Paint paint{.colour = kDevice, .glow = 0.6f};
  list.push_back({ball_, placed({Quat::Identity(), seen.p_WF}, Vec3::Constant(2.5 * thin)), paint, Layer::kMark});
  list.push_back({rod_, placed(pointing(seen.p_WP, spring), Vec3(thin, thin, spring.norm())), paint, Layer::kMark});
}

// Where over the ground a finger is: a disc at z = 0, and a line up to it.
void SceneDrawing::addDropShadow(const Vec3& p_W, double radius, DrawList& list) const {
  const Vec3 below_W(p_W.x(), p_W.y(), 1e-3);
  const Paint paint{.colour = Vec3f(0.05f, 0.05f, 0.08f), .alpha = 0.35f};
  list.push_back({ball_, placed({Quat::Identity(), below_W}, Vec3(radius, radius, 2e-4)), paint, Layer::kMark});
  const double thin = 0.008 * size_;
  if (p_W.z() > below_W.z())
    list.push_back(
        {rod_, placed({Quat::Identity(), below_W}, Vec3(thin, thin, p_W.z() - below_W.z())), paint, Layer::kMark});
}

// A ring at the height that the object's middle is to reach; a line along the heading that its mark is to take.
void SceneDrawing::addGoal(const Snapshot& snapshot, DrawList& list) const {
  const auto object = std::find_if(bodies_.begin(), bodies_.end(), [](const BodyLook& body) { return body.dynamic; });
  if (object == bodies_.end()) return;
  const Vec3 middle_W = snapshot.X_WB[static_cast<std::size_t>(object - bodies_.begin())] * object->p_BC;
  const Paint paint{.colour = kGoal, .glow = 0.8f};
  const double thin = 0.02 * size_;
  const auto line = [&](const Vec3& from_W, const Vec3& to_W) {
    list.push_back(
        {rod_, placed(pointing(from_W, to_W - from_W), Vec3(thin, thin, (to_W - from_W).norm())), paint, Layer::kMark});
  };
  if (snapshot.trial.goal_height) {
    constexpr int kSides = 32;  // of the goal's circle; chosen: it looks round
    const auto corner = [&](int k) {
      const double a = 2 * std::numbers::pi * k / kSides;
      return Vec3(middle_W.x() + 1.6 * object->radius * math::cos(a),
                  middle_W.y() + 1.6 * object->radius * math::sin(a), *snapshot.trial.goal_height);
    };
    for (int k = 0; k < kSides; ++k) line(corner(k), corner(k + 1));
  }
  if (snapshot.trial.goal_heading) {
    const Vec3 along(math::cos(*snapshot.trial.goal_heading), math::sin(*snapshot.trial.goal_heading), 0);
    const Vec3 top_W = middle_W + object->radius * Vec3::UnitZ();
    addMarkArrow(marks(), top_W, 1.5 * object->radius * along, thin, paint, list);
  }
}

ContactLook SceneDrawing::contactLook(const Snapshot& snapshot) const {
  return {marks(), cone_, metresPerNewton(snapshot)};
}

double SceneDrawing::metresPerNewton(const Snapshot& snapshot) const {
  double largest = 0;
  for (int i = 0; i < snapshot.contact_count; ++i)
    largest = std::max(largest, snapshot.contacts[static_cast<std::size_t>(i)].f_W.norm());
  double scale = 0.8 * size_;  // for some newtons; ten times as large ones are drawn at a tenth, in steps of about two
  for (int i = 0; scale * largest > kLongestArrow * size_; ++i) scale *= i % 3 == 1 ? 0.4 : 0.5;
  return scale;
}

std::vector<ViewLabel> SceneDrawing::labels(const Snapshot& snapshot, const ViewChoice& choice) const {
  if (!choice.forces || snapshot.trial.blind) return {};
  return contactLabels(snapshot, contactLook(snapshot), choice.selected);
}

std::vector<Eigen::AlignedBox2d> SceneDrawing::outlines(const Snapshot& snapshot, const Camera& camera, int width,
                                                        int height) const {
  std::vector<Eigen::AlignedBox2d> boxes;
  if (snapshot.trial.blind) return boxes;
  for (const ShapeLook& look : shapes_) {
    if (!bodies_[look.body].matters) continue;
    Eigen::AlignedBox2d box;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p_S = look.box_S.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      if (const auto pixel = camera.toPixel(snapshot.X_WB[look.body] * (look.X_BS * p_S), width, height))
        box.extend(*pixel);
    }
    if (!box.isEmpty()) boxes.push_back(box);
  }
  return boxes;
}

Vec3 SceneDrawing::centre_W(const Snapshot& snapshot) const {
  Eigen::AlignedBox3d box;
  for (const FingerSnapshot& finger : snapshot.fingers) box.extend(finger.p_WP);
  for (std::size_t i = 0; i < snapshot.X_WB.size(); ++i) {
    if (bodies_[i].dynamic) box.extend(snapshot.X_WB[i] * bodies_[i].p_BC);
  }
  return box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(box.center());
}

double SceneDrawing::radius(const Snapshot& snapshot) const {
  const Vec3 centre = centre_W(snapshot);
  double radius = 0.01;
  for (std::size_t i = 0; i < snapshot.fingers.size(); ++i) {
    radius = std::max(radius, (snapshot.fingers[i].p_WP - centre).norm() + 2 * fingers_[i].radius);
  }
  for (std::size_t i = 0; i < snapshot.X_WB.size(); ++i) {
    if (bodies_[i].matters)
      radius = std::max(radius, (snapshot.X_WB[i] * bodies_[i].p_BC - centre).norm() + bodies_[i].radius);
  }
  return radius;
}

Camera SceneDrawing::camera(const Snapshot& snapshot) const {
  Camera camera;
  const double r = radius(snapshot);
  camera.frame(centre_W(snapshot) + 0.1 * r * Vec3::UnitZ(), 1.25 * r);
  return camera;
}

}  // namespace pincer::tasks
