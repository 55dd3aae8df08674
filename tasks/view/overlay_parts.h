// overlay_parts: the panels of the overlay, each drawn by one function between the beginning and the end of a picture.
#pragma once
#include "pincer/tasks/view/overlay.h"

namespace pincer::tasks {

// A panel of its own size at a corner of the picture: the place (x, y) [pixels] is the panel's (pivot_x, pivot_y), 0
// left or upper, 1 right or lower. What is written while it lives is in it.
class OverlayPanel {
 public:
  OverlayPanel(const char* name, double x, double y, double pivot_x, double pivot_y);
  ~OverlayPanel();
  OverlayPanel(const OverlayPanel&) = delete;
  OverlayPanel& operator=(const OverlayPanel&) = delete;
};

constexpr double kBarHeight = 40;  // of the bar of times at the picture's lower border [pixels]

void drawLabels(const OverlayText& text, int width, int height);
void drawScale(const OverlayText& text, int width, int height);     // right, over the bar
void drawTimeline(const OverlayText& text, int width, int height);  // the bar
void drawBodies(const OverlayText& text, int width, int height);    // right
void drawStatus(const OverlayText& text);                           // upper left
void drawTrial(const OverlayText& text, int width);                 // upper middle
void drawPads(const OverlayText& text, int width);                  // upper right
void drawCharts(const OverlayText& text, int width, int height);    // lower left
void drawHealth(const OverlayText& text, int height);               // left
void drawHelp(const OverlayText& text, int width, int height);
void drawPage(const OverlayText& text, int width, int height);    // over all of it
void drawNotice(const OverlayText& text, int width, int height);  // lower middle

}  // namespace pincer::tasks
