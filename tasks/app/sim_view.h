// sim_view: a scene's simulation to look at: as a picture, or live in a window, with the fingers on their trajectories or on the mouse.
#pragma once
#include "tasks/app/view_run.h"
#include "tasks/scene/simulation.h"
#include "tasks/view/image.h"

namespace pincer::tasks {

// As it stands now, drawn in memory. Throws devices::DisplayError.
Image pictureOf(const Simulation& simulation);

// In real time, until the window is closed. With `mouse` the scene's fingers (one or two) follow it from where they start, without end;
// else the scene stands still where it ends. Throws InputError when the scene's fingers can't follow a mouse.
ServoReport watchScene(Simulation& simulation, const ViewOptions& options, bool mouse, const std::atomic<bool>& interrupted);

}  // namespace pincer::tasks
