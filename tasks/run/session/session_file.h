// session_file: a session's file before the first trial and between two programs. Internal to the session store.
#pragma once
#include <string>

#include "pincer/tasks/run/records.h"
#include "pincer/tasks/run/session/database.h"

namespace pincer::tasks {

// Makes the session at `path` under another name, with its tables and its first row, then puts it in
// place: a kill leaves no beginnings of a session behind. `max_pages` of the file; 0: no limit. Throws
// InputError; also where something stands at `path`.
void makeSession(const std::string& path, const SessionInfo& info, std::int64_t max_pages);

// Switches to SQLite's write-ahead log.
void openForWriting(Database& d, std::int64_t max_pages);

// Inside one transaction, these three: tables, columns and indexes that an older format lacks;
void upgradeTables(Database& d);
// what the session holds of trials that weren't finished is removed;
void removeUnfinished(Database& d);
// this program is named after the one that the session names, where it is another.
void tellWhoGoesOn(Database& d, SessionInfo info);

}  // namespace pincer::tasks
