// finger_tick: a tick's work on one finger, before and after the world's step.
#pragma once
#include <span>

#include "pincer/engine/world/stages.h"
#include "pincer/grasp/tick/scratch.h"

namespace pincer::grasp {

// Fills scratch.inputs and q_mid_WF: where the devices lead the proxies.
void setInputs(const GraspModel& model, const GraspState& state, std::span<const FingerInput> inputs,
               GraspScratch& scratch);

// A finger's contacts, which follow each other, sorted by id.
using FingersContacts = std::span<const engine::Contact>;

// Fills scratch.fingers[finger] from its contacts of the tick.
void reportFinger(const GraspModel& model, const GraspState& state, int finger, FingersContacts contacts,
                  GraspScratch& scratch);

// Contacts of `finger` and, sorted, of all behind it.
FingersContacts contactsFrom(const GraspScratch& scratch, int finger);
// Contacts of `finger`, with which `sorted` begins if it has any.
FingersContacts firstOf(FingersContacts sorted, int finger);

// Fills FingerReport::pressure of a finger that has taxels, from its report and its contacts.
void mapPressure(const GraspModel& model, int finger, FingersContacts contacts, GraspScratch& scratch);

// Notes in `state` what the next tick needs to know of scratch.fingers[finger],
// and in that the touch of the tick before.
void rememberFinger(const GraspModel& model, const FingerInput& input, int finger, GraspState& state,
                    GraspScratch& scratch);

// True if the fingers are turned as they were when their reports were made: what the pads feel turns with them.
bool keepOrientations(std::span<const FingerInput> inputs, const GraspScratch& scratch);

}  // namespace pincer::grasp
