// part_file: the file under a temporary name, beside the place where it is to
// appear: `.<name>.<16 hexadecimal digits>.part`.
//
// The name is drawn at random and made with O_EXCL | O_NOFOLLOW: nothing that was planted there is followed
// or overwritten, and two programs that write the same file don't share one part. The mode is the umask's.
// Parts that a killed program left of the same file are removed on the way: a part is locked while its program
// lives, so that one without a lock is nobody's.
//
// Errors: InputError with path, cause and remedy; the part is removed.
#pragma once
#include <string>

#include "pincer/contact/io/file_descriptor.h"

namespace pincer {

class PartFile {
 public:
  explicit PartFile(std::string path);  // of the file to come
  PartFile(PartFile&&) = delete;
  ~PartFile();  // not put in place: nothing is left

  const std::string& name() const { return part_; }
  int descriptor() const { return file_.get(); }
  // Gives up descriptor and lock, for a library that opens the file by its name (SQLite loses its
  // own locks when any descriptor is closed).
  void release() { file_ = FileDescriptor(); }

  void replace();   // puts it in place, whatever stood there; a link is replaced, not followed
  void placeNew();  // puts it in place, where nothing may stand

 private:
  [[noreturn]] void fail(const char* doing) const;
  void placed();
  std::string path_, part_;
  FileDescriptor file_;
};

// True if a part of the file at `path` is there: it is being written, or a killed program left it.
bool hasPart(const std::string& path);

// Removes what killed programs left of the file at `path`.
void removeLeftParts(const std::string& path);

// Throws InputError: "<path>: can't <doing>: <what errno says>. <remedy>".
[[noreturn]] void failOnFile(const std::string& path, const char* doing, int error);

}  // namespace pincer
