// html_page: the parts that every report's page is made of. Text is escaped here; what these give is HTML.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "pincer/tasks/lab/report/report.h"

namespace pincer::tasks {

std::string escaped(const std::string& text);

// A table row of cells `tag` ("td", "th"); `attributes` stand in the row's own tag, with a blank before.
std::string htmlRow(const std::vector<std::string>& fields, const char* tag, const std::string& attributes = "");

// The same; of a cell "1.40 (1.10 to 1.78)" the interval stands in a line of its own, smaller.
std::string htmlRowOfIntervals(const std::vector<std::string>& fields, const std::string& attributes = "");

// A table of names and values.
std::string htmlFacts(const std::vector<std::pair<std::string, std::string>>& rows);

// The picture inside the page, its caption, and links to its files in `figures_name`.
std::string htmlFigure(const Picture& picture, const std::string& figures_name);

// Compiler, flags, C library and processor, as far as the session tells.
std::string buildFacts(const SessionInfo& info);

// Says which figures are missing; nothing if none is.
std::string htmlNotDrawn(const std::vector<std::string>& titles);

// Something long, folded away; nothing if `json` is empty.
std::string htmlDetails(const char* title, const std::string& json);

// People's answers beside the trials, a row per question and what it was asked of: how many answered, the mean and the
// range of numbers, and how often each answer was given. Nothing if nobody was asked, as of simulated people.
std::string htmlSurvey(const std::vector<SurveyRecord>& answers);
// A sentence that leads to the page that plays the session; nothing if there is none.
std::string htmlReplay(const ReplayPage& replay);

std::string htmlHead(const std::string& title, const std::string& warning);
std::string htmlFoot(const SessionInfo& info, const std::string& facts = "");  // what was run, and the end of the page

}  // namespace pincer::tasks
