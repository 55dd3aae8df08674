// checks: what must hold after every tick of a stressed world (stress.h), each
// found afresh from the state and the contacts.
#pragma once
#include <string>

#include "pincer/grasp/step.h"

namespace pincer::tasks {

// The complaint, for a person; empty when all holds.
std::string faultOfState(const engine::WorldModel& model, const engine::WorldState& state);
std::string faultOfCones(const engine::WorldScratch& scratch);
std::string faultOfLaw(const engine::WorldModel& model, const engine::WorldScratch& scratch);

// Kinetic and potential energy of all bodies [J].
double totalEnergy(const engine::WorldModel& model, const engine::WorldState& state);

}  // namespace pincer::tasks
