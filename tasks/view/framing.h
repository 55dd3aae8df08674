// framing: where a camera stands so that most of each thing is seen.
//
// Of eight ways around the scene it takes the one with the largest sum over things of log(1 + pixels that show it), so
// that a small thing behind a large one counts as much as a large one seen edge-on; the given one, if it is nearly as
// good. Then things fill the picture.
#pragma once
#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/view/renderer.h"

namespace pincer::tasks {

// `plain` with another yaw, target and distance; as it is where `list` has no things (DrawItem::thing). What `given`
// has stays as given.
Camera framed(const DrawList& list, const Camera& plain, const SceneCamera& given, Renderer& renderer);

// `camera` with what is given.
Camera withGiven(const SceneCamera& given, Camera camera);

}  // namespace pincer::tasks
