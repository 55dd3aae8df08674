// claim_judge: what the sessions of many simulated studies say of the published claims.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "pincer/tasks/lab/findings/claim_measures.h"
#include "pincer/tasks/lab/findings/claims.h"

namespace pincer::tasks {

// Files by study. Controls: the tactor is parked in every condition; what is felt is drawn,
// whatever is asked (shape identification).
struct StudySessions {
  std::map<std::string, std::vector<std::string>> studies, parked, unrelated;
};

struct ClaimRow {
  const Claim* claim = nullptr;
  ClaimEvidence evidence;
  ClaimEvidence parked, unrelated;  // the same under the controls; no studies: not run
};

struct ClaimTable {
  std::vector<ClaimRow> rows;             // in the order of publishedClaims()
  std::string commit;                     // of the program that ran the studies; empty: none ran
  std::vector<std::string> participants;  // "study: fingerprint of its people"
};

// Evidence of one claim from studies' measures.
ClaimEvidence evidenceOf(const Claim& claim, const std::vector<StudyMeasures>& studies);

// Unfinished sessions are left out. Throws InputError for a session that can't be read, and where two
// are of different commits, claims or people.
ClaimTable judgeClaims(const StudySessions& sessions);

std::string claimTableText(const ClaimTable& table);
std::string claimTableCsv(const ClaimTable& table);
std::string claimTableMarkdown(const ClaimTable& table);
std::string claimTableHtml(const ClaimTable& table);

}  // namespace pincer::tasks
