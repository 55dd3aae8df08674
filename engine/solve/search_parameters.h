// search_parameters: the parameters of the search (search.h); docs/engine.md gives their reasons.
#pragma once
#include <cstdint>

namespace pincer::engine {

// Enough.
constexpr double kShareOfSlip = 3e-4;  // of what pushes: below it, in motion, errors don't show
constexpr double kShareOfSlow = 0.03;  // of that slip: what is more would keep it from rest, however loose the accuracy
constexpr double kMostAccuracies = 100;  // of what is too entangled for anything but sweeps
constexpr double kQuiet = 1e-3;          // slip of what is about to rest, of the problem's speeds
constexpr double kNear = 100;            // of what is enough: a start that is nearer settles

// Rounds. Epsilon is e over w.
constexpr double kLeastEpsilon = 1e-5, kFirstEpsilon = 0.1, kMostEpsilon = 1;  // range, and the first at most
constexpr double kEpsilonOfError = 1e3;        // the first is that times the start's error [s/m]
constexpr double kEasier = 0.2, kHarder = 10;  // times epsilon: after a round of a few steps, after one that failed
constexpr int kEasySteps = 2;
constexpr double kLeft = 0.1;         // of what is enough, and of the error before: a round's own error
constexpr double kStillFading = 0.7;  // of a give or an error before
constexpr double kFar = 3e-4;         // from where rounds rather fail [m/s]
constexpr int kRoundPatience = 3, kMostFailures = 12;  // rounds whose give doesn't fade, rounds that fail; chosen
constexpr int kPolishRounds = 3;                       // of what is quiet, to round-off
constexpr double kPolishEpsilon = 1e-4;

// Descents.
constexpr double kFirstDescent = 1e-2;                // epsilon, at most
constexpr double kRough = 1e-2, kMostlyGive = 0.3;    // a descent's error, of its start's; a give, of its error
constexpr int kDescents = 6, kMostDescentSteps = 30;  // at a time; of one

// Sweeps.
constexpr double kSliding = 1e4;    // of the accuracy: fast slips
constexpr double kSwept = 3e-4;     // of the problem's speeds: an error that sweeps reach for less than steps
constexpr int kSweepsAtATime = 16;  // they cost two steps

// Contacts that are soft (squeeze.h).
constexpr int kSoftSteps = 12;  // Newton's, chosen

// Work.
constexpr int kProductsPerRoundContact = 3;  // between balls: a row of them in a groove takes one
constexpr int kMostRoundMovers = 100;  // whose factors are sought where sweeps failed: of more that costs too much
constexpr std::int64_t kPerContactLooked = 150, kFewestOperations = 60'000'000;  // multiplications; a search's, 80 ms
constexpr int kMostFactorisations = 160;              // and their steps: beyond, the best iterate counts
constexpr int kFewFactorisations[] = {80, 160, 480};  // of few contacts, by effort: 80 find 98 in a hundred
constexpr int kSweptFactorisations = 80;              // where sweeps failed: four in five are found
constexpr int kPatient = 10;                          // times as much of everything, where there is time
constexpr double kHitSpeed = 3e6;                     // of the accuracy: problems of such speeds are hits
constexpr int kHitSolves = 6;                         // that share a tick's hits

}  // namespace pincer::engine
