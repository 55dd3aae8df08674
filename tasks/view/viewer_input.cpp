#include <algorithm>
#include <cmath>

#include "pincer/tasks/view/overlay_parts.h"
#include "pincer/tasks/view/viewer.h"

namespace pincer::tasks {
namespace {

constexpr double kTurn = 3.0;                         // of the camera by a drag over the picture's height [rad]
constexpr double kKeyStep = 4e-3;                     // of the fingers by a key [m]
constexpr double kTurnStep = 0.06;                    // of the hand by a key [rad]
constexpr double kHandTurn = 2.0;                     // by a way of the mouse over the picture's height [rad]
constexpr double kGripStep = 1.15;                    // per notch or key
constexpr double kSlowest = 1.0 / 256, kFastest = 8;  // of real time
constexpr double kClick = 4;       // a button that goes up this near to where it went down was a click [pixels]
constexpr double kZoomStep = 0.9;  // per notch

Vec3 wayOf(ViewAction action) {
  switch (action) {
    case ViewAction::kHandLeft:
      return -Vec3::UnitX();
    case ViewAction::kHandRight:
      return Vec3::UnitX();
    case ViewAction::kHandUp:
      return Vec3::UnitZ();
    case ViewAction::kHandDown:
      return -Vec3::UnitZ();
    case ViewAction::kHandAway:
      return Vec3::UnitY();
    case ViewAction::kHandNear:
      return -Vec3::UnitY();
    default:
      return Vec3::Zero();
  }
}

}  // namespace

void Viewer::handle(const devices::InputEvent& event) {
  using devices::InputKind;
  if (event.kind == InputKind::kKey) {
    if (event.code == devices::kKeyShift) shift_ = event.down;
    if (event.code == devices::kKeyControl) control_ = event.down;
    if (!event.down) return;
    if (options_.type && event.code != devices::kKeyEscape) return options_.type(event);
    if (isAnswer(event.code)) return options_.answer(event.code);
    if (!options_.keys && event.code != devices::kKeyEscape) return;
    if (const auto action = actionOf(event.code, hand_ && !pace_.paused)) act(*action);
  } else if (event.kind == InputKind::kButton) {
    if (event.code == devices::kButtonLeft) press(event.down);
    if (event.code == devices::kButtonRight) right_ = event.down;
  } else if (event.kind == InputKind::kWheel) {
    wheel(event);
  } else {
    followMouse(event);
  }
}

void Viewer::press(bool down) {
  left_ = down;
  if (hand_) hand_->squeeze(down);
  if (down) pressed_ = mouse_;
  const bool pulls = options_.pull && options_.pull->holds();
  if (down && control_ && options_.pull && !recorded_ && !pace_.ended && !scrub_) takeBody(thingUnderMouse());
  if (!down && pulls) options_.pull->letGo();
  if (!down && !hand_ && !pulls && !bar_held_ && (mouse_ - pressed_).norm() < kClick) {
    const int thing = thingUnderMouse();
    select(isBody(thing) ? thing : -1);
  }
  bar_held_ = down && mouseIsOnBar();
  if (bar_held_) scrubToMouse();
}

void Viewer::followMouse(const devices::InputEvent& event) {
  const Vec2 now(event.x, event.y), by = (now - mouse_) / surface_.size().height;
  const bool pulls = options_.pull && options_.pull->holds();
  if (mouse_known_ && !bar_held_ && !pulls) drag(by.x(), by.y());
  mouse_ = now;
  if (bar_held_) scrubToMouse();
  if (pulls) movePull();
  mouse_known_ = true;
  hovered_ = hand_ || left_ || right_ || !options_.keys ? -1 : thingUnderMouse();
}

void Viewer::takeBody(int body) {
  if (!isBody(body) || !is_free_[static_cast<std::size_t>(body)]) return;
  const Pose& X_WB = shown().X_WB[static_cast<std::size_t>(body)];
  const devices::SurfaceSize size = surface_.size();
  pulled_W_ = painter_.camera().fromPixel(mouse_, size.width, size.height, X_WB.p);
  options_.pull->take(body, X_WB.inverse() * pulled_W_, pulled_W_);
}

// In the plane in which the body was taken.
void Viewer::movePull() {
  const devices::SurfaceSize size = surface_.size();
  options_.pull->moveTo(painter_.camera().fromPixel(mouse_, size.width, size.height, pulled_W_));
}

bool Viewer::isAnswer(int key) const {
  return options_.answer && ((key >= '0' && key <= '9') || key == devices::kKeyEnter);
}

// From the side, right is away from the operator, and depth to the left.
void Viewer::drag(double right, double down) {
  Camera& camera = painter_.camera();
  if (hand_ && !right_) {
    const Vec3 across = options_.from_the_side ? Vec3::UnitY() : Vec3::UnitX(), ahead = Vec3::UnitZ().cross(across);
    const Vec3 way = right * across + (shift_ ? Vec3(-down * ahead) : Vec3(-down * Vec3::UnitZ()));
    if (pace_.paused) return;
    control_ ? hand_->turn(kHandTurn * right) : hand_->move(metresPerHeight() * way);
  } else if (right_ && !hand_) {
    camera.pan(-right, down);
  } else if (left_ || right_) {
    camera.turn(-kTurn * right, kTurn * down);
  }
}

void Viewer::wheel(const devices::InputEvent& event) {
  const bool hand = hand_ && !event.modifiers.control && !pace_.paused;
  if (hand) {
    hand_->changeGrip(math::pow(kGripStep, event.y));
  } else {
    painter_.camera().zoom(math::pow(kZoomStep, event.y));
  }
}

void Viewer::act(ViewAction action) {
  if (toggle(action, choice_) || actOnScene(action)) return;
  switch (action) {
    case ViewAction::kQuit:
      quit_ = true;
      break;
    case ViewAction::kFullScreen:
      surface_.toggleFullScreen();
      break;
    case ViewAction::kScreenshot:
      saveScreenshot();
      break;
    case ViewAction::kSequence:
      toggleSequence();
      break;
    default:
      actOnTime(action);
      if (hand_) actOnHand(action);
  }
}

bool Viewer::actOnScene(ViewAction action) {
  if (action == ViewAction::kCamera) {
    lookAtAll(shown());
  } else if (action == ViewAction::kNextBody) {
    int next = choice_.selected;
    do {
      if (++next == static_cast<int>(moves_.size())) next = -1;
    } while (next >= 0 && !moves_[static_cast<std::size_t>(next)]);
    select(next);
  } else if (action >= ViewAction::kChart1 && action <= ViewAction::kChart8) {
    charts_->toggle(static_cast<std::size_t>(action) - static_cast<std::size_t>(ViewAction::kChart1));
  } else {
    return false;
  }
  return true;
}

void Viewer::actOnTime(ViewAction action) {
  const bool at_present = !scrub_ || *scrub_ + 1 >= history_.size();
  switch (action) {
    case ViewAction::kPause:
      pace_.paused = !pace_.paused;
      if (!pace_.paused && recorded_ && at_present) play_time_ = history_.at(0).time;
      if (!pace_.paused && !recorded_) scrub_.reset();
      replaying_ = false;
      break;
    case ViewAction::kRestart:
      replay();
      break;
    case ViewAction::kLoop:
      loop_ = !loop_;
      break;
    case ViewAction::kTickForward:
      if (pace_.paused && at_present && !recorded_) {
        scrub_.reset();
        pace_.single_ticks.fetch_add(1);
      } else if (scrub_) {
        scrubBy(1);
      }
      break;
    case ViewAction::kTickBack:
      scrubBy(-1);
      break;
    case ViewAction::kScrubBack:
      scrubTo(shown().time - 1);
      break;
    case ViewAction::kScrubForward:
      scrubTo(shown().time + 1);
      break;
    case ViewAction::kLive:
      if (recorded_) {
        scrubTo(kInfinity);
      } else {
        scrub_.reset();
        replaying_ = false;
      }
      break;
    case ViewAction::kSlower:
      pace_.speed = std::max(0.5 * pace_.speed, kSlowest);
      break;
    case ViewAction::kFaster:
      pace_.speed = std::min(2 * pace_.speed, hand_ ? 1.0 : kFastest);
      break;
    default:
      break;
  }
}

void Viewer::scrubBy(int pictures) {
  if (!(pace_.paused || pace_.ended) || history_.size() == 0) return;
  replaying_ = false;
  const auto last = static_cast<std::ptrdiff_t>(history_.size()) - 1;
  const auto from = scrub_ ? static_cast<std::ptrdiff_t>(*scrub_) : last;
  scrub_ = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(from + pictures, 0, last));
  play_time_ = shown().time;
  chartRecording();
}

void Viewer::scrubTo(double time) {
  if (!(pace_.paused || recorded_ || pace_.ended) || history_.size() == 0) return;
  replaying_ = false;
  scrub_ = history_.find(time);
  play_time_ = shown().time;
  chartRecording();
}

// A scene that goes on stands still meanwhile.
void Viewer::replay() {
  if (history_.size() == 0) return;
  play_time_ = history_.at(0).time;
  scrub_ = 0;
  if (!recorded_) pace_.paused = !pace_.ended;
  if (recorded_) pace_.paused = false;
  replaying_ = !recorded_;
  chartRecording();
}

void Viewer::select(int body) {
  if (!options_.keys || shown().trial.blind) return;
  choice_.selected = body;
  if (body < 0) return;
  choice_.bodies = true;
  if (!is_free_[static_cast<std::size_t>(body)]) return;
  charts_->follow(body, body_names_[static_cast<std::size_t>(body)]);
  if (history_.size() > 0) chartRecording();
}

int Viewer::thingUnderMouse() {
  if (shown().trial.blind) return -1;
  constexpr int kShare = 4;  // of the window's pixels along a side, that are looked at
  const devices::SurfaceSize size = surface_.size(),
                             small{std::max(1, size.width / kShare), std::max(1, size.height / kShare)};
  const int x = std::clamp(static_cast<int>(mouse_.x()) / kShare, 0, small.width - 1);
  const int y = std::clamp(static_cast<int>(mouse_.y()) / kShare, 0, small.height - 1);
  const std::vector<int> things =
      painter_.renderer().things(painter_.scene().compose(shown(), choice_), painter_.camera(), small);
  return things[static_cast<std::size_t>(y * small.width + x)] - SceneDrawing::thingOfBody(0);
}

bool Viewer::mouseIsOnBar() const {
  return hasBar() && choice_.overlay && mouse_.y() > surface_.size().height - kBarHeight;
}

void Viewer::scrubToMouse() {
  if (!recorded_ && !pace_.ended) pace_.paused = true;
  constexpr double kAside = 14;  // where the bar begins and ends [pixels]
  const double share = std::clamp((mouse_.x() - kAside) / (surface_.size().width - 2 * kAside), 0.0, 1.0);
  scrubTo(history_.at(0).time + share * (history_.at(history_.size() - 1).time - history_.at(0).time));
}

void Viewer::actOnHand(ViewAction action) {
  const Vec3 way = wayOf(action);
  hand_->move(kKeyStep * (options_.from_the_side ? Vec3(-way.y(), way.x(), way.z()) : way));
  if (action == ViewAction::kTurnLeft) hand_->turn(kTurnStep);
  if (action == ViewAction::kTurnRight) hand_->turn(-kTurnStep);
  if (action == ViewAction::kSqueeze) hand_->toggleSqueeze();
  if (action == ViewAction::kGripLess) hand_->changeGrip(1 / kGripStep);
  if (action == ViewAction::kGripMore) hand_->changeGrip(kGripStep);
}

}  // namespace pincer::tasks
