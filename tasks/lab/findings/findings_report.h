// findings_report: what `runFindings` found, for a terminal, for machines, and as one HTML page with a picture.
#pragma once
#include <string>

#include "pincer/tasks/lab/findings/findings.h"
#include "pincer/tasks/lab/findings/published_figures.h"

namespace pincer::tasks {

std::string findingsText(const FindingsResult& result);
std::string findingsCsv(const FindingsResult& result);
// `studies`: what was found of the published figures of the studies with one finger; may be empty.
// The page, its pictures inside; beside it <name>_figures/ with the pictures as PNG and the numbers as CSV. Needs gnuplot. Throws InputError.
void writeFindingsPage(const FindingsResult& result, const PublishedFindings& studies, const std::string& path);

}  // namespace pincer::tasks
