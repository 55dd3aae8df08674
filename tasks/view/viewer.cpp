#include "pincer/tasks/view/viewer.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <thread>

#include "pincer/tasks/view/framing.h"

namespace pincer::tasks {
namespace {

constexpr double kNoticeTime = 2.5;  // [s]
constexpr double kQuietTime = 0.4;   // without change, until a picture at its best is worth its time [s]

double viewerSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The first of pattern(1), pattern(2), ... that isn't there yet.
std::string freshPath(const std::string& folder, const std::string& stem, const std::string& ending) {
  for (int i = 1;; ++i) {
    std::string path = fmt::format("{}/{}-{:03}{}", folder, stem, i, ending);
    if (!std::filesystem::exists(path)) return path;
  }
}

}  // namespace

Viewer::Viewer(devices::Surface& surface, const grasp::GraspModel& model, const Snapshot& start,
               SnapshotChannel& channel, PaceControl& pace, devices::MouseHand* hand, ViewerOptions options)
    : surface_(surface),
      channel_(channel),
      pace_(pace),
      hand_(hand),
      options_(std::move(options)),
      painter_(surface, model, start) {
  for (const grasp::FingerModel& finger : model.fingers) pads_.push_back({finger.name, 1.5 * finger.radius, 0});
  for (const grasp::FingerModel& finger : model.fingers) finger_names_.push_back(finger.name);
  charts_.emplace(start, finger_names_);
  start_X_WB_ = start.X_WB;
  int object = -1;
  for (std::size_t i = 0; i < model.world.bodies.size(); ++i) {
    const engine::BodyModel& body = model.world.bodies[i];
    body_names_.push_back(body.name.empty() ? fmt::format("body {}", i) : body.name);
    moves_.push_back(body.dynamic || body.driven);
    is_free_.push_back(body.dynamic);
    if (body.dynamic && object < 0) object = static_cast<int>(i);
  }
  if (object >= 0) charts_->follow(object, body_names_[static_cast<std::size_t>(object)]);
  lookAtAll(start);
}

void Viewer::lookAtAll(const Snapshot& snapshot) {
  painter_.camera() = painter_.scene().camera(snapshot);
  painter_.camera() = withGiven(options_.camera, painter_.camera());
  if (options_.choose_camera) painter_.frame(snapshot, options_.camera);
  if (options_.from_the_side) painter_.camera().yaw = 0.5 * std::numbers::pi;
}

bool Viewer::update() {
  const auto events = surface_.poll();
  for (const devices::InputEvent& event : events) handle(event);
  look();
  surface_.showPointer(!(hand_ && shown().trial.blind));  // it would tell where the hidden hand is
  if (!events.empty() || looksOtherwise()) quiet_since_ = viewerSeconds();
  // Without a graphics card, a picture at its best takes most of a second: once, of what has stood still for a while,
  // and of what is kept.
  const bool quiet = viewerSeconds() - quiet_since_ > kQuietTime;
  const bool at_best = !painter_.renderer().isSoftware() || quiet || !sequence_.empty();
  if (quiet && is_best_) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  } else {
    draw(at_best);
    is_best_ = at_best && painter_.renderer().isSoftware();
  }
  if (!sequence_.empty()) savePictureOfSequence();
  painter_.show();
  const double now = viewerSeconds();
  if (last_picture_ > 0) pictures_per_second_ += 0.1 * (1 / std::max(now - last_picture_, 1e-6) - pictures_per_second_);
  last_picture_ = now;
  return !quit_ && !surface_.closed();
}

void Viewer::showRecording(History recording, double time) {
  history_ = std::move(recording);
  for (std::size_t i = 0; i < history_.size(); ++i) timeline_.add(history_.at(i));
  recorded_ = true;
  play_time_ = time;
  scrub_ = history_.find(time);
  chartRecording();
}

// Since the last picture.
bool Viewer::looksOtherwise() {
  const Camera& camera = painter_.camera();
  const bool says = viewerSeconds() < notice_until_;
  const bool same = shown().tick == seen_tick_ && camera == seen_camera_ && says == said_ && !surface_.closed();
  seen_tick_ = shown().tick;
  seen_camera_ = camera;
  said_ = says;
  return !same;
}

// The recording goes on by the time since the last picture.
void Viewer::play() {
  const double passed = last_picture_ > 0 ? viewerSeconds() - last_picture_ : 0;
  if (!isPlaying()) return;
  play_time_ += pace_.speed * passed;
  const std::size_t before = *scrub_;
  scrub_ = history_.find(play_time_);
  if (*scrub_ != before) chartRecording();
  if (*scrub_ + 1 < history_.size()) return;
  if (loop_) return replay();
  replaying_ = false;
  if (recorded_) pace_.paused = true;
}

// The seconds before what is shown.
void Viewer::chartRecording() {
  constexpr std::size_t kPoints = 400;  // of a chart 250 pixels wide: as many show each pixel; chosen
  const double from = shown().time - StripChart::kSeconds;
  const std::size_t last = scrub_.value_or(history_.size() - 1), first = history_.find(from),
                    step = (last - first) / kPoints + 1;
  for (std::size_t i = first; i < last; i += step) charts_->add(history_.at(i));
  charts_->add(shown());
}

void Viewer::look() {
  if (scrub_ && (recorded_ || replaying_)) play();
  if (recorded_) return;
  if (loop_ && pace_.ended && !scrub_ && history_.size() > 1) replay();
  if (!channel_.update()) return;
  const Snapshot& snapshot = channel_.current();
  if (history_.size() > 0 && snapshot.tick == history_.at(history_.size() - 1).tick) return;
  history_.add(snapshot);
  timeline_.add(snapshot);
  charts_->add(snapshot);
  if (const double late = pace_.late; late >= 0) lateness_.add(late);
}

bool Viewer::hasBar() const {
  return history_.size() > 1 && options_.keys && !(hand_ && !pace_.paused) && !shown().trial.blind && !page_;
}

BodyRow Viewer::rowOf(std::size_t body) const {
  const Snapshot& now = shown();
  const std::size_t at = history_.size() == 0 ? 0 : history_.find(now.time);
  const Snapshot& before = at > 0 ? history_.at(at - 1) : now;
  BodyRow row{.name = body_names_[body],
              .p_W = now.X_WB[body].p,
              .selected = choice_.selected == static_cast<int>(body),
              .contacts = {}};
  if (now.time > before.time) row.speed = (now.X_WB[body].p - before.X_WB[body].p).norm() / (now.time - before.time);
  row.turn = angleBetween(start_X_WB_[body].q, now.X_WB[body].q);
  return row;
}

std::vector<BodyRow> Viewer::bodyRows() const {
  std::vector<BodyRow> rows;
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    if (!moves_[i]) continue;
    rows.push_back(rowOf(i));
    if (rows.back().selected)
      rows.back().contacts = contactWords(shown(), static_cast<int>(i), finger_names_, body_names_);
  }
  return rows;
}

std::string Viewer::hoveredWords() const {
  if (hovered_ < 0 || shown().trial.blind) return "";
  const auto i = static_cast<std::size_t>(hovered_);
  if (!isBody(hovered_)) {
    const std::size_t finger = i - body_names_.size();
    return fmt::format("{}\n{}", finger_names_[finger].empty() ? "finger" : finger_names_[finger],
                       fingerWords(shown().fingers[finger]));
  }
  if (!moves_[i]) return body_names_[i];
  const std::string contacts = contactWords(shown(), hovered_, finger_names_, body_names_);
  return fmt::format("{}\n{}{}{}", body_names_[i], motionWords(rowOf(i)), contacts.empty() ? "" : "\n", contacts);
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
  if (!text.labels.empty())
    text.things = painter_.scene().outlines(shown(), painter_.camera(), size.width, size.height);
  for (std::size_t i = 0; i < pads_.size(); ++i) {
    if (shown().fingers[i].q_WF) text.pads.push_back(pads_[i]);
    if (hand_ && pads_.size() > 1 && !text.pads.empty()) text.pads.back().grip = hand_->grip();
  }
  text.charts = charts_->shown();
  text.title = options_.title;
  text.page = page_ ? &*page_ : nullptr;
  text.pace = paceText();
  if (viewerSeconds() < notice_until_) text.notice = notice_;
  text.pictures_per_second = pictures_per_second_;
  text.lateness = &lateness_;
  if (hasBar()) {
    text.timeline = &timeline_;
    if (const TimelineMoment* moment = timeline_.before(shown().time))
      text.moment = fmt::format("{:.2f} s: {}", moment->time, momentText(*moment, finger_names_));
    text.from = history_.at(0).time;
    text.to = history_.at(history_.size() - 1).time;
  }
  if (choice_.bodies) text.bodies = bodyRows();
  text.hovered = hoveredWords();
  if (options_.pull && options_.pull->holds()) {
    const Vec3 p_W = shown().X_WB[static_cast<std::size_t>(options_.pull->body())] * options_.pull->place_B();
    text.pulled = painter_.camera().toPixel(p_W, size.width, size.height);
  }
  text.pointer = mouse_;
  if (!shown().trial.blind) text.grid = painter_.scene().grid();
  text.hands = hand_ != nullptr;
  text.keys = options_.keys;
  return text;
}

std::string Viewer::paceText() const {
  const double speed = pace_.speed;
  std::string words = speed < 1   ? fmt::format("1/{:.0f} of real time", 1 / speed)
                      : speed > 1 ? fmt::format("{:.0f} times real time", speed)
                                  : "real time";
  if (loop_) words += ", over and over";
  const bool at_end = !scrub_ || *scrub_ + 1 == history_.size();
  if (recorded_ && pace_.paused)
    return at_end ? "ended" : fmt::format("paused, of {:.3f} s", history_.at(history_.size() - 1).time);
  if (replaying_) return "again, " + words;
  if (scrub_ && !recorded_) return "looking back";
  if (pace_.ended && !recorded_) return options_.verdict ? "ended: " + options_.verdict() : "ended";
  return pace_.paused ? "paused" : words;
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

void Viewer::savePictureOfSequence() {
  writePng(painter_.picture(), fmt::format("{}/{:06}.png", sequence_, ++sequence_count_));
}

}  // namespace pincer::tasks
