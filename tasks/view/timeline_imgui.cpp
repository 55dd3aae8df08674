#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/math.h"
#include "pincer/tasks/view/overlay_parts.h"

namespace pincer::tasks {
namespace {

// Colours: red, green, blue and opacity, 0 to 255; chosen by eye.
constexpr ImU32 kBarPaper = IM_COL32(20, 23, 28, 205), kBarInk = IM_COL32(235, 238, 242, 255),
                kBarDim = IM_COL32(235, 238, 242, 110);
constexpr ImU32 kPassed = IM_COL32(70, 140, 235, 255), kTouchInk = IM_COL32(115, 217, 128, 255),
                kSlipMark = IM_COL32(255, 115, 90, 255);
constexpr ImU32 kReleaseInk = IM_COL32(200, 200, 200, 255);
constexpr int kMostBodies = 12;  // in the list

ImU32 inkOf(MomentKind kind) {
  if (kind == MomentKind::kSlip) return kSlipMark;
  return kind == MomentKind::kRelease ? kReleaseInk : kTouchInk;
}

std::string lengthText(double metres) {
  return metres < 0.9995e-3 ? fmt::format("{:g} um", 1e6 * metres)
         : metres < 0.9995  ? fmt::format("{:g} mm", 1e3 * metres)
                            : fmt::format("{:g} m", metres);
}

}  // namespace

// Times above the line, moments on it, and where one is.
void drawTimeline(const OverlayText& text, int width, int height) {
  constexpr float kAside = 14, kLabel = 90;  // [pixels]
  const double span = text.to - text.from;
  if (!(span > 0)) return;
  ImDrawList* list = ImGui::GetForegroundDrawList();
  const auto top = static_cast<float>(height - kBarHeight), right = static_cast<float>(width);
  const float y = top + 30;
  const auto x = [&](double time) {
    return kAside + static_cast<float>(std::clamp((time - text.from) / span, 0.0, 1.0)) * (right - 2 * kAside);
  };
  list->AddRectFilled({0, top}, {right, static_cast<float>(height)}, kBarPaper);
  list->AddRectFilled({x(text.from), y - 2}, {x(text.to), y + 2}, kBarDim, 2);
  list->AddRectFilled({x(text.from), y - 2}, {x(text.snapshot->time), y + 2}, kPassed, 2);
  const double step = tickStep(span, std::max(1, static_cast<int>(right / kLabel)));
  for (double time = std::ceil(text.from / step) * step; time <= text.to + 1e-9 * span; time += step) {
    const std::string label = fmt::format("{:g} s", std::round(time / step) * step);
    const float wide = ImGui::CalcTextSize(label.c_str()).x;
    list->AddLine({x(time), y - 8}, {x(time), y - 3}, kBarDim);
    list->AddText({std::clamp(x(time) - 0.5f * wide, 2.0f, right - wide - 2), top + 3}, kBarInk, label.c_str());
  }
  for (const TimelineMoment& moment : text.timeline->moments()) {
    if (moment.time < text.from || moment.time > text.to) continue;
    list->AddTriangleFilled({x(moment.time) - 4, y + 9}, {x(moment.time) + 4, y + 9}, {x(moment.time), y + 2},
                            inkOf(moment.kind));
  }
  list->AddCircleFilled({x(text.snapshot->time), y}, 6, kBarInk, 20);
}

void drawScale(const OverlayText& text, int width, int height) {
  const std::string words = "grid " + lengthText(text.grid);
  const ImVec2 size = ImGui::CalcTextSize(words.c_str());
  const float below = text.timeline && text.choice.overlay ? static_cast<float>(kBarHeight) : 0;
  ImGui::GetBackgroundDrawList()->AddText(
      {static_cast<float>(width) - size.x - 14, static_cast<float>(height) - size.y - 8 - below},
      IM_COL32(40, 46, 54, 220), words.c_str());
}

void drawBodies(const OverlayText& text, int width, int height) {
  if (text.bodies.empty() || text.snapshot->trial.blind) return;
  const OverlayPanel panel("bodies", width, 0.42 * height, 1, 0);
  int shown = 0;
  for (const BodyRow& body : text.bodies) {
    if (++shown > kMostBodies) break;
    const ImVec4 ink = body.selected ? ImVec4(1.0f, 0.92f, 0.5f, 1) : ImGui::GetStyle().Colors[ImGuiCol_Text];
    ImGui::TextColored(ink, "%s", body.name.c_str());
    ImGui::TextDisabled("%s", motionWords(body).c_str());
    if (!body.contacts.empty()) ImGui::TextUnformatted(body.contacts.c_str());
  }
  const int more = static_cast<int>(text.bodies.size()) - kMostBodies;
  if (more > 0) ImGui::TextDisabled("%s", fmt::format("and {} more", more).c_str());
}

}  // namespace pincer::tasks
