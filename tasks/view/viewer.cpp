#include "pincer/tasks/view/viewer.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace pincer::tasks {
namespace {

constexpr double kNoticeTime = 2.5;  // [s]

double viewerSeconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// The first of pattern(1), pattern(2), ... that isn't there yet.
std::string freshPath(const std::string& folder, const std::string& stem, const std::string& ending) {
  for (int i = 1;; ++i) {
    std::string path = fmt::format("{}/{}-{:03}{}", folder, stem, i, ending);
    if (!std::filesystem::exists(path)) return path;
  }
}

}  // namespace

Viewer::Viewer(devices::Surface& surface, const grasp::GraspModel& model, const Snapshot& start, SnapshotChannel& channel,
               PaceControl& pace, devices::MouseHand* hand, ViewerOptions options)
    : surface_(surface), channel_(channel), pace_(pace), hand_(hand), options_(std::move(options)), painter_(surface, model, start) {
  if (!model.fingers.empty()) charts_.emplace_back("grip force", "N", model.fingers.size());
  for (const grasp::FingerModel& finger : model.fingers) pads_.push_back({finger.name, 1.5 * finger.radius, 0});
  for (std::size_t i = 0; i < model.world.bodies.size() && object_ < 0; ++i) {
    if (model.world.bodies[i].dynamic) object_ = static_cast<int>(i);
  }
  if (object_ >= 0) {
    start_height_ = start.X_WB[static_cast<std::size_t>(object_)].p.z();
    charts_.emplace_back("height", "mm", 1);
  }
  charts_.emplace_back("tick", "us", 1);
  if (options_.from_the_side) painter_.camera().yaw = 0.5 * std::numbers::pi;
}

bool Viewer::update() {
  for (const devices::InputEvent& event : surface_.poll()) handle(event);
  look();
  // Without a graphics card, borders are smoothed only where there is time to see them: in what stands still, and what is kept.
  draw(!painter_.renderer().isSoftware() || pace_.paused || !sequence_.empty());
  if (!sequence_.empty()) savePictureOfSequence();
  painter_.show();
  const double now = viewerSeconds();
  if (last_picture_ > 0) pictures_per_second_ += 0.1 * (1 / std::max(now - last_picture_, 1e-6) - pictures_per_second_);
  last_picture_ = now;
  return !quit_ && !surface_.closed();
}

void Viewer::showRecording(History recording, double time) {
  history_ = std::move(recording);
  recorded_ = true;
  play_time_ = time;
  scrub_ = history_.find(time);
  chartRecording();
}

// The recording goes on by the time since the last picture.
void Viewer::play() {
  const double passed = last_picture_ > 0 ? viewerSeconds() - last_picture_ : 0;
  if (!pace_.paused) play_time_ += pace_.speed * passed;
  const std::size_t before = *scrub_;
  if (!pace_.paused) scrub_ = history_.find(play_time_);
  if (*scrub_ + 1 == history_.size()) pace_.paused = true;
  if (*scrub_ != before) chartRecording();
}

// The seconds before what is shown.
void Viewer::chartRecording() {
  constexpr std::size_t kPoints = 400;
  const double from = shown().time - charts_.front().seconds();
  const std::size_t first = history_.find(from), step = (*scrub_ - first) / kPoints + 1;
  for (std::size_t i = first; i < *scrub_; i += step) addToCharts(history_.at(i));
  addToCharts(shown());
}

void Viewer::look() {
  if (recorded_) return play();
  if (!channel_.update()) return;
  const Snapshot& snapshot = channel_.current();
  history_.add(snapshot);
  addToCharts(snapshot);
  if (const double late = pace_.late; late >= 0) lateness_.add(late);
}

void Viewer::addToCharts(const Snapshot& snapshot) {
  std::size_t next = 0;
  if (!snapshot.fingers.empty()) {
    std::vector<double> forces;
    for (const FingerSnapshot& finger : snapshot.fingers) forces.push_back(finger.normal_force);
    charts_[next++].add(snapshot.time, std::move(forces));
  }
  if (object_ >= 0) {
    const double height = snapshot.X_WB[static_cast<std::size_t>(object_)].p.z() - start_height_;
    charts_[next++].add(snapshot.time, {1e3 * height});
  }
  charts_[next].add(snapshot.time, {1e6 * snapshot.tick_seconds});
}

Image Viewer::picture() {
  draw(true);
  return painter_.picture();
}

void Viewer::draw(bool at_best) {
  painter_.draw(shown(), choice_, at_best);
  const devices::SurfaceSize size = surface_.size();
  const OverlayText text = overlayText();
  overlay_.draw(text, size.width, size.height);
}

OverlayText Viewer::overlayText() const {
  OverlayText text;
  text.snapshot = &shown();
  text.choice = choice_;
  const devices::SurfaceSize size = surface_.size();
  for (const ViewLabel& label : painter_.scene().labels(shown(), choice_)) {
    if (const auto pixel = painter_.camera().toPixel(label.p_W, size.width, size.height))
      text.labels.push_back({*pixel, label.text, label.slips});
  }
  for (std::size_t i = 0; i < pads_.size(); ++i) {
    if (shown().fingers[i].q_WF) text.pads.push_back(pads_[i]);
    if (hand_ && pads_.size() > 1 && !text.pads.empty()) text.pads.back().grip = hand_->grip();
  }
  text.charts = charts_;
  text.title = options_.title;
  text.page = page_ ? &*page_ : nullptr;
  text.pace = paceText();
  if (viewerSeconds() < notice_until_) text.notice = notice_;
  text.pictures_per_second = pictures_per_second_;
  text.lateness = &lateness_;
  if (scrub_) text.scrub = static_cast<double>(*scrub_ + 1) / static_cast<double>(history_.size());
  text.hands = hand_ != nullptr;
  text.keys = options_.keys;
  return text;
}

std::string Viewer::paceText() const {
  if (recorded_ && pace_.paused) return fmt::format("paused, of {:.3f} s", history_.at(history_.size() - 1).time);
  if (scrub_ && !recorded_) return "looking back";
  if (pace_.paused) return "paused";
  const double speed = pace_.speed;
  return speed < 1 ? fmt::format("1/{:.0f} of real time", 1 / speed) : "real time";
}

double Viewer::metresPerHeight() const {
  const Camera& camera = painter_.camera();
  return 2 * camera.distance * math::tan(camera.opening / 2);
}

void Viewer::saveScreenshot() {
  const std::string path = freshPath(options_.folder, "pincer", ".png");
  writePng(picture(), path);
  notice_ = "saved " + path;
  notice_until_ = viewerSeconds() + kNoticeTime;
}

void Viewer::toggleSequence() {
  if (!sequence_.empty()) {
    notice_ = fmt::format("{} pictures in {}", sequence_count_, sequence_);
    sequence_.clear();
  } else {
    sequence_ = freshPath(options_.folder, "pincer-sequence", "");
    sequence_count_ = 0;
    std::filesystem::create_directories(sequence_);
    notice_ = "pictures go to " + sequence_;
  }
  notice_until_ = viewerSeconds() + kNoticeTime;
}

void Viewer::savePictureOfSequence() { writePng(painter_.picture(), fmt::format("{}/{:06}.png", sequence_, ++sequence_count_)); }

}  // namespace pincer::tasks
