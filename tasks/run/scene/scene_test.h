// scene_test: scenes with expectations as tests: found, run side by side, reported; hashes that they pin are renewed.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "pincer/tasks/run/scene/sim_run.h"

namespace pincer::tasks {

// Outcome of one scene.
struct SceneVerdict {
  std::string file;
  std::vector<std::string> failures;  // a sentence each: quantity, time, wanted, measured, why; and a run that broke
  std::string error;                  // it couldn't be read or built: the message
  std::size_t expectations = 0;
  double seconds = 0;  // that it took
  bool run = false;    // false: interrupted before its end

  bool isGood() const { return run && failures.empty() && error.empty(); }
};

struct SceneTestOptions {
  int jobs = 1;                // scenes at once
  bool update_hashes = false;  // writes the hashes that were measured into the files, in place of those expected
  // Called after a scene has failed, from any thread, one at a time.
  std::function<void(const SceneVerdict& verdict, const Simulation& simulation)> failed = {};
  std::function<void(const SceneVerdict& verdict, std::size_t done, std::size_t total)> progress = {};
};

// Files as they are given, names of built-in scenes, and of folders all *.json below that expect something, in the
// order of their names. Throws InputError where there is nothing.
std::vector<std::string> findSceneTests(const std::vector<std::string>& paths);

// One verdict per file, in the same order; neither jobs nor order change what is in it, but the times.
std::vector<SceneVerdict> runSceneTests(const std::vector<std::string>& files, const SceneTestOptions& options,
                                        const std::atomic<bool>& interrupted);

// The verdicts as JUnit's XML, which CI servers read: a failed expectation is a
// failure, a file that can't be read an error.
std::string junitText(const std::vector<SceneVerdict>& verdicts);

// A failed scene as a file that replays it: the scene's file, the build, and the hash of the state after every tick up
// to its end. Small: the state itself follows from the scene.
std::string sceneLog(const std::string& file);
// Runs the scene of a log again. Returns a sentence that names the first tick that differs;
// empty: the same to the bit. Throws InputError.
std::string replaySceneLog(const std::string& log, const std::atomic<bool>& interrupted);

}  // namespace pincer::tasks
