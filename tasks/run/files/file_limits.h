// file_limits: how large what the program reads may be, and why; docs/limits.md has the table. What a text file takes
// in memory was measured with a file of that size (tests/unit/tasks/app/input_limits_test.cpp).
#pragma once
#include "pincer/contact/io/input_file.h"

namespace pincer::tasks {

// A scene of kMostBodies bodies with every key takes some 4 MB; a study 20 kB, a calibration 1 kB.
inline constexpr InputKind kSceneFile = {"a scene (a JSON file, docs/scenes.md)", 8 * kMegabyte, true,
                                         "Long trajectories go into CSV files, meshes into files of their own."};
inline constexpr InputKind kStudyFile = {"a study (a JSON file, docs/experiments.md)", kMegabyte, true,
                                         "`pincer run TASK --print-study` prints one."};
inline constexpr InputKind kCalibrationFile = {"a calibration (a JSON file, docs/devices/setup.md)", kMegabyte / 16,
                                               true, "`pincer devices calibrate --save` writes one."};
// Half an hour at 1 kHz, with 35 bytes per row.
inline constexpr InputKind kTrajectoryFile = {"a trajectory (a CSV file, docs/scenes.md)", 64 * kMegabyte, true,
                                              "Cut it, or keep fewer samples per second."};
// 100,000 cases of ten numbers.
inline constexpr InputKind kCasesFile = {"a table of cases (a CSV file, docs/sweeps.md)", 32 * kMegabyte, true,
                                         "Cut it into several sweeps."};
// The samples of a study of 12 participants as `pincer export` writes them; read line
// by line, as far as the first trial goes.
inline constexpr InputKind kRecordingFile = {"a recording (a session.db, or a CSV file of samples)", 4096 * kMegabyte,
                                             false, "Cut it to the trial that shall be replayed."};
// The Falcon's own has some 16 kB.
inline constexpr InputKind kFirmwareFile = {"a firmware image", kMegabyte, false,
                                            "Is it the image out of the maker's driver?"};

// Numbers, texts, lists and objects in a JSON file: three times those of a scene of kMostBodies
// bodies. Each takes some 300 bytes of memory.
constexpr std::size_t kMostJsonValues = 250'000;
// The largest heaps that are measured have 1,000 bodies (pincer bench engine); a tick
// of 4,096 apart from each other takes 1 ms.
constexpr std::size_t kMostBodies = 4096;
constexpr std::size_t kMostRobots = 64;
constexpr std::size_t kMostJoints = kMostBodies;
constexpr std::size_t kMostPairs = 4 * kMostBodies;  // special ones
constexpr std::size_t kMostFingers = 64;             // six hands of ten, and four
constexpr std::size_t kMostQuantities = 1024;        // columns of a table; likewise expectations
constexpr std::size_t kMostHullPoints = 100'000;     // of a convex shape, which may have 4,096 corners
// of a lathe: with 1000 segments the 2 million triangles that a mesh may have
constexpr std::size_t kMostProfilePoints = 1000;
constexpr std::size_t kMostInStudyList = 100;  // conditions, frictions: each is done by every participant
constexpr std::size_t kLongestName = 64;       // [bytes], so that tables keep their shape

}  // namespace pincer::tasks
