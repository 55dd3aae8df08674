// page_view: pages and questions that a person reads in a window, and what is typed there.
#pragma once
#include <atomic>
#include <optional>
#include <string>

#include "pincer/devices/window/surface.h"
#include "pincer/tasks/lab/finger/finger_host.h"

namespace pincer::tasks {

// Until Enter. False: the person has closed the window, or `interrupted`.
bool showPage(devices::Surface& surface, const std::string& title, const StudyPage& page,
              const std::atomic<bool>& interrupted);

// Text typed until Enter: letters, digits and signs of a US keyboard. Absent: the person has left.
std::optional<std::string> askOnPage(devices::Surface& surface, const std::string& title, const AskedQuestion& question,
                                     const std::atomic<bool>& interrupted);

}  // namespace pincer::tasks
