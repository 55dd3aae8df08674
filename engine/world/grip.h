// grip: which islands are grips of one free body (solve/grip_problem.h).
#pragma once
#include <span>
#include <vector>

#include "pincer/engine/solve/grip_problem.h"
#include "pincer/engine/world/contact.h"

namespace pincer::engine {

struct Island;
struct IslandScratch;
struct WorldScratch;

// False of nearly all that aren't, at next to no cost: a grip holds by a face, and points come last by id.
bool mayBeGrip(const IslandScratch& s, const Island& island, const std::vector<Contact>& contacts);

// False if the contacts `order` aren't those of a grip.
bool readGrip(const WorldModel& model, const WorldScratch& scratch, std::span<const int> order, GripProblem& grip);

}  // namespace pincer::engine
