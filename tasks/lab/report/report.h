// report: what happened in a sphere-pickup session, as one HTML file that needs
// nothing else, and its figures beside it.
//
//   <name>.html            what was run, the table, all figures inside it as PNG
//   <name>_figures/        each figure as PNG and the numbers that it draws as CSV
//
// Files appear whole or not at all and replace older ones. Needs gnuplot. Throws InputError (path or program, cause,
// remedy). A session that was killed or aborted gets its report too; it says so at the top.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "pincer/tasks/lab/report/gnuplot.h"
#include "pincer/tasks/lab/report/summary.h"

namespace pincer::tasks {

// A page that plays the session (tasks/share), for links to it.
struct ReplayPage {
  std::string name;                  // as an address, relative to the report; empty: there is none
  std::vector<std::int64_t> trials;  // which trial each of its recordings is, from 0
};

struct ReportOptions {
  std::string gnuplot = "gnuplot";                 // the plotting program, a name in PATH or a path
  const std::atomic<bool>* interrupted = nullptr;  // ends the report with Interrupted; null: never
  ReplayPage replay = {};
};

struct ReportFiles {
  std::string html, figures_directory;
  std::vector<std::string> figures;    // paths of the PNG files
  std::vector<std::string> not_drawn;  // titles of figures that no trial has numbers for yet
};

ReportFiles writeReport(const SessionReader& session, const std::string& html_path, const ReportOptions& options = {});

// A figure as it stands in the page.
struct Picture {
  Figure figure;
  std::string png;
  std::string anchor_trial;  // the trial that the caption is about, or empty
  std::string svg = {};
};

// Plots the pictures and writes them, as PNG, SVG and CSV, to the directory that belongs to the page at
// `html_path`. Returns that directory's name relative to the page and fills in `files`. Pictures that have nothing
// to draw are taken out; the page says which.
std::string plotAndWrite(std::vector<Picture>& pictures, const std::string& html_path, const ReportOptions& options,
                         ReportFiles& files);

// The page itself. `figures_name`: the figures' directory relative to the page;
// `devices`: HTML of what the devices did.
std::string reportHtml(const SessionSummary& summary, const std::vector<TrialRecord>& trials,
                       const std::vector<Picture>& pictures, const std::string& figures_name,
                       const std::string& devices = "", const ReplayPage& replay = {});

}  // namespace pincer::tasks
