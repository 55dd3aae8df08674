// json_change: a JSON file with some of its numbers changed, as if they had been written so: what reads it
// says the same of them, with the same line.
//
//   bodies[0].material.mu_s      fingers[1].force[2]      solver.tolerance
#pragma once
#include <string>
#include <string_view>

#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {

// Sets the number at `path`. A key that isn't there is added, with the objects around it; an element of a list has to
// be there. Whether the key may be there is for the reader to say. Throws InputError: for a path that is none, that
// leads through something else, or to something that is no number.
void setNumber(JsonValue& file, std::string_view path, double value);

// The value at `path`, or as far along it as the file goes. `path` is one of ours.
const JsonValue& nearestTo(const JsonValue& file, std::string_view path);

// The path in a scene: one that begins with the name of a body, joint or finger becomes that of
// its object ("sphere.mass" -> "bodies[2].mass"). Throws InputError, with a did-you-mean, where
// there is neither such a key nor such a name.
std::string scenePath(const JsonValue& scene, std::string_view path);

}  // namespace pincer::tasks
