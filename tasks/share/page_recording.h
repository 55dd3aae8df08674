// page_recording: a scene's run or a trial, picture by picture, as a page shows it:
// things drawn, fingerpads, charts, captions.
//
// Things are those of the window (view/scene_drawing.h). Items that differ only in their place, and so in the matrix
// that takes their mesh to W, are a group; the k-th of a group in one picture goes on as the k-th in the next.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/share/mesh_table.h"
#include "pincer/tasks/view/scene_drawing.h"

namespace pincer::tasks {

// The upper three rows of the matrix, column by column; the first is NaN where there is no such item.
using PlacedItem = std::array<std::vector<double>, 12>;

struct PageGroup {
  DrawItem look;  // its matrix means nothing
  std::vector<PlacedItem> items;
};

struct PageChart {
  std::string name, unit;
  std::vector<double> values{};  // NaN: absent
};

// A fingerpad; frame L: first axis towards the finger's end, second radial.
struct PagePad {
  std::string finger;
  double reach = 0.012;  // from its centre to the border that is shown [m]
  bool has_display = false;
  std::array<std::vector<double>, 2> place_L{}, tactor_L{};  // contact and tactor [m]
  std::vector<double> sliding{};                             // 1: the contact slides
};

struct PageCaption {
  std::size_t picture;
  std::string text;
};

class PageRecording {
 public:
  // `start` is of `model`. `meshes` takes what is drawn, for all recordings of a page.
  PageRecording(std::string title, const grasp::GraspModel& model, const Snapshot& start, MeshTable& meshes,
                const SceneCamera& camera = {});

  // The next picture. Charts' values are added by whoever made them.
  void add(const Snapshot& snapshot);
  PageChart& chart(const std::string& name, const std::string& unit);  // a new one; valid until the next call
  std::vector<PageChart>& charts() { return charts_; }

  // Every second picture; the last one stays. Not of fewer than three pictures.
  void halve();

  const std::string& title() const { return title_; }
  const Camera& camera() const { return camera_; }
  double radius() const { return radius_; }                    // of what moves, for the light [m]
  const std::vector<double>& times() const { return times_; }  // of the pictures [s]
  const std::vector<PageGroup>& groups() const { return groups_; }
  const std::vector<PageChart>& charts() const { return charts_; }
  const std::vector<PagePad>& pads() const { return pads_; }
  const std::vector<PageCaption>& captions() const { return captions_; }

 private:
  std::size_t groupOf(const DrawItem& item);
  void addItems(const DrawList& list);
  void addPads(const Snapshot& snapshot);
  void addCaption(const Snapshot& snapshot);

  std::string title_;
  SceneDrawing drawing_;
  Camera camera_;
  double radius_ = 0;
  std::vector<double> times_;
  std::vector<PageGroup> groups_;
  std::vector<PageChart> charts_;
  std::vector<PagePad> pads_;
  std::vector<PageCaption> captions_;
};

}  // namespace pincer::tasks
