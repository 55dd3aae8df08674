// share_scene: a scene's run as a recording for a page, with the quantities that the scene records as charts.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "pincer/tasks/run/simulation.h"
#include "pincer/tasks/share/page_recording.h"

namespace pincer::tasks {

constexpr double kPicturesPerSecond = 50;  // as many as an eye follows
constexpr double kPicturesAtLeast = 200;   // of something short, which is then played slowly

// Ticks from one picture to the next of a run of `ticks` ticks of `h` seconds.
std::int64_t ticksPerPicture(std::int64_t ticks, double h);

// Runs the simulation to the scene's end or until its state isn't finite. Throws
// Interrupted. `progress` gets the ticks done.
PageRecording recordScene(Simulation& simulation, const std::string& title, MeshTable& meshes,
                          const std::atomic<bool>& interrupted,
                          const std::function<void(std::int64_t done)>& progress = {});

}  // namespace pincer::tasks
