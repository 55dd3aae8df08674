// overlay: what is written over a picture: panels, charts, fingerpads, newtons, help. Drawn by Dear ImGui into whatever
// is drawn to.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pincer/tasks/lab/finger/finger_host.h"
#include "pincer/tasks/run/servo/histogram.h"
#include "pincer/tasks/run/tick/snapshot.h"
#include "pincer/tasks/view/keys.h"
#include "pincer/tasks/view/strip_chart.h"
#include "pincer/tasks/view/timeline.h"
#include "pincer/tasks/view/words.h"

namespace pincer::tasks {

// A text at a pixel.
struct OverlayLabel {
  Vec2 pixel;
  std::string text;
  bool slips = false;
};

struct PadLook {
  std::string finger;    // its name
  double reach = 0.012;  // of the pad that is shown, from its centre [m]
  double grip = 0;       // that it is asked for, with mouse fingers [N]; 0: unknown
};

// All that an overlay says; the viewer fills it in for every picture.
struct OverlayText {
  const Snapshot* snapshot = nullptr;
  ViewChoice choice;
  std::vector<OverlayLabel> labels;
  std::vector<Eigen::AlignedBox2d> things;  // that labels keep off [pixels, y down]
  std::vector<PadLook> pads;                // one per finger
  std::vector<const StripChart*> charts;
  std::string title;                // of scene or task
  const StudyPage* page = nullptr;  // that covers everything else; null: none
  std::string pace;                 // "real time", "1/4 speed", "paused"
  std::string notice;               // of what has just happened: a screenshot's name
  double pictures_per_second = 0;
  const Histogram* lateness = nullptr;  // of the ticks that were seen; null: not known
  const Timeline* timeline = nullptr;   // what happened; null: there is no bar
  std::string moment;                   // the last that happened: "1.24 s: index slips"
  double from = 0, to = 0;              // times that the bar shows [s]
  std::vector<BodyRow> bodies;          // that move
  std::string hovered;                  // of the thing under the pointer: name, values
  std::optional<Vec2> pulled;           // from where the pointer pulls a body [pixels]
  Vec2 pointer = Vec2::Zero();          // [pixels]
  double grid = 0;                      // spacing of the ground's lines [m]; 0: none are drawn
  bool hands = false;                   // the mouse moves fingers
  bool keys = true;                     // do something
};

class Overlay {
 public:
  // The surface must be current, and OpenGL loaded (a Renderer made). One per thread at a time.
  Overlay();
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  void draw(const OverlayText& text, int width, int height);

 private:
  void write(const OverlayText& text, int width, int height);
  void drawPanels(const OverlayText& text, int width, int height);
  struct Gui;
  std::unique_ptr<Gui> gui_;
};

}  // namespace pincer::tasks
