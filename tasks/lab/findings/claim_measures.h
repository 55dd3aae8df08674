// claim_measures: what one study says, as named measures with one value per person, in the units of the claims.
//
//   NAME                 threshold of the condition NAME [segments, mm, ms]
//   finger:NAME          mean speed of the finger in it [mm/s]
//   tactor:NAME          of the tactor;   finger/tactor:NAME  their ratio
//   place-error          of delays: tactor speed times threshold, over the whole travel [mm]
//   error                of matched places, mean absolute [mm]
//   error:inner, error:outer  at the inner and the two outermost places
//   inward:outer         signed error towards the pad's middle at the two outermost places [mm]
//
//   tries:C, pickup-time:C, alignment-error:C, alignment-time:C  of both manipulation tasks, C "force" or "cld"
//                                                                [-], [s], [deg], [s]
//   alignment-time:longer                                        with the display, against without [s]
//   shape identification: shape_measures.h
//
// Who has no value has NaN; people stand in the same order everywhere.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "pincer/tasks/lab/report/study_summary.h"

namespace pincer::tasks {

struct StudyMeasures {
  std::map<std::string, std::vector<double>> people;
  std::map<std::string, bool> unsettled;  // measures whose staircases found no threshold
  std::size_t persons = 0;                // only measures of so many values, one per person, can be paired

  const std::vector<double>& of(const std::string& measure) const;  // empty where there is none
};

StudyMeasures measuresOf(const StudySummary& summary, const std::vector<ResponseRecord>& responses);
// Of the manipulation tasks.
StudyMeasures measuresOf(const std::vector<TrialRecord>& trials);

}  // namespace pincer::tasks
