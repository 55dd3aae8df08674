// study_summary: what a psychophysical session found, per condition.
//
// Each task has one headline figure, taken per participant and then averaged with its 95 %
// interval over the participants (statistics.h):
//
//   discriminations        threshold: mean of the last reversals of the staircase; of the polygons in segments, a
//                          person's mean of n, never the n of a mean of angles (tasks/lab/study/arc_segments.h)
//   repeated-localisation  mean absolute error of the places named
//   shape-identification   share of right answers
// All other figures are participants' means likewise. Trials that weren't
// answered count as trials and for nothing else.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/lab/report/statistics.h"
#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

// A figure's name and how a person reads it: shown value = scale x SI value.
struct HeadlineQuantity {
  std::string name, unit;
  double scale = 1;
  std::string level_unit{};  // of the staircases' levels
  double level_scale = 1;
  Averaged averaged = Averaged::kPositive;
};

struct StudyPerson {
  std::int64_t participant = 0;
  double headline = 0;  // SI; NaN if the staircase found none
};

struct StudyCondition {
  std::string name, label;
  double published = 0;  // headline, SI; NaN if there is none
  int averaged = 0;      // reversals that make a threshold; 0: no staircase
  std::int64_t trials = 0, unanswered = 0;
  std::vector<StudyPerson> people;
  Estimate headline;                    // SI
  Estimate right;                       // share of right answers [-]
  Estimate duration, response_time;     // [s]
  Estimate contact_share;               // [-]
  Estimate finger_speed, tactor_speed;  // [m/s]
};

// True if its staircases ended before they had risen to a threshold: one that settles is answered right in 70.7 % of
// its trials and more; at chance it has only begun to rise from where it started.
bool isUnsettled(const StudyCondition& condition);

struct StudySummary {
  std::string path;
  SessionInfo info;
  std::string state, started_utc, warning;
  std::string fingerprint;  // of the participants' parameters
  std::int64_t participants = 0, trials = 0;
  HeadlineQuantity headline;
  std::vector<StudyCondition> conditions;  // in the protocol's order
};

// The level, shown, at which a threshold lies; the same unless thresholds are counted in segments.
double levelShown(const StudySummary& summary, double headline);

// True if the session is of a task that this summary is for.
bool isStudy(const std::string& task);

// Throws InputError for a session of something else, and a protocol that can't be
// read; `name` stands for the session there.
StudySummary summariseStudy(const SessionInfo& info, const std::string& name,
                            const std::vector<ResponseRecord>& responses);
StudySummary summariseStudy(const SessionReader& session, const std::vector<ResponseRecord>& responses);

std::vector<std::string> studyTableHeads(const StudySummary& summary);
std::vector<std::string> studyTableRow(const StudySummary& summary, const StudyCondition& condition);
std::string studyNote(const StudySummary& summary);
// The outcome in words that need no table: who took part, and each condition's figure
// with its interval beside the published one.
std::string studyFinding(const StudySummary& summary);

std::string formatStudyTable(const StudySummary& summary);  // for a terminal
std::string studySummaryJson(const StudySummary& summary);  // for machines

}  // namespace pincer::tasks
