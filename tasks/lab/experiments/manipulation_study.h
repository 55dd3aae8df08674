// manipulation_study: sphere pickup and cylinder alignment as one study (A. J. Doxon,
// dissertation, University of Utah, 2014).
//
// 12 participants; both tasks in one condition, then both in the other; every other participant begins with the second
// condition. A study file names other conditions, as many as it likes, their order and how often each participant goes
// through them. Training before each task in each condition. Every trial's seed follows from the study's, the
// participant's, the condition and the place in it, so that any trial can be done again alone. How many trials of
// training there are, and which task comes first, is ours.
#pragma once
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "pincer/tasks/lab/experiments/cylinder_alignment.h"
#include "pincer/tasks/lab/experiments/hands_cycle.h"
#include "pincer/tasks/lab/experiments/pickup_object.h"
#include "pincer/tasks/lab/experiments/sphere_pickup.h"
#include "pincer/tasks/lab/participants/participant_model.h"
#include "pincer/tasks/lab/study/survey.h"

namespace pincer::tasks {

struct TrainingTrials {
  int pickups = 2, alignments = 1;  // per condition, before the counted ones, 0 .. 100
};

struct ManipulationStudy {
  int participants = 12;  // 1 .. 1000
  std::uint64_t seed = 1;
  std::vector<HandCondition> conditions = publishedHandConditions();
  std::vector<HandTask> tasks{HandTask::kPickup, HandTask::kAlignment};  // done in this order
  TrainingTrials training;
  SpherePickupOptions pickup;          // its participants, conditions and seed don't count here
  CylinderAlignmentOptions alignment;  // likewise
  ParticipantModel people;
  SurveyPlan session = manipulationSurvey();  // what people read and are asked
  bool frozen_tactor = false;                 // the tactors stay parked in every condition (a control)
};

// Throws InputError naming the first value out of range, its range and the remedy.
void validate(const ManipulationStudy& study);

bool has(const ManipulationStudy& study, HandTask task);

// "sphere-pickup", "cylinder-alignment", or "manipulation" for both.
std::string taskName(const ManipulationStudy& study);

struct ManipulationTrial {
  HandTask task = HandTask::kPickup;
  PickupTrialSpec pickup;       // of the one task
  CylinderTrialSpec alignment;  // or of the other

  std::int64_t trial() const { return task == HandTask::kPickup ? pickup.trial : alignment.trial; }
  std::int64_t participant() const { return task == HandTask::kPickup ? pickup.participant : alignment.participant; }
  const HandCondition& condition() const { return task == HandTask::kPickup ? pickup.condition : alignment.condition; }
};

// Every trial, in the order of its doing. Throws as validate().
std::vector<ManipulationTrial> manipulationTrials(const ManipulationStudy& study);

// The thing that is picked up in each condition, by its name. Throws as makePickupObject().
using PickupObjects = std::map<std::string, PickupObject>;
PickupObjects makePickupObjects(const ManipulationStudy& study);

// The trial, not begun.
std::unique_ptr<HandTrial> makeTrial(const ManipulationStudy& study, const PickupObjects& objects,
                                     const ManipulationTrial& trial, RecordSink& sink);
std::unique_ptr<Participant> makeParticipant(const ManipulationStudy& study, const ManipulationTrial& trial);

struct TrialProgress {
  std::size_t done = 0, total = 0;  // trials
};

struct StudyHooks {
  std::set<std::int64_t> finished;                     // trials that needn't be done again
  std::function<void(const TrialProgress&)> progress;  // before the first and after every trial
  std::function<void(const ServoReport&)> served;      // what the servo says of each, the interrupted one included
  TrialHost host = {};                                 // who watches, and whose hands they are
};

// Every trial, with simulated participants unless `hooks.host` brings other hands. An interrupted trial
// leaves no row. Returns the number of trials finished, those of `hooks.finished` included. Throws
// InputError for bad options or a bad object.
std::size_t runManipulationStudy(const ManipulationStudy& study, const ServoOptions& servo, RecordSink& sink,
                                 const std::atomic<bool>& interrupted, const StudyHooks& hooks = {});

}  // namespace pincer::tasks
