// inputs: sound files of every kind that the program reads, made once; cases harm copies of them.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "pincer/tests/campaign/row.h"

namespace pincer::campaign {

// Makes all of them under ground.inputs(), and measures ground.session_time. Throws
// std::runtime_error if the program can't.
void makeInputs(Ground& ground);

std::vector<fs::path> sceneFiles(const Ground& ground);  // of the house, and one whose finger follows a table
std::vector<fs::path> studyFiles(const Ground& ground);  // TASK.json
std::vector<fs::path> meshFiles(const Ground& ground);   // of every format, text and binary

fs::path trajectoryScene(const Ground& ground);  // its finger follows trajectory.csv, beside it
fs::path trajectoryTable(const Ground& ground);
fs::path pickupSession(const Ground& ground);   // complete, four trials
fs::path killedSession(const Ground& ground);   // the same, killed after some of them
fs::path peoplesSession(const Ground& ground);  // complete, one trial, with the inputs of every tick
fs::path studySession(const Ground& ground);    // complete, of one finger, with some hundred responses
fs::path recordingFile(const Ground& ground);   // samples of a trial, as export writes them
fs::path calibrationFile(const Ground& ground);
fs::path robotFile(const Ground& ground);  // MJCF: two links, a drive

// Of the session in pickupSession, for a new folder `out`.
std::vector<std::string> pickupArguments(const std::string& out);
std::vector<std::string> studyArguments(const std::string& out);  // of the session in studySession
std::vector<std::string> resumedPickup(const std::string& out);   // to go on with it
inline constexpr int kPickupTrials = 4;

}  // namespace pincer::campaign
