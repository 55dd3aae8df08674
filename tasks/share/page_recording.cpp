#include "pincer/tasks/share/page_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pincer/tasks/view/framing.h"

namespace pincer::tasks {
namespace {

bool sameLook(const DrawItem& a, const DrawItem& b) {
  const Paint &p = a.paint, &q = b.paint;
  return a.mesh == b.mesh && a.layer == b.layer && a.part == b.part && p.colour == q.colour && p.alpha == q.alpha &&
         p.gloss == q.gloss && p.octants == q.octants && p.glow == q.glow && p.fade == q.fade;
}

void keepEverySecond(std::vector<double>& values) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); i += 2) values[kept++] = values[i];
  if (values.size() % 2 == 0) values[kept++] = values.back();
  values.resize(kept);
}

// Told in words: the trial's stage, and what the person is asked to do.
std::string captionOf(const TrialSnapshot& trial) {
  const std::string stage = trial.stage, instruction = trial.instruction;
  return stage.empty() || instruction.empty() ? stage + instruction : stage + ": " + instruction;
}

}  // namespace

PageRecording::PageRecording(std::string title, const grasp::GraspModel& model, const Snapshot& start,
                             MeshTable& meshes, const SceneCamera& camera)
    : title_(std::move(title)),
      drawing_(model, start, meshes),
      camera_(withGiven(camera, drawing_.camera(start))),
      radius_(drawing_.radius(start)) {
  for (std::size_t i = 0; i < start.fingers.size(); ++i) {
    const std::string name = model.fingers[i].name.empty() ? fmt::format("finger {}", i + 1) : model.fingers[i].name;
    PagePad& pad = pads_.emplace_back();
    pad.finger = name;
    pad.has_display = start.fingers[i].has_display;
    chart("force on " + name, "N");
  }
}

PageChart& PageRecording::chart(const std::string& name, const std::string& unit) {
  return charts_.emplace_back(PageChart{name, unit});
}

void PageRecording::add(const Snapshot& snapshot) {
  times_.push_back(snapshot.time);
  addItems(drawing_.compose(snapshot, {}));
  addPads(snapshot);
  addCaption(snapshot);
}

std::size_t PageRecording::groupOf(const DrawItem& item) {
  const auto known =
      std::find_if(groups_.begin(), groups_.end(), [&](const PageGroup& group) { return sameLook(group.look, item); });
  const auto place = static_cast<std::size_t>(known - groups_.begin());
  if (known == groups_.end()) groups_.push_back({item, {}});
  return place;
}

// Where an item isn't there, its first number is NaN, and the others stay as they were: no change costs nothing.
void PageRecording::addItems(const DrawList& list) {
  std::vector<std::size_t> placed(groups_.size());
  const std::size_t pictures = times_.size();
  for (const DrawItem& item : list) {
    if (item.paint.sheer) continue;  // the page's own shader knows no grid
    const std::size_t group = groupOf(item);
    placed.resize(groups_.size());
    std::vector<PlacedItem>& items = groups_[group].items;
    if (placed[group] == items.size()) {
      PlacedItem& fresh = items.emplace_back();
      for (int k = 0; k < 12; ++k) {
        fresh[static_cast<std::size_t>(k)].assign(pictures - 1,
                                                  k == 0 ? NAN : static_cast<double>(item.X_WM(k % 3, k / 3)));
      }
    }
    PlacedItem& here = items[placed[group]++];
    for (int k = 0; k < 12; ++k)
      here[static_cast<std::size_t>(k)].push_back(static_cast<double>(item.X_WM(k % 3, k / 3)));
  }
  for (std::size_t group = 0; group < groups_.size(); ++group) {
    for (std::size_t i = placed[group]; i < groups_[group].items.size(); ++i) {
      PlacedItem& gone = groups_[group].items[i];
      gone[0].push_back(NAN);
      for (std::size_t k = 1; k < gone.size(); ++k) gone[k].push_back(gone[k].back());
    }
  }
}

void PageRecording::addPads(const Snapshot& snapshot) {
  for (std::size_t i = 0; i < pads_.size(); ++i) {
    const FingerSnapshot& finger = snapshot.fingers[i];
    for (int k = 0; k < 2; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      pads_[i].place_L[axis].push_back(finger.place_L ? (*finger.place_L)[k] : NAN);
      pads_[i].tactor_L[axis].push_back(finger.tactor_L && !finger.tactor_parked ? (*finger.tactor_L)[k] : NAN);
    }
    pads_[i].has_display |= finger.has_display;
    pads_[i].sliding.push_back(finger.sliding ? 1 : 0);
    charts_[i].values.push_back(finger.f_user_W.norm());
  }
}

void PageRecording::addCaption(const Snapshot& snapshot) {
  const std::string text = captionOf(snapshot.trial);
  if (captions_.empty() ? text.empty() : text == captions_.back().text) return;
  captions_.push_back({times_.size() - 1, text});
}

void PageRecording::halve() {
  const std::size_t before = times_.size();
  keepEverySecond(times_);
  for (PageGroup& group : groups_) {
    for (PlacedItem& item : group.items) {
      for (auto& column : item) keepEverySecond(column);
    }
  }
  for (PageChart& chart : charts_) keepEverySecond(chart.values);
  for (PagePad& pad : pads_) {
    for (auto* column : {&pad.place_L[0], &pad.place_L[1], &pad.tactor_L[0], &pad.tactor_L[1], &pad.sliding})
      keepEverySecond(*column);
  }
  for (PageCaption& caption : captions_) {
    caption.picture = caption.picture + 1 == before ? times_.size() - 1 : (caption.picture + 1) / 2;
  }
}

}  // namespace pincer::tasks
