// findings_report: what `runFindings` found, for a terminal, for machines, and as one HTML page with a picture.
#pragma once
#include <string>

#include "tasks/findings/findings.h"

namespace pincer::tasks {

std::string findingsText(const FindingsResult& result);
std::string findingsCsv(const FindingsResult& result);
// The page, its picture inside; beside it <name>_figures/ with the picture as PNG and the numbers as CSV. Needs gnuplot. Throws InputError.
void writeFindingsPage(const FindingsResult& result, const std::string& path);

}  // namespace pincer::tasks
