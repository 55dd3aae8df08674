// session_lock: one program writes a session at a time.
//
// A writer holds a lock (file_descriptor.h) on `<session>-lock`, a file beside the session that says who holds it, and
// removes it when it is done. The file of a killed writer stays, without a lock, until the next writer comes. The lock
// isn't on the session itself: SQLite keeps POSIX locks there, which the process loses with any descriptor of that
// file that it closes. Readers need no lock.
#pragma once
#include <string>

#include "pincer/contact/io/file_descriptor.h"

namespace pincer::tasks {

class SessionLock {
 public:
  // Throws InputError: the session is being written (by whom), or the lock's file can't be made.
  explicit SessionLock(const std::string& session);
  SessionLock(SessionLock&& other) noexcept = default;
  ~SessionLock();

 private:
  std::string path_;
  FileDescriptor file_;
};

// Who is writing the session: "process 4711 on box, since 2026-11-23T09:30:00Z". Empty: nobody.
std::string sessionWriterOf(const std::string& session);

std::string nowUtc();  // ISO 8601

}  // namespace pincer::tasks
