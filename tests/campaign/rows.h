// rows: what each row of the campaign does with a case. The table that names them is in rows.cpp.
#pragma once
#include "pincer/tests/campaign/row.h"

namespace pincer::campaign {

int allCommandLines(const Ground& ground);
void harmCommandLine(Case& c);

void harmScene(Case& c);
void harmStudy(Case& c);
void harmTrajectory(Case& c);
void harmMesh(Case& c);
void harmDeviceFile(Case& c);

int allSpecialFiles(const Ground& ground);
void useSpecialFile(Case& c);

int allDamagedColumns(const Ground& ground);
void damageColumn(Case& c);
void damageSessionFile(Case& c);

void killSession(Case& c);
void runTwoPrograms(Case& c);
void signalProgram(Case& c);

void failCall(Case& c);
void failAllocation(Case& c);
int allFailures(const Ground& ground);
void failEach(Case& c);

int allStreams(const Ground& ground);
void breakStreams(Case& c);
void plantLinks(Case& c);
void fillDisk(Case& c);

void useHostileNames(Case& c);
int allSurroundings(const Ground& ground);
void changeSurroundings(Case& c);
int allProcessors(const Ground& ground);
void changeProcessor(Case& c);

void harmFrames(Case& c);
void harmMessages(Case& c);
void harmFalconPackets(Case& c);

}  // namespace pincer::campaign
