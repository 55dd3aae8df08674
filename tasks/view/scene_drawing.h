// scene_drawing: a snapshot as things to draw: bodies, fingertips, where devices and proxies are, contacts, cones,
// forces.
//
// Tips are drawn as their own geometry; a sphere, which stands for a person's fingertip, as a finger. Contacts:
// contact_drawing.h. The scale of force arrows is the largest round one at which all fit the picture.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "pincer/tasks/run/tick/snapshot.h"
#include "pincer/tasks/view/camera.h"
#include "pincer/tasks/view/draw_list.h"
#include "pincer/tasks/view/joint_drawing.h"

namespace pincer::tasks {

// Parts of the picture; a key each (keys.h).
struct ViewChoice {
  bool facets = false;       // of meshes, in place of the smooth surface
  bool edges = false;        // of the triangles of meshes
  bool contacts = true;      // places and normals
  bool forces = true;        // arrows, newtons
  bool cones = true;         // of friction
  bool joints = true;        // axes, stops, drives' forces
  bool devices = true;       // where the devices are, and the spring to the proxies
  bool transparent = false;  // moving bodies
  bool shadows = true;
  bool overlay = true;  // panels and charts
  bool pads = true;     // the fingerpad insets
  bool bodies = false;  // the list of what moves
  int selected = -1;    // body that stands out; -1: none
  bool help = false;
  bool timing = false;
};

// A text at a place of the scene.
struct ViewLabel {
  Vec3 p_W;
  std::string text;
  bool slips;
};

struct ContactLook;

class SceneDrawing {
 public:
  // Makes the meshes; `start` says where things are at first.
  SceneDrawing(const grasp::GraspModel& model, const Snapshot& start, MeshSink& meshes);

  // The drawing of `snapshot`. A blind trial shows nothing but the fingers' home: an empty dish. Things
  // (DrawItem::thing) are thingOfBody, and after them the fingers; 0 is what needn't be in the picture.
  static int thingOfBody(std::size_t body) { return static_cast<int>(body) + 1; }
  DrawList compose(const Snapshot& snapshot, const ViewChoice& choice) const;
  std::vector<ViewLabel> labels(const Snapshot& snapshot, const ViewChoice& choice) const;
  // About each shape of a body that is to be in the picture [pixels, y down].
  std::vector<Eigen::AlignedBox2d> outlines(const Snapshot& snapshot, const Camera& camera, int width,
                                            int height) const;

  // A ball about all that moves, in this snapshot.
  Vec3 centre_W(const Snapshot& snapshot) const;
  double radius(const Snapshot& snapshot) const;
  Camera camera(const Snapshot& snapshot) const;           // that looks at it
  double grid() const { return grid_; }                    // spacing of the ground's lines [m]
  double metresPerNewton(const Snapshot& snapshot) const;  // of the arrows

 private:
  struct ShapeLook {
    std::size_t body = 0;
    Pose X_BS;
    int smooth = 0, facets = 0;
    Paint paint;
    Layer layer = Layer::kSolid;
    bool is_mesh = false;
    Eigen::AlignedBox3d box_S;  // about it, in its frame [m]
  };
  struct BodyLook {
    bool dynamic = false, moves = false;
    bool matters = false;      // is to be in the picture
    Vec3 p_BC = Vec3::Zero();  // its centre of mass [m]
    double radius = 0;         // about it [m]
  };

  static BodyLook bodyLook(const engine::WorldModel& model, const engine::BodyModel& body);
  static ShapeLook shapeLook(const engine::ColliderModel& collider, double reach, MeshSink& meshes);
  void addShapes(const engine::WorldModel& model, const Snapshot& start, double reach, MeshSink& meshes);
  void addReferencePlane(const Snapshot& start, double lowest, double reach, MeshSink& meshes);
  void addBodies(const Snapshot& snapshot, const ViewChoice& choice, DrawList& list) const;
  void addFinger(const Snapshot& snapshot, std::size_t finger, DrawList& list) const;
  void addDevice(const FingerSnapshot& seen, std::size_t finger, DrawList& list) const;
  void addDropShadow(const Vec3& p_W, double radius, DrawList& list) const;
  void addGoal(const Snapshot& snapshot, DrawList& list) const;
  ContactLook contactLook(const Snapshot& snapshot) const;
  MarkMeshes marks() const { return {ball_, rod_, head_, size_}; }

  std::vector<grasp::FingerModel> fingers_;
  std::vector<int> tips_;  // per finger: its own geometry, -1 of spheres, which are drawn as human fingers
  std::vector<BodyLook> bodies_;
  std::vector<ShapeLook> shapes_;
  JointDrawing joints_;
  std::vector<Quat> plain_q_WF_;  // of fingers whose device says nothing of their orientation
  int ball_, rod_, cone_, head_, finger_, pad_, nail_;
  std::optional<DrawItem> reference_plane_;  // lines below all, where no half-space lies
  double grid_ = 0.01;                       // [m]
  double size_ = 0.05;                       // of marks: that of the things that move [m]
};

}  // namespace pincer::tasks
