// state_bytes: a state as bytes and back, for pickles and for other processes of the same program.
//
// Numbers as they lie in memory, one part after the other; so the bytes are for the same build of pincer, and say so.
#pragma once
#include <string>
#include <string_view>

#include "pincer/tasks/run/rollout/scene_state.h"

namespace pincer::tasks {

// Throws InputError where fingers are rendered as published: what those remember isn't open.
std::string bytesOf(const SceneState& state);

// Throws InputError when the bytes are another build's, another model's, or cut off; `state` is as it was then.
void setFromBytes(SceneState& state, std::string_view bytes);

}  // namespace pincer::tasks
