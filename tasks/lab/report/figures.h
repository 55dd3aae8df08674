// figures: the pictures of a sphere-pickup session, as gnuplot scripts with their data.
//
// Data files keep SI units but for what is drawn in mm (then the column says so). Colours: M. Okabe, K. Ito, "Color
// universal design", 2008, distinguishable with any colour vision; finger 0 is the index finger, finger 1 the thumb.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pincer/tasks/lab/report/gnuplot.h"
#include "pincer/tasks/lab/report/summary.h"

namespace pincer::tasks {

// A measure over friction: each trial as a dot, each cell's mean with its interval. `measure` is a place in kMeasures.
Figure measureFigure(const SessionSummary& summary, const std::vector<TrialRecord>& trials, std::size_t measure);

// The condition's trial with the median number of squeezes (of two middle ones the lower;
// of equals the earliest), faults left out.
std::optional<TrialRecord> representativeTrial(const std::vector<TrialRecord>& trials, const std::string& condition);

struct TrialTrace {
  TrialRecord trial;
  std::vector<SampleRecord> samples;
  std::vector<EventRecord> events;
  std::string label;  // of its condition
};
TrialTrace traceOf(const SessionReader& session, const TrialRecord& trial, const std::string& label);

// Over the trial's time: events, height, grip forces, each finger's friction
// against its limit. `trace` must hold a sample.
Figure trialFigure(const TrialTrace& trace);

// Where the tactors were told to be on the fingerpads and where they were. `trace` must hold a sample.
Figure tactorFigure(const TrialTrace& trace);

// "trial 7 (participant 0, µₛ 0.45)".
std::string trialWords(const TrialRecord& trial);

// Each participant in all conditions, joined by a line: squeezes and time per sphere, error and time of alignment.
// Nothing with fewer than two participants in the first and another.
std::optional<Figure> peopleFigure(const SessionSummary& summary);

// True unless all tactors were parked throughout the trial.
bool isShownByTactors(const TrialTrace& trace);

// Error and time of alignment, each trial as a dot, one column per condition, means beside them.
Figure alignmentFigure(const SessionSummary& summary, const std::vector<TrialRecord>& trials);

// Over a trial of alignment: events, direction of the flat from its target, grip forces. `trace` must hold a sample.
Figure turnFigure(const TrialTrace& trace);

// How long the ticks took: histogram and percentiles. Nothing if no tick was timed.
std::optional<Figure> tickFigure(const SessionReader& session);

// A file name's part from any text: other than letters, digits and - becomes _.
std::string fileNamePart(const std::string& text);

namespace palette {
// Colours that the colour-blind tell apart (Okabe and Ito), ink and grey: red, green, blue in hexadecimal.
constexpr const char *kBlue = "#0072B2", *kVermillion = "#D55E00", *kGreen = "#009E73", *kPurple = "#CC79A7",
                     *kOrange = "#E69F00", *kSkyBlue = "#56B4E9", *kInk = "#222222", *kGrey = "#999999";
}  // namespace palette

// One colour for one meaning in all figures: conditions blue, vermillion ...; fingers green and purple.
const char* conditionColour(std::size_t condition);
int conditionPoint(std::size_t condition);  // gnuplot's number of its mark

struct FingerStyle {
  const char *name, *colour;
};
// By the finger's number in a session.
constexpr std::array<FingerStyle, kRecordedFingers> kFingers{
    {{"index finger", palette::kGreen}, {"thumb", palette::kPurple}}};

// Lines and letters that all figures share; `data` is then the figure's table, <name>.csv.
std::string figurePrelude(const std::string& name);

}  // namespace pincer::tasks
