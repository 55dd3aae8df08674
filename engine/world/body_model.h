// body_model: from what the builder is told about one body to its model: shapes, mass, inertia, extent.
#pragma once
#include <string>
#include <vector>

#include "pincer/engine/model.h"

namespace pincer::engine {

// Throws InputError "`what` = `value` is out of range [`low`, `high`]. `remedy`".
void requireRange(const std::string& what, double value, double low, double high, const char* remedy);
void checkMaterial(const std::string& body, const Material& material);  // throws InputError

// Half-spaces and dishes: no mass, no end, never move.
bool isSupport(const contact::Shape& shape);

// The shapes of the body with this number, or its only one. Throws InputError where a material or pose can't be.
std::vector<ColliderModel> collidersFor(const BodySpec& spec, int number);

// The body of these shapes, in a world of the given contact margin, but for where they stand in the model and for its
// motion. Throws InputError where its mass or inertia can't be.
BodyModel bodyFor(const BodySpec& spec, const std::vector<ColliderModel>& colliders, double margin);

}  // namespace pincer::engine
