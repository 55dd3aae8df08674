#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pincer/tasks/view/overlay_parts.h"

namespace pincer::tasks {
namespace {

constexpr float kPadSide = 148;                        // of a fingerpad inset [pixels]
constexpr float kChartWidth = 250, kChartHeight = 78;  // [pixels]
// Colours: red, green, blue and opacity, 0 to 255; chosen by eye.
constexpr ImU32 kSkinInk = IM_COL32(222, 170, 148, 255), kPadInk = IM_COL32(205, 130, 112, 255),
                kGridInk = IM_COL32(255, 255, 255, 60);
constexpr ImU32 kWantedInk = IM_COL32(25, 60, 160, 255), kTactorInk = IM_COL32(20, 24, 30, 255),
                kParkedInk = IM_COL32(110, 110, 110, 255);
constexpr ImU32 kTargetInk = IM_COL32(20, 140, 60, 255);
constexpr std::array<ImU32, 3> kLineInks = {IM_COL32(95, 175, 255, 255), IM_COL32(255, 165, 70, 255),
                                            IM_COL32(120, 215, 130, 255)};

// The pad seen from outside, as one looks at one's own finger: distal up; L's first axis is distal, its second radial.
ImVec2 onPad(const ImVec2& middle, double reach, const Vec2& place_L) {
  const double scale = 0.46 * kPadSide / reach;
  return {middle.x + static_cast<float>(scale * place_L.y()), middle.y - static_cast<float>(scale * place_L.x())};
}

void drawTactor(ImDrawList* list, const ImVec2& middle, const PadLook& pad, const FingerSnapshot& finger) {
  const ImVec2 wanted = onPad(middle, pad.reach, finger.tactor_parked ? Vec2(Vec2::Zero()) : finger.tactor_wanted_L);
  const ImU32 ink = finger.tactor_parked ? kParkedInk : kWantedInk;
  if (finger.tactor_L) {
    const ImVec2 at = onPad(middle, pad.reach, *finger.tactor_L);
    list->AddLine(at, wanted, ink, 1.5f);
    list->AddCircleFilled(at, 8, finger.tactor_parked ? kParkedInk : kTactorInk, 24);
    list->AddCircleFilled({at.x - 2, at.y - 2}, 2.2f, IM_COL32(255, 255, 255, 130), 12);
  }
  list->AddCircle(wanted, 10, ink, 24, 2);
}

void drawTarget(ImDrawList* list, const ImVec2& middle, const PadLook& pad, double target) {
  list->AddCircle(onPad(middle, pad.reach, {target, 0}), 13, kTargetInk, 32, 3);
}

void drawPad(const PadLook& pad, const FingerSnapshot& finger, const std::optional<double>& target) {
  ImGui::TextUnformatted(pad.finger.c_str());
  const std::string force = fmt::format("{:.2f} N", finger.normal_force);
  ImGui::SameLine(kPadSide - ImGui::CalcTextSize(force.c_str()).x + ImGui::GetStyle().WindowPadding.x);
  ImGui::TextColored(finger.sliding ? ImVec4(1.0f, 0.45f, 0.35f, 1) : ImVec4(0.45f, 0.85f, 0.50f, 1), "%s",
                     force.c_str());
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 middle(corner.x + 0.5f * kPadSide, corner.y + 0.5f * kPadSide);
  ImGui::Dummy({kPadSide, kPadSide});
  ImDrawList* list = ImGui::GetWindowDrawList();
  // The fingertip: round at the top (distal), open at the bottom.
  list->PushClipRect(corner, {corner.x + kPadSide, corner.y + kPadSide}, true);
  const float r = 0.48f * kPadSide;
  list->AddRectFilled({middle.x - r, middle.y - r}, {middle.x + r, corner.y + kPadSide + 40}, kSkinInk, r);
  list->AddCircleFilled(middle, 0.36f * kPadSide, kPadInk, 48);
  list->AddLine({middle.x - r, middle.y}, {middle.x + r, middle.y}, kGridInk);
  list->AddLine({middle.x, middle.y - r}, {middle.x, middle.y + r}, kGridInk);
  if (target) drawTarget(list, middle, pad, *target);
  if (finger.has_display) drawTactor(list, middle, pad, finger);
  if (finger.place_L) {
    const ImVec2 at = onPad(middle, pad.reach, *finger.place_L);
    list->AddLine({at.x - 5, at.y - 5}, {at.x + 5, at.y + 5}, IM_COL32(255, 255, 255, 255), 2);
    list->AddLine({at.x - 5, at.y + 5}, {at.x + 5, at.y - 5}, IM_COL32(255, 255, 255, 255), 2);
  }
  list->PopClipRect();
  if (pad.grip > 0) ImGui::TextDisabled("grip up to %.2g N", pad.grip);
}

// The title, and the values in the colours of their lines, each with its name where there are several.
void chartHead(const StripChart& chart, const StripChart::Point* at) {
  ImGui::TextDisabled("%s:", chart.title().c_str());
  for (std::size_t i = 0; at && i < chart.lines().size(); ++i) {
    const std::string name = chart.lines().size() > 1 && !chart.lines()[i].empty() ? chart.lines()[i] + " " : "";
    ImGui::SameLine(0, 7);
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kLineInks[i % kLineInks.size()]), "%s%s", name.c_str(),
                       std::isfinite(at->values[i]) ? fmt::format("{:.3g}", at->values[i]).c_str() : "-");
  }
  ImGui::SameLine(0, 5);
  ImGui::TextDisabled("%s", chart.unit().c_str());
}

// Where the pointer is over the chart that comes next, its point there; else the last one.
struct ChartCursor {
  const StripChart::Point* point = nullptr;
  bool under_pointer = false;
};
ChartCursor cursorOf(const StripChart& chart, const Vec2& pointer) {
  if (chart.points().empty()) return {};
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const double x = (pointer.x() - corner.x) / kChartWidth,
               y = (pointer.y() - corner.y - ImGui::GetTextLineHeightWithSpacing()) / kChartHeight;
  if (x < 0 || x > 1 || y < 0 || y > 1) return {&chart.points().back(), false};
  return {chart.at(chart.points().back().time - (1 - x) * StripChart::kSeconds), true};
}

void drawChart(const StripChart& chart, const Vec2& pointer) {
  ImGui::BeginGroup();
  const ChartCursor cursor = cursorOf(chart, pointer);
  chartHead(chart, cursor.point);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({kChartWidth, kChartHeight});
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(corner, {corner.x + kChartWidth, corner.y + kChartHeight}, IM_COL32(255, 255, 255, 14), 3);
  const StripChart::Range range = chart.range();
  const double end = chart.points().empty() ? 0 : chart.points().back().time;
  const auto place = [&](double time, double value) {
    const double x = 1 - (end - time) / StripChart::kSeconds, y = (value - range.low) / (range.high - range.low);
    return ImVec2(corner.x + static_cast<float>(x) * kChartWidth, corner.y + static_cast<float>(1 - y) * kChartHeight);
  };
  for (std::size_t line = 0; line < chart.lines().size(); ++line) {
    std::vector<ImVec2> points;
    for (const StripChart::Point& point : chart.points()) {
      if (std::isfinite(point.values[line])) points.push_back(place(point.time, point.values[line]));
    }
    list->AddPolyline(points.data(), static_cast<int>(points.size()), kLineInks[line % kLineInks.size()], 0, 1.6f);
  }
  if (cursor.under_pointer) {
    const float x = place(cursor.point->time, 0).x;
    list->AddLine({x, corner.y}, {x, corner.y + kChartHeight}, kGridInk, 1.5f);
    list->AddText({std::min(x + 4, corner.x + kChartWidth - 50), corner.y + 0.4f * kChartHeight},
                  IM_COL32(255, 255, 255, 200), fmt::format("{:.2f} s", cursor.point->time).c_str());
  }
  constexpr ImU32 kScaleInk = IM_COL32(255, 255, 255, 150);  // faint, not to hide the lines
  list->AddText({corner.x + 3, corner.y}, kScaleInk, fmt::format("{:g} {}", range.high, chart.unit()).c_str());
  const float low = corner.y + kChartHeight - ImGui::GetFontSize();
  list->AddText({corner.x + 3, low}, kScaleInk, fmt::format("{:g}", range.low).c_str());
  const std::string since = fmt::format("last {:g} s", StripChart::kSeconds);
  list->AddText({corner.x + kChartWidth - ImGui::CalcTextSize(since.c_str()).x - 3, low}, kScaleInk, since.c_str());
  ImGui::EndGroup();
}

}  // namespace

void drawPads(const OverlayText& text, int width) {
  if (text.pads.empty() || !text.snapshot->trial.shows_pads) return;
  const OverlayPanel panel("pads", width, 0, 1, 0);
  for (std::size_t i = 0; i < std::min(text.pads.size(), text.snapshot->fingers.size()); ++i) {
    drawPad(text.pads[i], text.snapshot->fingers[i], text.snapshot->trial.target);
  }
}

void drawCharts(const OverlayText& text, int width, int height) {
  if (text.charts.empty() || text.snapshot->trial.blind) return;
  const OverlayPanel panel("charts", 0, height, 0, 1);
  constexpr float kGap = 14;  // [pixels]
  const auto in_a_row =
      static_cast<std::size_t>(std::max(1.0f, (static_cast<float>(width) - 40) / (kChartWidth + kGap)));
  for (std::size_t i = 0; i < text.charts.size(); ++i) {
    if (i % in_a_row > 0) ImGui::SameLine(0, kGap);
    drawChart(*text.charts[i], text.pointer);
  }
}

}  // namespace pincer::tasks
