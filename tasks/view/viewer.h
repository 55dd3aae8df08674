// viewer: what a person who watches has: pictures of the latest snapshots, time to go back in, keys and mouse.
//
// It reads snapshots from a channel and writes to the servo nothing but the pace and, with mouse fingers, where the
// hand wants to be. So nothing it does can delay a tick.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "pincer/devices/window/mouse_hand.h"
#include "pincer/tasks/lab/finger/finger_host.h"
#include "pincer/tasks/run/servo/paced_cycle.h"
#include "pincer/tasks/view/body_pull.h"
#include "pincer/tasks/view/chart_board.h"
#include "pincer/tasks/view/history.h"
#include "pincer/tasks/view/overlay.h"
#include "pincer/tasks/view/painter.h"

namespace pincer::tasks {

struct ViewerOptions {
  std::string title = {};
  bool keys = true;                           // false: only Esc
  std::string folder = ".";                   // for screenshots and sequences
  bool choose_camera = false;                 // that sees most of each thing; else as the operator looks
  SceneCamera camera = {};                    // from where it looks, as far as it is given
  BodyPull* pull = nullptr;                   // by the mouse; null: bodies can't be pulled
  bool from_the_side = false;                 // looks along -x at the plane x = 0, in which the mouse moves fingers
  std::function<std::string()> verdict = {};  // said once the cycle has ended; empty: none
  std::function<void(int key)> answer = {};   // gets the digits and Enter; empty: nobody does
  // gets every key that goes down, but Esc; empty: nobody does
  std::function<void(const devices::InputEvent& key)> type = {};
};

class Viewer {
 public:
  // All must outlive it; `hand` may be null.
  Viewer(devices::Surface& surface, const grasp::GraspModel& model, const Snapshot& start, SnapshotChannel& channel,
         PaceControl& pace, devices::MouseHand* hand, ViewerOptions options);

  // From now on what is shown is this, not empty, from `time` [s] on; the channel isn't looked at any more.
  void showRecording(History recording, double time = 0);

  // A page of text over all, until the viewer's end.
  void showPage(const StudyPage& page) { page_ = page; }

  // Takes the person's input, draws one picture and shows it. Returns false when the person has closed it.
  bool update();

  // The parts of update():
  void handle(const devices::InputEvent& event);
  void look();      // at the channel
  Image picture();  // of what is shown, at its best
  ViewChoice& choice() { return choice_; }
  Painter& painter() { return painter_; }
  const Snapshot& shown() const { return scrub_ ? history_.at(*scrub_) : channel_.current(); }
  const Histogram& lateness() const { return lateness_; }
  double pictures_per_second() const { return pictures_per_second_; }

 private:
  bool looksOtherwise();
  void lookAtAll(const Snapshot& snapshot);
  void draw(bool at_best);
  void act(ViewAction action);
  void actOnTime(ViewAction action);
  void actOnHand(ViewAction action);
  bool isAnswer(int key) const;
  void drag(double right, double down);  // [shares of the picture's height]
  void wheel(const devices::InputEvent& event);
  void play();
  void scrubBy(int pictures);
  void scrubTo(double time);  // [s]
  void scrubToMouse();        // on the bar at the picture's lower border
  void replay();              // of what was seen, from its beginning
  void select(int body);
  int thingUnderMouse();  // a body; a finger, counted after all bodies; -1: none
  bool isBody(int thing) const { return thing >= 0 && thing < static_cast<int>(body_names_.size()); }
  void takeBody(int body);
  void movePull();
  void press(bool down);  // the left button
  void followMouse(const devices::InputEvent& event);
  bool actOnScene(ViewAction action);
  std::string hoveredWords() const;
  BodyRow rowOf(std::size_t body) const;
  bool hasBar() const;
  bool isPlaying() const { return recorded_ ? !pace_.paused : replaying_; }
  std::vector<BodyRow> bodyRows() const;
  bool mouseIsOnBar() const;
  void chartRecording();
  void saveScreenshot();
  void toggleSequence();
  void savePictureOfSequence();
  OverlayText overlayText() const;
  std::string paceText() const;
  double metresPerHeight() const;

  devices::Surface& surface_;
  SnapshotChannel& channel_;
  PaceControl& pace_;
  devices::MouseHand* hand_;
  ViewerOptions options_;
  Painter painter_;
  Overlay overlay_;
  ViewChoice choice_;
  std::optional<StudyPage> page_;
  History history_;
  std::optional<ChartBoard> charts_;
  std::vector<PadLook> pads_;
  Histogram lateness_;
  std::optional<std::size_t> scrub_;  // place in the history; absent: the present
  bool recorded_ = false;             // the history is all there is
  double play_time_ = 0;              // of what is shown of it [s]
  bool replaying_ = false;            // what was seen of something that goes on
  bool loop_ = false;
  bool bar_held_ = false;         // by the left button
  Vec2 pressed_ = Vec2::Zero();   // where the left button went down [pixels]
  int hovered_ = -1;              // thing under the pointer; -1: none
  Vec3 pulled_W_ = Vec3::Zero();  // where a body was taken [m]
  Timeline timeline_;
  std::vector<std::string> body_names_, finger_names_;
  std::vector<bool> moves_, is_free_;  // per body: at all; by forces
  std::vector<Pose> start_X_WB_;
  double quiet_since_ = 0;       // when a picture last changed
  std::int64_t seen_tick_ = -1;  // of the last picture, as the next two
  Camera seen_camera_;
  bool said_ = false;
  bool is_best_ = false;       // nothing to draw until something changes
  Vec2 mouse_ = Vec2::Zero();  // [pixels]
  bool mouse_known_ = false;
  bool left_ = false, right_ = false, shift_ = false, control_ = false;
  bool quit_ = false;
  std::string notice_, sequence_;  // sequence_: folder, empty: none is being written
  int sequence_count_ = 0;
  double notice_until_ = 0, last_picture_ = 0, pictures_per_second_ = 0;
};

}  // namespace pincer::tasks
