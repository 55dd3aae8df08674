// findings_report: what `runFindings` found, for a terminal, for machines, and as one HTML page with a picture.
#pragma once
#include <string>

#include "pincer/tasks/lab/findings/claim_judge.h"
#include "pincer/tasks/lab/findings/findings.h"

namespace pincer::tasks {

std::string findingsText(const FindingsResult& result);
std::string findingsCsv(const FindingsResult& result);
// `claims`: the table of published findings, beside the page as claims.csv.
// The page, its pictures inside; beside it <name>_figures/ with the pictures as PNG and the numbers
// as CSV. Needs gnuplot. Throws InputError.
void writeFindingsPage(const FindingsResult& result, const ClaimTable& claims, const std::string& path);

}  // namespace pincer::tasks
