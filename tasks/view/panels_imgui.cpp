#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "pincer/contact/io/counted.h"
#include "pincer/tasks/view/label_layout.h"
#include "pincer/tasks/view/overlay_parts.h"

namespace pincer::tasks {
namespace {

// Colours: red, green, blue and opacity, 0 to 255; chosen by eye.
constexpr ImU32 kInk = IM_COL32(18, 22, 28, 255), kPaper = IM_COL32(255, 255, 255, 205),
                kSlipInk = IM_COL32(190, 30, 10, 255), kLeaderInk = IM_COL32(18, 22, 28, 120),
                kPullInk = IM_COL32(25, 60, 160, 255);
const ImVec4 kGoodText(0.45f, 0.85f, 0.50f, 1), kBadText(1.0f, 0.45f, 0.35f, 1);  // likewise, 0 to 1

void textLine(const std::string& text) { ImGui::TextUnformatted(text.c_str()); }
void dimLine(const std::string& text) { ImGui::TextDisabled("%s", text.c_str()); }
void colourLine(bool good, const std::string& text) {
  ImGui::TextColored(good ? kGoodText : kBadText, "%s", text.c_str());
}

std::string statusWords(const Snapshot& snapshot) {
  if (snapshot.status & engine::kStateNotFinite) return "the state isn't finite: begin again";
  if (snapshot.status & engine::kSolverNotConverged) return "contact forces are approximate";
  if (snapshot.status & engine::kContactsDropped) return "contacts were dropped";
  return snapshot.asleep ? "at rest" : "";
}

// A list of keys or gestures, and what each does beside it.
template <class Rows>
void helpList(const char* title, const Rows& rows) {
  constexpr float kGap = 14;  // [pixels]
  float widest = 0;
  for (const auto& row : rows) widest = std::max(widest, ImGui::CalcTextSize(row.name).x);
  ImGui::BeginGroup();
  textLine(title);
  for (const auto& row : rows) {
    textLine(row.name);
    ImGui::SameLine(widest + kGap);
    dimLine(row.effect);
  }
  ImGui::EndGroup();
}

}  // namespace

void drawLabels(const OverlayText& text, int width, int height) {
  std::vector<LabelBox> boxes;
  for (const OverlayLabel& label : text.labels) {
    const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
    boxes.push_back({label.pixel, Vec2(size.x + 10, size.y + 4)});
  }
  const std::vector<Vec2> places = layOut(boxes, text.things, Vec2(width, height));
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const auto pixel = [](const Vec2& v) { return ImVec2(static_cast<float>(v.x()), static_cast<float>(v.y())); };
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const OverlayLabel& label = text.labels[i];
    if (places[i] != label.pixel) list->AddLine(pixel(label.pixel), pixel(places[i]), kLeaderInk, 1);
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const OverlayLabel& label = text.labels[i];
    const Vec2 low = places[i] - 0.5 * boxes[i].size, high = places[i] + 0.5 * boxes[i].size;
    list->AddRectFilled(pixel(low), pixel(high), kPaper, 4);
    list->AddText(pixel(low + Vec2(5, 2)), label.slips ? kSlipInk : kInk, label.text.c_str());
  }
  if (text.pulled) list->AddLine(pixel(*text.pulled), pixel(text.pointer), kPullInk, 2.5f);
  if (text.hovered.empty()) return;
  const ImVec2 at(static_cast<float>(text.pointer.x()) + 14, static_cast<float>(text.pointer.y()) + 6);
  const ImVec2 size = ImGui::CalcTextSize(text.hovered.c_str());
  list->AddRectFilled({at.x - 5, at.y - 2}, {at.x + size.x + 5, at.y + size.y + 2}, kPaper, 4);
  list->AddText(at, kInk, text.hovered.c_str());
}

void drawStatus(const OverlayText& text) {
  const OverlayPanel panel("status", 0, 0, 0, 0);
  const Snapshot& s = *text.snapshot;
  if (!text.title.empty()) textLine(text.title);
  textLine(fmt::format("{:.3f} s", s.time));
  ImGui::SameLine();
  dimLine(fmt::format("{}", text.pace));
  if (s.tick_seconds > 0 && !s.trial.blind)
    dimLine(fmt::format("tick {:.1f} us, {}", 1e6 * s.tick_seconds, counted(s.contact_count, "contact")));
  const std::string words = statusWords(s);
  if (!text.moment.empty()) dimLine(text.moment);
  if (!words.empty()) colourLine((s.status & ~std::uint32_t{0}) == 0, words);
  if (text.keys) dimLine("F1 help");
}

void drawTrial(const OverlayText& text, int width) {
  const TrialSnapshot& trial = text.snapshot->trial;
  if (trial.trials == 0 && *trial.instruction == 0) return;
  const OverlayPanel panel("trial", 0.5 * width, 0, 0.5, 0);
  if (*trial.instruction) textLine(trial.instruction);
  if (*trial.hint) colourLine(true, trial.hint);
  if (trial.trials == 0) return;
  std::string line = fmt::format("trial {} of {}", trial.trial, trial.trials);
  if (*trial.condition) line += fmt::format(" · {}", trial.condition);
  if (*trial.stage) line += fmt::format(" · {}", trial.stage);
  if (trial.time_left >= 0) line += fmt::format(" · {:.0f} s left", std::ceil(trial.time_left));
  dimLine(line);
}

void drawHealth(const OverlayText& text, int height) {
  const OverlayPanel panel("health", 0, 0.36 * height, 0, 0.5);
  textLine("Health");
  dimLine(fmt::format("{:.0f} pictures/s", text.pictures_per_second));
  if (text.lateness && text.lateness->count() > 0) {
    const auto us = [&](double q) { return 1e6 * text.lateness->quantile(q); };
    dimLine(fmt::format("ticks late by {:.0f} us (median), {:.0f} us (99 %), {:.0f} us (worst)", us(0.5), us(0.99),
                        1e6 * text.lateness->largest()));
  }
  for (std::size_t i = 0; i < text.snapshot->fingers.size(); ++i) {
    const FingerSnapshot& finger = text.snapshot->fingers[i];
    if (!finger.has_device) continue;
    const std::string name = i < text.pads.size() ? text.pads[i].finger : fmt::format("finger {}", i);
    const bool good = finger.device == devices::DeviceState::kReady && finger.trip == devices::Trip::kNone;
    colourLine(good,
               fmt::format("{}: {}{}", name, devices::nameOf(finger.device), finger.armed ? ", armed" : ", not armed"));
    if (finger.trip != devices::Trip::kNone) colourLine(false, devices::describe(finger.trip));
  }
}

void drawHelp(const OverlayText& text, int width, int height) {
  const OverlayPanel panel("help", 0.5 * width, 0.5 * height, 0.5, 0.5);
  const auto groups = keyGroups();
  ImGui::BeginGroup();
  for (std::size_t i = 0; i < 2; ++i) helpList(groups[i].title, groups[i].keys);
  ImGui::EndGroup();
  ImGui::SameLine(0, 30);
  ImGui::BeginGroup();
  for (std::size_t i = 2; i < groups.size() - (text.hands ? 0 : 1); ++i) helpList(groups[i].title, groups[i].keys);
  helpList("Mouse", text.hands ? handGestures() : cameraGestures());
  ImGui::EndGroup();
}

void drawPage(const OverlayText& text, int width, int height) {
  constexpr float kWidest = 760;  // of a line [pixels]
  const OverlayPanel panel("page", 0.5 * width, 0.42 * height, 0.5, 0.5);
  ImGui::SetWindowFontScale(1.5f);
  textLine(text.page->title);
  ImGui::SetWindowFontScale(1.15f);
  ImGui::PushTextWrapPos(std::min(kWidest, static_cast<float>(width) - 60));
  for (const std::string& line : text.page->lines) {
    ImGui::Dummy({1, 4});
    textLine(line);
  }
  ImGui::PopTextWrapPos();
  ImGui::SetWindowFontScale(1);
}

void drawNotice(const OverlayText& text, int width, int height) {
  if (text.notice.empty()) return;
  const OverlayPanel panel("notice", 0.5 * width, text.timeline ? height - kBarHeight : height, 0.5, 1);
  textLine(text.notice);
}

}  // namespace pincer::tasks
