#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <filesystem>

#include "pincer/devices/window/surface.h"
#include "pincer/tasks/view/overlay.h"
#include "pincer/tasks/view/overlay_parts.h"

namespace pincer::tasks {
namespace {

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";  // Debian's fonts-dejavu-core
constexpr float kFontSize = 15;                                                   // [pixels]
constexpr float kMargin = 12;                                                     // [pixels]

void setOverlayStyle() {
  ImGuiStyle& style = ImGui::GetStyle();
  ImGui::StyleColorsDark(&style);
  style.WindowRounding = 7;
  style.WindowBorderSize = 0;
  style.WindowPadding = {12, 9};
  style.ItemSpacing = {8, 4};
  style.Colors[ImGuiCol_WindowBg] = {0.08f, 0.09f, 0.11f, 0.80f};
  style.Colors[ImGuiCol_Text] = {0.93f, 0.94f, 0.95f, 1};
  style.Colors[ImGuiCol_TextDisabled] = {0.62f, 0.65f, 0.70f, 1};
}

}  // namespace

struct Overlay::Gui {
  ImGuiContext* context = nullptr;
};

Overlay::Overlay() : gui_(std::make_unique<Gui>()) {
  gui_->context = ImGui::CreateContext();
  ImGui::SetCurrentContext(gui_->context);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  if (std::filesystem::exists(kFont)) io.Fonts->AddFontFromFileTTF(kFont, kFontSize);
  setOverlayStyle();
  if (!ImGui_ImplOpenGL3_Init("#version 330 core")) {
    throw devices::DisplayError(
        "Dear ImGui can't draw here: libGL.so.1 is missing. Install it: apt-get install libgl1.");
  }
}

Overlay::~Overlay() {
  ImGui::SetCurrentContext(gui_->context);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(gui_->context);
}

// Panels fit their text from the second pass on: the first, which draws nothing, tells how large they are.
void Overlay::draw(const OverlayText& text, int width, int height) {
  ImGui::SetCurrentContext(gui_->context);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = 1 / 60.0f;
  ImGui_ImplOpenGL3_NewFrame();
  write(text, width, height);
  write(text, width, height);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Overlay::write(const OverlayText& text, int width, int height) {
  ImGui::NewFrame();
  if (text.page) {
    drawPage(text, width, height);
  } else {
    drawPanels(text, width, height);
  }
  ImGui::Render();
}

void Overlay::drawPanels(const OverlayText& text, int width, int height) {
  drawLabels(text, width, height);
  if (text.grid > 0) drawScale(text, width, height);
  if (text.choice.overlay) {
    drawStatus(text);
    drawTrial(text, width);
    if (text.choice.pads) drawPads(text, width);
    if (text.choice.bodies) drawBodies(text, width, height);
    drawCharts(text, width, text.timeline ? height - static_cast<int>(kBarHeight) : height);
    if (text.timeline) drawTimeline(text, width, height);
  }
  if (text.choice.timing) drawHealth(text, height);
  if (text.choice.help) drawHelp(text, width, height);
  drawNotice(text, width, height);
}

OverlayPanel::OverlayPanel(const char* name, double x, double y, double pivot_x, double pivot_y) {
  const auto inset = [](double pivot) { return static_cast<float>(1 - 2 * pivot) * kMargin; };
  const ImVec2 pivot(static_cast<float>(pivot_x), static_cast<float>(pivot_y));
  ImGui::SetNextWindowPos({static_cast<float>(x) + inset(pivot_x), static_cast<float>(y) + inset(pivot_y)},
                          ImGuiCond_Always, pivot);
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings);
}
OverlayPanel::~OverlayPanel() { ImGui::End(); }

}  // namespace pincer::tasks
